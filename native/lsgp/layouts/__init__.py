# SPDX-License-Identifier: GPL-3.0-or-later
"""Where islands lie: packing, stacks, UDIM tiles, texel density, the placement of an earlier map."""

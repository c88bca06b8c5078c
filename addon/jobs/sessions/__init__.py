# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones and Edit Cuts: picking, steps, the map that follows, and the end of a session."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Tools on selected islands of UV maps."""

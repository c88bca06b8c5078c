# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones marked, selected, placed and edited, and all that is stored about them cleared."""

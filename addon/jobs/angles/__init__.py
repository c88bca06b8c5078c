# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles of cones before unwrapping: their table, whether they are possible, and what further cones would gain."""

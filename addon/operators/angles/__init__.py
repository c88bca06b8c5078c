# SPDX-License-Identifier: GPL-3.0-or-later
"""The angles of cones set, snapped, spread, suggested and previewed, and the rows of their table."""

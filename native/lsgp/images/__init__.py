# SPDX-License-Identifier: GPL-3.0-or-later
"""Gutters of images: texels beyond the borders of islands, filled from the other sides of cuts."""

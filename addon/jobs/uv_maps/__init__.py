# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps as they are on meshes: their texel densities, their distortion, and gutters of the images they show."""

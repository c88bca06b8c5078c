# SPDX-License-Identifier: GPL-3.0-or-later
"""A map in one call: the choices of the presets among cones, creases and divisions."""

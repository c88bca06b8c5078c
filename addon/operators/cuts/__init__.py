# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts of the UV map: moved, steered, selected, marked as seams, and crossed by an extended image."""

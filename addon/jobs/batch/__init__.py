# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's command line: many files, each unwrapped as a whole."""

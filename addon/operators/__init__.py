# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's operators, one per file, in rooms by topic, and what they share. Mathematics belongs in jobs."""

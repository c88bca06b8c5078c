# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished maps on their way to the mesh: islands packed, stacked and scaled, and maps kept for the next run."""

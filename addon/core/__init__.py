# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays, names, errors and findings. Reads nothing from meshes, draws nothing."""

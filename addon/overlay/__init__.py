# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing over meshes: first as arrays, then with the GPU."""

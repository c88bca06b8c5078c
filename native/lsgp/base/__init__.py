# SPDX-License-Identifier: GPL-3.0-or-later
"""What all other modules use: checked arguments, dataclasses that hold arrays, edges as numbers, progress."""

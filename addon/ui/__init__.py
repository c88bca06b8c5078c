# SPDX-License-Identifier: GPL-3.0-or-later
"""Menus and panels."""

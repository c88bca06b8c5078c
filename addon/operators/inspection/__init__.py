# SPDX-License-Identifier: GPL-3.0-or-later
"""A UV map inspected: its distortion measured, a texture shown on it, and what was reported of it selected."""

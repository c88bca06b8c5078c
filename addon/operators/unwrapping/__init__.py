# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap and Unwrap from Cones, and the properties of both."""

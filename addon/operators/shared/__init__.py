# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators of several rooms share: when they can run, their properties, work in the background, their reports."""

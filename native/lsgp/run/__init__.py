# SPDX-License-Identifier: GPL-3.0-or-later
"""One run over one mesh file, as commands and batches share it: its options, its report and how it ends."""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Why an edge is cut, as stored in reports, and how it is called."""

SEAM, REQUIRED, ADDED, MOVED = "seam", "required", "added", "moved"

KINDS = {
    SEAM: ("Seams", "Cuts along marked seams"),
    REQUIRED: ("Required", "Cuts that cones, handles and holes need besides the seams"),
    ADDED: ("Added", "Further cuts: at creases, where islands overlapped themselves, and for compact islands"),
    MOVED: ("By Hand", "Cuts moved with Edit Cuts"),
}
"""Label and description by kind."""

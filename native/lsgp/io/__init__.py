# SPDX-License-Identifier: GPL-3.0-or-later
"""Files: mesh files in every format, the files beside them, and safe reading and writing.

`mesh_files` reads and writes meshes; each format has its own `mesh_...` module. `polygons` triangulates what was read.
`safe_files` and `whole_files` decide what may be overwritten, and write each file as a whole or not at all.
"""

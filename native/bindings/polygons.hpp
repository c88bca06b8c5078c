// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons, their diagonals and their corners, in passes over all of them, for `lsgp.io` and `lsgp.indexed_uv`.
#pragma once

#include <pybind11/pybind11.h>

void define_polygons(pybind11::module_& module);

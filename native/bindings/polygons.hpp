// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons and their diagonals, in passes over all of them, for `lsgp.io.polygons`.
#pragma once

#include <pybind11/pybind11.h>

void define_polygons(pybind11::module_& module);

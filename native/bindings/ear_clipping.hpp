// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of polygons of any size, for `lsgp.base.ear_clipping`.
#pragma once

#include <pybind11/pybind11.h>

void define_ear_clipping(pybind11::module_& module);

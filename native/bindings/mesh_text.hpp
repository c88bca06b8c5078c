// SPDX-License-Identifier: GPL-3.0-or-later
// The text of mesh files: tokens, numbers, lines of faces and their edges, for the readers and writers of `lsgp.io`.
#pragma once

#include <pybind11/pybind11.h>

void define_mesh_text(pybind11::module_& module);

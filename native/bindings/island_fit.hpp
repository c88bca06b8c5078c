// SPDX-License-Identifier: GPL-3.0-or-later
// Whether islands fit into a square as the packer of xatlas places them, for `lsgp.layouts`.
#pragma once

#include <pybind11/pybind11.h>

void define_island_fit(pybind11::module_& module);

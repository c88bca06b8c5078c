// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of binary mesh files whose rows have lists of different lengths, for the readers of `lsgp.io`.
#pragma once

#include <pybind11/pybind11.h>

void define_binary_rows(pybind11::module_& module);

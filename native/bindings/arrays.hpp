// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays of numpy by what they hold.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>

using Places = pybind11::array_t<std::int64_t, pybind11::array::c_style>;
using Vertices = pybind11::array_t<std::int32_t, pybind11::array::c_style>;
using Numbers = pybind11::array_t<double, pybind11::array::c_style>;
using Marks = pybind11::array_t<bool, pybind11::array::c_style>;

// SPDX-License-Identifier: GPL-3.0-or-later
// Results of verbs as dictionaries.
#pragma once

#include <pybind11/pybind11.h>

#include "lsgp/lsgp.hpp"

namespace py = pybind11;

py::dict to_dict(const lsgp::Distortion& distortion);

py::dict to_dict(const lsgp::SeamQuality& seams);

py::dict to_dict(const lsgp::Result& result);

py::dict to_dict(const lsgp::Placement& result);

// SPDX-License-Identifier: GPL-3.0-or-later
// Calls of verbs: the GIL released while they compute, their progress, and signals meanwhile.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <optional>

#include "lsgp/progress.hpp"

namespace py = pybind11;

// Calls a verb without the GIL.
template <typename Verb>
auto without_gil(Verb verb) {
  py::gil_scoped_release release;
  return verb();
}

// Gets the fraction done. The verb stops if it returns False or raises an exception, and at a signal.
using ProgressCallback = std::optional<py::typing::Callable<std::optional<bool>(double)>>;

lsgp::Progress to_progress(const ProgressCallback& callback);

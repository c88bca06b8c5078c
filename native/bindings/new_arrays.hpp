// SPDX-License-Identifier: GPL-3.0-or-later
// What verbs return: arrays that own their numbers, lists of these, and findings.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "surfaces.hpp"

// Throws OUT_OF_MEMORY where numpy has a MemoryError.
template <typename Scalar>
py::array_t<Scalar> new_array(std::vector<py::ssize_t> shape) {
  double bytes = sizeof(Scalar);
  for (const py::ssize_t length : shape) bytes *= static_cast<double>(length);
  try {
    return py::array_t<Scalar>(std::move(shape));
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_MemoryError)) throw;
    constexpr double megabyte = 1e6;
    throw lsgp::Error(lsgp::Code::out_of_memory,
                      "A part of the result needs " + std::to_string(std::lround(bytes / megabyte)) +
                          " MB of memory, which are not left. Unwrap fewer faces at once, or close other programs.");
  }
}

template <typename Scalar>
py::array_t<Scalar> to_array(const Scalar* data, std::vector<py::ssize_t> shape) {
  py::array_t<Scalar> out = new_array<Scalar>(std::move(shape));
  if (out.size() > 0) std::memcpy(out.mutable_data(), data, sizeof(Scalar) * static_cast<std::size_t>(out.size()));
  return out;
}

template <typename Scalar>
py::array_t<Scalar> to_array(const std::vector<Scalar>& values) {
  return to_array(values.data(), {static_cast<py::ssize_t>(values.size())});
}

py::array_t<double> to_array(const Eigen::VectorXd& values);

py::array_t<Index> to_array(const lsgp::VertexPairs& pairs);

py::typing::List<IndexArray> to_arrays(const std::vector<std::vector<Index>>& lists);

py::object to_elements(const lsgp::Elements& elements);

py::list to_findings(const std::vector<lsgp::Finding>& findings);

// SPDX-License-Identifier: GPL-3.0-or-later
// What verbs take: surfaces, cones, pins and coordinates, from checked views of arrays.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <optional>
#include <tuple>
#include <vector>

#include "arrays.hpp"
#include "lsgp/lsgp.hpp"

namespace py = pybind11;

using lsgp::Index;

using FloatArray = Numbers;
using IndexArray = Vertices;
using BoolArray = Marks;

template <typename Matrix, typename Array>
Matrix to_matrix(const char* name, const Array& array) {
  using Scalar = typename Matrix::Scalar;
  const View<Scalar, 2> view(name, array, {any_length, Matrix::ColsAtCompileTime});
  return Eigen::Map<const Matrix>(view.data(), view.length(0), view.length(1));
}

std::vector<Index> to_vector(const char* name, const IndexArray& array);

Eigen::VectorXd to_vector_of_numbers(const char* name, const FloatArray& array);

// triangle_count: any_length where it is not known.
lsgp::CornerUv to_corner_uv(const FloatArray& array, py::ssize_t triangle_count);

// Positions, triangles, edges, seams, importance, costs of cuts along the edges, borders, directions, features,
// whether triangles may collapse, and the scale.
using SurfaceArrays = std::tuple<FloatArray, IndexArray, std::optional<IndexArray>, IndexArray, FloatArray, FloatArray,
                                 IndexArray, FloatArray, IndexArray, bool, FloatArray>;

lsgp::Surface to_surface(const SurfaceArrays& arrays);

// Vertices, angles, and which of them are given.
using ConeArrays = std::tuple<IndexArray, FloatArray, BoolArray>;

lsgp::Cones to_cones(const ConeArrays& arrays);

// Corners and their positions.
using PinArrays = std::tuple<IndexArray, FloatArray>;

lsgp::Pins to_pins(const PinArrays& arrays);

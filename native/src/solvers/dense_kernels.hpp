// SPDX-License-Identifier: GPL-3.0-or-later
// The dense kernels of factorizations and prescription, compiled for several instruction sets; the best available one
// is selected at run time.
#pragma once

#include <complex>
#include <cstddef>

namespace lsgp {

// A front: the columns of one supernode, and the rows below them that they touch. Column-major.
template <typename Scalar>
struct Front {
  Scalar* panel;  // (columns + below, columns) lower trapezoid
  int columns;
  int below;       // rows under the square
  int retained;    // the last of these belong to variables that are not eliminated
  Scalar* update;  // (below, below - retained) what is subtracted from the columns of the rows below, lower trapezoid
};

// Vectors have rows of `width` numbers, one of each right-hand side.
template <typename Scalar>
struct DenseKernels {
  // Factors the panel and subtracts its outer product from the update. False where a pivot is not positive.
  bool (*eliminate)(const Front<Scalar>& front);
  // Writes the outer product of a factored panel's retained rows, negative, lower triangle, to `outer` (retained,
  // retained).
  void (*subtract_outer)(const Front<Scalar>& front, Scalar* outer);

  // The steps of both, for fronts that are processed block by block. Blocks are column-major, their columns `stride`
  // numbers apart.
  // square = its Cholesky factor, lower triangle, (size, size). False where a pivot is not positive.
  bool (*factor_square)(Scalar* square, int size, std::ptrdiff_t stride);
  // block = block * factor^-H, (rows, size).
  void (*divide_rows)(const Scalar* factor, int size, Scalar* block, int rows, std::ptrdiff_t stride);
  // out -= left * right^H, (rows, columns), of matrices with `depth` columns.
  void (*subtract_product)(const Scalar* left, int rows, const Scalar* right, int columns, int depth,
                           std::ptrdiff_t stride, Scalar* out, std::ptrdiff_t out_stride);
  // out -= left * left^H, lower triangle, (rows, rows).
  void (*subtract_square)(const Scalar* left, int rows, int depth, std::ptrdiff_t stride, Scalar* out,
                          std::ptrdiff_t out_stride);

  // own = L^-1 own, (columns, width);  others = panel below * own, (below, width).
  void (*substitute_forward)(const Front<Scalar>& front, int width, Scalar* own, Scalar* others);
  // own = L^-H (own - panel below^H * others).
  void (*substitute_backward)(const Front<Scalar>& front, int width, Scalar* own, const Scalar* others);
  // sum += A^H A, lower triangle, (count, count). A: (rows, count), column-major.
  void (*add_gram)(const Scalar* matrix, int rows, int count, Scalar* sum);
};

template <typename Scalar>
const DenseKernels<Scalar>& dense_kernels();
template <>
const DenseKernels<double>& dense_kernels();
template <>
const DenseKernels<std::complex<double>>& dense_kernels();

}  // namespace lsgp

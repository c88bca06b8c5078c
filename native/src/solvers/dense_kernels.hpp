// SPDX-License-Identifier: GPL-3.0-or-later
// The dense work of factorizations and prescription, compiled for several instruction sets; the best one that the
// machine has is taken at run time.
#pragma once

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

// Vectors are rows of `width` numbers: one of each right side.
template <typename Scalar>
struct DenseKernels {
  // Factors the panel, subtracts its outer product from the update and writes that of the retained rows, lower
  // triangle, to `outer` (retained, retained). False where a pivot is not positive.
  bool (*eliminate)(const Front<Scalar>& front, Scalar* outer);
  // own = L^-1 own, (columns, width);  others = panel below * own, (below, width).
  void (*substitute_forward)(const Front<Scalar>& front, int width, Scalar* own, Scalar* others);
  // own = L^-H (own - panel below^H * others).
  void (*substitute_backward)(const Front<Scalar>& front, int width, Scalar* own, const Scalar* others);
  // sum += A^H A, lower triangle, (count, count). A: (rows, count), column-major.
  void (*add_gram)(const Scalar* matrix, int rows, int count, Scalar* sum);
};

template <typename Scalar>
const DenseKernels<Scalar>& dense_kernels();

}  // namespace lsgp

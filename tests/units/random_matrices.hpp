// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices to test solvers with, the same in every run.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>
#include <random>

using Random = std::mt19937;

inline double between(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / static_cast<double>(Random::max()));
}
inline int below(Random& random, int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); }

template <typename Scalar>
Scalar random_scalar(Random& random);

template <typename Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> random_matrix(Random& random, Eigen::Index rows,
                                                                    Eigen::Index columns) {
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> out(rows, columns);
  for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] = random_scalar<Scalar>(random);
  return out;
}

// The lower triangle of a Hermitian positive definite matrix with about `neighbors` entries a row off the diagonal.
template <typename Scalar>
Eigen::SparseMatrix<Scalar> random_definite(Random& random, int size, int neighbors);

template <typename Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> full(const Eigen::SparseMatrix<Scalar>& lower) {
  using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  return Dense(lower).template selfadjointView<Eigen::Lower>();
}

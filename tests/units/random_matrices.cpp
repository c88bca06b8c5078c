// SPDX-License-Identifier: GPL-3.0-or-later
#include "random_matrices.hpp"

#include <algorithm>
#include <vector>

template <>
double random_scalar<double>(Random& random) {
  return between(random, -1, 1);
}

template <>
std::complex<double> random_scalar<std::complex<double>>(Random& random) {
  const double real = between(random, -1, 1);
  return {real, between(random, -1, 1)};
}

template <typename Scalar>
Eigen::SparseMatrix<Scalar> random_definite(Random& random, int size, int neighbors) {
  std::vector<Eigen::Triplet<Scalar>> entries;
  Eigen::VectorXd sum = Eigen::VectorXd::Constant(size, 0.1);
  for (int k = 0; k < size * neighbors / 2; ++k) {
    const int i = below(random, size), j = below(random, size);
    if (i == j) continue;
    const Scalar value = random_scalar<Scalar>(random);
    entries.emplace_back(std::max(i, j), std::min(i, j), value);
    sum[i] += std::abs(value);
    sum[j] += std::abs(value);
  }
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, Scalar(sum[i]));
  Eigen::SparseMatrix<Scalar> out(size, size);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

template Eigen::SparseMatrix<double> random_definite(Random&, int, int);
template Eigen::SparseMatrix<std::complex<double>> random_definite(Random&, int, int);

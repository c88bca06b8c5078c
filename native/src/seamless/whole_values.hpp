// SPDX-License-Identifier: GPL-3.0-or-later
// Whole numbers for coordinates that depend on each other linearly.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/borrowed.hpp"

namespace lsgp {

// All values that dependent coordinates can take if all of them are whole: an offset and whole multiples of the columns
// of a matrix, which becomes narrower with every coordinate that is fixed.
class WholeValues {
 public:
  // compliance: (n, n) symmetric, positive semidefinite; its null space is that of the relations between coordinates,
  // whose coefficients are ratios of small whole numbers. None where they are not.
  static std::optional<WholeValues> among(const Eigen::MatrixXd& compliance);

  // The distance between the values that coordinate i can take; 0 if there is a single one. It changes the columns,
  // and does not change the values that they generate.
  double isolate(Eigen::Index i);
  // The one of them nearest to `value` and not below `least`.  step: of isolate(i).
  double nearest(Eigen::Index i, double step, double value, double least) const;
  // Fixes the coordinate that was isolated last at one of its values. Returns whether all numbers are still exact.
  bool fix(Eigen::Index i, double step, double value);

 private:
  void measure(Eigen::Index column);
  bool is_exact() const;

  Eigen::VectorXd offset_;   // (n)
  Eigen::MatrixXd columns_;  // (n, rank)
  Eigen::VectorXd largest_;  // (rank) magnitude in each column
  Eigen::Index free_ = 0;    // columns, the first ones
};

// A symmetric, positive semidefinite matrix, factored as far as coordinates are chosen (Cholesky with pivots in any
// order, each column computed as it is needed).
class PivotedCholesky {
 public:
  explicit PivotedCholesky(Borrowed<const Eigen::MatrixXd> matrix);

  // The diagonal of what is left of the matrix.
  const Eigen::VectorXd& left() const { return left_; }
  // Column i of what is left.
  Eigen::VectorXd column(Eigen::Index i) const;
  // Whether coordinate i does not follow from those that are eliminated.
  bool is_independent(Eigen::Index i) const;
  // Eliminates i, whose column is given.
  void eliminate(Eigen::Index i, const Eigen::VectorXd& column);
  // (n, eliminated) in the order of elimination.
  auto factor() const { return factor_.leftCols(count_); }

 private:
  const Eigen::MatrixXd& matrix_;
  Eigen::MatrixXd factor_;
  Eigen::VectorXd left_;
  Eigen::Index count_ = 0;
};

}  // namespace lsgp

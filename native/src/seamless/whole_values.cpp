// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/whole_values.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/array.hpp"
#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr double dependent = 1e-9;        // share of a coordinate's compliance that is left
constexpr double most_divisor = 840;      // of coefficients; it has all divisors up to 8
constexpr double inexact = 1e-5;          // of a whole number
constexpr double most_exact = 1LL << 40;  // of whole numbers, so that their products with others stay exact

bool is_whole(double value) { return std::abs(value - std::round(value)) <= inexact; }

// A whole number whose product with every coefficient is whole; 0 if there is no small one.
double common_divisor(const Eigen::RowVectorXd& coefficients) {
  double out = 1;
  for (const double coefficient : coefficients) {
    double factor = 1;
    while (factor * out <= most_divisor && !is_whole(factor * out * coefficient)) ++factor;
    out *= factor;
    if (out > most_divisor) return 0;
  }
  return out;
}

}  // namespace

PivotedCholesky::PivotedCholesky(Borrowed<const Eigen::MatrixXd> matrix)
    : matrix_(matrix.get()), factor_(matrix_.rows(), 0), left_(matrix_.diagonal()) {}

Eigen::VectorXd PivotedCholesky::column(Eigen::Index i) const {
  return matrix_.col(i) - factor_.leftCols(count_) * factor_.row(i).head(count_).transpose();
}

bool PivotedCholesky::is_independent(Eigen::Index i) const { return left_[i] > dependent * matrix_(i, i); }

void PivotedCholesky::eliminate(Eigen::Index i, const Eigen::VectorXd& column) {
  if (count_ == factor_.cols()) factor_.conservativeResize(matrix_.rows(), std::max<Eigen::Index>(16, 2 * count_));
  factor_.col(count_) = column / std::sqrt(column[i]);
  left_ -= factor_.col(count_).cwiseAbs2();
  ++count_;
}

std::optional<WholeValues> WholeValues::among(const Eigen::MatrixXd& compliance) {
  const Eigen::Index count = compliance.rows();
  PivotedCholesky cholesky(compliance);
  Array<Eigen::Index> pivots;
  Array<char> is_pivot(count, 0);
  for (Eigen::Index i = 0; i < count; ++i) {
    checkpoint(static_cast<double>(count * (i + 1)));
    if (!cholesky.is_independent(i)) continue;
    cholesky.eliminate(i, cholesky.column(i));
    pivots.push_back(i);
    is_pivot[i] = 1;
  }
  // All coordinates as functions of the pivots.
  const Eigen::Index rank = static_cast<Eigen::Index>(pivots.size());
  Eigen::MatrixXd triangle(rank, rank);
  for (Eigen::Index k = 0; k < rank; ++k) triangle.row(k) = cholesky.factor().row(pivots[k]);
  const Eigen::MatrixXd relations = triangle.triangularView<Eigen::Lower>().solve<Eigen::OnTheRight>(cholesky.factor());
  WholeValues out;
  out.offset_ = Eigen::VectorXd::Zero(count);
  out.columns_ = Eigen::MatrixXd::Zero(count, rank);
  out.largest_ = Eigen::VectorXd::Ones(rank);
  out.free_ = rank;
  for (Eigen::Index k = 0; k < rank; ++k) out.columns_(pivots[k], k) = 1;
  // The values of the pivots for which the others are whole as well.
  for (Eigen::Index i = 0; i < count; ++i) {
    if (is_pivot[i]) continue;
    checkpoint(static_cast<double>(count * rank));
    const double divisor = common_divisor(relations.row(i));
    if (divisor == 0) return std::nullopt;
    const Eigen::RowVectorXd whole = (divisor * relations.row(i)).array().round();
    Eigen::RowVectorXd multiples = Eigen::RowVectorXd::Zero(rank);
    for (Eigen::Index k = 0; k < rank; ++k) {
      if (whole[k] != 0) multiples += whole[k] * out.columns_.row(pivots[k]);
    }
    out.columns_.row(i) = multiples;
    const double step = out.isolate(i);
    const auto shared = static_cast<double>(std::gcd(std::llround(step), std::llround(divisor)));
    if (step != 0) out.columns_.col(out.free_ - 1) *= divisor / shared;
    out.columns_.row(i) /= divisor;
    if (step != 0) out.measure(out.free_ - 1);
    if (!out.is_exact()) return std::nullopt;
  }
  return out;
}

void WholeValues::measure(Eigen::Index column) { largest_[column] = columns_.col(column).cwiseAbs().maxCoeff(); }

// Eigen has no largest element of nothing.
bool WholeValues::is_exact() const { return free_ == 0 || largest_.head(free_).maxCoeff() < most_exact; }

// Euclid's algorithm on row i leaves one column with a coefficient there, which becomes the last one.
double WholeValues::isolate(Eigen::Index i) {
  for (;;) {
    checkpoint(static_cast<double>(columns_.rows() * free_));
    Eigen::Index pivot = -1;
    Eigen::Index with = 0;
    for (Eigen::Index k = 0; k < free_; ++k) {
      const double here = std::abs(columns_(i, k));
      if (here == 0) continue;
      ++with;
      if (pivot < 0 || here < std::abs(columns_(i, pivot))) pivot = k;
    }
    if (pivot < 0) return 0;
    if (with == 1) {
      columns_.col(pivot).swap(columns_.col(free_ - 1));
      std::swap(largest_[pivot], largest_[free_ - 1]);
      return std::abs(columns_(i, free_ - 1));
    }
    for (Eigen::Index k = 0; k < free_; ++k) {
      if (k == pivot || columns_(i, k) == 0) continue;
      columns_.col(k) -= std::round(columns_(i, k) / columns_(i, pivot)) * columns_.col(pivot);
      measure(k);
    }
  }
}

double WholeValues::nearest(Eigen::Index i, double step, double value, double least) const {
  if (step == 0) return offset_[i];
  const double at = offset_[i] + step * std::round((value - offset_[i]) / step);
  return at < least ? at + step * std::ceil((least - at) / step) : at;
}

bool WholeValues::fix(Eigen::Index i, double step, double value) {
  if (step == 0) return true;
  const Eigen::Index last = --free_;
  offset_ += (value - offset_[i]) / columns_(i, last) * columns_.col(last);
  return is_exact();
}

}  // namespace lsgp

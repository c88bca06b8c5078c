// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/line_constraints.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "base/checkpoint.hpp"
#include "solvers/cholesky.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

// A sum of real variables: 2 k and 2 k + 1 are the real and the imaginary part of unknown k. Ordered by variable.
using Sum = Array<std::pair<Index, double>>;

constexpr double cancelled = 1e-11;  // of coefficients, which are around 1

// Adds up coefficients, in the order in which they come.
class Summation {
 public:
  explicit Summation(Index variable_count) : value_(variable_count, 0), is_listed_(variable_count, 0) {}

  void add(Index variable, double coefficient) {
    if (!is_listed_[variable]) {
      is_listed_[variable] = 1;
      listed_.push_back(variable);
    }
    value_[variable] += coefficient;
  }

  // The sum without coefficients below the least one; begins a new one.
  Sum take(double least) {
    std::sort(listed_.begin(), listed_.end());
    Sum out;
    for (const Index variable : listed_) {
      const double coefficient = std::exchange(value_[variable], 0);
      is_listed_[variable] = 0;
      if (!(std::abs(coefficient) < least)) out.emplace_back(variable, coefficient);
    }
    listed_.clear();
    return out;
  }

 private:
  Array<double> value_;
  Array<char> is_listed_;
  Array<Index> listed_;
};

// Solves equations one after the other, each for one of its free variables.
class Elimination {
 public:
  explicit Elimination(Index variable_count)
      : is_used_(variable_count, 0), is_solved_(variable_count, 0), solution_(variable_count), total_(variable_count) {}

  // sum = 0
  void add(const Sum& sum) {
    Sum left = resolve(sum);
    if (left.empty()) return;
    auto pivot = left.begin();
    for (auto term = left.begin(); term != left.end(); ++term) {
      if (is_better(*term, *pivot)) pivot = term;
    }
    const auto [solved, coefficient_of_solved] = *pivot;
    left.erase(pivot);
    for (auto& [variable, coefficient] : left) {
      coefficient /= -coefficient_of_solved;
      is_used_[variable] = 1;
    }
    const auto is_cancelled = [](const auto& term) { return std::abs(term.second) < cancelled; };
    left.erase(std::remove_if(left.begin(), left.end(), is_cancelled), left.end());
    is_solved_[solved] = 1;
    solution_[solved] = std::move(left);
  }

  bool is_free(Index variable) const { return !is_solved_[variable]; }
  // Whether others depend on it.
  bool is_used(Index variable) const { return is_used_[variable] != 0; }

  // In terms of free variables.
  Sum resolve(const Sum& sum) {
    for (const auto& term : sum) update(term.first);
    for (const auto& [variable, coefficient] : sum) {
      if (is_free(variable)) {
        total_.add(variable, coefficient);
        continue;
      }
      for (const auto& [other, share] : solution_[variable]) total_.add(other, coefficient * share);
    }
    return total_.take(cancelled);
  }

 private:
  // Leaves free variables alone in the solution of a variable, if it is solved.
  void update(Index variable) {
    const auto is_solved = [&](const auto& term) { return !is_free(term.first); };
    Sum& solution = solution_[variable];
    if (std::any_of(solution.begin(), solution.end(), is_solved)) solution = resolve(solution);
  }

  // Among variables with coefficients of similar size, those on which nothing depends are preferred: this keeps the
  // expressions short.
  bool is_better(const std::pair<Index, double>& term, const std::pair<Index, double>& than) const {
    const double ratio = std::abs(term.second / than.second);
    if (ratio > 2 || ratio < 0.5) return ratio > 2;
    return is_used_[term.first] <= is_used_[than.first];
  }

  Array<char> is_used_, is_solved_;
  Array<Sum> solution_;
  Summation total_;
};

using RealMatrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

RealMatrix matrix_of(const Entries& entries, Index rows, Index columns) {
  RealMatrix out(rows, columns);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

RealMatrix coordinates_from(const DegreesOfFreedom& freedom) {
  const Array<Index> rows = first_rows(freedom);
  const Index copies = freedom.displacement.copy_count();
  Entries entries;
  for (Index copy = 0; copy < copies; ++copy) {
    freedom.displacement.for_each_term(copy, [&](const Term& term) {
      Complex factor = term.coefficient;
      for (Index row = rows[term.unknown]; row < rows[term.unknown + 1]; ++row, factor *= Complex(0, 1)) {
        entries.emplace_back(2 * copy, row, factor.real());
        entries.emplace_back(2 * copy + 1, row, factor.imag());
      }
    });
  }
  return matrix_of(entries, 2 * copies, rows.back());
}

// The Dirichlet form of these coordinates, all of it.
RealMatrix form_of_coordinates(const CutSurface& surface) {
  const Index copies = surface.cut_mesh.copy_count();
  PerCopy<Index> row_of_copy(copies);
  std::iota(row_of_copy.begin(), row_of_copy.end(), 0);
  const RealMatrix form = assemble_dirichlet(surface, surface.cut_mesh, row_of_copy);
  Entries entries;
  for (int column = 0; column < copies; ++column) {
    for (RealMatrix::InnerIterator it(form, column); it; ++it) {
      const int row = static_cast<int>(it.row());
      for (const int axis : {0, 1}) {
        entries.emplace_back(2 * row + axis, 2 * column + axis, it.value());
        if (row != column) entries.emplace_back(2 * column + axis, 2 * row + axis, it.value());
      }
    }
  }
  return matrix_of(entries, 2 * copies, 2 * copies);
}

// The factor of an unknown's real or imaginary part in the position of a copy, from that of the unknown.
Complex factor_of(Index variable, Complex of_unknown) {
  return variable % 2 == 0 ? of_unknown : of_unknown * Complex(0, 1);
}

Sum in_variables(const CoordinateForm& form, const Reduction& reduction, Summation& total) {
  for (const auto& [copy, factor] : form) {
    reduction.for_each_term(copy, [&, factor = factor](const Term& term) {
      for (const Index variable : {2 * term.unknown, 2 * term.unknown + 1}) {
        total.add(variable, factor_of(variable, factor * term.coefficient).imag());
      }
    });
  }
  return total.take(0);
}

// Both coordinates of held copies, the fixed ones, and those of edges across their directions.
Array<CoordinateForm> coordinates_at_zero(const CutMesh& cut_mesh, const DirectedEdges& edges) {
  Array<CoordinateForm> out;
  for (const Index copy : edges.held) {
    for (const Complex factor : {Complex(1), Complex(0, 1)}) out.push_back({{copy, factor}});
  }
  out.insert(out.end(), edges.fixed.begin(), edges.fixed.end());
  for (Index i = 0; i < ssize(edges.halfedges); ++i) {
    const Index h = edges.halfedges[i];
    const Complex back = std::conj(edges.directions[i]);
    out.push_back({{cut_mesh.copy_of_corner[next(h)], back}, {cut_mesh.copy_of_corner[h], -back}});
  }
  return out;
}

}  // namespace

double value_of(const CoordinateForm& form, const Eigen::VectorXcd& position) {
  Complex sum = 0;
  for (const auto& [copy, factor] : form) sum += factor * position[copy];
  return sum.imag();
}

DegreesOfFreedom free_along(const CutSurface& surface, const Reduction& reduction, const DirectedEdges& edges) {
  Elimination elimination(2 * reduction.unknown_count);
  Summation total(2 * reduction.unknown_count);
  for (const CoordinateForm& zero : coordinates_at_zero(surface.cut_mesh, edges)) {
    elimination.add(in_variables(zero, reduction, total));
  }

  DegreesOfFreedom out;
  Array<Index> number(2 * reduction.unknown_count, none);  // of free variables; a whole unknown has one
  Array<char> is_whole(reduction.unknown_count, 0);
  for (Index k = 0; k < reduction.unknown_count; ++k) {
    const Index re = 2 * k, im = 2 * k + 1;
    is_whole[k] =
        elimination.is_free(re) && elimination.is_free(im) && !elimination.is_used(re) && !elimination.is_used(im);
    for (const Index variable : {re, im}) {
      if (!elimination.is_free(variable) || (is_whole[k] && variable == im)) continue;
      number[variable] = out.displacement.unknown_count++;
      out.is_real.push_back(!is_whole[k]);
    }
  }
  out.displacement.begin.assign(1, 0);
  for (Index copy = 0; copy < surface.cut_mesh.copy_count(); ++copy) {
    std::map<Index, Complex> moved;
    reduction.for_each_term(copy, [&](const Term& term) {
      if (is_whole[term.unknown]) {
        moved[number[2 * term.unknown]] += term.coefficient;
        return;
      }
      for (const Index variable : {2 * term.unknown, 2 * term.unknown + 1}) {
        for (const auto& [of, share] : elimination.resolve({{variable, 1.0}})) {
          moved[number[of]] += factor_of(variable, term.coefficient) * share;
        }
      }
    });
    for (const auto& [unknown, coefficient] : moved) out.displacement.terms.push_back({unknown, coefficient});
    out.displacement.begin.push_back(static_cast<Index>(out.displacement.terms.size()));
  }
  out.triangles.resize(surface.mesh.triangle_count());
  std::iota(out.triangles.begin(), out.triangles.end(), 0);
  return out;
}

namespace {

using Columns = Eigen::SparseMatrix<double>;

// A product of sparse matrices, some columns after the other.
Columns product(const Columns& left, const Columns& right) {
  constexpr Eigen::Index products_at_once = 1 << 20;
  constexpr double operations_a_product = 20;
  const auto products_of = [&](Eigen::Index column) {
    Eigen::Index products = 0;
    for (Columns::InnerIterator it(right, column); it; ++it)
      products += left.outerIndexPtr()[it.row() + 1] - left.outerIndexPtr()[it.row()];
    return products;
  };
  Columns out(left.rows(), right.cols());
  for (Eigen::Index first = 0, end = 0; first < right.cols(); first = end) {
    Eigen::Index products = 0;
    while (end < right.cols() && products < products_at_once) products += products_of(end++);
    out.middleCols(first, end - first) = left * right.middleCols(first, end - first);
    checkpoint(operations_a_product * static_cast<double>(products));
  }
  return out;
}

}  // namespace

FreedomSystem::FreedomSystem(const CutSurface& surface, const DegreesOfFreedom& freedom)
    : surface_(surface), coordinates_(coordinates_from(freedom)) {
  dirichlet_ = product(coordinates_.transpose() * form_of_coordinates(surface), coordinates_);
}

Eigen::VectorXcd FreedomSystem::fit(const Jacobians& jacobians) const {
  const Eigen::VectorXcd pull = pull_of(surface_, jacobians);
  Eigen::VectorXd right(2 * pull.size());
  for (Eigen::Index copy = 0; copy < pull.size(); ++copy) {
    right.segment<2>(2 * copy) << pull[copy].real(), pull[copy].imag();
  }
  right = (coordinates_.transpose() * right).eval();
  return expand(Cholesky<double>(dirichlet_.triangularView<Eigen::Lower>()).solve(right));
}

Eigen::VectorXcd FreedomSystem::expand(const Eigen::VectorXd& values) const {
  const Eigen::VectorXd coordinates = coordinates_ * values;
  Eigen::VectorXcd out(coordinates.size() / 2);
  for (Eigen::Index copy = 0; copy < out.size(); ++copy) out[copy] = {coordinates[2 * copy], coordinates[2 * copy + 1]};
  return out;
}

Eigen::SparseMatrix<double> FreedomSystem::coefficients_of(const Array<CoordinateForm>& forms) const {
  // The imaginary part of factor * (u + i v) is Im(factor) u + Re(factor) v.
  Array<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < ssize(forms); ++i) {
    for (const auto& [copy, factor] : forms[i]) {
      entries.emplace_back(2 * copy, i, factor.imag());
      entries.emplace_back(2 * copy + 1, i, factor.real());
    }
  }
  Eigen::SparseMatrix<double> of_coordinates(coordinates_.rows(), ssize(forms));
  of_coordinates.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> transposed = coordinates_.transpose();
  return (transposed * of_coordinates).pruned();
}

}  // namespace lsgp

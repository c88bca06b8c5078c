// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/cholesky.hpp"

#include <algorithm>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "solvers/dense_kernels.hpp"
#include "solvers/elimination.hpp"
#include "solvers/failure.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace lsgp {

namespace {

// Of numbers that are not negative, beyond the range of int.
std::size_t product(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

}  // namespace

template <typename Scalar>
struct Cholesky<Scalar>::Factor {
  Adjacency adjacency;
  Elimination plan;
  Vector panels;
  Matrix schur;

  int size() const { return static_cast<int>(plan.position.size()); }
  int retained() const { return size() - plan.eliminated; }
  const int* rows(int front) const { return plan.rows.data() + plan.rows_begin[front]; }
  Front<Scalar> front(int i) const {
    return {const_cast<Scalar*>(panels.data()) + plan.panel_begin[i], plan.columns(i), plan.below(i),
            plan.retained_rows[i], nullptr};
  }

  void factorize(const Eigen::SparseMatrix<Scalar>& lower);
  void fill(const Eigen::SparseMatrix<Scalar>& lower, int front, const Array<int>& local);
  void start_schur(const Eigen::SparseMatrix<Scalar>& lower);

  // x: (size, width) by rows, in the order of elimination.
  void eliminate(int width, Scalar* x) const;
  void substitute(int width, Scalar* x) const;
};

template <typename Scalar>
void Cholesky<Scalar>::Factor::start_schur(const Eigen::SparseMatrix<Scalar>& lower) {
  schur = Matrix::Zero(retained(), retained());
  for (int column = plan.eliminated; column < size(); ++column) {
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(lower, column); it; ++it) {
      schur(it.row() - plan.eliminated, column - plan.eliminated) = it.value();
    }
  }
}

// The matrix's own entries in a front's columns, and zeros.  local: the place in the panel of every row of the front.
template <typename Scalar>
void Cholesky<Scalar>::Factor::fill(const Eigen::SparseMatrix<Scalar>& lower, int front, const Array<int>& local) {
  const int first = plan.first[front], columns = plan.columns(front), rows = columns + plan.below(front);
  Scalar* panel = panels.data() + plan.panel_begin[front];
  std::fill_n(panel, product(rows, columns), Scalar(0));
  for (int c = 0; c < columns; ++c) {
    const int row = plan.row_at[first + c];
    Scalar* column = panel + product(c, rows);
    column[c] += lower.valuePtr()[lower.outerIndexPtr()[row]];
    for (int k = adjacency.begin[row]; k < adjacency.begin[row + 1]; ++k) {
      const int other = adjacency.neighbour[k], at = plan.position[other];
      if (at < first + c) continue;
      const Scalar value = lower.valuePtr()[adjacency.entry[k]];
      column[local[at]] += other > row ? value : Eigen::numext::conj(value);
    }
  }
}

template <typename Scalar>
void Cholesky<Scalar>::Factor::factorize(const Eigen::SparseMatrix<Scalar>& lower) {
  const DenseKernels<Scalar>& kernels = dense_kernels<Scalar>();
  const int fronts = plan.front_count();
  count_factorization();
  start_schur(lower);
  Vector stack(static_cast<Eigen::Index>(plan.stack_size));
  prefer_huge_pages(stack.data(), plan.stack_size * sizeof(Scalar));
  Vector outer(plan.outer_size);
  Array<std::size_t> update_end;  // of the updates on the stack
  Array<int> local(size()), waiting;
  for (int i = 0; i < fronts; ++i) {
    Front<Scalar> front = this->front(i);
    const int first = plan.first[i], rows = front.columns + front.below, free = front.below - front.retained;
    const int* below = this->rows(i);
    for (int c = 0; c < front.columns; ++c) local[first + c] = c;
    for (int r = 0; r < front.below; ++r) local[below[r]] = front.columns + r;
    fill(lower, i, local);
    const std::size_t top = update_end.empty() ? 0 : update_end.back();
    const std::size_t update_size = product(front.below, free);
    front.update = stack.data() + top;
    std::fill_n(front.update, update_size, Scalar(0));
    std::size_t base = top;
    while (!waiting.empty() && plan.parent[waiting.back()] == i) {
      const int child = waiting.back();
      waiting.pop_back();
      update_end.pop_back();
      base = update_end.empty() ? 0 : update_end.back();
      const int* child_rows = this->rows(child);
      const int child_below = plan.below(child), child_free = child_below - plan.retained_rows[child];
      for (int c = 0; c < child_free; ++c) {
        const Scalar* from = stack.data() + base + product(c, child_below);
        const int at = local[child_rows[c]];
        Scalar* to = at < front.columns ? front.panel + product(at, rows)
                                        : front.update + product(at - front.columns, front.below) - front.columns;
        for (int r = c; r < child_below; ++r) to[local[child_rows[r]]] += from[r];
      }
    }
    if (!kernels.eliminate(front, outer.data())) throw_unsolvable();
    for (int c = 0; c < front.retained; ++c) {
      Scalar* column = schur.data() + product(below[free + c] - plan.eliminated, retained());
      const Scalar* from = outer.data() + product(c, front.retained);
      for (int r = c; r < front.retained; ++r) column[below[free + r] - plan.eliminated] += from[r];
    }
    if (plan.parent[i] != -1) {
      std::copy_n(front.update, update_size, stack.data() + base);
      update_end.push_back(base + update_size);
      waiting.push_back(i);
    }
    checkpoint(static_cast<double>(front.columns) * rows * rows);
  }
  for (Eigen::Index column = 1; column < schur.cols(); ++column) {
    schur.col(column).head(column) = schur.row(column).head(column).adjoint();
  }
}

template <typename Scalar>
void Cholesky<Scalar>::Factor::eliminate(int width, Scalar* x) const {
  const DenseKernels<Scalar>& kernels = dense_kernels<Scalar>();
  Array<Scalar> others;
  for (int i = 0; i < plan.front_count(); ++i) {
    const Front<Scalar> front = this->front(i);
    Scalar* own = x + product(plan.first[i], width);
    // Impulses reach the fronts above them alone.
    if (std::all_of(own, own + front.columns * width, [](const Scalar& value) { return value == Scalar(0); })) continue;
    others.resize(std::max(others.size(), product(front.below, width)));
    kernels.substitute_forward(front, width, own, others.data());
    const int* below = rows(i);
    for (int r = 0; r < front.below; ++r) {
      Scalar* to = x + product(below[r], width);
      const Scalar* from = others.data() + product(r, width);
      for (int w = 0; w < width; ++w) to[w] -= from[w];
    }
  }
}

template <typename Scalar>
void Cholesky<Scalar>::Factor::substitute(int width, Scalar* x) const {
  const DenseKernels<Scalar>& kernels = dense_kernels<Scalar>();
  Array<Scalar> others;
  for (int i = plan.front_count(); i-- > 0;) {
    const Front<Scalar> front = this->front(i);
    others.resize(std::max(others.size(), product(front.below, width)));
    const int* below = rows(i);
    for (int r = 0; r < front.below; ++r) {
      std::copy_n(x + product(below[r], width), width, others.data() + product(r, width));
    }
    kernels.substitute_backward(front, width, x + product(plan.first[i], width), others.data());
  }
}

template <typename Scalar>
Cholesky<Scalar>::Cholesky(const Eigen::SparseMatrix<Scalar>& lower, int retained, Vector memory)
    : factor_(std::make_unique<Factor>()) {
  keep_freed_memory();
  const int size = static_cast<int>(lower.rows());
  factor_->adjacency = adjacency_of_lower(size, lower.outerIndexPtr(), lower.innerIndexPtr());
  factor_->plan = order_elimination(factor_->adjacency, retained);
  // The dense problems that are made of the Schur complement take up to five times as much as itself.
  const std::size_t dense = 6 * product(retained, retained);
  const std::size_t numbers = factor_->plan.panel_begin.back();
  const bool fits = numbers <= static_cast<std::size_t>(memory.size());
  if (!fits) memory.resize(0);
  require_memory(static_cast<double>(((fits ? 0 : numbers) + factor_->plan.stack_size + dense) * sizeof(Scalar)));
  if (!fits) {
    memory.resize(static_cast<Eigen::Index>(numbers));
    prefer_huge_pages(memory.data(), numbers * sizeof(Scalar));
  }
  factor_->panels = std::move(memory);
  refactor(lower);
}

template <typename Scalar>
typename Cholesky<Scalar>::Vector Cholesky<Scalar>::take_memory() {
  return std::move(factor_->panels);
}

template <typename Scalar>
void Cholesky<Scalar>::refactor(const Eigen::SparseMatrix<Scalar>& lower) {
  factor_->factorize(lower);
}

template <typename Scalar>
Cholesky<Scalar>::~Cholesky() = default;
template <typename Scalar>
Cholesky<Scalar>::Cholesky(Cholesky&&) noexcept = default;

template <typename Scalar>
Eigen::Index Cholesky<Scalar>::size() const {
  return factor_->size();
}

template <typename Scalar>
typename Cholesky<Scalar>::Vector Cholesky<Scalar>::solve(const Vector& right_side) const {
  return solve(Matrix(right_side));
}

template <typename Scalar>
typename Cholesky<Scalar>::Matrix Cholesky<Scalar>::solve(const Matrix& right_sides) const {
  Matrix out(right_sides.rows(), right_sides.cols());
  for (Eigen::Index begin = 0, used; begin < out.cols(); begin += used) {
    const Eigen::Index width = width_for(out.cols() - begin);
    used = std::min(out.cols() - begin, width);
    Rows x = Rows::Zero(size(), width);
    for (Eigen::Index row = 0; row < out.rows(); ++row) {
      x.row(factor_->plan.position[row]).head(used) = right_sides.row(row).segment(begin, used);
    }
    eliminate(x);
    substitute(x, used);
    for (Eigen::Index row = 0; row < out.rows(); ++row) {
      out.row(row).segment(begin, used) = x.row(factor_->plan.position[row]).head(used);
    }
  }
  return out;
}

template <typename Scalar>
const typename Cholesky<Scalar>::Matrix& Cholesky<Scalar>::schur() const {
  return factor_->schur;
}

template <typename Scalar>
int Cholesky<Scalar>::place(int row) const {
  return factor_->plan.position[row];
}

template <typename Scalar>
void Cholesky<Scalar>::eliminate(Rows& right_sides) const {
  factor_->eliminate(static_cast<int>(right_sides.cols()), right_sides.data());
}

template <typename Scalar>
void Cholesky<Scalar>::substitute(Rows& half_solved, Eigen::Index sides) const {
  count_back_substitutions(static_cast<int>(sides));
  checkpoint(2.0 * static_cast<double>(factor_->panels.size() * half_solved.cols()));
  factor_->substitute(static_cast<int>(half_solved.cols()), half_solved.data());
}

template class Cholesky<double>;
template class Cholesky<std::complex<double>>;

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/cholesky.hpp"

#include <algorithm>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "base/thread_team.hpp"
#include "solvers/dense_kernels.hpp"
#include "solvers/elimination.hpp"
#include "solvers/failure.hpp"
#include "solvers/front_blocks.hpp"
#include "solvers/linear_algebra_counter.hpp"
#include "solvers/solve_blocks.hpp"

namespace lsgp {

namespace {

// The product of two nonnegative numbers, which may exceed the range of int.
std::size_t product(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

// How many numbers of outer products are computed before they are added, and to how many columns of the Schur
// complement one thread adds them.
constexpr std::size_t outer_at_once = 1 << 18;
constexpr int schur_columns = 64;

// Whether memory suffices for several tasks at once.  bytes: of a factorization with updates of that size.
template <typename Bytes>
bool has_room(const Elimination& plan, int threads, const Bytes& bytes) {
  constexpr double of_a_thread = 80 << 20;  // of its stack and heap, as the system reserves them
  if (threads == 1 || plan.task_count() < 2) return false;
  const double most = bytes(plan.most_kept + plan.stack_size * static_cast<std::size_t>(threads));
  return most + threads * of_a_thread <= memory_left();
}

}  // namespace

template <typename Scalar>
struct Cholesky<Scalar>::Factor {
  Adjacency adjacency;
  Elimination plan;
  Vector panels;
  Matrix schur;
  const DenseKernels<Scalar>& kernels = dense_kernels<Scalar>();

  int size() const { return static_cast<int>(plan.position.size()); }
  int retained() const { return size() - plan.eliminated; }
  const int* rows(int front) const { return plan.rows.data() + plan.rows_begin[front]; }
  Front<Scalar> front(int i) const {
    return {const_cast<Scalar*>(panels.data()) + plan.panel_begin[i], plan.columns(i), plan.below(i),
            plan.retained_rows[i], nullptr};
  }

  // The scratch memory of a thread.
  struct Workspace {
    Vector stack;                   // of updates
    Array<std::size_t> update_end;  // of the updates on it
    Array<int> waiting;             // the fronts that these belong to
    Array<int> local;               // (size) the index of every row in the current front
  };

  bool has_room_for_threads = false;

  void prepare(Workspace& work) const;
  std::size_t outer_size() const;  // numbers of the outer products that are computed at once
  void factorize(const Eigen::SparseMatrix<Scalar>& lower);
  void run_task(const Eigen::SparseMatrix<Scalar>& lower, int task, Workspace& work, Array<Vector>& kept,
                ThreadTeam& team);
  void take_in(int child, const Scalar* update, const Front<Scalar>& front, const Array<int>& local) const;
  void complete_schur(ThreadTeam& team);
  void add_outer(int front, const Scalar* outer, int block);
  void fill(const Eigen::SparseMatrix<Scalar>& lower, int front, const Array<int>& local);
  void start_schur(const Eigen::SparseMatrix<Scalar>& lower);

  // x: (size, width) by rows, in the order of elimination.
  void eliminate(int width, Scalar* x) const;
  void substitute(int width, Scalar* x) const;
  template <typename Work>
  void run_leaves(const Work& work) const;
  bool is_leaf(int task) const { return plan.last_child[task] == -1; }
  bool eliminate_front(int front, int width, Scalar* x, Array<Scalar>& others) const;
  Array<Scalar> eliminate_task(int task, int width, Scalar* x) const;
  void substitute_task(int task, int width, Scalar* x) const;
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
      const int other = adjacency.neighbor[k], at = plan.position[other];
      if (at < first + c) continue;
      const Scalar value = lower.valuePtr()[adjacency.entry[k]];
      column[local[at]] += other > row ? value : Eigen::numext::conj(value);
    }
  }
}

// Allocates the memory of a thread before its first task.
template <typename Scalar>
void Cholesky<Scalar>::Factor::prepare(Workspace& work) const {
  if (ssize(work.local) == size()) return;
  work.stack.resize(static_cast<Eigen::Index>(plan.stack_size));
  prefer_huge_pages(work.stack.data(), plan.stack_size * sizeof(Scalar));
  work.local.resize(size());
}

// The fronts of a task, from the first to the last.
template <typename Scalar>
void Cholesky<Scalar>::Factor::run_task(const Eigen::SparseMatrix<Scalar>& lower, int task, Workspace& work,
                                        Array<Vector>& kept, ThreadTeam& team) {
  const int last = plan.task_begin[task + 1] - 1;
  Array<int>&local = work.local, &waiting = work.waiting;
  Array<std::size_t>& update_end = work.update_end;
  for (int i = plan.task_begin[task]; i <= last; ++i) {
    Front<Scalar> front = this->front(i);
    const int first = plan.first[i], rows = front.columns + front.below;
    const int* below = this->rows(i);
    for (int c = 0; c < front.columns; ++c) local[first + c] = c;
    for (int r = 0; r < front.below; ++r) local[below[r]] = front.columns + r;
    fill(lower, i, local);
    const std::size_t top = update_end.empty() ? 0 : update_end.back(), update_size = plan.update_size(i);
    if (i == last) kept[task].resize(static_cast<Eigen::Index>(update_size));
    front.update = i == last ? kept[task].data() : work.stack.data() + top;
    std::fill_n(front.update, update_size, Scalar(0));
    std::size_t base = top;
    while (!waiting.empty() && plan.parent[waiting.back()] == i) {
      update_end.pop_back();
      base = update_end.empty() ? 0 : update_end.back();
      take_in(waiting.back(), work.stack.data() + base, front, local);
      waiting.pop_back();
    }
    const int newest_child = i == last ? plan.last_child[task] : -1;
    for (int child = newest_child; child != -1; child = plan.earlier_sibling[child]) {
      take_in(plan.task_begin[child + 1] - 1, kept[child].data(), front, local);
      kept[child].resize(0);
    }
    const bool by_blocks = has_blocks(front);
    if (!(by_blocks ? eliminate_by_blocks(front, team) : kernels.eliminate(front)))
      throw SolverFailure(SolverFailure::Cause::not_positive_definite);
    if (i < last && plan.parent[i] != -1) {
      std::copy_n(front.update, update_size, work.stack.data() + base);
      update_end.push_back(base + update_size);
      waiting.push_back(i);
    }
    if (!by_blocks) checkpoint(static_cast<double>(front.columns) * rows * rows);
  }
}

// Adds a child's update to its parent.  local: the places of the parent's rows.
template <typename Scalar>
void Cholesky<Scalar>::Factor::take_in(int child, const Scalar* update, const Front<Scalar>& front,
                                       const Array<int>& local) const {
  const int* child_rows = rows(child);
  const int below = plan.below(child), free = below - plan.retained_rows[child], rows = front.columns + front.below;
  for (int c = 0; c < free; ++c) {
    const Scalar* from = update + product(c, below);
    const int at = local[child_rows[c]];
    Scalar* to = at < front.columns ? front.panel + product(at, rows)
                                    : front.update + product(at - front.columns, front.below) - front.columns;
    for (int r = c; r < below; ++r) to[local[child_rows[r]]] += from[r];
  }
}

// Subtracts the outer products of all fronts from the Schur complement, in the order of the fronts at each entry. Those
// of several fronts are computed at once.
template <typename Scalar>
void Cholesky<Scalar>::Factor::complete_schur(ThreadTeam& team) {
  Vector outer(static_cast<Eigen::Index>(outer_size()));
  Array<int> some;
  Array<std::size_t> begin;
  for (int i = 0, end = 0; i < plan.front_count(); i = end) {
    some.clear();
    begin.assign(1, 0);
    for (end = i; end < plan.front_count(); ++end) {
      const int retained_rows = plan.retained_rows[end];
      if (retained_rows == 0) continue;
      const std::size_t next = begin.back() + product(retained_rows, retained_rows);
      if (!some.empty() && next > outer_at_once) break;
      some.push_back(end);
      begin.push_back(next);
    }
    const auto subtract_outer = [&](int k) {
      const Front<Scalar> front = this->front(some[k]);
      Scalar* to = outer.data() + begin[k];
      if (has_blocks(front)) {
        subtract_outer_by_blocks(front, to, team);
      } else {
        kernels.subtract_outer(front, to);
        checkpoint(static_cast<double>(front.columns) * front.retained * front.retained / 2);
      }
    };
    if (some.size() == 1) {
      subtract_outer(0);
    } else {
      team.run_each(static_cast<int>(some.size()), subtract_outer);
    }
    const int blocks = (retained() + schur_columns - 1) / schur_columns;
    team.run_each(blocks, [&](int block) {
      for (int k = 0; k < ssize(some); ++k) add_outer(some[k], outer.data() + begin[k], block);
    });
  }
  for (Eigen::Index column = 1; column < schur.cols(); ++column) {
    schur.col(column).head(column) = schur.row(column).head(column).adjoint();
  }
}

// Adds the part of a front's outer product in a block of columns.
template <typename Scalar>
void Cholesky<Scalar>::Factor::add_outer(int front, const Scalar* outer, int block) {
  const int count = plan.retained_rows[front], first = plan.eliminated + block * schur_columns;
  const int *end = rows(front) + plan.below(front), *begin = end - count;
  const int* from = std::lower_bound(begin, end, first);
  for (const int* at = from; at < end && *at < first + schur_columns; ++at) {
    const Scalar* numbers = outer + product(static_cast<int>(at - begin), count);
    Scalar* column = schur.data() + product(*at - plan.eliminated, retained());
    for (int r = static_cast<int>(at - begin); r < count; ++r) column[begin[r] - plan.eliminated] += numbers[r];
  }
}

template <typename Scalar>
std::size_t Cholesky<Scalar>::Factor::outer_size() const {
  std::size_t all = 0, largest = 0;
  for (const int count : plan.retained_rows) {
    all += product(count, count);
    largest = std::max(largest, product(count, count));
  }
  return std::max(largest, std::min(all, outer_at_once));
}

template <typename Scalar>
void Cholesky<Scalar>::Factor::factorize(const Eigen::SparseMatrix<Scalar>& lower) {
  count_factorization();
  start_schur(lower);
  ThreadTeam alone(1);
  ThreadTeam& team = has_room_for_threads ? team_of_this_call() : alone;
  Array<Workspace> work(team.size());
  Array<Vector> kept(plan.task_count());
  team.run_forest(plan.task_parent, [&](int task, int thread) {
    prepare(work[thread]);
    run_task(lower, task, work[thread], kept, team);
  });
  work.clear();
  complete_schur(team);
}

// Calls work(task) for the tasks that have no children, at the same time where there is room. They hold most of the
// factor; the tasks above them are few, and half a solve has little to do in each.
template <typename Scalar>
template <typename Work>
void Cholesky<Scalar>::Factor::run_leaves(const Work& work) const {
  Array<int> leaves;
  for (int task = 0; task < plan.task_count(); ++task) {
    if (is_leaf(task)) leaves.push_back(task);
  }
  ThreadTeam alone(1);
  ThreadTeam& team = has_room_for_threads ? team_of_this_call() : alone;
  team.run_each(static_cast<int>(leaves.size()), [&](int i) { work(leaves[i]); });
}

// others: receives what is subtracted from the rows below. False if that is zero: sparse right-hand sides affect only
// the fronts above their entries.
template <typename Scalar>
bool Cholesky<Scalar>::Factor::eliminate_front(int front, int width, Scalar* x, Array<Scalar>& others) const {
  const Front<Scalar> own = this->front(front);
  Scalar* values = x + product(plan.first[front], width);
  const auto is_zero = [](const Scalar& value) { return value == Scalar(0); };
  if (std::all_of(values, values + own.columns * width, is_zero)) return false;
  others.resize(std::max(others.size(), product(own.below, width)));
  kernels.substitute_forward(own, width, values, others.data());
  return true;
}

// The fronts of a task. Returns what the rows below its last front change by: all rows below any of its fronts are
// among them, or else columns of the task, and tasks that run at the same time have some of them in common.
template <typename Scalar>
Array<Scalar> Cholesky<Scalar>::Factor::eliminate_task(int task, int width, Scalar* x) const {
  const int last = plan.task_begin[task + 1] - 1;
  const int end = plan.task_count() == 1 ? size() : plan.first[last + 1];  // of the rows that no other task has
  Array<Scalar> change, others;
  const auto subtract = [&](Scalar* to, int row) {
    const Scalar* from = others.data() + product(row, width);
    for (int w = 0; w < width; ++w) to[w] -= from[w];
  };
  for (int i = plan.task_begin[task]; i <= last; ++i) {
    if (!eliminate_front(i, width, x, others)) continue;
    const int *below = rows(i), *outside = rows(last), count = plan.below(i);
    if (end < size()) change.resize(product(plan.below(last), width), Scalar(0));
    for (int r = 0; r < count; ++r) {
      if (below[r] < end) {
        subtract(x + product(below[r], width), r);
      } else {
        outside = std::lower_bound(outside, rows(last) + plan.below(last), below[r]);
        subtract(change.data() + product(static_cast<int>(outside - rows(last)), width), r);
      }
    }
  }
  return change;
}

template <typename Scalar>
void Cholesky<Scalar>::Factor::eliminate(int width, Scalar* x) const {
  Array<Array<Scalar>> changes(plan.task_count());
  run_leaves([&](int task) { changes[task] = eliminate_task(task, width, x); });
  for (int task = 0; task < plan.task_count(); ++task) {
    if (!is_leaf(task)) changes[task] = eliminate_task(task, width, x);
    const int* below = rows(plan.task_begin[task + 1] - 1);
    const int count = static_cast<int>(ssize(changes[task]) / width);
    for (int r = 0; r < count; ++r) {
      Scalar* to = x + product(below[r], width);
      const Scalar* change = changes[task].data() + product(r, width);
      for (int w = 0; w < width; ++w) to[w] += change[w];
    }
  }
}

template <typename Scalar>
void Cholesky<Scalar>::Factor::substitute_task(int task, int width, Scalar* x) const {
  Array<Scalar> others;
  const int first = plan.task_begin[task], last = plan.task_begin[task + 1] - 1;
  for (int i = last; i >= first; --i) {
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
void Cholesky<Scalar>::Factor::substitute(int width, Scalar* x) const {
  for (int task = plan.task_count(); task-- > 0;) {
    if (!is_leaf(task)) substitute_task(task, width, x);
  }
  run_leaves([&](int task) { substitute_task(task, width, x); });
}

template <typename Scalar>
Cholesky<Scalar>::Cholesky(const Eigen::SparseMatrix<Scalar>& lower, int retained, Vector memory)
    : factor_(std::make_unique<Factor>()) {
  keep_freed_memory();
  const int size = static_cast<int>(lower.rows());
  factor_->adjacency = adjacency_of_lower(size, lower.outerIndexPtr(), lower.innerIndexPtr());
  factor_->plan = order_elimination(factor_->adjacency, retained);
  // The dense problems derived from the Schur complement take up to five times its memory.
  const std::size_t dense = 6 * product(retained, retained);
  const std::size_t numbers = factor_->plan.panel_begin.back();
  const bool fits = numbers <= static_cast<std::size_t>(memory.size());
  if (!fits) memory.resize(0);
  const Elimination& plan = factor_->plan;
  const auto bytes = [&](std::size_t updates) {
    return static_cast<double>(((fits ? 0 : numbers) + updates + dense) * sizeof(Scalar));
  };
  require_memory(bytes(plan.kept_size + plan.stack_size));
  factor_->has_room_for_threads = has_room(plan, thread_count(), bytes);
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
  count_back_substitutions(static_cast<int>(right_sides.cols()));
  Matrix out(right_sides.rows(), right_sides.cols());
  for_each_block(out.cols(), size(), [&](const SolveBlock& block) {
    Rows x = Rows::Zero(size(), block.width);
    for (Eigen::Index row = 0; row < out.rows(); ++row) {
      x.row(factor_->plan.position[row]).head(block.used) = right_sides.row(row).segment(block.begin, block.used);
    }
    eliminate(x);
    substitute(x);
    for (Eigen::Index row = 0; row < out.rows(); ++row) {
      out.row(row).segment(block.begin, block.used) = x.row(factor_->plan.position[row]).head(block.used);
    }
  });
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
void Cholesky<Scalar>::substitute(Rows& half_solved) const {
  checkpoint(2.0 * static_cast<double>(factor_->panels.size() * half_solved.cols()));
  factor_->substitute(static_cast<int>(half_solved.cols()), half_solved.data());
}

template class Cholesky<double>;
template class Cholesky<std::complex<double>>;

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/elimination.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "solvers/nested_dissection.hpp"

namespace lsgp {

Adjacency adjacency_of_lower(int size, const int* outer, const int* inner) {
  Adjacency out;
  out.begin.assign(size + 1, 0);
  const auto for_each_off_diagonal = [&](auto visit) {
    for (int column = 0; column < size; ++column) {
      for (int k = outer[column]; k < outer[column + 1]; ++k) {
        if (inner[k] != column) visit(column, inner[k], k);
      }
    }
  };
  for_each_off_diagonal([&](int column, int row, int) {
    ++out.begin[column + 1];
    ++out.begin[row + 1];
  });
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  out.neighbor.resize(out.begin.back());
  out.entry.resize(out.begin.back());
  Array<int> cursor(out.begin.begin(), out.begin.end() - 1);
  for_each_off_diagonal([&](int column, int row, int k) {
    out.neighbor[cursor[column]] = row;
    out.entry[cursor[column]++] = k;
    out.neighbor[cursor[row]] = column;
    out.entry[cursor[row]++] = k;
  });
  return out;
}

namespace {

// The share of zeros that a front may have, by its number of columns.
struct Merging {
  int columns;
  double zeros;
};
constexpr Merging merging[]{{4, 1.1}, {16, 0.8}, {48, 0.1}};
constexpr double zeros_of_any = 0.05;

// Smaller matrices are one task, since threads take time to start. Others are divided until no subtree has more than
// this share of the work.
constexpr int least_rows_of_tasks = 20000;
constexpr double least_tasks = 64;

class Ordering {
 public:
  Ordering(const Adjacency& adjacency, int retained)
      : adjacency_(adjacency), size_(static_cast<int>(adjacency.begin.size()) - 1), eliminated_(size_ - retained) {}

  Elimination run() {
    reduce_fill();
    find_parents();
    post_order();
    count_rows();
    const Array<int> front_of = find_fronts();
    list_rows(front_of);
    find_tasks();
    measure();
    return std::move(out_);
  }

 private:
  template <typename Visit>
  void for_each_neighbor(int at, Visit visit) const {
    const int row = out_.row_at[at];
    for (int k = adjacency_.begin[row]; k < adjacency_.begin[row + 1]; ++k) {
      visit(out_.position[adjacency_.neighbor[k]]);
    }
  }

  template <typename Visit>
  void for_each_earlier(int at, Visit visit) const {
    for_each_neighbor(at, [&](int other) {
      if (other < at && other < eliminated_) visit(other);
    });
  }

  template <typename Visit>
  void for_each_later(int at, Visit visit) const {
    for_each_neighbor(at, [&](int other) {
      if (other > at) visit(other);
    });
  }

  void reduce_fill() {
    const Array<int> order = order_rows(adjacency_, eliminated_);
    out_.eliminated = eliminated_;
    out_.row_at.resize(size_);
    std::iota(out_.row_at.begin(), out_.row_at.end(), 0);
    std::copy(order.begin(), order.end(), out_.row_at.begin());
    invert();
  }

  void invert() {
    out_.position.resize(size_);
    for (int at = 0; at < size_; ++at) out_.position[out_.row_at[at]] = at;
  }

  // The elimination tree (Liu 1990), with paths compressed; `size_` for children of what is retained.
  void find_parents() {
    parent_.assign(eliminated_, size_);
    Array<int> ancestor(eliminated_, size_);
    for (int at = 0; at < eliminated_; ++at) {
      for_each_earlier(at, [&](int other) {
        while (other != at && other != size_) {
          const int above = ancestor[other];
          ancestor[other] = at;
          if (above == size_) parent_[other] = at;
          other = above;
        }
      });
    }
  }

  // Renumbers so that every subtree is contiguous.
  void post_order() {
    Array<int> child(eliminated_ + 1, -1), sibling(eliminated_, -1), order, stack;
    const auto list_of = [&](int node) { return node == size_ ? eliminated_ : node; };
    for (int node = eliminated_; node-- > 0;) {
      sibling[node] = child[list_of(parent_[node])];
      child[list_of(parent_[node])] = node;
    }
    order.reserve(eliminated_);
    for (int root = child[eliminated_]; root != -1; root = sibling[root]) {
      stack.push_back(root);
      while (!stack.empty()) {
        const int node = stack.back();
        if (child[node] != -1) {
          stack.push_back(child[node]);
          child[node] = sibling[child[node]];
        } else {
          order.push_back(node);
          stack.pop_back();
        }
      }
    }
    Array<int> place(size_ + 1), row_at = out_.row_at, parent(eliminated_);
    place[size_] = size_;
    for (int at = 0; at < eliminated_; ++at) {
      place[order[at]] = at;
      row_at[at] = out_.row_at[order[at]];
    }
    for (int node = 0; node < eliminated_; ++node) parent[place[node]] = place[parent_[node]];
    parent_ = std::move(parent);
    out_.row_at = std::move(row_at);
    invert();
  }

  // Rows below the diagonal of every column (Gilbert, Ng and Peyton 1994): a row's entries span a subtree of the
  // elimination tree, which is counted by adding one at its leaves and subtracting one where their paths meet and above
  // its root.
  void count_rows() {
    Array<int> first(eliminated_, -1);  // descendant of each column
    count_.resize(eliminated_);
    for (int at = 0; at < eliminated_; ++at) {
      count_[at] = first[at] == -1;
      for (int node = at; node != size_ && first[node] == -1; node = parent_[node]) first[node] = at;
    }
    Array<int> ancestor(parent_), newest_first(size_, -1), newest_leaf(size_, -1);
    const auto meet_above = [&](int leaf, int at) {  // the first ancestor that is not before `at`
      int root = leaf;
      while (root < at && ancestor[root] != size_) root = ancestor[root];
      while (leaf < root) leaf = std::exchange(ancestor[leaf], root);
      return root;
    };
    for (int at = 0; at < eliminated_; ++at) {
      if (parent_[at] != size_) --count_[parent_[at]];
      for_each_later(at, [&](int row) {
        if (first[at] <= newest_first[row]) return;
        newest_first[row] = first[at];
        ++count_[at];
        const int before = std::exchange(newest_leaf[row], at);
        const int meeting = before == -1 ? -1 : meet_above(before, at);
        if (meeting >= at) --count_[meeting];
      });
    }
    for (int at = 0; at < eliminated_; ++at) {
      if (parent_[at] != size_) count_[parent_[at]] += count_[at];
    }
    for (int& count : count_) --count;
  }

  // Whether columns that share their rows with the front that follows become part of it, at the price of zeros.
  static bool worth_merging(double columns, double below, double zeros) {
    const double share = zeros / (columns * (columns + 1) / 2 + columns * below);
    bool worth = share < zeros_of_any;
    for (const Merging& rule : merging) worth = worth || (columns <= rule.columns && share < rule.zeros);
    return worth;
  }

  // Gathers columns into fronts, from the last to the first; returns the front of every column.
  Array<int> find_fronts() {
    Array<int> last;   // column of every front, from the last front to the first
    double zeros = 0;  // in the front that grows
    for (int end = eliminated_ - 1, begin = end; end >= 0; end = begin - 1, begin = end) {
      while (begin > 0 && parent_[begin - 1] == begin && count_[begin - 1] == count_[begin] + 1) --begin;
      if (!last.empty() && parent_[end] <= last.back()) {
        const double columns = last.back() - end, below = count_[last.back()], own = end - begin + 1;
        const double added = own * (columns + below - count_[end]);
        if (worth_merging(own + columns, below, zeros + added)) {
          zeros += added;
          continue;
        }
      }
      last.push_back(end);
      zeros = 0;
    }
    std::reverse(last.begin(), last.end());
    const int fronts = static_cast<int>(last.size());
    out_.first.assign(1, 0);
    for (const int column : last) out_.first.push_back(column + 1);
    Array<int> front_of(eliminated_);
    for (int front = 0; front < fronts; ++front) {
      std::fill(front_of.begin() + out_.first[front], front_of.begin() + out_.first[front + 1], front);
    }
    out_.parent.resize(fronts);
    out_.rows_begin.assign(1, 0);
    for (int front = 0; front < fronts; ++front) {
      const int above = parent_[last[front]];
      out_.parent[front] = above == size_ ? -1 : front_of[above];
      out_.rows_begin.push_back(out_.rows_begin.back() + static_cast<std::size_t>(count_[last[front]]));
    }
    return front_of;
  }

  // Rows come in ascending order, each into the fronts of its subtree.
  void list_rows(const Array<int>& front_of) {
    const int fronts = out_.front_count();
    out_.rows.resize(out_.rows_begin.back());
    out_.retained_rows.assign(fronts, 0);
    Array<std::size_t> cursor(out_.rows_begin.begin(), out_.rows_begin.end() - 1);
    Array<int> mark(fronts, -1);
    for (int at = 0; at < size_; ++at) {
      if (at < eliminated_) mark[front_of[at]] = at;
      for_each_earlier(at, [&](int column) {
        for (int front = front_of[column]; front != -1 && mark[front] != at; front = out_.parent[front]) {
          mark[front] = at;
          out_.rows[cursor[front]++] = at;
          out_.retained_rows[front] += at >= eliminated_;
        }
      });
    }
  }

  // A small matrix is one task.
  void find_tasks() {
    const int fronts = out_.front_count();
    Array<double> work(fronts, 0.0);  // of the subtree below each front, itself included
    double total = 0;
    for (int front = 0; front < fronts; ++front) {
      const double columns = out_.columns(front), rows = columns + out_.below(front);
      total += columns * rows * rows;
      work[front] += columns * rows * rows;
      if (out_.parent[front] != -1) work[out_.parent[front]] += work[front];
    }
    const double little = total / least_tasks;
    Array<int> task_of(fronts);
    out_.task_begin.assign(1, 0);
    for (int front = 0; front < fronts; ++front) {
      const int above = out_.parent[front];
      task_of[front] = static_cast<int>(out_.task_begin.size()) - 1;
      const bool is_last = size_ < least_rows_of_tasks ? front + 1 == fronts : above == -1 || work[above] > little;
      if (is_last) out_.task_begin.push_back(front + 1);
    }
    const int tasks = static_cast<int>(out_.task_begin.size()) - 1;
    out_.task_parent.resize(tasks);
    out_.last_child.assign(tasks, -1);
    out_.earlier_sibling.assign(tasks, -1);
    for (int task = 0; task < tasks; ++task) {
      const int above = out_.parent[out_.task_begin[task + 1] - 1];
      out_.task_parent[task] = above == -1 ? -1 : task_of[above];
      if (above != -1) out_.earlier_sibling[task] = std::exchange(out_.last_child[task_of[above]], task);
    }
  }

  void measure() {
    out_.panel_begin.assign(1, 0);
    Array<std::size_t> held(out_.front_count(), 0);  // by the updates of a front's children within its task
    Array<std::size_t> kept(out_.task_count(), 0),   // of each task's children, all at once
        most(out_.task_count(), 0);                  // within each task's children, at any time
    std::size_t kept_now = 0;
    for (int task = 0; task < out_.task_count(); ++task) {
      const int last = out_.task_begin[task + 1] - 1, above = out_.task_parent[task];
      std::size_t in_use = 0;
      for (int front = out_.task_begin[task]; front <= last; ++front) {
        const auto columns = static_cast<std::size_t>(out_.columns(front)),
                   below = static_cast<std::size_t>(out_.below(front));
        out_.panel_begin.push_back(out_.panel_begin.back() + columns * (columns + below));
        if (front == last) break;
        out_.stack_size = std::max(out_.stack_size, in_use + out_.update_size(front));
        in_use += out_.update_size(front) - held[front];
        if (out_.parent[front] != -1) held[out_.parent[front]] += out_.update_size(front);
      }
      const std::size_t update = out_.update_size(last);
      out_.kept_size = std::max(out_.kept_size, kept_now + update);
      kept_now += update - kept[task];
      most[task] = std::max(most[task], kept[task] + update);
      if (above == -1) {
        out_.most_kept += most[task];
      } else {
        kept[above] += update;
        most[above] += most[task];
      }
    }
  }

  const Adjacency& adjacency_;
  const int size_, eliminated_;
  Array<int> parent_, count_;
  Elimination out_;
};

}  // namespace

Elimination order_elimination(const Adjacency& adjacency, int retained) { return Ordering(adjacency, retained).run(); }

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/nested_dissection.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/thread_team.hpp"

namespace lsgp {

namespace {

// From this many rows on, dissection was measured to pay, if only on several threads at first: below, counting levels
// takes more than the factorization saves.
constexpr int least_rows = 80000;
// Parts of fewer rows are not divided.
constexpr int smallest_part = 400;
// Rows from which levels are counted, far from each other: more of them find shorter separators.
constexpr int level_functions = 8;
// Both sides of a separator have at least this share of a part.
constexpr double least_side = 0.3;
// Rows of a level to the square root of all: those of surfaces have up to 3, others 10 and more.
constexpr double narrow = 5;
// Rows with more neighbors than this are shared by rows far apart, such as the translation of a long cut. They come
// last if they are this few to the square root of all; more of them, in every separator, were measured to cost more
// than dissection saves.
constexpr int shared_neighbors = 64;
constexpr double most_shared = 0.1;

template <typename Visit>
void for_each_neighbor(const Adjacency& adjacency, int rows, int row, Visit visit) {
  for (int k = adjacency.begin[row]; k < adjacency.begin[row + 1]; ++k) {
    if (adjacency.neighbor[k] < rows) visit(adjacency.neighbor[k]);
  }
}

class Dissection {
 public:
  Dissection(const Adjacency& adjacency, int rows) : adjacency_(adjacency), rows_(rows), order_(rows) {
    std::iota(order_.begin(), order_.end(), 0);
  }

  Array<int> by_degree() && {
    find_places();
    reduce_fill({0, rows_});
    return std::move(order_);
  }

  Array<int> by_dissection() && {
    if (level_.empty()) find_shared();
    find_levels();
    const Array<Range> parts = divide_all();
    find_places();
    team_of_this_call().run_each(static_cast<int>(parts.size()), [&](int i) { reduce_fill(parts[i]); });
    return std::move(order_);
  }

  bool has_narrow_levels() {
    find_shared();
    if (rows_ - divided_ > most_shared * std::sqrt(rows_)) return false;
    count_levels_from(first_row());
    Array<int> count(rows_, 0);
    for (int k = 0; k < divided_; ++k) ++count[level_[order_[k]]];
    return *std::max_element(count.begin(), count.end()) <= narrow * std::sqrt(rows_);
  }

 private:
  // Shared rows have no levels.
  void find_shared() {
    const auto is_divided = [&](int row) {
      return adjacency_.begin[row + 1] - adjacency_.begin[row] <= shared_neighbors;
    };
    const auto shared = std::stable_partition(order_.begin(), order_.end(), is_divided);
    divided_ = static_cast<int>(shared - order_.begin());
  }

  int first_row() const { return divided_ > 0 ? order_[0] : 0; }

  // Edges from a row, and in other components from one of theirs: neighbors differ by one at most.
  void count_levels_from(int start) {
    level_.assign(rows_, -1);
    for (int k = divided_; k < rows_; ++k) level_[order_[k]] = 0;
    queue_.resize(rows_);
    int tail = 0, next = 0;
    for (int head = 0; tail < divided_; start = next) {
      level_[start] = 0;
      queue_[tail++] = start;
      for (; head < tail; ++head) {
        const int above = level_[queue_[head]] + 1;
        for_each_neighbor(adjacency_, rows_, queue_[head], [&](int other) {
          if (level_[other] != -1) return;
          level_[other] = above;
          queue_[tail++] = other;
        });
      }
      while (next < rows_ && level_[next] != -1) ++next;
    }
  }

  using Levels = Eigen::Array<int, level_functions, 1>;

  // From rows that are as far as possible from those before.
  void find_levels() {
    if (level_.empty()) count_levels_from(first_row());
    Array<int> nearest = level_;
    levels_.resize(rows_);
    for (int function = 0; function < level_functions; ++function) {
      int farthest = first_row();
      for (int k = 0; k < divided_; ++k) {
        if (nearest[order_[k]] > nearest[farthest]) farthest = order_[k];
      }
      count_levels_from(farthest);
      for (int row = 0; row < rows_; ++row) {
        levels_[row][function] = level_[row];
        nearest[row] = function == 0 ? level_[row] : std::min(nearest[row], level_[row]);
      }
    }
    separates_.assign(rows_, 0);
  }

  struct Separator {
    double rows;
    int function = -1, level = 0;
  };

  // A part, in `order_`.
  struct Range {
    int begin, end;
    int size() const { return end - begin; }
  };

  // Divides all rows, the parts of one depth at the same time. Returns what is not divided any further.
  Array<Range> divide_all() {
    Array<Range> parts{{0, divided_}}, undivided;
    while (!parts.empty()) {
      Array<Array<Range>> halves(parts.size());
      team_of_this_call().run_each(static_cast<int>(parts.size()), [&](int i) { halves[i] = divide(parts[i]); });
      Array<Range> next;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (halves[i].empty()) undivided.push_back(parts[i]);
        next.insert(next.end(), halves[i].begin(), halves[i].end());
      }
      parts = std::move(next);
    }
    return undivided;
  }

  // The smallest level that divides a part.
  Separator find_separator(const Range& part) const {
    Levels low = levels_[order_[part.begin]], high = low;
    for (int k = part.begin; k < part.end; ++k) {
      const Levels& levels = levels_[order_[k]];
      low = low.min(levels);
      high = high.max(levels);
    }
    const double size = part.size();
    Separator best{narrow * std::sqrt(size)};
    Eigen::Array<int, level_functions + 1, 1> first;  // count of each function
    first[0] = 0;
    for (int i = 0; i < level_functions; ++i) first[i + 1] = first[i] + high[i] - low[i] + 1;
    Array<int> count(first[level_functions], 0);
    for (int k = part.begin; k < part.end; ++k) {
      const Levels& levels = levels_[order_[k]];
      for (int i = 0; i < level_functions; ++i) ++count[first[i] + levels[i] - low[i]];
    }
    for (int i = 0; i < level_functions; ++i) {
      double below = 0;
      for (int level = low[i]; level <= high[i]; ++level) {
        const double rows = count[first[i] + level - low[i]], side = std::min(below, size - below - rows);
        if (side >= least_side * size && rows < best.rows) best = {rows, i, level};
        below += rows;
      }
    }
    return best;
  }

  // Returns both sides of a separator, which comes behind them, or nothing if there is none. Rows of a level without a
  // neighbor above it go below. Parts that are divided at the same time have no neighbors in each other.
  Array<Range> divide(const Range& part) {
    if (part.size() < smallest_part) return {};
    const Separator separator = find_separator(part);
    if (separator.function == -1) return {};
    const auto is_above = [&](int row) { return levels_[row][separator.function] > separator.level; };
    Array<int> above, between;
    int at = part.begin;
    for (int k = part.begin; k < part.end; ++k) {
      const int row = order_[k];
      if (is_above(row)) {
        above.push_back(row);
        continue;
      }
      if (levels_[row][separator.function] == separator.level) {
        for_each_neighbor(adjacency_, rows_, row, [&](int other) {
          if (!separates_[other] && is_above(other)) separates_[row] = 1;
        });
      }
      if (separates_[row])
        between.push_back(row);
      else
        order_[at++] = row;
    }
    std::copy(above.begin(), above.end(), order_.begin() + at);
    std::copy(between.begin(), between.end(), order_.begin() + part.end - ssize(between));
    return {{part.begin, at}, {at, part.end - static_cast<int>(between.size())}};
  }

  void find_places() {
    place_.resize(rows_);
    for (int k = 0; k < rows_; ++k) place_[order_[k]] = k;
  }

  // Minimum degree in a part.
  void reduce_fill(const Range& range) {
    if (range.size() == 0) return;
    using Pattern = Eigen::SparseMatrix<signed char, Eigen::ColMajor, int>;
    const Array<int> part(order_.begin() + range.begin, order_.begin() + range.end);
    const int size = range.size();
    Pattern pattern(size, size);
    Array<int> inner;
    for (int i = 0; i < size; ++i) {
      pattern.outerIndexPtr()[i] = static_cast<int>(inner.size());
      inner.push_back(i);
      for_each_neighbor(adjacency_, rows_, part[i], [&](int other) {
        const int place = place_[other];
        if (place >= range.begin && place < range.end) inner.push_back(place - range.begin);
      });
    }
    pattern.outerIndexPtr()[size] = static_cast<int>(inner.size());
    pattern.resizeNonZeros(static_cast<Eigen::Index>(inner.size()));
    std::copy(inner.begin(), inner.end(), pattern.innerIndexPtr());
    std::fill_n(pattern.valuePtr(), pattern.nonZeros(), Pattern::Scalar(1));
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    // With both triangles in one matrix: otherwise Eigen sorts the pattern again, which takes 3 % of a map.
    Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower | Eigen::Upper>(), order);
    for (int i = 0; i < size; ++i) order_[range.begin + i] = part[order.indices()[i]];
  }

  const Adjacency& adjacency_;
  const int rows_;
  int divided_ = 0;   // rows that are not shared
  Array<int> order_;  // parts and, behind them, their separators; shared rows last
  Array<int> place_;  // of every row in `order_`, as long as parts have no order of their own
  Array<int> level_, queue_;
  Array<Levels> levels_;
  Array<char> separates_;
};

}  // namespace

Array<int> order_by_degree(const Adjacency& adjacency, int rows) { return Dissection(adjacency, rows).by_degree(); }

Array<int> order_by_dissection(const Adjacency& adjacency, int rows) {
  return Dissection(adjacency, rows).by_dissection();
}

Array<int> order_rows(const Adjacency& adjacency, int rows) {
  if (rows >= least_rows) {
    Dissection dissection(adjacency, rows);
    if (dissection.has_narrow_levels()) return std::move(dissection).by_dissection();
  }
  return order_by_degree(adjacency, rows);
}

}  // namespace lsgp

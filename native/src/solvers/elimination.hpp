// SPDX-License-Identifier: GPL-3.0-or-later
// The symbolic part of a sparse Cholesky factorization: elimination order and fronts.
#pragma once

#include <cstddef>

#include "base/array.hpp"

namespace lsgp {

// The pattern of a symmetric matrix: the neighbors of every row, and the stored entry for each.
struct Adjacency {
  Array<int> begin;     // (n + 1)
  Array<int> neighbor;  // without the row itself
  Array<int> entry;     // in the lower triangle as it was given
};
// outer, inner: the lower triangle by columns.
Adjacency adjacency_of_lower(int size, const int* outer, const int* inner);

// Columns are eliminated front by front; children stand before their parent, the last child just before it.
struct Elimination {
  Array<int> position;             // (n) of every row; retained ones come last, in their own order
  Array<int> row_at;               // (n) its inverse
  int eliminated = 0;              // rows that are not retained
  Array<int> first;                // (fronts + 1) position of each front's first column
  Array<int> parent;               // (fronts) or -1
  Array<std::size_t> rows_begin;   // (fronts + 1)
  Array<int> rows;                 // positions of the rows below each front's columns, ascending
  Array<int> retained_rows;        // (fronts) how many of them are retained
  Array<std::size_t> panel_begin;  // (fronts + 1) into the factor's numbers

  // Fronts that are eliminated together, tasks by the size of the matrix alone: whole subtrees with little work, and
  // one by one the fronts above them. The last front's update is kept until the parent of the task takes it in.
  Array<int> task_begin;       // (tasks + 1) its first front
  Array<int> task_parent;      // (tasks) or -1
  Array<int> last_child;       // (tasks) or -1
  Array<int> earlier_sibling;  // (tasks) or -1
  std::size_t stack_size = 0;  // the most numbers that updates within a task take up at once
  std::size_t kept_size = 0;   // and those that are kept, with the tasks in their order
  std::size_t most_kept = 0;   // or in any other

  int task_count() const { return static_cast<int>(task_parent.size()); }
  int front_count() const { return static_cast<int>(parent.size()); }
  int columns(int front) const { return first[front + 1] - first[front]; }
  int below(int front) const { return static_cast<int>(rows_begin[front + 1] - rows_begin[front]); }
  std::size_t update_size(int front) const {
    return static_cast<std::size_t>(below(front)) * static_cast<std::size_t>(below(front) - retained_rows[front]);
  }
};

// An order of the rows but the last `retained`; supernodes of its elimination tree, merged where that adds few zeros
// (Ashcraft and Grimes 1989; Chen, Davis, Hager, Rajamanickam 2008, section 2.4).
Elimination order_elimination(const Adjacency& adjacency, int retained);

}  // namespace lsgp

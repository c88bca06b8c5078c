// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of elimination with little fill, of the first `rows` rows without the others: the row at each position.
#pragma once

#include "base/array.hpp"
#include "solvers/elimination.hpp"

namespace lsgp {

// Minimum degree (Amestoy, Davis and Duff 1996).
Array<int> order_by_degree(const Adjacency& adjacency, int rows);

// Nested dissection (George 1973) by levels of edges from a few rows, with minimum degree in parts that are small or
// have no narrow separator.
Array<int> order_by_dissection(const Adjacency& adjacency, int rows);

// Dissection of large surfaces, minimum degree otherwise.
Array<int> order_rows(const Adjacency& adjacency, int rows);

}  // namespace lsgp

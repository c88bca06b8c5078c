// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/nested_dissection.hpp"

#include <doctest/doctest.h>

#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "base/thread_team.hpp"
#include "random_matrices.hpp"

namespace {

using lsgp::Adjacency;
using lsgp::Array;
using Edges = std::vector<std::pair<int, int>>;  // one may occur twice

Adjacency adjacency_of(int size, const Edges& edges) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(size) + edges.size());
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1);
  for (const auto& [a, b] : edges) entries.emplace_back(std::max(a, b), std::min(a, b), 1);
  Eigen::SparseMatrix<double> lower(size, size);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lsgp::adjacency_of_lower(size, lower.outerIndexPtr(), lower.innerIndexPtr());
}

// A triangulated grid, numbered in random order or row by row.
Edges grid(int width, int height, Random* random = nullptr) {
  std::vector<int> number(width * height);
  std::iota(number.begin(), number.end(), 0);
  for (int i = width * height; random && i-- > 1;) std::swap(number[i], number[below(*random, i + 1)]);
  Edges out;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto join = [&](int to_x, int to_y) {
        if (to_x < width && to_y < height) out.emplace_back(number[y * width + x], number[to_y * width + to_x]);
      };
      join(x + 1, y);
      join(x, y + 1);
      join(x + 1, y + 1);
    }
  }
  return out;
}

void check_permutation(const Array<int>& order, int rows) {
  REQUIRE(order.size() == static_cast<std::size_t>(rows));
  CHECK(std::set<int>(order.begin(), order.end()).size() == static_cast<std::size_t>(rows));
  for (const int row : order) CHECK((row >= 0 && row < rows));
}

// The sum of the squared numbers of entries of the factor's columns. Row `at` of the factor has an entry in each column
// on the ways up the elimination tree from the earlier neighbors of `at`.
double operations(const Adjacency& adjacency, const Array<int>& order) {
  const int rows = static_cast<int>(order.size());
  std::vector<int> position(rows), parent(rows, -1), last_row(rows, -1), entries(rows, 1);
  for (int at = 0; at < rows; ++at) position[order[at]] = at;
  for (int at = 0; at < rows; ++at) {
    last_row[at] = at;
    for (int k = adjacency.begin[order[at]]; k < adjacency.begin[order[at] + 1]; ++k) {
      const int other = adjacency.neighbor[k];
      if (other >= rows || position[other] > at) continue;
      for (int column = position[other]; last_row[column] != at; column = parent[column]) {
        if (parent[column] == -1) parent[column] = at;
        last_row[column] = at;
        ++entries[column];
      }
    }
  }
  double out = 0;
  for (const int count : entries) out += static_cast<double>(count) * count;
  return out;
}

}  // namespace

TEST_CASE("orders of elimination are permutations") {
  Random random(1);
  std::vector<std::pair<int, Edges>> patterns{{0, {}}, {1, {}}, {3000, {}}, {2500, grid(50, 50, &random)}};
  patterns.push_back({10000, grid(2, 5000)});
  Edges hub = grid(60, 60), parts, sparse;
  for (int row = 1; row < 3600; ++row) hub.emplace_back(0, row);
  for (int part = 0; part < 40; ++part) {
    for (const auto& [a, b] : grid(10, 10)) parts.emplace_back(100 * part + a, 100 * part + b);
  }
  for (int i = 0; i < 6000; ++i) {
    const int a = below(random, 3000), b = below(random, 3000);
    if (a != b) sparse.emplace_back(std::min(a, b), std::max(a, b));
  }
  patterns.push_back({3600, hub});
  patterns.push_back({4000, parts});
  patterns.push_back({3000, sparse});
  for (const auto& [size, edges] : patterns) {
    const Adjacency adjacency = adjacency_of(size, edges);
    for (const int retained : {0, size / 3}) {
      CAPTURE(size);
      CAPTURE(retained);
      check_permutation(lsgp::order_by_degree(adjacency, size - retained), size - retained);
      check_permutation(lsgp::order_by_dissection(adjacency, size - retained), size - retained);
    }
  }
}

TEST_CASE("dissection takes fewer operations than minimum degree on large grids, few more on others") {
  Random random(2);
  for (const auto& [width, height] :
       {std::pair(100, 100), std::pair(300, 50), std::pair(200, 200), std::pair(250, 250)}) {
    const Adjacency adjacency = adjacency_of(width * height, grid(width, height, &random));
    const double by_degree = operations(adjacency, lsgp::order_by_degree(adjacency, width * height)),
                 by_dissection = operations(adjacency, lsgp::order_by_dissection(adjacency, width * height));
    CAPTURE(width);
    CHECK(by_dissection < (width * height < 30000 ? 1.2 : 0.9) * by_degree);
  }
}

TEST_CASE("large surfaces are dissected, also with a few rows that many others share") {
  constexpr int width = 300, height = 270, rows = width * height;
  const Edges edges = grid(width, height);
  const Adjacency surface = adjacency_of(rows, edges);
  CHECK(lsgp::order_rows(surface, rows) == lsgp::order_by_dissection(surface, rows));
  CHECK(lsgp::order_rows(surface, width * 260) == lsgp::order_by_degree(surface, width * 260));
  for (const int shared : {20, 400, 4000}) {  // with 2000, 100 and 10 others each
    Random random(3);
    Edges more = edges;
    for (int i = 0; i < 40000; ++i) more.emplace_back(below(random, shared), shared + below(random, rows - shared));
    const Adjacency adjacency = adjacency_of(rows, more);
    CAPTURE(shared);
    CHECK(lsgp::order_rows(adjacency, rows) ==
          (shared == 20 ? lsgp::order_by_dissection(adjacency, rows) : lsgp::order_by_degree(adjacency, rows)));
  }
}

TEST_CASE("dissection takes fewer operations than minimum degree where lines of a grid share a row each") {
  constexpr int width = 250, height = 250, lines = 10;
  Random random(5);
  Edges edges = grid(width, height, &random);
  std::vector<int> number(width * height);  // as in the grid
  std::iota(number.begin(), number.end(), 0);
  Random same(5);
  for (int i = width * height; i-- > 1;) std::swap(number[i], number[below(same, i + 1)]);
  for (int line = 0; line < lines; ++line) {
    for (int x = 0; x < width; ++x) edges.emplace_back(number[25 * line * width + x], width * height + line);
  }
  constexpr int rows = width * height + lines;
  const Adjacency adjacency = adjacency_of(rows, edges);
  const Array<int> order = lsgp::order_by_dissection(adjacency, rows);
  check_permutation(order, rows);
  CHECK(operations(adjacency, order) < 0.9 * operations(adjacency, lsgp::order_by_degree(adjacency, rows)));
}

TEST_CASE("dissection is the same on any number of threads") {
  Random random(4);
  const Adjacency adjacency = adjacency_of(300 * 200, grid(300, 200, &random));
  const lsgp::ThreadCount one(1);
  const auto expected = lsgp::order_by_dissection(adjacency, 300 * 200);
  for (const int threads : {2, 3, 8}) {
    const lsgp::ThreadCount several(threads);
    CHECK(lsgp::order_by_dissection(adjacency, 300 * 200) == expected);
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "polygons.hpp"

#include <pybind11/typing.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"

namespace py = pybind11;

namespace {

// Calls visit(lower, begin, end) for every vertex with the items of which it is the lower vertex, sorted, as iterators.
// largest: of the vertices, -1 for none.  for_each_item: calls its argument with the lower vertex of each item, and the
// item.
template <typename Item, typename ForEachItem, typename Visit>
void visit_by_lower(std::int32_t largest, const ForEachItem& for_each_item, const Visit& visit) {
  // Counted into a bucket for each lower vertex; those have few each.
  std::vector<std::size_t> ends(static_cast<std::size_t>(std::int64_t{largest} + 2), 0);
  for_each_item([&](std::int32_t lower, const Item&) { ++ends[static_cast<std::size_t>(lower) + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<Item> items(ends.back());
  for_each_item([&](std::int32_t lower, const Item& item) { items[ends[static_cast<std::size_t>(lower)]++] = item; });
  auto begin = items.begin();
  for (std::int32_t lower = 0; lower <= largest; ++lower) {
    const auto end = items.begin() + static_cast<std::ptrdiff_t>(ends[static_cast<std::size_t>(lower)]);
    std::sort(begin, end);
    visit(lower, begin, end);
    begin = end;
  }
}

std::int32_t largest_of(const View<std::int32_t, 1>& vertices) {
  return std::accumulate(vertices.begin(), vertices.end(), -1, [](auto a, auto b) { return std::max(a, b); });
}

// The edges of polygons, each once, the smaller vertex first, in order, (e, 2).  corners: (c) vertices below
// vertex_count, polygon after polygon.  sizes: (f) corners of each.
Vertices polygon_edges(const Vertices& corners, const Places& sizes, std::int32_t vertex_count) {
  const View<std::int32_t, 1> vertex("corners", corners, {any_length});
  vertex.require_below(vertex_count);
  const View<std::int64_t, 1> size = view_of_sizes(sizes, 0, vertex.length());
  const auto for_each_edge = [&](const auto& visit) {
    py::ssize_t begin = 0;
    for (py::ssize_t f = 0; f < size.length(); begin += size(f++)) {
      std::int32_t before = size(f) > 0 ? vertex(begin + size(f) - 1) : 0;
      for (py::ssize_t corner = begin; corner < begin + size(f); ++corner) {
        visit(std::min(before, vertex(corner)), std::max(before, vertex(corner)));
        before = vertex(corner);
      }
    }
  };
  std::vector<std::int32_t> edges;
  edges.reserve(static_cast<std::size_t>(vertex.length()));
  visit_by_lower<std::int32_t>(largest_of(vertex), for_each_edge, [&](std::int32_t low, auto first, auto last) {
    std::for_each(first, std::unique(first, last), [&](std::int32_t high) { edges.insert(edges.end(), {low, high}); });
  });
  return Vertices({static_cast<py::ssize_t>(edges.size() / 2), py::ssize_t{2}}, edges.data());
}

// Whether to cut a quad from its first corner to its third, rather than from its second to its fourth.  points: of the
// corners.  is_first_lower: whether the least vertex is on that diagonal, which decides where both are as good.
bool is_cut_from_first(const Eigen::Matrix<double, 3, 4>& points, bool is_first_lower) {
  constexpr double nearly_flat = 1e-9, nearly_equal = 1e-9;
  // At the origin and of size 1, so that no product of coordinates over- or underflows.
  Eigen::Matrix<double, 3, 4> at = points.colwise() - points.col(0);
  const double extent = at.cwiseAbs().maxCoeff();
  if (extent > 0) at /= extent;
  const Eigen::Vector3d b = at.col(1), c = at.col(2), d = at.col(3), across = d - b;
  const Eigen::Vector3d normal = c.cross(across);  // twice Newell's area vector
  const double square = std::max(normal.squaredNorm(), std::numeric_limits<double>::min());
  // The two triangles on a diagonal have shares of this normal that add up to 1; a turned one has a negative share.
  const auto worst_of = [&](const Eigen::Vector3d& area) {
    const double share = area.dot(normal) / square;
    return std::min(share, 1 - share);
  };
  const double first = worst_of(b.cross(c)), second = worst_of(b.cross(d));
  const bool first_is_good = first > nearly_flat, second_is_good = second > nearly_flat;
  if (first_is_good != second_is_good) return first_is_good;
  if (!first_is_good) return first >= second;
  const double length = c.squaredNorm(), other = across.squaredNorm();
  return std::abs(length - other) <= nearly_equal * (length + other) ? is_first_lower : length < other;
}

// The same of each quad.  positions: (n, 3).  quads: (k, 4) vertices.
Marks quad_diagonals(const Numbers& positions, const Vertices& quads) {
  const View<double, 2> place("positions", positions, {any_length, 3});
  const View<std::int32_t, 2> vertex("quads", quads, {any_length, 4});
  vertex.require_below(place.length());
  Marks found(vertex.length());
  auto out = found.mutable_unchecked<1>();
  for (py::ssize_t q = 0; q < vertex.length(); ++q) {
    Eigen::Matrix<double, 3, 4> points;
    for (int c = 0; c < 4; ++c) {
      for (int axis = 0; axis < 3; ++axis) points(axis, c) = place(vertex(q, c), axis);
    }
    out(q) = is_cut_from_first(points, std::min(vertex(q, 0), vertex(q, 2)) < std::min(vertex(q, 1), vertex(q, 3)));
  }
  return found;
}

// The polygons with a diagonal between vertices that an edge or another diagonal joins as well, ascending.
// triangles: (m, 3) polygon corners, of every polygon two fewer than it has corners.  corners, sizes: as above.
// edges: (e, 2) vertices of corners, each once.
Places doubled_diagonals(const Places& triangles, const Vertices& corners, const Places& sizes, const Vertices& edges,
                         std::int32_t vertex_count) {
  constexpr std::int64_t edge = -1;
  struct Joint {
    std::int32_t higher;
    std::int64_t owner;  // of a diagonal
    bool operator<(const Joint& other) const { return higher < other.higher; }
    bool operator==(const Joint& other) const { return higher == other.higher; }
  };
  constexpr std::int64_t least_size = 2;
  const View<std::int32_t, 1> vertex("corners", corners, {any_length});
  vertex.require_below(vertex_count);
  const View<std::int64_t, 1> size = view_of_sizes(sizes, least_size, vertex.length());
  const View<std::int64_t, 2> corner("triangles", triangles, {vertex.length() - least_size * size.length(), 3});
  corner.require_below(vertex.length());
  const View<std::int32_t, 2> joined("edges", edges, {any_length, 2});
  joined.require_below(std::int64_t{largest_of(vertex)} + 1);
  const auto for_each_joint = [&](const auto& visit) {
    for (py::ssize_t e = 0; e < joined.length(); ++e) {
      const auto [lower, higher] = std::minmax(joined(e, 0), joined(e, 1));
      visit(lower, Joint{higher, edge});
    }
    py::ssize_t f = 0;
    for (py::ssize_t polygon = 0; polygon < size.length(); ++polygon) {
      for (const py::ssize_t end = f + size(polygon) - least_size; f < end; ++f) {
        for (int c = 0; c < 3; ++c) {
          // A diagonal is a side of two triangles, which run along it in opposite directions.
          const std::int64_t from = corner(f, c), to = corner(f, (c + 1) % 3);
          if (to - from < 2 || to - from > size(polygon) - 2) continue;
          const auto [lower, higher] = std::minmax(vertex(from), vertex(to));
          visit(lower, Joint{higher, polygon});
        }
      }
    }
  };
  std::vector<std::int64_t> found;
  visit_by_lower<Joint>(largest_of(vertex), for_each_joint, [&](std::int32_t, auto begin, auto end) {
    for (auto joint = begin; joint != end; ++joint) {
      const bool is_doubled =
          (joint != begin && *(joint - 1) == *joint) || (joint + 1 != end && *(joint + 1) == *joint);
      if (is_doubled && joint->owner != edge) found.push_back(joint->owner);
    }
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return Places(static_cast<py::ssize_t>(found.size()), found.data());
}

// A number for each vertex, by which a table has its entries: its own, or, where few of those up to the largest one
// have corners, as in a part of a large mesh, its place among these.
class VertexNumbers {
 public:
  explicit VertexNumbers(const View<std::int64_t, 1>& vertices) {
    constexpr std::int64_t most_a_corner = 8;
    for (const std::int64_t v : vertices) largest_ = std::max(largest_, v);
    if (largest_ / most_a_corner < vertices.length()) return;
    sorted_.assign(vertices.begin(), vertices.end());
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
  }

  std::size_t count() const { return sorted_.empty() ? static_cast<std::size_t>(largest_ + 1) : sorted_.size(); }
  std::size_t of(std::int64_t vertex) const {
    if (sorted_.empty()) return static_cast<std::size_t>(vertex);
    return static_cast<std::size_t>(std::lower_bound(sorted_.begin(), sorted_.end(), vertex) - sorted_.begin());
  }

 private:
  std::int64_t largest_ = -1;
  std::vector<std::int64_t> sorted_;
};

// The corners with coordinates that no corner of their vertex before them has, ascending, (k), and of every corner the
// place of the one among these that it equals, (c).  vertices: (c), not negative.  uv: (c, 2), without NaN.
py::typing::Tuple<Places, Places> distinct_corners(const Places& vertices, const Numbers& uv) {
  const View<std::int64_t, 1> vertex("vertices", vertices, {any_length});
  vertex.require_below(std::numeric_limits<std::int64_t>::max());
  const View<double, 2> at("uv", uv, {vertex.length(), 2});
  at.require_no_nan();
  const py::ssize_t count = vertex.length();
  const VertexNumbers numbers(vertex);
  // Most vertices have the same coordinates at all corners; those at cuts have few others.
  constexpr std::int64_t none = -1;
  std::vector<std::int64_t> first(numbers.count(), none), found;
  std::map<std::tuple<std::int64_t, double, double>, std::int64_t> others;
  Places place(count);
  auto out = place.mutable_unchecked<1>();
  for (py::ssize_t c = 0; c < count; ++c) {
    std::int64_t& known = first[numbers.of(vertex(c))];
    const auto next = static_cast<std::int64_t>(found.size());
    if (known == none) {
      known = next;
    } else {
      const auto own = found[static_cast<std::size_t>(known)];
      if (at(own, 0) == at(c, 0) && at(own, 1) == at(c, 1)) {
        out(c) = known;
        continue;
      }
      const auto [entry, is_new] = others.try_emplace({vertex(c), at(c, 0), at(c, 1)}, next);
      out(c) = entry->second;
      if (!is_new) continue;
    }
    out(c) = next;
    found.push_back(c);
  }
  return py::make_tuple(Places(static_cast<py::ssize_t>(found.size()), found.data()), place);
}

}  // namespace

void define_polygons(py::module_& module) {
  using py::literals::operator""_a;
  module.def("polygon_edges", &polygon_edges, "corners"_a, "sizes"_a, "vertex_count"_a);
  module.def("quad_diagonals", &quad_diagonals, "positions"_a, "quads"_a);
  module.def("distinct_corners", &distinct_corners, "vertices"_a, "uv"_a);
  module.def("doubled_diagonals", &doubled_diagonals, "triangles"_a, "corners"_a, "sizes"_a, "edges"_a,
             "vertex_count"_a);
}

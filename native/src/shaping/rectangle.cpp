// SPDX-License-Identifier: GPL-3.0-or-later
#include "shaping/rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/text.hpp"
#include "lsgp/errors.hpp"

namespace lsgp {

namespace {

constexpr std::size_t corner_count = 4;
// What it costs, in radians of the turning at corners, that a side is e times shorter than a quarter of the boundary.
constexpr double price_of_short_sides = 0.1;
// Of the vertices that turn most, and of all along the boundary, how many may be corners.
constexpr std::size_t sharpest = 24, spread = 12;

using Corners = std::array<std::size_t, corner_count>;  // along the boundary, ascending

// A boundary and, of each of its vertices, how far it is along it, and how much the boundary turns there.
struct Rim {
  Array<Index> vertices;
  Array<double> begin;  // one more: the whole length
  Array<double> turning;

  double side(std::size_t from, std::size_t to) const {
    const double length = begin[to] - begin[from];
    return to > from ? length : length + begin.back();
  }
};

Rim rim_of(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  if (mesh.genus != 0 || mesh.boundary_loops.size() != 1) {
    throw Error(Code::shape_impossible,
                "The faces have a hole or no boundary. Choose faces with a single boundary, or cut them.");
  }
  Rim out;
  out.vertices = mesh.boundary_loops[0];
  const std::size_t count = out.vertices.size();
  if (count < corner_count)
    throw Error(Code::shape_impossible, "The boundary has less than four vertices. Choose more faces.");
  double length = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Index v = out.vertices[i];
    out.begin.push_back(length);
    out.turning.push_back(surface.geometry.angle_defect[v]);
    length += surface.geometry.length[mesh.outgoing[v]];
  }
  out.begin.push_back(length);
  return out;
}

// The vertices that may be corners, ascending.
Array<std::size_t> candidates(const Rim& rim) {
  const std::size_t count = rim.vertices.size();
  Array<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rim.turning[a] > rim.turning[b]; });
  Array<std::size_t> out(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(count, sharpest)));
  for (std::size_t i = 0; i < std::min(count, spread); ++i) out.push_back(i * count / std::min(count, spread));
  sort_unique(out);
  return out;
}

Corners find_corners(const Rim& rim) {
  const Array<std::size_t> some = candidates(rim);
  const double quarter = rim.begin.back() / corner_count;
  const auto side = [&](std::size_t from, std::size_t to) {
    return price_of_short_sides * std::log(std::max(rim.side(from, to) / quarter, 1e-9));
  };
  Corners best{};
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < some.size(); ++a) {
    for (std::size_t b = a + 1; b < some.size(); ++b) {
      for (std::size_t c = b + 1; c < some.size(); ++c) {
        for (std::size_t d = c + 1; d < some.size(); ++d) {
          const Corners corners{some[a], some[b], some[c], some[d]};
          double value = 0;
          for (std::size_t i = 0; i < corner_count; ++i) {
            value += rim.turning[corners[i]] + side(corners[i], corners[(i + 1) % corner_count]);
          }
          if (value > highest) {
            highest = value;
            best = corners;
          }
        }
      }
    }
  }
  return best;
}

}  // namespace

RectangularBoundary lay_on_rectangle(const MetricMesh& surface, const PerVertex<char>& is_corner) {
  const Rim rim = rim_of(surface);
  const std::size_t count = rim.vertices.size();
  Array<std::size_t> marked;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_corner[rim.vertices[i]]) marked.push_back(i);
  }
  if (!marked.empty() && marked.size() != corner_count) {
    throw Error(Code::shape_impossible,
                concat("There are ", marked.size(), " corners on the boundary. Choose four, or none."));
  }
  Corners corners{};
  if (marked.empty()) {
    corners = find_corners(rim);
  } else {
    std::copy(marked.begin(), marked.end(), corners.begin());
  }
  const auto side = [&](std::size_t i) { return rim.side(corners[i], corners[(i + 1) % corner_count]); };
  const double width = (side(0) + side(2)) / 2, height = (side(1) + side(3)) / 2;
  const std::array<Complex, corner_count + 1> place{Complex{0, 0}, {width, 0}, {width, height}, {0, height}, {0, 0}};
  RectangularBoundary out;
  for (std::size_t i = 0; i < corner_count; ++i) {
    const std::size_t end = corners[(i + 1) % corner_count];
    for (std::size_t at = corners[i]; at != end; at = (at + 1) % count) {
      const double share = at == corners[i] ? 0 : rim.side(corners[i], at) / side(i);
      out.vertices.push_back(rim.vertices[at]);
      out.positions.push_back(place[i] + share * (place[i + 1] - place[i]));
    }
  }
  return out;
}

}  // namespace lsgp

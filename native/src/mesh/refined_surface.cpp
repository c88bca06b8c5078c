// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refined_surface.hpp"

#include <algorithm>

namespace lsgp {

namespace {

// Slivers map badly: with less of the opposite corner a vertex is on the edge, and of the others it has that much.
constexpr double share_beside_edge = 0.15, least_share = 0.05;

}  // namespace

RefinedSurface::RefinedSurface(const ThinnedSurface& thinned, const PerHalfedge<char>& fixed)
    : twin_(thinned.twin), fixed_(fixed), part_(thinned.triangles.rows()) {
  triangles_.reserve(thinned.triangles.rows());
  for (Index f = 0; f < thinned.triangles.rows(); ++f) {
    triangles_.push_back({thinned.triangles(f, 0), thinned.triangles(f, 1), thinned.triangles(f, 2)});
    whole_.push_back(f);
  }
}

SurfacePlace RefinedSurface::locate(SurfacePlace place) const {
  while (is_divided(place.triangle)) {
    const Parts& parts = part_[place.triangle];
    // The part without the corner that the point has least of, compared with the added vertex.
    int without = none;
    double of_added = 0;
    for (int c = 0; c < 3; ++c) {
      if (parts.with_corner_replaced[c] == none) continue;
      const double share = place.share[c] / parts.share[c];
      if (without != none && share >= of_added) continue;
      without = c;
      of_added = share;
    }
    for (int c = 0; c < 3; ++c) {
      place.share[c] = c == without ? of_added : std::max(place.share[c] - of_added * parts.share[c], 0.0);
    }
    place.triangle = parts.with_corner_replaced[without];
  }
  return place;
}

void RefinedSurface::link(Index h, Index twin) {
  twin_[h] = twin;
  if (twin != none) twin_[twin] = h;
}

// A part of triangle f: this corner replaced, which only the edge opposite is not affected by.
Index RefinedSurface::append(Index f, int corner, Index vertex) {
  const Index part = triangle_count();
  triangles_.push_back(triangles_[f]);
  triangles_.back()[static_cast<std::size_t>(corner)] = vertex;
  part_.emplace_back();
  whole_.push_back(whole_[f]);
  const int opposite = (corner + 1) % 3;
  for (int c = 0; c < 3; ++c) {
    twin_.push_back(none);
    fixed_.push_back(c == opposite ? fixed_[3 * f + c] : 0);
  }
  link(3 * part + opposite, twin_[3 * f + opposite]);
  part_[f].with_corner_replaced[corner] = part;
  ++part_[f].size;
  return part;
}

// Into two parts, by a vertex on the edge opposite a corner.  at_first: its share of the edge's first end.
void RefinedSurface::divide(Index f, int opposite, Index vertex, double at_first) {
  const int first = (opposite + 1) % 3, second = (opposite + 2) % 3;
  part_[f].share[opposite] = 0;
  part_[f].share[first] = at_first;
  part_[f].share[second] = 1 - at_first;
  part_[f].with_corner_replaced[opposite] = none;
  const Index without_first = append(f, first, vertex), without_second = append(f, second, vertex);
  link(3 * without_first + opposite, 3 * without_second + second);
}

void RefinedSurface::insert(Index vertex, const SurfacePlace& at) {
  const Index f = at.triangle;
  const int least = static_cast<int>(std::min_element(at.share, at.share + 3) - at.share);
  const int first = (least + 1) % 3, second = (least + 2) % 3;
  const Index edge = 3 * f + first, across = twin_[edge];
  if (at.share[least] < share_beside_edge && across != none && !fixed_[edge]) {
    const double along = at.share[first] / (at.share[first] + at.share[second]);
    const double at_first = std::min(std::max(along, least_share), 1 - least_share);
    const Index g = across / 3;
    divide(f, least, vertex, at_first);
    divide(g, static_cast<int>((across + 2) % 3), vertex, 1 - at_first);
    const int g_first = static_cast<int>(across % 3), g_second = (g_first + 1) % 3;
    link(3 * part_[f].with_corner_replaced[first] + first, 3 * part_[g].with_corner_replaced[g_second] + g_first);
    link(3 * part_[f].with_corner_replaced[second] + first, 3 * part_[g].with_corner_replaced[g_first] + g_first);
    return;
  }
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += part_[f].share[c] = std::max(at.share[c], least_share);
  for (double& share : part_[f].share) share /= sum;
  Index part[3];
  for (int c = 0; c < 3; ++c) part[c] = append(f, c, vertex);
  for (int c = 0; c < 3; ++c) link(3 * part[c] + c, 3 * part[(c + 2) % 3] + (c + 1) % 3);
}

}  // namespace lsgp

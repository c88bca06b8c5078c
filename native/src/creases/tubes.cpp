// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/tubes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/array.hpp"
#include "base/union_find.hpp"
#include "creases/face_quads.hpp"
#include "creases/opened_tube.hpp"
#include "cut/cut_cost.hpp"
#include "lsgp/tubes.hpp"
#include "mesh/large_surface.hpp"

namespace lsgp {

namespace {

constexpr double least_share = 0.8;  // of a component's area, of tubes: more than four sides of a cube
constexpr double steepest = 0.5;     // the sine of half a cone's angle: half a disk
constexpr double most_even = 1.1;    // between girths: texel density is off by a twentieth at most
constexpr double least_handle = 1;   // of its girth: shorter ones are rims

// The side of a quad that a halfedge is, as 4 * quad + side; none if it is no side.
using SideOf = PerHalfedge<Index>;

// Quads one after the other across opposite sides, and the halfedges of its rims.
struct Ring {
  Array<Index> quads;
  std::array<Array<Index>, 2> rim;
};

// All closed rings, and for every side of a quad the ring whose rim it is on, or none.
class Rings {
 public:
  explicit Rings(const HalfedgeMesh& mesh, const Array<Quad>& quads);

  const Array<Ring>& all() const { return rings_; }
  // The ring and its rim across a whole rim; none where other faces, or several rings, are there.
  std::optional<std::pair<Index, int>> across(Index ring, int rim) const;
  // The quad across a halfedge; none where another face is there.
  Index quad_across(Index halfedge) const;

 private:
  void add_ring(Index quad, int side);
  bool is_whole(const Ring& ring) const;

  const HalfedgeMesh& mesh_;
  const Array<Quad>& quads_;
  SideOf side_of_;
  Array<char> is_visited_;     // 2 * quad + direction: sides 0 and 2, or 1 and 3, are crossed
  PerHalfedge<Index> rim_of_;  // 2 * ring + rim, or none
  Array<Ring> rings_;
};

Rings::Rings(const HalfedgeMesh& mesh, const Array<Quad>& quads)
    : mesh_(mesh),
      quads_(quads),
      side_of_(mesh.halfedge_count(), none),
      is_visited_(2 * quads.size(), 0),
      rim_of_(mesh.halfedge_count(), none) {
  const Index count = static_cast<Index>(quads.size());
  for (Index q = 0; q < count; ++q) {
    for (int s = 0; s < 4; ++s) side_of_[element(quads[q].side, s)] = 4 * q + s;
  }
  for (Index q = 0; q < count; ++q) {
    for (const int s : {0, 1}) add_ring(q, s);
  }
}

void Rings::add_ring(Index quad, int side) {
  Ring ring;
  for (Index at = 4 * quad + side; at != none;) {
    const Index q = at / 4;
    const int s = at % 4;
    if (is_visited_[2 * q + s % 2]) return;  // of an open row
    is_visited_[2 * q + s % 2] = 1;
    ring.quads.push_back(q);
    ring.rim[0].push_back(element(quads_[q].side, (s + 1) % 4));
    ring.rim[1].push_back(element(quads_[q].side, (s + 3) % 4));
    const Index beyond = mesh_.twin[element(quads_[q].side, (s + 2) % 4)];
    at = beyond == none ? none : side_of_[beyond];
    if (at != 4 * quad + side) continue;
    if (!is_whole(ring)) return;
    const Index number = static_cast<Index>(rings_.size());
    for (const int rim : {0, 1}) {
      for (const Index h : element(ring.rim, rim)) rim_of_[h] = 2 * number + rim;
    }
    rings_.push_back(std::move(ring));
    return;
  }
}

// Whether it crosses no quad twice, and its rims are rings.
bool Rings::is_whole(const Ring& ring) const {
  const auto are_distinct = [](Array<Index> some) {
    const std::size_t count = some.size();
    sort_unique(some);
    return some.size() == count;
  };
  Array<Index> ends[2];
  for (const int rim : {0, 1}) {
    for (const Index h : element(ring.rim, rim)) ends[rim].push_back(mesh_.origin(h));
  }
  return are_distinct(ring.quads) && are_distinct(ends[0]) && are_distinct(ends[1]);
}

std::optional<std::pair<Index, int>> Rings::across(Index ring, int rim) const {
  Index found = none;
  for (const Index h : element(rings_[ring].rim, rim)) {
    const Index beyond = mesh_.twin[h];
    const Index there = beyond == none ? none : rim_of_[beyond];
    if (there == none || (found != none && there != found)) return std::nullopt;
    found = there;
  }
  if (rings_[found / 2].quads.size() != rings_[ring].quads.size()) return std::nullopt;
  return std::pair(found / 2, static_cast<int>(found % 2));
}

Index Rings::quad_across(Index halfedge) const {
  const Index beyond = mesh_.twin[halfedge];
  const Index at = beyond == none ? none : side_of_[beyond];
  return at == none ? none : at / 4;
}

// girths: the least and the largest.
bool are_even(const std::array<double, 2>& girths) { return girths[1] <= most_even * girths[0]; }

// A stack of rings and the halfedges of its ends.
struct Tube {
  Array<Index> rings, quads;
  std::array<Array<Index>, 2> end;
  double area = 0;
  std::array<double, 2> girth;  // the least and the largest
  bool is_closed = false;       // on itself, as a torus: it has no ends

  double unevenness() const { return girth[1] / girth[0]; }
};

class TubeSearch {
 public:
  explicit TubeSearch(const MetricMesh& surface)
      : surface_(surface), quads_(find_quads(surface)), rings_(surface.mesh, quads_) {}

  const Array<Quad>& quads() const { return quads_; }
  // Tubes that share no quad: those that are closed on themselves, the most even first, then the others, the largest
  // first. Closed ones are tubes only if they are even and strips as well as placed cones leave other maps: what goes
  // around a hole is no rope.
  Array<Tube> find() const;
  // Whether it is a rectangle nearly without stretch.
  bool is_strip(const Tube& tube) const { return stretch_as_rectangle(tube) <= Tubes::most_l2; }

 private:
  // The L2 stretch of a rectangle whose rows and columns are as wide as those of a tube in the mean. In a bend of
  // constant radius R a round tube of radius r has (1 + 3/2 (r / R)^2)^(1/4).
  double stretch_as_rectangle(const Tube& tube) const;
  double area_of(const Ring& ring) const;
  double girth(const Ring& ring, int rim) const;
  bool is_steep(const Ring& ring) const;

  const MetricMesh surface_;
  const Array<Quad> quads_;
  const Rings rings_;
};

double TubeSearch::area_of(const Ring& ring) const {
  double out = 0;
  for (const Index q : ring.quads) {
    out += surface_.geometry.area[quads_[q].side[0] / 3] + surface_.geometry.area[quads_[q].side[2] / 3];
  }
  return out;
}

double TubeSearch::girth(const Ring& ring, int rim) const {
  double out = 0;
  for (const Index h : element(ring.rim, rim)) out += surface_.geometry.length[h];
  return out;
}

// The girth of a cone grows by 2 pi times the sine of half its angle for each unit along its side.
bool TubeSearch::is_steep(const Ring& ring) const {
  const double one = girth(ring, 0), other = girth(ring, 1);
  const double height = 2 * area_of(ring) / (one + other);
  return std::abs(one - other) > steepest * 2 * M_PI * height;
}

double TubeSearch::stretch_as_rectangle(const Tube& tube) const {
  Array<char> is_own(quads_.size(), 0);
  for (const Index q : tube.quads) is_own[q] = 1;
  struct Extent {
    Index quad, ring;
    double area, along, across;
  };
  Array<Extent> extents;
  UnionFind rows(static_cast<Index>(quads_.size()));
  for (const Index r : tube.rings) {
    const Ring& ring = rings_.all()[r];
    for (Index k = 0; k < ssize(ring.quads); ++k) {
      const Index q = ring.quads[k];
      const double area = surface_.geometry.area[quads_[q].side[0] / 3] + surface_.geometry.area[quads_[q].side[2] / 3];
      double across = 0;
      for (const int rim : {0, 1}) {
        const Index h = element(ring.rim, rim)[k], beyond = rings_.quad_across(h);
        across += surface_.geometry.length[h] / 2;
        if (beyond != none && is_own[beyond]) rows.unite(q, beyond);
      }
      extents.push_back({q, r, area, area / across, across});
    }
  }
  struct Sum {
    double value = 0;
    Index count = 0;
    double mean() const { return value / count; }
    void add(double each) { value += each, ++count; }
  };
  Array<Sum> along(rings_.all().size()), across(quads_.size());
  for (const Extent& each : extents) {
    along[each.ring].add(each.along);
    across[rows.find(each.quad)].add(each.across);
  }
  double of_along = 0, of_across = 0, image = 0;
  for (const Extent& each : extents) {
    const double length = along[each.ring].mean(), width = across[rows.find(each.quad)].mean();
    of_along += each.area * std::pow(each.along / length, 2);
    of_across += each.area * std::pow(each.across / width, 2);
    image += length * width;
  }
  return std::sqrt(std::sqrt(of_along * of_across) * image) / tube.area;
}

Array<Tube> TubeSearch::find() const {
  const Array<Ring>& all = rings_.all();
  Array<char> is_used;
  for (const Ring& ring : all) is_used.push_back(is_steep(ring));
  Array<Tube> tubes;
  for (Index r = 0; r < static_cast<Index>(all.size()); ++r) {
    if (is_used[r]) continue;
    is_used[r] = 1;
    Tube tube;
    Array<Index>& rings = tube.rings = {r};
    for (const int direction : {0, 1}) {
      Index ring = r;
      int rim = direction;
      while (const auto beyond = rings_.across(ring, rim)) {
        tube.is_closed |= *beyond == std::pair(r, 1 - direction);  // not where a rim is folded onto itself
        if (is_used[beyond->first]) break;
        ring = beyond->first;
        rim = 1 - beyond->second;
        is_used[ring] = 1;
        rings.push_back(ring);
      }
      element(tube.end, direction) = element(all[ring].rim, rim);
    }
    if (tube.is_closed) tube.end = {};
    tube.girth = {girth(all[r], 0), girth(all[r], 0)};
    for (const Index ring : rings) {
      for (const int rim : {0, 1}) {
        tube.girth[0] = std::min(tube.girth[0], girth(all[ring], rim));
        tube.girth[1] = std::max(tube.girth[1], girth(all[ring], rim));
      }
      tube.area += area_of(all[ring]);
      tube.quads.insert(tube.quads.end(), all[ring].quads.begin(), all[ring].quads.end());
    }
    if (tube.is_closed && !(are_even(tube.girth) && is_strip(tube))) continue;
    tubes.push_back(std::move(tube));
  }
  // A torus is a tube both ways.
  const auto rank = [](const Tube& tube) {
    return std::pair(!tube.is_closed, tube.is_closed ? tube.unevenness() : -tube.area);
  };
  std::stable_sort(tubes.begin(), tubes.end(), [&](const Tube& a, const Tube& b) { return rank(a) < rank(b); });
  Array<char> is_taken(quads_.size(), 0);
  Array<Tube> out;
  for (Tube& tube : tubes) {
    if (std::any_of(tube.quads.begin(), tube.quads.end(), [&](Index q) { return is_taken[q]; })) continue;
    for (const Index q : tube.quads) is_taken[q] = 1;
    out.push_back(std::move(tube));
  }
  return out;
}

// Whether the rest of the surface joins both ends of a tube that is long and a strip nearly without stretch.
bool is_handle(const HalfedgeMesh& mesh, const TubeSearch& search, const Tube& tube) {
  const Array<Quad>& quads = search.quads();
  const double mean = (tube.girth[0] + tube.girth[1]) / 2;
  if (mesh.genus == 0 || tube.is_closed || tube.area < least_handle * mean * mean) return false;
  if (!search.is_strip(tube)) return false;
  PerTriangle<char> is_in_tube(mesh.triangle_count(), 0);
  for (const Index q : tube.quads) {
    for (const int side : {0, 2}) is_in_tube[element(quads[q].side, side) / 3] = 1;
  }
  UnionFind rest(mesh.triangle_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index beyond = mesh.twin[h];
    if (beyond > h && !is_in_tube[h / 3] && !is_in_tube[beyond / 3]) rest.unite(h / 3, beyond / 3);
  }
  const auto around = [&](const Array<Index>& end) {
    Array<Index> out;
    for (const Index h : end) {
      const Index beyond = mesh.twin[h];
      if (beyond != none && !is_in_tube[beyond / 3]) out.push_back(rest.find(beyond / 3));
    }
    sort_unique(out);
    return out;
  };
  const Array<Index> one = around(tube.end[0]), other = around(tube.end[1]);
  return std::any_of(one.begin(), one.end(),
                     [&](Index part) { return std::binary_search(other.begin(), other.end(), part); });
}

}  // namespace

ComponentTubes find_component_tubes(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  ComponentTubes out{PerHalfedge<char>(mesh.halfedge_count(), 0), {}};
  if (girths_of_opened_tube(surface)) {
    for (Index f = 0; f < mesh.triangle_count(); ++f) out.triangles.push_back(f);
    return out;
  }
  const TubeSearch search(surface);
  const Array<Tube> tubes = search.find();
  double area = 0;
  for (const Tube& tube : tubes) area += tube.area;
  const bool consists_of_tubes = area >= least_share * surface.geometry.total_area;
  // Each handle takes as long as the mesh is large.
  if (!consists_of_tubes && mesh.triangle_count() >= least_large) return out;
  for (const Tube& tube : tubes) {
    if (!consists_of_tubes && !is_handle(mesh, search, tube)) continue;
    for (const Array<Index>& end : tube.end) {
      for (const Index h : end) {
        if (may_cut(mesh, h)) out.is_end[h] = out.is_end[mesh.twin[h]] = 1;
      }
    }
    for (const Index q : tube.quads) {
      for (const int side : {0, 2}) out.triangles.push_back(element(search.quads()[q].side, side) / 3);
    }
  }
  return out;
}

TubeShape tube_shape(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  const auto shape_of = [](const std::array<double, 2>& girths) {
    return are_even(girths) ? TubeShape::even : TubeShape::tapering;
  };
  if (const auto girths = girths_of_opened_tube(surface)) return shape_of(*girths);
  if (!mesh.is_ring() && !mesh.is_torus()) return TubeShape::none;
  const TubeSearch search(surface);
  const Array<Tube> tubes = search.find();
  if (tubes.empty() || 2 * ssize(tubes.front().quads) != mesh.triangle_count()) return TubeShape::none;
  return shape_of(tubes.front().girth);
}

}  // namespace lsgp

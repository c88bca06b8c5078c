// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/thinned_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "base/union_find.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

constexpr int most_neighbors = 16;           // triangles at a vertex that is removed
constexpr double share_of_pass = 0.5;        // of the vertices that are left, those that a pass may remove
constexpr double flat_weight = 0.05;         // of a ring's area beside that of its bending
constexpr double least_shape = 0.01;         // area of a triangle relative to its squared sides; 0.144 is the best
constexpr double least_flat_area = 1e-4;     // doubled, relative to the squared size of the ring
constexpr double least_cosine = 0.2;         // between the normals of a triangle and of the ring
constexpr double operations_a_refill = 1e3;  // about
constexpr double operations_a_ring = 100;
constexpr double bytes_a_corner = 40;

using Point = Eigen::Vector2d;

double doubled_flat_area(const Point& a, const Point& b, const Point& c) { return cross_product(b - a, c - a); }

class Thinning {
 public:
  Thinning(const Surface& surface, const PerHalfedge<Index>& twin)
      : positions_(surface.positions),
        triangles_(surface.triangles),
        twin_(twin),
        outgoing_(surface.positions.rows(), none),
        fixed_(surface.positions.rows(), 0),
        touched_in_(surface.positions.rows(), 0),
        place_(surface.positions.rows()),
        first_point_(surface.triangles.rows(), none),
        next_point_(surface.positions.rows(), none),
        live_(surface.triangles.rows(), 1) {
    PerVertex<Index> corners(surface.positions.rows(), 0);
    for (Index h = 0; h < ssize(twin_); ++h) {
      outgoing_[origin(h)] = h;
      ++corners[origin(h)];
    }
    for (const VertexPairs* edges : {&surface.seams, &surface.borders, &surface.features}) {
      for (Eigen::Index i = 0; i < edges->size(); ++i) fixed_[edges->data()[i]] = 1;
    }
    for (Index v = 0; v < ssize(outgoing_); ++v) {
      if (outgoing_[v] == none) continue;
      fixed_[v] |= static_cast<char>(corners[v] > most_corners || !is_ring(v, corners[v]));
      if (!fixed_[v]) left_.push_back(v);
    }
  }

  // In passes, each without two neighbors, and flat and small rings first.
  void remove(Index most) {
    Index count = static_cast<Index>(triangles_.rows());
    double share = share_of_pass;
    for (int pass = 1; count > most && !left_.empty(); ++pass) {
      Array<double> size(left_.size());
      for (std::size_t i = 0; i < left_.size(); ++i) size[i] = ring_size(left_[i]);
      checkpoint(operations_a_ring * static_cast<double>(left_.size()));
      Array<double> ordered = size;
      const auto last = static_cast<std::ptrdiff_t>(share * static_cast<double>(left_.size() - 1));
      std::nth_element(ordered.begin(), ordered.begin() + last, ordered.end());
      const double limit = ordered[last];
      Array<Index> stuck;
      for (std::size_t i = 0; i < left_.size(); ++i) {
        const Index v = left_[i];
        if (count > most && size[i] <= limit && touched_in_[v] != pass && remove_vertex(v, pass)) {
          count -= 2;
        } else {
          stuck.push_back(v);
        }
      }
      if (stuck.size() == left_.size() && share == 1) break;
      // What is left of the smaller ones cannot be removed.
      if (stuck.size() == left_.size()) share = 1;
      left_.swap(stuck);
    }
  }

  // source: the triangles as they were.
  ThinnedSurface read(const Triangles& source) const {
    ThinnedSurface out;
    PerTriangle<Index> row(live_.size(), none);
    Index count = 0;
    for (std::size_t f = 0; f < live_.size(); ++f) {
      if (live_[f]) row[f] = count++;
    }
    out.triangles.resize(count, 3);
    out.twin.resize(3 * count);
    // One that has lost no corner has never been in a ring.
    const auto is_left = [&](Index v) { return place_[v].triangle == none; };
    out.kept.assign(source.rows(), none);
    for (Index f = 0; f < source.rows(); ++f) {
      const Index* const corners = source.row(f).data();
      if (std::all_of(corners, corners + 3, is_left)) out.kept[f] = row[f];
    }
    out.place = place_;
    for (SurfacePlace& place : out.place) {
      if (place.triangle != none) place.triangle = row[place.triangle];
    }
    for (Index f = 0; f < ssize(live_); ++f) {
      if (row[f] == none) continue;
      for (Index c = 0; c < 3; ++c) {
        const Index h = 3 * f + c, twin = twin_[h], v = origin(h);
        out.triangles(row[f], c) = v;
        out.twin[3 * row[f] + c] = twin == none ? none : 3 * row[twin / 3] + twin % 3;
        SurfacePlace& place = out.place[v];
        if (place.triangle != none) continue;
        place.triangle = row[f];
        place.share[c] = 1;
      }
    }
    return out;
  }

 private:
  static constexpr Index most_corners = 4 * most_neighbors;

  Index origin(Index h) const { return triangles_.data()[h]; }
  Index target(Index h) const { return triangles_.data()[next(h)]; }
  Eigen::Vector3d position(Index v) const { return positions_.row(v).transpose(); }

  bool is_ring(Index v, Index corners) const {
    Index h = outgoing_[v];
    for (Index i = 0; i < corners; ++i) {
      h = twin_[prev(h)];
      if (h == none) return false;
      if (h == outgoing_[v]) return i == corners - 1;
    }
    return false;
  }

  double ring_size(Index v) const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double area = 0;
    Index h = outgoing_[v];
    const Eigen::Vector3d center = position(v);
    do {
      const Eigen::Vector3d of_triangle = (position(target(h)) - center).cross(position(origin(prev(h))) - center);
      normal += of_triangle;
      area += of_triangle.norm();
      h = twin_[prev(h)];
    } while (h != outgoing_[v]);
    return (1 + flat_weight) * area - normal.norm();
  }

  // A vertex that is not fixed has all its edges in its ring.
  bool may_join(Index a, Index b) const {
    if (fixed_[a]) std::swap(a, b);
    if (fixed_[a]) return false;
    Index h = outgoing_[a];
    do {
      if (target(h) == b) return false;
      h = twin_[prev(h)];
    } while (h != outgoing_[a]);
    return true;
  }

  // The neighbors of v, what is across the edges between them, its triangles, and all that in the plane, with v at 0.
  bool flatten(Index v) {
    ring_.clear();
    across_.clear();
    slots_.clear();
    Index h = outgoing_[v];
    do {
      if (ssize(ring_) == most_neighbors) return false;
      ring_.push_back(target(h));
      across_.push_back(twin_[next(h)]);
      slots_.push_back(h);
      h = twin_[prev(h)];
    } while (h != outgoing_[v]);
    const std::size_t degree = ring_.size();
    for (std::size_t i = 0; i < degree; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (ring_[i] == ring_[j]) return false;
      }
    }
    // The triangle on the other side of the three neighbors would be left with another on its back.
    if (degree < 3) return false;
    if (degree == 3 && across_[0] != none && origin(prev(across_[0])) == ring_[2]) return false;
    const Eigen::Vector3d center = position(v);
    spokes_.clear();
    for (const Index neighbor : ring_) spokes_.push_back(position(neighbor) - center);
    normal_.setZero();
    angle_.assign(1, 0.0);
    for (std::size_t i = 0; i < degree; ++i) {
      const Eigen::Vector3d& a = spokes_[i];
      const Eigen::Vector3d& b = spokes_[(i + 1) % degree];
      const Eigen::Vector3d of_triangle = a.cross(b);
      normal_ += of_triangle;
      angle_.push_back(angle_.back() + std::atan2(of_triangle.norm(), a.dot(b)));
    }
    const double turn = 2 * M_PI / angle_.back();
    if (!std::isfinite(turn) || !(normal_.norm() > 0)) return false;
    normal_.normalize();
    flat_.clear();
    size_ = 0;
    for (std::size_t i = 0; i < degree; ++i) {
      const double length = spokes_[i].norm();
      flat_.emplace_back(length * std::cos(turn * angle_[i]), length * std::sin(turn * angle_[i]));
      size_ = std::max(size_, length);
    }
    return true;
  }

  // The quality of a triangle between neighbors; 0 where it must not be.
  double shape(int a, int b, int c) const {
    if (!(doubled_flat_area(flat_[a], flat_[b], flat_[c]) > least_flat_area * size_ * size_)) return 0;
    const Eigen::Vector3d first = spokes_[b] - spokes_[a], second = spokes_[c] - spokes_[a];
    const Eigen::Vector3d across = first.cross(second);
    const double doubled = across.norm();
    if (!(across.dot(normal_) > least_cosine * doubled)) return 0;
    const double shape = doubled / 2 / (first.squaredNorm() + second.squaredNorm() + (second - first).squaredNorm());
    return shape > least_shape ? shape : 0;
  }

  bool contains_another(int a, int b, int c) const {
    return std::any_of(polygon_.begin(), polygon_.end(), [&](int other) {
      if (other == a || other == b || other == c) return false;
      const Point& p = flat_[other];
      return doubled_flat_area(flat_[a], flat_[b], p) >= 0 && doubled_flat_area(flat_[b], flat_[c], p) >= 0 &&
             doubled_flat_area(flat_[c], flat_[a], p) >= 0;
    });
  }

  // Cuts off the best corner of the ring, one after the other.
  bool triangulate() {
    polygon_.clear();
    filling_.clear();
    for (int i = 0; i < static_cast<int>(ring_.size()); ++i) polygon_.push_back(i);
    while (polygon_.size() > 3) {
      const std::size_t count = polygon_.size();
      double best = 0;
      std::size_t at = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const int a = polygon_[(i + count - 1) % count], b = polygon_[i], c = polygon_[(i + 1) % count];
        const double tried = shape(a, b, c);
        if (tried <= best || contains_another(a, b, c) || !may_join(ring_[a], ring_[c])) continue;
        best = tried;
        at = i;
      }
      if (best == 0) return false;
      filling_.push_back({polygon_[(at + count - 1) % count], polygon_[at], polygon_[(at + 1) % count]});
      polygon_.erase(polygon_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    filling_.push_back({polygon_[0], polygon_[1], polygon_[2]});
    return shape(polygon_[0], polygon_[1], polygon_[2]) > 0;
  }

  // The points in the triangles around v, v among them, and where they are in the plane.
  void take_points(Index v) {
    points_.assign(1, v);
    at_.assign(1, Point(0, 0));
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const Index f = slots_[i] / 3;
      const int center = static_cast<int>(slots_[i] % 3);
      const Point &a = flat_[i], &b = flat_[(i + 1) % flat_.size()];
      for (Index point = first_point_[f]; point != none; point = next_point_[point]) {
        const double* share = place_[point].share;
        points_.push_back(point);
        at_.push_back(share[(center + 1) % 3] * a + share[(center + 2) % 3] * b);
      }
      first_point_[f] = none;
    }
  }

  void put_points() {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      SurfacePlace best;
      double inside = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < filling_.size(); ++k) {
        const Point &a = flat_[filling_[k][0]], &b = flat_[filling_[k][1]], &c = flat_[filling_[k][2]];
        const double whole = doubled_flat_area(a, b, c);
        const double share[3] = {doubled_flat_area(b, c, at_[i]) / whole, doubled_flat_area(c, a, at_[i]) / whole,
                                 doubled_flat_area(a, b, at_[i]) / whole};
        const double least = std::min({share[0], share[1], share[2]});
        if (!(least > inside)) continue;
        inside = least;
        best = {slots_[k] / 3, {share[0], share[1], share[2]}};
        if (least >= 0) break;
      }
      double sum = 0;
      // A little more than nothing, since only what has never been removed is at a corner.
      for (double& share : best.share) sum += share = std::max(share, 1e-12);
      for (double& share : best.share) share /= sum;
      place_[points_[i]] = best;
      next_point_[points_[i]] = first_point_[best.triangle];
      first_point_[best.triangle] = points_[i];
    }
  }

  void link(Index h, Index twin) {
    twin_[h] = twin;
    if (twin != none) twin_[twin] = h;
  }

  // Writes the new triangles to the places of the first ones around v.
  void fill() {
    const int degree = static_cast<int>(ring_.size());
    for (std::size_t k = 0; k < slots_.size(); ++k) {
      const Index f = slots_[k] / 3;
      live_[f] = k < filling_.size();
      if (!live_[f]) continue;
      for (int c = 0; c < 3; ++c) triangles_(f, c) = ring_[filling_[k][static_cast<std::size_t>(c)]];
    }
    for (std::size_t k = 0; k < filling_.size(); ++k) {
      for (int c = 0; c < 3; ++c) {
        const int from = filling_[k][static_cast<std::size_t>(c)];
        const int to = filling_[k][static_cast<std::size_t>((c + 1) % 3)];
        const Index h = 3 * (slots_[k] / 3) + c;
        outgoing_[ring_[from]] = h;
        if (to == (from + 1) % degree) {
          link(h, across_[from]);
          continue;
        }
        for (std::size_t other = 0; other < k; ++other) {
          for (int d = 0; d < 3; ++d) {
            const bool is_same = filling_[other][static_cast<std::size_t>(d)] == to &&
                                 filling_[other][static_cast<std::size_t>((d + 1) % 3)] == from;
            if (is_same) link(h, 3 * (slots_[other] / 3) + d);
          }
        }
      }
    }
  }

  bool remove_vertex(Index v, int pass) {
    checkpoint(operations_a_refill);
    if (!flatten(v) || !triangulate()) return false;
    take_points(v);
    fill();
    put_points();
    outgoing_[v] = none;
    for (const Index neighbor : ring_) touched_in_[neighbor] = pass;
    return true;
  }

  const Positions& positions_;
  Triangles triangles_;
  PerHalfedge<Index> twin_;
  PerVertex<Index> outgoing_;
  PerVertex<char> fixed_;
  PerVertex<int> touched_in_;  // pass
  PerVertex<SurfacePlace> place_;
  PerTriangle<Index> first_point_;
  PerVertex<Index> next_point_;  // in the same triangle
  PerTriangle<char> live_;
  Array<Index> left_;  // vertices that may be removed

  // About the vertex that is being removed. Neighbors by their place in the ring.
  Array<Index> ring_, across_, slots_;
  Array<Eigen::Vector3d> spokes_;
  Array<double> angle_;
  Array<Point> flat_;
  Eigen::Vector3d normal_;
  double size_ = 0;
  Array<int> polygon_;
  Array<std::array<int, 3>> filling_;
  Array<Index> points_;
  Array<Point> at_;
};

PerTriangle<Index> find_polygons(const Surface& surface, const EdgeTable& edges) {
  Array<char> is_cuttable(edges.count(), 0);
  for (Eigen::Index row = 0; row < surface.edges->rows(); ++row) {
    const Index edge = edges.find((*surface.edges)(row, 0), (*surface.edges)(row, 1));
    if (edge != none) is_cuttable[edge] = 1;
  }
  UnionFind polygons(static_cast<Index>(surface.triangles.rows()));
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (is_cuttable[edge]) continue;
    for (Index i = 1; i < edges.halfedge_count(edge); ++i) {
      polygons.unite(edges.halfedge(edge, 0) / 3, edges.halfedge(edge, i) / 3);
    }
  }
  PerTriangle<Index> first(surface.triangles.rows());
  for (Index f = 0; f < ssize(first); ++f) first[f] = polygons.find(f);
  return first;
}

}  // namespace

VerticesLeft vertices_left(const ThinnedSurface& thinned) {
  VerticesLeft out{PerVertex<Index>(thinned.place.size(), none), {}};
  for (const Index v : thinned.triangles.reshaped()) out.number[v] = 0;
  for (Index v = 0; v < ssize(out.number); ++v) {
    if (out.number[v] == none) continue;
    out.number[v] = static_cast<Index>(out.vertex.size());
    out.vertex.push_back(v);
  }
  return out;
}

Index triangle_left(const Triangles& whole, const ThinnedSurface& thinned, Index f) {
  const Index* const corners = whole.row(f).data();
  const auto is_gone = [&](Index v) { return thinned.place[v].corner() == none; };
  const Index* const gone = std::find_if(corners, corners + 3, is_gone);
  return gone == corners + 3 ? thinned.kept[f] : thinned.place[*gone].triangle;
}

ThinnedSurface thin(const Surface& surface, const EdgeTable& edges, const PerHalfedge<Index>& twin, Index triangles) {
  require_memory(bytes_a_corner * 3 * static_cast<double>(surface.triangles.rows()));
  Thinning thinning(surface, twin);
  thinning.remove(triangles);
  ThinnedSurface out = thinning.read(surface.triangles);
  if (surface.edges) out.polygon = find_polygons(surface, edges);
  return out;
}

PerHalfedge<Index> find_twins(const Surface& surface, const EdgeTable& edges) {
  PerHalfedge<Index> twin = other_sides(edges, 3 * static_cast<Index>(surface.triangles.rows()));
  const Index* tail = surface.triangles.data();
  for (Index h = 0; h < ssize(twin); ++h) {
    if (twin[h] == none || tail[h] != tail[twin[h]]) continue;
    twin[twin[h]] = none;
    twin[h] = none;
  }
  return twin;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/coarse_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/memory.hpp"

namespace lsgp {

namespace {

// Doubled areas relative to the longest squared side.
constexpr double least_area = 1e-3;  // of triangles between the flips of a removal
constexpr double no_area = 1e-9;
// Sine of the angle by which an edge fails to be Delaunay before it is flipped; less is a tie.
constexpr double delaunay_tie = 1e-10;
constexpr double bytes_a_halfedge = 40;
constexpr int most_degree = 24;               // triangles at a vertex that is removed
constexpr double operations_a_removal = 500;  // about
constexpr std::int64_t flips_an_edge = 20;    // that keep it Delaunay, at most, on average

}  // namespace

// By squared lengths. No triangle has a vertex twice.
class CoarseSurface::Triangulation {
 public:
  Triangulation(const MetricMesh& surface, const PerVertex<char>& kept)
      : halfedges_(surface.mesh.halfedge_count()),
        area_(surface.mesh.triangle_count()),
        outgoing_(surface.mesh.outgoing),
        touched_in_(surface.mesh.vertex_count(), 0),
        flips_left_(flips_an_edge * surface.mesh.halfedge_count()) {
    const HalfedgeMesh& mesh = surface.mesh;
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const double length = surface.geometry.length[h];
      halfedges_[h] = {mesh.origin(h), mesh.twin[h], length * length};
    }
    for (Index f = 0; f < mesh.triangle_count(); ++f) area_[f] = 2 * surface.geometry.area[f];
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (!kept[v] && mesh.loop_of_vertex[v] == none) left_.push_back(v);
    }
    for (Index h = 0; h < mesh.halfedge_count(); ++h) suspects_.push_back(h);
    restore_delaunay();
  }

  // In passes, each without two neighbors, which coarsens evenly and keeps degrees small.
  Array<Removal> remove(Index most) {
    Array<Removal> removals;
    Array<Index> stuck;
    for (int pass = 1; ssize(removals) < most && !left_.empty(); ++pass) {
      stuck.clear();
      for (const Index v : left_) {
        if (touched_in_[v] == pass || !remove(v, pass, removals)) stuck.push_back(v);
        checkpoint(operations_a_removal);
      }
      if (stuck.size() == left_.size()) break;
      left_.swap(stuck);
    }
    return removals;
  }

  // The triangles that are left.  node: of each vertex.
  void read(const PerVertex<Index>& node, HalfedgeMesh& mesh, Geometry& geometry) const {
    PerHalfedge<Index> place(halfedges_.size(), none);
    Index count = 0;
    for (Index h = 0; h < ssize(halfedges_); ++h) {
      if (origin(h) != none) place[h] = count++;
    }
    mesh.triangles.resize(count / 3, 3);
    mesh.twin.resize(count);
    geometry.half_cotangent.resize(count);
    for (Index h = 0; h < ssize(halfedges_); ++h) {
      if (place[h] == none) continue;
      mesh.triangles.data()[place[h]] = node[origin(h)];
      mesh.twin[place[h]] = twin(h) == none ? none : place[twin(h)];
      // A vertex that could not be removed may have been left on the line between two neighbors.
      const double least = no_area * (square(h) + square(next(h)) + square(prev(h)));
      geometry.half_cotangent[place[h]] = dot_opposite(h) / (2 * std::max(area_[h / 3], least));
    }
    for (std::size_t v = 0; v < node.size(); ++v) {
      if (node[v] != none) mesh.outgoing.push_back(place[outgoing_[v]]);
    }
  }

 private:
  struct Halfedge {
    Index origin;   // vertex, none in triangles that are gone
    Index twin;     // none on a boundary
    double square;  // of its length
  };
  // The result of a flip: the squared length of the new edge, and the doubled areas on the sides of the old one's
  // origin and target.
  struct Flipped {
    double square, at_origin, at_target;
    double shape_at_origin, shape_at_target;  // areas relative to the longest squared side
  };

  Index origin(Index h) const { return halfedges_[h].origin; }
  Index twin(Index h) const { return halfedges_[h].twin; }
  Index rotate(Index h) const { return twin(prev(h)); }
  double square(Index h) const { return halfedges_[h].square; }
  // The product of the sides at the corner opposite a halfedge, and at its origin.
  double dot_opposite(Index h) const { return (square(next(h)) + square(prev(h)) - square(h)) / 2; }
  double dot_at(Index h) const { return (square(h) + square(prev(h)) - square(next(h))) / 2; }

  Flipped flipped(Index h) const {
    const Index t = twin(h);
    // The apexes in units of the edge's length, which lies on the first axis from 0 to its square.
    const double left = dot_at(h), right = square(t) - dot_at(t), above = area_[h / 3], below = area_[t / 3];
    const double across = above + below, along = left - right;
    Flipped out;
    out.square = (along * along + across * across) / square(h);
    const double crossing = (left * below + right * above) / (square(h) * across);  // 0 at the origin, 1 at the target
    out.at_origin = crossing * across;
    out.at_target = (1 - crossing) * across;
    out.shape_at_origin = out.at_origin / std::max({out.square, square(prev(h)), square(next(t))});
    out.shape_at_target = out.at_target / std::max({out.square, square(next(h)), square(prev(t))});
    return out;
  }

  bool may_flip(Index h) const {
    const Index t = twin(h);
    return t != none && h / 3 != t / 3 && origin(prev(h)) != origin(prev(t));
  }

  // Moves a halfedge from a place that is no longer used to this one.
  void put(Index h, const Halfedge& from) {
    halfedges_[h] = from;
    if (from.twin != none) halfedges_[from.twin].twin = h;
    outgoing_[from.origin] = h;
    suspects_.push_back(h);
  }

  // Replaces the edge by the other diagonal of its two triangles.
  void flip(Index h, const Flipped& to) {
    const Index t = twin(h);
    const Halfedge into_origin = halfedges_[prev(h)], from_origin = halfedges_[next(t)];
    const Halfedge into_target = halfedges_[prev(t)], from_target = halfedges_[next(h)];
    put(next(h), into_origin);
    put(prev(h), from_origin);
    put(next(t), into_target);
    put(prev(t), from_target);
    put(h, {into_target.origin, t, to.square});
    put(t, {into_origin.origin, h, to.square});
    area_[h / 3] = std::max(to.at_origin, 0.0);
    area_[t / 3] = std::max(to.at_target, 0.0);
  }

  bool is_delaunay(Index h) const {
    const double left = dot_opposite(h), right = dot_opposite(twin(h));
    const double above = area_[h / 3], below = area_[twin(h) / 3];
    const double sine = left * below + right * above;  // of the sum of the angles opposite
    return sine >= -delaunay_tie * (std::abs(left * below) + std::abs(right * above) + std::abs(above * below));
  }

  void restore_delaunay() {
    while (!suspects_.empty()) {
      checkpoint(10);
      const Index h = suspects_.back();
      suspects_.pop_back();
      if (origin(h) == none || !may_flip(h) || flips_left_ <= 0 || is_delaunay(h)) continue;
      const Flipped to = flipped(h);
      if (!(std::min(to.shape_at_origin, to.shape_at_target) > no_area)) continue;
      flip(h, to);
      --flips_left_;
    }
  }

  // The edge at v to flip next to lower its degree: the one that leaves the best triangles; none if none can be
  // flipped.
  std::pair<Index, Flipped> best_flip(Index v) const {
    Index best = none, h = outgoing_[v];
    Flipped to{};
    double best_shape = least_area;
    bool is_tie = true;  // v comes to lie on the line between two neighbors; what is left at v is dissolved soon
    do {
      if (may_flip(h)) {
        const Flipped tried = flipped(h);
        const bool without = tried.shape_at_origin > least_area;
        const double shape = without ? std::min(tried.shape_at_origin, tried.shape_at_target) : tried.shape_at_target;
        const bool is_possible = without || (is_tie && tried.shape_at_origin > -no_area);
        if (is_possible && shape > least_area && (shape > best_shape || (without && is_tie))) {
          best = h;
          to = tried;
          best_shape = shape;
          is_tie = !without;
        }
      }
      h = rotate(h);
    } while (h != outgoing_[v]);
    return {best, to};
  }

  // Returns whether it was possible. Marks the neighbors as touched in this pass.
  bool remove(Index v, int pass, Array<Removal>& removals) {
    int degree = 0;
    Index h = outgoing_[v];
    do {
      h = rotate(h);
    } while (++degree <= most_degree && h != outgoing_[v]);
    if (degree > most_degree) return false;
    do {
      touched_in_[origin(next(h))] = pass;
      h = rotate(h);
    } while (h != outgoing_[v]);
    for (; degree > 3; --degree) {
      const auto [spoke, to] = best_flip(v);
      if (spoke == none) break;
      flip(spoke, to);
    }
    const bool is_gone = degree == 3 && merge_triangles(v, removals);
    restore_delaunay();
    return is_gone;
  }

  // Replaces the three triangles around v by one.
  bool merge_triangles(Index v, Array<Removal>& removals) {
    const Index first = outgoing_[v], second = rotate(first), third = rotate(second);
    const Halfedge side[3] = {halfedges_[next(first)], halfedges_[next(second)], halfedges_[next(third)]};
    if (side[0].origin == side[1].origin || side[1].origin == side[2].origin || side[2].origin == side[0].origin) {
      return false;
    }
    const double dot = (side[0].square + side[2].square - side[1].square) / 2;
    const double area = std::sqrt(std::max(side[0].square * side[2].square - dot * dot, 0.0));
    if (!(area > least_area * std::max({side[0].square, side[1].square, side[2].square}))) return false;
    const double opposite[3] = {area_[second / 3], area_[third / 3], area_[first / 3]};
    const double whole = opposite[0] + opposite[1] + opposite[2];
    removals.push_back({v,
                        {side[0].origin, side[1].origin, side[2].origin},
                        {opposite[0] / whole, opposite[1] / whole, opposite[2] / whole}});
    put(next(first), side[0]);
    put(prev(first), side[1]);
    put(first, side[2]);
    area_[first / 3] = area;
    for (const Index gone : {second, third}) {
      for (const Index h : {gone, next(gone), prev(gone)}) halfedges_[h].origin = none;
    }
    return true;
  }

  PerHalfedge<Halfedge> halfedges_;
  PerTriangle<double> area_;  // doubled
  PerVertex<Index> outgoing_;
  PerVertex<int> touched_in_;  // pass
  Array<Index> left_;          // vertices that may be removed
  Array<Index> suspects_;      // halfedges that may not be Delaunay
  std::int64_t flips_left_;    // of those that only keep it Delaunay
};

CoarseSurface::CoarseSurface(const MetricMesh& surface, const PerVertex<char>& kept, Index nodes)
    : node_of_vertex_(surface.mesh.vertex_count(), 0) {
  require_memory(bytes_a_halfedge * surface.mesh.halfedge_count() +
                 static_cast<double>(sizeof(Removal)) * surface.mesh.vertex_count());
  Triangulation triangulation(surface, kept);
  removals_ = triangulation.remove(surface.mesh.vertex_count() - nodes);
  for (const Removal& removal : removals_) node_of_vertex_[removal.vertex] = none;
  for (Index& node : node_of_vertex_) {
    if (node != none) node = node_count_++;
  }
  triangulation.read(node_of_vertex_, mesh_, geometry_);
  mesh_.euler = surface.mesh.euler;
  geometry_.vertex_area = at_nodes(surface.geometry.vertex_area);
  geometry_.angle_defect = at_nodes(surface.geometry.angle_defect);
  geometry_.total_area = surface.geometry.total_area;
}

Eigen::VectorXd CoarseSurface::at_nodes(Eigen::VectorXd values) const {
  for (const Removal& removal : removals_) {
    for (int c = 0; c < 3; ++c) values[removal.corner[c]] += removal.share[c] * values[removal.vertex];
  }
  Eigen::VectorXd out(node_count_);
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    if (node_of_vertex_[v] != none) out[node_of_vertex_[v]] = values[v];
  }
  return out;
}

Eigen::VectorXd CoarseSurface::at_vertices(const Eigen::VectorXd& values) const {
  Eigen::VectorXd out(ssize(node_of_vertex_));
  for (Eigen::Index v = 0; v < out.size(); ++v) {
    if (node_of_vertex_[v] != none) out[v] = values[node_of_vertex_[v]];
  }
  for (auto removal = removals_.rbegin(); removal != removals_.rend(); ++removal) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += removal->share[c] * out[removal->corner[c]];
    out[removal->vertex] = sum;
  }
  return out;
}

BorderConditions CoarseSurface::at_nodes(const BorderConditions& border) const {
  BorderConditions out{PerVertex<char>(node_count_, 0), at_nodes(border.curvature), border.balanced};
  for (std::size_t v = 0; v < border.held.size(); ++v) {
    if (node_of_vertex_[v] != none) out.held[node_of_vertex_[v]] = border.held[v];
  }
  return out;
}

}  // namespace lsgp

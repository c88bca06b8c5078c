// SPDX-License-Identifier: GPL-3.0-or-later
#include "transitions/cone_triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/checkpoint.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

// Areas of triangles are compared relative to the square of their longest side.
constexpr double strictly_convex = 1e-12;
// A triangle at a vertex that is about to be removed may have no area: if the vertex lies on the line between two
// neighbors, the removal dissolves it.
constexpr double flat_area = 1e-9;
// Sine of the angle by which an edge fails to be Delaunay before it is flipped; less is a tie.
constexpr double sine_of_tie = 1e-10;
// Relative to its triangle's size, the gap between the first and the last triangle around a vertex without curvature.
constexpr double no_gap = 1e-6;
// Coefficients below this have cancelled: they are sums of products of numbers of modulus 1.
constexpr double cancelled = 1e-12;
constexpr double operations_a_translation = 10;  // of two motions
constexpr double operations_of_removal = 2000;   // of a vertex
constexpr double operations_of_check = 100;      // of an edge, about

double relative_area(Complex a, Complex b, Complex c) {
  return doubled_area(a, b, c) / std::max({std::norm(b - a), std::norm(c - b), std::norm(a - c)});
}

// Motions z -> turn * z + sum of coefficient * t, by number. Nearly all that occur are the identity, number 0.
class Motions {
 public:
  struct Motion {
    Complex turn;
    Array<std::pair<Index, Complex>> translations;  // ascending
  };
  static constexpr Index identity = 0;

  const Motion& operator[](Index id) const { return all_[id]; }

  Index add(Motion motion) {
    all_.push_back(std::move(motion));
    return static_cast<Index>(all_.size()) - 1;
  }

  Index compose(Index second, Index first) {
    if (second == identity) return first;
    if (first == identity) return second;
    const Motion &b = all_[second], &a = all_[first];
    checkpoint(operations_a_translation * static_cast<double>(a.translations.size() + b.translations.size()));
    Motion out{b.turn * a.turn, {}};
    out.translations.reserve(a.translations.size() + b.translations.size());
    auto i = a.translations.begin(), j = b.translations.begin();
    while (i != a.translations.end() || j != b.translations.end()) {
      const bool from_a = j == b.translations.end() || (i != a.translations.end() && i->first <= j->first);
      const bool from_b = i == a.translations.end() || (j != b.translations.end() && j->first <= i->first);
      const Index cut = from_a ? i->first : j->first;
      Complex coefficient = 0;
      if (from_a) coefficient += b.turn * (i++)->second;
      if (from_b) coefficient += (j++)->second;
      if (std::norm(coefficient) > cancelled * cancelled) out.translations.emplace_back(cut, coefficient);
    }
    if (out.translations.empty() && std::norm(out.turn - 1.0) <= cancelled * cancelled) return identity;
    return add(std::move(out));
  }

  Index invert(Index id) {
    if (id == identity) return identity;
    Motion out{std::conj(all_[id].turn), all_[id].translations};
    for (auto& [cut, coefficient] : out.translations) coefficient *= -out.turn;
    return add(std::move(out));
  }

 private:
  Array<Motion> all_{{1.0, {}}};
};

// A triangulation that can be flipped; every triangle has a chart of its own.
class IntrinsicTriangulation {
 public:
  IntrinsicTriangulation(const CutSurface& surface, const PerCut<Complex>& turn, const Array<Index>& cones,
                         const Eigen::VectorXcd& position)
      : halfedges_(surface.mesh.halfedge_count()),
        outgoing_(surface.mesh.outgoing),
        is_cone_(surface.mesh.vertex_count(), 0),
        touched_in_(surface.mesh.vertex_count(), 0),
        flips_left_(100 * std::int64_t{surface.mesh.halfedge_count()}) {
    const HalfedgeMesh& mesh = surface.mesh;
    const CutGraph& cut_graph = surface.cut_graph;
    const CutMesh& cut_mesh = surface.cut_mesh;
    for (const Index v : cones) is_cone_[v] = 1;
    PerCut<Index> to_right, to_left;  // motions
    for (std::size_t cut = 0; cut < turn.size(); ++cut) {
      to_right.push_back(motions_.add({turn[cut], {{static_cast<Index>(cut), 1.0}}}));
      to_left.push_back(motions_.invert(to_right.back()));
    }
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index cut = cut_graph.cut_of[h];
      halfedges_[h] = {mesh.origin(h), mesh.twin[h], Motions::identity, Motions::identity,
                       position[cut_mesh.copy_of_corner[h]]};
      if (cut != none) halfedges_[h].across = cut_graph.runs_forward[h] ? to_left[cut] : to_right[cut];
    }
    for (const Index v : cones) {
      const Index opened_by = sectors(mesh, cut_graph, cut_mesh, v).front().opened_by;
      Index h = opened_by == none ? mesh.outgoing[v] : opened_by, place = Motions::identity;
      for (const Index first = h;;) {
        halfedges_[h].place = place;
        h = mesh.rotate(h);
        if (h == first) break;
        place = motions_.compose(halfedges_[h].across, place);
      }
    }
    for (Index h = 0; h < mesh.halfedge_count(); ++h) suspects_.push_back(h);
  }

  // Removes all vertices but the cones; returns whether that was possible.
  bool remove_others() {
    restore_delaunay();
    Array<Index> left, stuck;
    for (Index v = 0; v < static_cast<Index>(is_cone_.size()); ++v) {
      if (!is_cone_[v]) left.push_back(v);
    }
    // No two neighbors in one pass, which coarsens evenly and keeps degrees small.
    for (int pass = 1; !left.empty(); ++pass) {
      stuck.clear();
      for (const Index v : left) {
        if (touched_in_[v] == pass || !remove(v, pass)) stuck.push_back(v);
        restore_delaunay();
        checkpoint(operations_of_removal);
      }
      if (stuck.size() == left.size()) return false;
      left.swap(stuck);
    }
    return true;
  }

  // None if a triangle has no area.
  std::optional<ConeTriangulation> read() const {
    ConeTriangulation out;
    for (Index h = 0; h < static_cast<Index>(halfedges_.size()); h += 3) {
      if (halfedges_[h].origin == none) continue;
      if (!(doubled_area(at(h), at(h + 1), at(h + 2)) > 0)) return std::nullopt;
      out.triangles.emplace_back();
      for (Index corner = 0; corner < 3; ++corner) {
        const Halfedge& from = halfedges_[h + corner];
        element(out.triangles.back(), corner) = {from.origin, motions_[from.place].turn,
                                                 motions_[from.place].translations};
      }
    }
    return out;
  }

 private:
  struct Halfedge {
    Index origin;  // vertex, none in triangles that are gone
    Index twin;
    Index across;  // motion: from the chart of the twin's triangle into this one's
    Index place;   // motion: from the first copy of the origin to its place in the chart; only of cones
    Complex at;    // the place
  };

  Complex at(Index h) const { return halfedges_[h].at; }
  Index origin(Index h) const { return halfedges_[h].origin; }
  Index twin(Index h) const { return halfedges_[h].twin; }
  Index rotate(Index h) const { return twin(prev(h)); }

  // Expresses the triangle of h's twin in the chart of h's.
  void join_charts(Index h) {
    const Index motion = halfedges_[h].across, inverse = halfedges_[twin(h)].across;
    if (motion == Motions::identity) return;
    const Index other = twin(h) - twin(h) % 3;
    const Complex turn = motions_[motion].turn;
    // By their common edge, so that charts fit together however often they are moved.
    const Complex from = 0.5 * (at(twin(h)) + at(next(twin(h)))), to = 0.5 * (at(h) + at(next(h)));
    for (Index k = other; k < other + 3; ++k) {
      halfedges_[k].across = motions_.compose(motion, halfedges_[k].across);
      halfedges_[k].at = to + turn * (at(k) - from);
      if (is_cone_[origin(k)]) halfedges_[k].place = motions_.compose(motion, halfedges_[k].place);
    }
    for (Index k = other; k < other + 3; ++k) {
      halfedges_[twin(k)].across = motions_.compose(halfedges_[twin(k)].across, inverse);
    }
  }

  // Where the apex of the triangle of h's twin lies in the chart of h's.
  Complex opposite_apex(Index h) const {
    const Index t = twin(h);
    const Complex from = 0.5 * (at(t) + at(next(t))), to = 0.5 * (at(h) + at(next(h)));
    return to + motions_[halfedges_[h].across].turn * (at(prev(t)) - from);
  }

  // Overwrites corners and edges of triangles by those of `sources`, which are no longer used.
  template <std::size_t Count>
  void move_halfedges(const std::array<Index, Count>& sources, const std::array<Index, Count>& targets) {
    std::array<Halfedge, Count> moved;
    for (std::size_t i = 0; i < Count; ++i) {
      moved[i] = halfedges_[sources[i]];
      const auto also = std::find(sources.begin(), sources.end(), moved[i].twin);
      if (also != sources.end()) moved[i].twin = element(targets, also - sources.begin());
    }
    for (std::size_t i = 0; i < Count; ++i) halfedges_[targets[i]] = moved[i];
    for (std::size_t i = 0; i < Count; ++i) {
      halfedges_[moved[i].twin].twin = targets[i];
      outgoing_[moved[i].origin] = targets[i];
      suspects_.push_back(targets[i]);
    }
  }

  // Replaces the edge by the other diagonal of its two triangles, which are not the same.
  void flip(Index h) {
    join_charts(h);
    const Index t = twin(h);
    const Halfedge from_left = halfedges_[prev(h)], from_right = halfedges_[prev(t)];
    move_halfedges<4>({prev(h), next(t), prev(t), next(h)}, {next(h), prev(h), next(t), prev(t)});
    halfedges_[h] = {from_right.origin, t, Motions::identity, from_right.place, from_right.at};
    halfedges_[t] = {from_left.origin, h, Motions::identity, from_left.place, from_left.at};
    outgoing_[origin(h)] = h;
    outgoing_[origin(t)] = t;
    suspects_.push_back(h);
  }

  bool same_triangle(Index h, Index k) const { return h / 3 == k / 3; }

  // The relative areas of the triangles that a flip would make: on the side of h's origin, and of its target.
  std::pair<double, double> areas_after_flip(Index h) const {
    const Complex left = at(prev(h)), right = opposite_apex(h);
    return {relative_area(right, left, at(h)), relative_area(left, right, at(next(h)))};
  }

  bool is_delaunay(Index h) const {
    const Index t = twin(h);
    const Complex left = std::conj(at(h) - at(prev(h))) * (at(next(h)) - at(prev(h)));
    const Complex right = std::conj(at(t) - at(prev(t))) * (at(next(t)) - at(prev(t)));
    const Complex both = left * right;  // its argument is the sum of the angles opposite the edge
    return std::imag(both) >= -sine_of_tie * (std::abs(std::real(both)) + std::abs(std::imag(both)));
  }

  void restore_delaunay() {
    while (!suspects_.empty()) {
      checkpoint(operations_of_check);
      const Index h = suspects_.back();
      suspects_.pop_back();
      if (origin(h) == none || same_triangle(h, twin(h)) || flips_left_ <= 0 || is_delaunay(h)) continue;
      const auto [here, there] = areas_after_flip(h);
      if (!(std::min(here, there) > strictly_convex)) continue;
      flip(h);
      --flips_left_;
    }
  }

  // The edge at v to flip next so that v has fewer, none if there is none: loops first, then what leaves the best
  // triangles.  degree receives the number of edges at v, a loop counted twice.
  Index best_flip(Index v, int& degree) const {
    Index best = none, best_tie = none, h = outgoing_[v];
    double best_area = strictly_convex, best_tie_area = strictly_convex;
    bool best_is_loop = false;
    degree = 0;
    do {
      ++degree;
      const Index spoke = h;
      h = rotate(h);
      if (same_triangle(spoke, twin(spoke))) continue;
      const bool is_loop = origin(twin(spoke)) == v;
      const int gained = (origin(prev(spoke)) == v) + (origin(prev(twin(spoke))) == v);
      if (gained >= (is_loop ? 2 : 1)) continue;
      const auto [inside, outside] = areas_after_flip(spoke);
      const double area = std::min(inside, outside);
      if (area > strictly_convex && (is_loop > best_is_loop || (is_loop == best_is_loop && area > best_area))) {
        best = spoke;
        best_area = area;
        best_is_loop = is_loop;
      } else if (!is_loop && inside >= -flat_area && outside > best_tie_area) {
        best_tie = spoke;
        best_tie_area = outside;
      }
    } while (h != outgoing_[v]);
    return best != none ? best : best_tie;
  }

  // Whether it was possible. Neighbors are marked as touched in this pass.
  bool remove(Index v, int pass) {
    Index h = outgoing_[v];
    do {
      touched_in_[origin(next(h))] = pass;
      h = rotate(h);
    } while (h != outgoing_[v]);
    for (int degree;;) {
      const Index spoke = best_flip(v, degree);
      checkpoint(operations_of_check * degree);
      if (degree == 3 && merge_triangles(v)) return true;
      if (degree <= 3 || spoke == none) return false;
      flip(spoke);
    }
  }

  // Replaces the three triangles around v by one.
  bool merge_triangles(Index v) {
    const Index first = outgoing_[v], second = rotate(first), third = rotate(second);
    for (const Index h : {first, second, third}) {
      if (origin(next(h)) == v) return false;
    }
    join_charts(prev(first));
    join_charts(first);
    const Complex gap = at(prev(second)) - at(next(third));
    const double area = relative_area(at(next(first)), at(next(second)), at(next(third)));
    // A cone that passes for a flat vertex leaves a gap.
    const bool closed = std::norm(gap) <= no_gap * no_gap * std::norm(at(next(third)) - at(next(first)));
    if (!closed || !(area > strictly_convex)) return false;
    move_halfedges<3>({next(first), next(second), next(third)}, {next(first), prev(first), first});
    for (const Index gone : {second, third}) {
      for (const Index h : {gone, next(gone), prev(gone)}) halfedges_[h].origin = none;
    }
    return true;
  }

  Motions motions_;
  PerHalfedge<Halfedge> halfedges_;
  PerVertex<Index> outgoing_;
  PerVertex<char> is_cone_;
  PerVertex<int> touched_in_;  // pass
  Array<Index> suspects_;      // halfedges that may not be Delaunay
  std::int64_t flips_left_;    // of those that only keep it Delaunay
};

}  // namespace

std::optional<ConeTriangulation> triangulate_cones(const CutSurface& surface, const PerCut<Complex>& turn,
                                                   const Array<Index>& cones, const Eigen::VectorXcd& position) {
  IntrinsicTriangulation triangulation(surface, turn, cones, position);
  if (!triangulation.remove_others()) return std::nullopt;
  return triangulation.read();
}

}  // namespace lsgp

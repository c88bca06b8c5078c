// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/carried_map.hpp"

#include <algorithm>

#include "base/memory.hpp"
#include "base/thread_team.hpp"

namespace lsgp {

namespace {

constexpr double same_position = 1e-7;  // of both sides of an edge without a cut, in the unit square
constexpr double bytes_a_corner = 24;
constexpr int most_steps = 128;  // triangles that are visited on the way from one to another

bool differ(Complex a, Complex b) { return std::abs(a - b) > same_position; }

}  // namespace

CarriedMap::CarriedMap(const Triangles& triangles, const ThinnedSurface& thinned, const RefinedSurface& refined,
                       const PerHalfedge<Complex>& position)
    : triangles_(triangles),
      thinned_(thinned),
      refined_(refined),
      position_(position),
      is_on_cut_(thinned.place.size(), 0),
      is_beside_cut_(refined.triangle_count(), 0),
      is_added_(thinned.place.size(), 0),
      around_(thinned.place.size(), none),
      of_vertex_(thinned.place.size()),
      home_(triangles.rows()) {
  require_memory(bytes_a_corner * static_cast<double>(triangles.size()));
  mark_cuts();
  place_vertices();
  for_each_at_once(static_cast<Index>(triangles.rows()),
                   [&](Index f) { home_[f] = find_home(thinned_.polygon.empty() ? f : thinned_.polygon[f]); });
}

void CarriedMap::place_vertices() {
  for_each_at_once(static_cast<Index>(around_.size()), [&](Index v) {
    if (thinned_.place[v].triangle == none) return;
    const SurfacePlace at = refined_.locate(thinned_.place[v]);
    around_[v] = at.triangle;
    of_vertex_[v] = inside(at);
  });
  // Those that were added are corners again.
  for (auto f = static_cast<Index>(thinned_.triangles.rows()); f < refined_.triangle_count(); ++f) {
    const Index v = refined_.corner_of(f, 0);
    if (refined_.is_replaced(f)) continue;
    is_added_[v] = 1;
    around_[v] = f;
    of_vertex_[v] = position_[3 * f];
  }
}

// The refined triangle where a corner is that is none there, since it is on one side of all cuts.
Index CarriedMap::find_home(Index f) const {
  const Index kept = thinned_.kept[f];
  if (kept != none) return refined_.locate({kept, {1.0 / 3, 1.0 / 3, 1.0 / 3}}).triangle;
  Index added = none, other = none;
  for (int c = 0; c < 3; ++c) {
    const Index v = triangles_(f, c);
    if (is_added_[v]) {
      added = v;
    } else if (thinned_.place[v].corner() == none) {
      return around_[v];
    } else {
      other = v;
    }
  }
  return around_added(added, other);
}

// A triangle at an added vertex, that with another corner if there is one.
Index CarriedMap::around_added(Index vertex, Index corner) const {
  for (auto f = static_cast<Index>(thinned_.triangles.rows()); corner != none && f < refined_.triangle_count(); ++f) {
    if (refined_.is_replaced(f) || refined_.corner_of(f, 0) != vertex) continue;
    if (refined_.corner_of(f, 1) == corner || refined_.corner_of(f, 2) == corner) return f;
  }
  return around_[vertex];
}

void CarriedMap::mark_cuts() {
  const auto origin = [&](Index h) { return refined_.triangle(h / 3)[static_cast<std::size_t>(h % 3)]; };
  for (Index h = 0; h < 3 * refined_.triangle_count(); ++h) {
    const Index twin = refined_.twin(h);
    if (refined_.is_replaced(h / 3) || twin < h) continue;
    if (!differ(position_[h], position_[next(twin)]) && !differ(position_[next(h)], position_[twin])) continue;
    is_on_cut_[origin(h)] = is_on_cut_[origin(twin)] = 1;
  }
  for (Index f = 0; f < refined_.triangle_count(); ++f) {
    const auto& corners = refined_.triangle(f);
    is_beside_cut_[f] = std::any_of(corners.begin(), corners.end(), [&](Index v) { return is_on_cut_[v] != 0; });
  }
}

Complex CarriedMap::inside(const SurfacePlace& place) const {
  const Index h = 3 * place.triangle;
  // Exactly, where it is a corner.
  if (place.corner() != none) return position_[h + place.corner()];
  return place.share[0] * position_[h] + place.share[1] * position_[h + 1] + place.share[2] * position_[h + 2];
}

// The vertex's position continued from a triangle to the one it is on, on the shortest way.
Complex CarriedMap::seen_from(Index home, Index vertex) const {
  struct Step {
    Index triangle, through;  // the halfedge of the step before
    int before;
  };
  Step steps[most_steps];
  steps[0] = {home, none, -1};
  int count = 1;
  for (int i = 0; i < count; ++i) {
    const Index f = steps[i].triangle;
    const auto& corners = refined_.triangle(f);
    const auto at = std::find(corners.begin(), corners.end(), vertex);
    if (f == around_[vertex] || at != corners.end()) {
      Complex z =
          at != corners.end() ? position_[3 * f + static_cast<Index>(at - corners.begin())] : of_vertex_[vertex];
      for (int k = i; k > 0; k = steps[k].before) {
        const Index h = steps[k].through, twin = refined_.twin(h);
        const Complex tail = position_[h], head = position_[next(h)];
        const Complex tail_across = position_[next(twin)], head_across = position_[twin];
        if (differ(tail, tail_across) || differ(head, head_across)) {
          z = tail + (head - tail) / (head_across - tail_across) * (z - tail_across);
        }
      }
      return z;
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index twin = refined_.twin(h);
      if (twin == none || count == most_steps) continue;
      const auto is_there = [&](const Step& step) { return step.triangle == twin / 3; };
      if (!std::any_of(steps, steps + count, is_there)) steps[count++] = {twin / 3, h, i};
    }
  }
  return of_vertex_[vertex];
}

CornerUv CarriedMap::corner_uv() const {
  CornerUv out(triangles_.size(), 2);
  for_each_at_once(static_cast<Index>(triangles_.rows()), [&](Index f) {
    const Index from = home_[f];
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index v = triangles_.data()[h];
      const bool is_near = around_[v] != from && (is_beside_cut_[from] || is_beside_cut_[around_[v]]);
      const Complex z = is_near ? seen_from(from, v) : of_vertex_[v];
      out(h, 0) = z.real();
      out(h, 1) = z.imag();
    }
  });
  return out;
}

VertexPairs CarriedMap::cuts(const CornerUv& uv, const PerHalfedge<Index>& twin) const {
  const auto at = [&](Index h) { return Complex(uv(h, 0), uv(h, 1)); };
  Array<Index> ends;
  for (Index h = 0; h < ssize(twin); ++h) {
    if (twin[h] < h || !is_beside_cut_[home_[h / 3]]) continue;
    if (!differ(at(h), at(next(twin[h]))) && !differ(at(next(h)), at(twin[h]))) continue;
    ends.push_back(triangles_.data()[h]);
    ends.push_back(triangles_.data()[next(h)]);
  }
  return Eigen::Map<const VertexPairs>(ends.data(), ssize(ends) / 2, 2);
}

Eigen::VectorXd CarriedMap::interpolated(const Eigen::VectorXd& values) const {
  Eigen::VectorXd out = values;
  for_each_at_once(static_cast<Index>(out.size()), [&](Index v) {
    const SurfacePlace& place = thinned_.place[v];
    if (place.triangle == none || place.corner() != none) return;
    out[v] = 0;
    for (int c = 0; c < 3; ++c) out[v] += place.share[c] * values[thinned_.triangles(place.triangle, c)];
  });
  return out;
}

}  // namespace lsgp

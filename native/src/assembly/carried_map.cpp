// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/carried_map.hpp"

#include <algorithm>
#include <optional>

#include "base/memory.hpp"
#include "base/thread_team.hpp"

namespace lsgp {

namespace {

constexpr double same_place = 1e-7;  // of both sides of an edge without a cut, in the unit square
constexpr double bytes_a_corner = 24;
constexpr int most_steps = 128;  // triangles that are visited on the way from one to another

bool differ(Complex a, Complex b) { return std::abs(a - b) > same_place; }

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

// A position beyond a halfedge as continued from this side of it.
Complex CarriedMap::across(Index h, Complex z) const {
  const Index twin = refined_.twin(h);
  const Complex tail = position_[h], head = position_[next(h)];
  const Complex tail_across = position_[next(twin)], head_across = position_[twin];
  if (!differ(tail, tail_across) && !differ(head, head_across)) return z;
  return tail + (head - tail) / (head_across - tail_across) * (z - tail_across);
}

// The same around a corner of the triangle, which may be a cone: on the side on which the angle is smaller.
Complex CarriedMap::seen_around(Index corner, Index home, Index vertex) const {
  const Complex middle = (position_[3 * home] + position_[3 * home + 1] + position_[3 * home + 2]) / 3.0;
  std::optional<Complex> nearest;
  double least_turn = 0;
  for (const bool is_left : {true, false}) {
    Index crossed[most_steps];
    int count = 0;
    double turn = 0;
    Complex toward = middle;
    for (Index f = home; count < most_steps;) {
      const auto& corners = refined_.triangle(f);
      const auto place_of = [&](Index v) {
        return static_cast<Index>(std::find(corners.begin(), corners.end(), v) - corners.begin());
      };
      const Index at = place_of(vertex), out = 3 * f + place_of(corner);
      const auto turn_to = [&](Complex z) {
        return std::abs(std::arg((z - position_[out]) / (toward - position_[out])));
      };
      if (f == around_[vertex] || at < 3) {
        Complex z = at < 3 ? position_[3 * f + at] : of_vertex_[vertex];
        if (vertex != corner) turn += turn_to(z);
        while (count > 0) z = across(crossed[--count], z);
        if (!nearest || turn < least_turn) {
          nearest = z;
          least_turn = turn;
        }
        break;
      }
      crossed[count++] = is_left ? prev(out) : out;
      const Index twin = refined_.twin(crossed[count - 1]);
      if (twin == none || twin / 3 == home) break;
      turn += turn_to(position_[is_left ? prev(out) : next(out)]);
      toward = position_[is_left ? next(twin) : twin];
      f = twin / 3;
    }
  }
  return nearest ? *nearest : seen_from(home, vertex);
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
        z = across(steps[k].through, z);
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
    const auto& corners = refined_.triangle(from);
    const Index* const own = triangles_.row(f).data();
    const Index* const pivot = std::find_first_of(own, own + 3, corners.begin(), corners.end());
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index v = triangles_.data()[h];
      const bool is_near = around_[v] != from && (is_beside_cut_[from] || is_beside_cut_[around_[v]]);
      const Complex z = !is_near ? of_vertex_[v] : pivot == own + 3 ? seen_from(from, v) : seen_around(*pivot, from, v);
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
    if (twin[h] < h) continue;
    const Index tail = triangles_.data()[h], head = triangles_.data()[next(h)];
    const Index near[] = {home_[h / 3], home_[twin[h] / 3], around_[tail], around_[head]};
    if (std::none_of(near, near + 4, [&](Index f) { return is_beside_cut_[f] != 0; })) continue;
    if (!differ(at(h), at(next(twin[h]))) && !differ(at(next(h)), at(twin[h]))) continue;
    ends.push_back(tail);
    ends.push_back(head);
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

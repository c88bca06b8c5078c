// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/boundary_polygon.hpp"

#include <algorithm>

#include "plane/aabb_tree.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

bool is_before(Complex a, Complex b) { return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag(); }

}  // namespace

BoundaryPolygon::BoundaryPolygon(const Eigen::VectorXcd& position, const PerHalfedge<Index>& twin) {
  const Index halfedge_count = static_cast<Index>(twin.size());
  PerTriangle<char> is_left_out(halfedge_count / 3);
  for (Index f = 0; f < halfedge_count / 3; ++f) is_left_out[f] = !position.segment<3>(3 * f).allFinite();
  const auto ends_at = [&](Index h) { return twin[h] == none || is_left_out[twin[h] / 3]; };
  PerHalfedge<char> traced(halfedge_count, 0);
  for (Index first = 0; first < halfedge_count; ++first) {
    if (traced[first] || is_left_out[first / 3] || !ends_at(first)) continue;
    trace_loop(twin, first, ends_at, [&](Index h) { return position[h]; }, traced);
  }
  loops_.push_back(edge_count());
}

bool BoundaryPolygon::touches_itself() const {
  Array<Box> boxes;
  for (Index e = 0; e < edge_count(); ++e) {
    const auto [left, right] = std::minmax({tail_[e].real(), head_[e].real()});
    const auto [bottom, top] = std::minmax({tail_[e].imag(), head_[e].imag()});
    boxes.push_back({left, right, bottom, top});
  }
  return AabbTree(boxes).any_meeting_pair([&](Index i, Index j) { return touch(i, j); });
}

// The number of times a point is covered is the winding number of the boundary. It changes by one across a loop, so it
// suffices to count beside the leftmost point of each.
bool BoundaryPolygon::encloses_itself() const {
  constexpr double most_tests = 2e7;
  if (static_cast<double>(loops_.size()) * edge_count() > most_tests) return true;
  for (std::size_t loop = 0; loop + 1 < loops_.size(); ++loop) {
    Index leftmost = loops_[loop];
    for (Index e = leftmost; e < loops_[loop + 1]; ++e) {
      if (is_before(tail_[e], tail_[leftmost])) leftmost = e;
    }
    const Index before = leftmost == loops_[loop] ? loops_[loop + 1] - 1 : leftmost - 1;
    const int turn = side(tail_[before], tail_[leftmost], head_[leftmost]);
    if (turn == 0 || covers_left_of(tail_[leftmost], static_cast<Index>(loop)) != (turn > 0 ? 0 : 1)) return true;
  }
  return false;
}

bool BoundaryPolygon::follows(Index i, Index j) const {
  return loop_[i] == loop_[j] && (j == i + 1 || (i == loops_[loop_[i] + 1] - 1 && j == loops_[loop_[i]]));
}

bool BoundaryPolygon::touch(Index i, Index j) const {
  if (follows(i, j)) return folds_back(i, j);
  if (follows(j, i)) return folds_back(j, i);
  const auto are_beside = [&](Index e, Index other) {
    const int of_tail = side(tail_[e], head_[e], tail_[other]), of_head = side(tail_[e], head_[e], head_[other]);
    return of_tail != 0 && of_tail == of_head;
  };
  return !are_beside(i, j) && !are_beside(j, i);
}

bool BoundaryPolygon::folds_back(Index i, Index j) const {
  const Complex along = head_[i] - tail_[i], on = head_[j] - tail_[j];
  return side(tail_[i], head_[i], head_[j]) == 0 && !(std::real(along * std::conj(on)) > 0);
}

int BoundaryPolygon::covers_left_of(Complex point, Index loop) const {
  int count = 0;
  for (Index e = 0; e < edge_count(); ++e) {
    if (loop_[e] == loop || (tail_[e].imag() <= point.imag()) == (head_[e].imag() <= point.imag())) continue;
    // To the left of the point, a falling edge starts a covered interval, a rising edge ends it.
    const bool falls = tail_[e].imag() > point.imag();
    const int beside = side(tail_[e], head_[e], point);
    if (falls ? beside > 0 : beside < 0) count += falls ? 1 : -1;
  }
  return count;
}

}  // namespace lsgp

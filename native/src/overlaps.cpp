// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "box_pairs.hpp"
#include "topology.hpp"

namespace lsgp {

namespace {

constexpr double explained_share = 1e-9;  // of a triangle's area that rounding of the map may put on another
constexpr double last_digit = std::numeric_limits<double>::epsilon();
constexpr double explained_digits = 64 * last_digit;  // of a coordinate

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

using Corners = std::array<Complex, 3>;  // counter-clockwise

// Where c lies beside the line from a to b: 1 left, -1 right, 0 where rounding leaves that open (Shewchuk 1997).
int side(Complex a, Complex b, Complex c) {
  const Complex along = b - a, to = c - a;
  const double left = along.real() * to.imag(), right = along.imag() * to.real();
  const double bound = 2 * last_digit * (std::abs(left) + std::abs(right));
  return left - right > bound ? 1 : left - right < -bound ? -1 : 0;
}

// Whether a line along a side of `a` has all of `b` on its far side.
bool is_parted_by_side(const Corners& a, const Corners& b) {
  for (int i = 0; i < 3; ++i) {
    const Complex from = a[i], to = a[(i + 1) % 3];
    if (side(from, to, b[0]) <= 0 && side(from, to, b[1]) <= 0 && side(from, to, b[2]) <= 0) return true;
  }
  return false;
}

// Cuts `b` down to what lies in `a`, side after side (Sutherland and Hodgman 1974); corners relative to one of them.
double shared_area(const Corners& a, const Corners& b) {
  constexpr int most = 6;
  std::array<Complex, most> polygon, cut;
  int count = 3;
  std::copy(b.begin(), b.end(), polygon.begin());
  for (int i = 0; i < 3 && count > 2; ++i) {
    const Complex from = a[i], along = a[(i + 1) % 3] - from;
    int kept = 0;
    for (int k = 0; k < count; ++k) {
      const Complex here = polygon[k], there = polygon[(k + 1) % count];
      const double height = cross(along, here - from), next_height = cross(along, there - from);
      if (height >= 0 && kept < most) cut[kept++] = here;
      if ((height > 0 && next_height < 0) || (height < 0 && next_height > 0)) {
        if (kept < most) cut[kept++] = here + (there - here) * (height / (height - next_height));
      }
    }
    polygon = cut;
    count = kept;
  }
  double doubled = 0;
  for (int k = 1; k + 1 < count; ++k) doubled += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
  return doubled / 2;
}

class Layout {
 public:
  explicit Layout(const Eigen::VectorXcd& position) {
    for (Index f = 0; f < static_cast<Index>(position.size() / 3); ++f) {
      Corners corners{position[3 * f], position[3 * f + 1], position[3 * f + 2]};
      const double area = cross(corners[1] - corners[0], corners[2] - corners[0]) / 2;
      if (!std::isfinite(area) || area == 0) continue;
      if (area < 0) std::swap(corners[1], corners[2]);
      triangle_.push_back(f);
      corners_.push_back(corners);
      area_.push_back(std::abs(area));
      const auto [left, right] = std::minmax({corners[0].real(), corners[1].real(), corners[2].real()});
      const auto [bottom, top] = std::minmax({corners[0].imag(), corners[1].imag(), corners[2].imag()});
      boxes_.push_back({left, right, bottom, top});
    }
  }

  std::vector<Overlap> find_overlaps() const {
    std::vector<Overlap> out;
    BoxTree(boxes_).for_each_meeting_pair([&](Index i, Index j) {
      const double area = overlap(i, j);
      if (area > 0) out.push_back({triangle_[i], triangle_[j], area});
    });
    std::sort(out.begin(), out.end(), [](const Overlap& a, const Overlap& b) {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    return out;
  }

 private:
  // 0 where it is none.
  double overlap(Index i, Index j) const {
    const Corners &a = corners_[i], &b = corners_[j];
    if (is_parted_by_side(a, b) || is_parted_by_side(b, a)) return 0;
    const Complex origin = a[0];
    const double area = shared_area({0.0, a[1] - origin, a[2] - origin}, {b[0] - origin, b[1] - origin, b[2] - origin});
    const Index smaller = area_[i] <= area_[j] ? i : j;
    const Corners& c = corners_[smaller];
    const double border = std::abs(c[1] - c[0]) + std::abs(c[2] - c[1]) + std::abs(c[0] - c[2]);
    const Box both = around(boxes_[i], boxes_[j]);
    const double farthest = std::max({-both.left, both.right, -both.bottom, both.top});
    return area > explained_share * area_[smaller] + explained_digits * farthest * border ? area : 0;
  }

  std::vector<Index> triangle_;
  std::vector<Corners> corners_;
  std::vector<double> area_;
  std::vector<Box> boxes_;
};

// The border of a layout: where it ends, the layout on its left.
class Border {
 public:
  Border(const Eigen::VectorXcd& position, const std::vector<Index>& twin) {
    const Index halfedge_count = static_cast<Index>(twin.size());
    std::vector<char> is_left_out(halfedge_count / 3);
    for (Index f = 0; f < halfedge_count / 3; ++f) is_left_out[f] = !position.segment<3>(3 * f).allFinite();
    const auto ends_at = [&](Index h) { return twin[h] == none || is_left_out[twin[h] / 3]; };
    std::vector<char> traced(halfedge_count, 0);
    for (Index first = 0; first < halfedge_count; ++first) {
      if (traced[first] || is_left_out[first / 3] || !ends_at(first)) continue;
      loops_.push_back(edge_count());
      for (Index h = first; !traced[h];) {
        traced[h] = 1;
        tail_.push_back(position[h]);
        head_.push_back(position[next(h)]);
        loop_.push_back(static_cast<Index>(loops_.size()) - 1);
        h = next(h);
        while (!ends_at(h)) h = next(twin[h]);
      }
    }
    loops_.push_back(edge_count());
  }

  bool touches_itself() const {
    std::vector<Box> boxes;
    for (Index e = 0; e < edge_count(); ++e) {
      const auto [left, right] = std::minmax({tail_[e].real(), head_[e].real()});
      const auto [bottom, top] = std::minmax({tail_[e].imag(), head_[e].imag()});
      boxes.push_back({left, right, bottom, top});
    }
    bool touches = false;
    BoxTree(boxes).for_each_meeting_pair([&](Index i, Index j) { touches = touches || touch(i, j); });
    return touches;
  }

  // Whether the layout lies on itself somewhere, its border being simple curves that do not touch.  How often a point
  // is covered is how often the border winds around it.  That changes by one across a loop, so it is enough to count
  // beside one point of each, its leftmost.
  bool encloses_itself() const {
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

 private:
  Index edge_count() const { return static_cast<Index>(tail_.size()); }

  static bool is_before(Complex a, Complex b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
  }

  bool follows(Index i, Index j) const {
    return loop_[i] == loop_[j] && (j == i + 1 || (i == loops_[loop_[i] + 1] - 1 && j == loops_[loop_[i]]));
  }

  // Whether two edges have a point in common, or may have one, but for the corner between an edge and the next.
  bool touch(Index i, Index j) const {
    if (follows(i, j)) return folds_back(i, j);
    if (follows(j, i)) return folds_back(j, i);
    const auto are_beside = [&](Index e, Index other) {
      const int of_tail = side(tail_[e], head_[e], tail_[other]), of_head = side(tail_[e], head_[e], head_[other]);
      return of_tail != 0 && of_tail == of_head;
    };
    return !are_beside(i, j) && !are_beside(j, i);
  }
  bool folds_back(Index i, Index j) const {
    const Complex along = head_[i] - tail_[i], on = head_[j] - tail_[j];
    return side(tail_[i], head_[i], head_[j]) == 0 && !(std::real(along * std::conj(on)) > 0);
  }

  // How often the layout covers what lies just left of the leftmost point of a loop.
  int covers_left_of(Complex point, Index loop) const {
    int count = 0;
    for (Index e = 0; e < edge_count(); ++e) {
      if (loop_[e] == loop || (tail_[e].imag() <= point.imag()) == (head_[e].imag() <= point.imag())) continue;
      // To the left of the point a falling edge begins what is covered, a rising one ends it.
      const bool falls = tail_[e].imag() > point.imag();
      const int beside = side(tail_[e], head_[e], point);
      if (falls ? beside > 0 : beside < 0) count += falls ? 1 : -1;
    }
    return count;
  }

  std::vector<Complex> tail_, head_;  // (edges) loop after loop
  std::vector<Index> loop_;           // (edges)
  std::vector<Index> loops_;          // the first edge of each, and the end
};

}  // namespace

std::vector<Overlap> find_overlaps(const Eigen::VectorXcd& position) { return Layout(position).find_overlaps(); }

bool has_overlap(const Eigen::VectorXcd& position, const std::vector<Index>& twin) {
  const Border border(position, twin);
  return border.touches_itself() || border.encloses_itself();
}

}  // namespace lsgp

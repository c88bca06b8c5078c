// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/checkpoint.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

bool is_before(Complex a, Complex b) { return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag(); }

bool is_before(const Array<Complex>& a, const Array<Complex>& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [](Complex one, Complex other) { return is_before(one, other); });
}

namespace {

struct Before {
  template <typename Points>
  bool operator()(const Points& a, const Points& b) const {
    return is_before(a, b);
  }
};

constexpr double operations_a_corner = 100;

// The sides of triangles from corner to corner, all of which are counter-clockwise; those that run against each other
// cancel.
class SideChain {
 public:
  explicit SideChain(Array<Complex> places) : places_(std::move(places)) {
    std::sort(places_.begin(), places_.end(), Before());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  }

  void add(Complex a, Complex b) { sides_.emplace_back(vertex(a), vertex(b)); }

  // What is left, as closed polygons.
  template <typename Take>
  void trace(Take take) {
    cancel();
    Array<Index> begin(places_.size() + 1, 0);
    for (const auto& [tail, head] : sides_) ++begin[tail + 1];
    for (std::size_t v = 0; v < places_.size(); ++v) begin[v + 1] += begin[v];
    Array<Index> next(begin.begin(), begin.end() - 1);
    // As many sides end at each vertex as begin there.
    for (std::size_t v = 0; v < places_.size(); ++v) {
      checkpoint(operations_a_corner);
      while (next[v] < begin[v + 1]) {
        Array<Complex> polygon;
        auto at = static_cast<Index>(v);
        do {
          polygon.push_back(places_[at]);
          at = sides_[next[at]++].second;
        } while (at != static_cast<Index>(v));
        take(polygon);
      }
    }
  }

 private:
  using Side = std::pair<Index, Index>;  // tail and head

  Index vertex(Complex place) const {
    return static_cast<Index>(std::lower_bound(places_.begin(), places_.end(), place, Before()) - places_.begin());
  }

  // Removes pairs that run against each other, and sorts the others by their tails.
  void cancel() {
    const auto along = [](const Side& side) { return std::minmax(side.first, side.second); };
    std::sort(sides_.begin(), sides_.end(),
              [&](const Side& a, const Side& b) { return along(a) != along(b) ? along(a) < along(b) : a < b; });
    Array<Side> left;
    for (std::size_t begin = 0, end; begin < sides_.size(); begin = end) {
      checkpoint(operations_a_corner);
      Index upward = 0;
      for (end = begin; end < sides_.size() && along(sides_[end]) == along(sides_[begin]); ++end)
        upward += sides_[end].first < sides_[end].second ? 1 : -1;
      const auto [low, high] = along(sides_[begin]);
      left.insert(left.end(), static_cast<std::size_t>(std::abs(upward)),
                  upward > 0 ? Side(low, high) : Side(high, low));
    }
    sides_ = std::move(left);
    std::sort(sides_.begin(), sides_.end());
  }

  Array<Complex> places_;
  Array<Side> sides_;
};

template <typename Point>
Box box_around(Point begin, Point end) {
  constexpr double most = std::numeric_limits<double>::infinity();
  Box out{most, -most, most, -most};
  for (; begin != end; ++begin) out = around(out, {begin->real(), begin->real(), begin->imag(), begin->imag()});
  return out;
}

// Marks the points between two that are kept which have to be kept, too.
void keep_far_points(const Array<Complex>& polygon, double tolerance, Array<char>& kept) {
  Array<std::pair<Index, Index>> open;
  for (Index begin = 0, end = 1; end <= ssize(polygon); ++end) {
    if (end < ssize(polygon) && !kept[end]) continue;
    open.emplace_back(begin, end);
    begin = end;
  }
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    double farthest = tolerance;
    Index split = -1;
    for (Index i = begin + 1; i < end; ++i) {
      const double distance = distance_to_segment(polygon[i], polygon[begin], polygon[end % ssize(polygon)]);
      if (distance <= farthest) continue;
      farthest = distance;
      split = i;
    }
    checkpoint(10.0 * (end - begin));
    if (split < 0) continue;
    kept[split] = 1;
    open.emplace_back(begin, split);
    open.emplace_back(split, end);
  }
}

}  // namespace

double distance_to_segment(Complex point, Complex a, Complex b) {
  const Complex along = b - a;
  const double squared = std::norm(along);
  const double share = squared > 0 ? std::clamp(std::real((point - a) * std::conj(along)) / squared, 0.0, 1.0) : 0.0;
  return std::abs(point - a - share * along);
}

Outline Outline::around_triangles(const Array<Complex>& corners) {
  SideChain chain(corners);
  Array<Array<Complex>> without_area;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    checkpoint(3 * operations_a_corner);
    const Complex a = corners[t], b = corners[t + 1], c = corners[t + 2];
    if (a == b || b == c || c == a) {
      // Its sides would cancel.
      const Complex other = a == b ? c : b;
      without_area.push_back(a == other ? Array<Complex>{a} : Array<Complex>{a, other});
      if (is_before(without_area.back().back(), a))
        std::reverse(without_area.back().begin(), without_area.back().end());
      continue;
    }
    const bool is_mirrored = doubled_area(a, b, c) < 0;
    chain.add(a, is_mirrored ? c : b);
    chain.add(b, is_mirrored ? a : c);
    chain.add(c, is_mirrored ? b : a);
  }
  Outline out;
  std::sort(without_area.begin(), without_area.end(), Before());
  for (const Array<Complex>& polygon : without_area) out.add_polygon(polygon);
  chain.trace([&](const Array<Complex>& polygon) { out.add_polygon(polygon); });
  return out;
}

void Outline::add_polygon(const Array<Complex>& polygon) {
  points_.insert(points_.end(), polygon.begin(), polygon.end());
  first_.push_back(static_cast<Index>(points_.size()));
}

Box Outline::box() const { return box_around(points_.begin(), points_.end()); }

// What triangles are around is on the left of their sides, so that holes run clockwise.
Array<Box> Outline::hole_boxes() const {
  Array<Box> out;
  for (std::size_t p = 0; p + 1 < first_.size(); ++p) {
    const auto begin = points_.begin() + first_[p], end = points_.begin() + first_[p + 1];
    double doubled = 0;
    for (auto point = begin; point != end; ++point)
      doubled += cross(*point - *begin, *(point + 1 == end ? begin : point + 1) - *begin);
    if (doubled < 0) out.push_back(box_around(begin, end));
  }
  return out;
}

Outline Outline::moved(Complex factor, Complex shift) const {
  Outline out(*this);
  for (Complex& z : out.points_) {
    z = Complex(z.real() * factor.real() - z.imag() * factor.imag(),
                z.real() * factor.imag() + z.imag() * factor.real()) +
        shift;
  }
  return out;
}

void Outline::append(const Outline& other) {
  const auto before = static_cast<Index>(points_.size());
  points_.insert(points_.end(), other.points_.begin(), other.points_.end());
  for (std::size_t p = 1; p < other.first_.size(); ++p) first_.push_back(before + other.first_[p]);
}

Outline Outline::simplified(double tolerance) const {
  Outline out;
  for (std::size_t p = 0; p + 1 < first_.size(); ++p) {
    const Array<Complex> polygon(points_.begin() + first_[p], points_.begin() + first_[p + 1]);
    Array<char> kept(polygon.size(), 0);
    kept[0] = 1;
    // That which is farthest from the first, so that both halves are open lines.
    const auto farthest = std::max_element(polygon.begin(), polygon.end(), [&](Complex a, Complex b) {
      return std::norm(a - polygon[0]) < std::norm(b - polygon[0]);
    });
    kept[farthest - polygon.begin()] = 1;
    keep_far_points(polygon, tolerance, kept);
    Array<Complex> left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      if (kept[i]) left.push_back(polygon[i]);
    }
    out.add_polygon(left);
  }
  return out;
}

}  // namespace lsgp

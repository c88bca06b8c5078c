// SPDX-License-Identifier: GPL-3.0-or-later
#include "ear_clipping.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"

namespace py = pybind11;

namespace {

// Polygons have the size of 1: these are lengths, areas or sines.
constexpr double rounding = 1e-14;
constexpr double nearly_touching = 1e-6;
constexpr double nearly_straight = 1e-4;

// As a fraction of an ear's height: otherwise all ears of round polygons with many corners would be close to corners.
constexpr double touching_share = 0.5;

// Penalties on the squared length of a diagonal, which is at most 8.
constexpr double needle_penalty = 16;
constexpr double taken_penalty = 64;

// The cost of an ear of which two corners coincide, above that of all others: without it no ear is left at such
// corners.
constexpr double flat_ear_cost = 128;

// In turn: no corner close to the diagonal, no corner inside, anything.
enum class Leniency { strict, allows_touching, allows_any };

// Limit on the corners and boxes of them tested, per corner of the polygon; beyond it ears are no longer tested.
// Those that do not cross themselves stay below, but for needles by the hundred thousand.
constexpr std::size_t most_looks = 1000;

// Between two checks whether the program is interrupted: some hundredths of a second.
constexpr std::size_t looks_between_signals = std::size_t{1} << 21;

using Corner = std::int32_t;

struct Point {
  double x, y;
};

double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
double squared_length(Point a) { return a.x * a.x + a.y * a.y; }

// The points in an ear: left of its sides but for rounding, and of its diagonal but for a margin.
class Ear {
 public:
  Ear(Point before, Point tip, Point after) : corners_{before, tip, after} {
    for (std::size_t k = 0; k < 3; ++k) sides_[k] = corners_[(k + 1) % 3] - corners_[k];
    area = cross(sides_[0], sides_[1]);
  }

  void set_margin(bool allows_touching) {
    const double diagonal = std::sqrt(squared_length(sides_[2]));
    const double height = area / std::max(diagonal, std::numeric_limits<double>::min());
    const double close = std::max(std::min(nearly_touching, touching_share * height), rounding);
    least_ = {-rounding, -rounding, -(allows_touching ? rounding : close) * diagonal};
  }

  // A point at the place of one of the ear's own touches it only: the two sides of a keyhole.
  bool contains(Point p) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(cross(sides_[k], p - corners_[k]) >= least_[k])) return false;
    }
    return std::none_of(corners_.begin(), corners_.end(), [&](Point own) { return own.x == p.x && own.y == p.y; });
  }

  // Whether no point of a box lies in it. Every step of the test above is monotonic in both coordinates, so that a
  // corner of the box says for all of it, rounding included.
  bool misses(Point low, Point high) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point leftmost{sides_[k].y > 0 ? low.x : high.x, sides_[k].x > 0 ? high.y : low.y};
      if (!(cross(sides_[k], leftmost - corners_[k]) >= least_[k])) return true;
    }
    return false;
  }

  double area;

 private:
  std::array<Point, 3> corners_, sides_;
  std::array<double, 3> least_{};
};

// The corners that are left, in boxes of boxes: halves of them by the longer side, so that clusters take no more looks
// than corners evenly spread.
class CornerTree {
 public:
  explicit CornerTree(const std::vector<Point>& points) : points_(points), leaf_(points.size()), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    build(0, order_.size(), none);
  }

  void remove(Corner corner) {
    std::size_t box = leaf_[static_cast<std::size_t>(corner)];
    Box& own = boxes_[box];
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(own.begin);
    *std::find(begin, begin + own.left, corner) = order_[own.begin + static_cast<std::size_t>(own.left) - 1];
    for (; box != none; box = boxes_[box].parent) --boxes_[box].left;
  }

  // looks: increased by the number of corners and boxes tested.
  bool any_in(const Ear& ear, std::size_t& looks) const {
    stack_.assign(1, 0);
    while (!stack_.empty()) {
      const std::size_t at = stack_.back();
      const Box& box = boxes_[at];
      stack_.pop_back();
      ++looks;
      if (box.left == 0 || ear.misses(box.low, box.high)) continue;
      if (box.second != none) {
        stack_.push_back(box.second);
        stack_.push_back(at + 1);
        continue;
      }
      looks += static_cast<std::size_t>(box.left);  // all, since their order depends on the standard library
      for (std::size_t i = box.begin; i < box.begin + static_cast<std::size_t>(box.left); ++i) {
        if (ear.contains(points_[static_cast<std::size_t>(order_[i])])) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t most_in_leaf = 8;

  // The first half of a box follows it; a leaf has no second one, and its corners from `begin` on in the order.
  struct Box {
    Point low, high;
    std::size_t parent, second, begin;
    std::int32_t left;  // corners
  };

  void build(std::size_t begin, std::size_t end, std::size_t parent) {
    const std::size_t own = boxes_.size();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point low{infinity, infinity}, high{-infinity, -infinity};
    for (std::size_t i = begin; i < end; ++i) {
      const Point p = points_[static_cast<std::size_t>(order_[i])];
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    boxes_.push_back({low, high, parent, none, begin, static_cast<std::int32_t>(end - begin)});
    if (end - begin <= most_in_leaf) {
      for (std::size_t i = begin; i < end; ++i) leaf_[static_cast<std::size_t>(order_[i])] = own;
      return;
    }
    const bool is_wide = high.x - low.x > high.y - low.y;
    const auto key = [&](Corner c) {
      const Point p = points_[static_cast<std::size_t>(c)];
      return std::pair(is_wide ? p.x : p.y, c);
    };
    const std::size_t middle = begin + (end - begin) / 2;
    const auto first = order_.begin();
    std::nth_element(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(middle),
                     first + static_cast<std::ptrdiff_t>(end), [&](Corner a, Corner b) { return key(a) < key(b); });
    build(begin, middle, own);
    boxes_[own].second = boxes_.size();
    build(middle, end, own);
  }

  const std::vector<Point>& points_;
  std::vector<Box> boxes_;
  std::vector<std::size_t> leaf_;
  std::vector<Corner> order_;
  mutable std::vector<std::size_t> stack_;
};

using IsTaken = std::function<bool(Corner, Corner)>;

// What is left of a polygon, and its ears by cost.
class Ring {
 public:
  Ring(const std::vector<Point>& points, const IsTaken& is_taken)
      : points_(points),
        is_taken_(is_taken),
        tree_(points),
        before_(points.size()),
        after_(points.size()),
        version_(points.size(), 0) {
    const auto n = static_cast<Corner>(points.size());
    for (Corner c = 0; c < n; ++c) {
      before_[at(c)] = c == 0 ? n - 1 : c - 1;
      after_[at(c)] = c == n - 1 ? 0 : c + 1;
    }
  }

  // In their order, from the lowest.
  std::vector<Corner> corners() const {
    std::vector<Corner> found{first_};
    for (Corner c = after_[at(first_)]; c != first_; c = after_[at(c)]) found.push_back(c);
    std::rotate(found.begin(), std::min_element(found.begin(), found.end()), found.end());
    return found;
  }

  // Anew, those put aside included.
  void find_ears() {
    for (const Corner c : corners()) {
      add(c);
      ++looks_;
    }
  }

  // -1 without any.
  Corner pop_cheapest() {
    while (!queue_.empty()) {
      const auto [cost, tip, version] = queue_.top();
      queue_.pop();
      if (version == version_[at(tip)]) return tip;
    }
    return -1;
  }

  std::array<Corner, 3> cut_off(Corner tip) {
    const Corner p = before_[at(tip)], q = after_[at(tip)];
    after_[at(p)] = q;
    before_[at(q)] = p;
    ++version_[at(tip)];
    first_ = q;
    tree_.remove(tip);
    add(p);
    add(q);
    return {p, tip, q};
  }

  // Whether another corner lies in the ear, or close to its diagonal unless that is allowed.
  bool is_occupied(Corner tip, bool allows_touching) {
    Ear ear(points_[at(before_[at(tip)])], points_[at(tip)], points_[at(after_[at(tip)])]);
    if (!(ear.area > rounding)) return false;
    ear.set_margin(allows_touching);
    return tree_.any_in(ear, looks_);
  }

  std::size_t looks() const { return looks_; }

 private:
  static std::size_t at(Corner c) { return static_cast<std::size_t>(c); }

  // Queues the ear at a corner, if there is one, by the squared length of its diagonal, the same to the last bit from
  // both sides of it, and penalties.
  void add(Corner tip) {
    const std::int32_t version = ++version_[at(tip)];
    const Corner p = before_[at(tip)], q = after_[at(tip)];
    const Point back = points_[at(tip)] - points_[at(p)], ahead = points_[at(q)] - points_[at(tip)];
    double cost = squared_length(points_[at(q)] - points_[at(p)]);
    const double behind = squared_length(back), before = squared_length(ahead), area = cross(back, ahead);
    if (std::min({cost, behind, before}) <= rounding * rounding) {
      queue_.emplace(flat_ear_cost, tip, version);
      return;
    }
    if (!(area > rounding)) return;
    if (area <= nearly_straight * std::sqrt(behind * before)) cost += needle_penalty;
    if (is_taken_ && is_taken_(p, q)) cost += taken_penalty;
    queue_.emplace(cost, tip, version);
  }

  const std::vector<Point>& points_;
  const IsTaken& is_taken_;
  CornerTree tree_;
  std::vector<Corner> before_, after_;
  std::vector<std::int32_t> version_;  // of an ear's cost; those of a lower one in the queue are out of date
  // The cost, the tip and the version, the least first.
  using Entry = std::tuple<double, Corner, std::int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  Corner first_ = 0;
  std::size_t looks_ = 0;
};

// Calls visit(a, b, c) with the corners of each triangle.
template <typename Visit>
void clip_ears_of_one(const std::vector<Point>& points, const IsTaken& is_taken, const Visit& visit) {
  const auto visit_fan = [&](const std::vector<Corner>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) visit(corners[0], corners[i - 1], corners[i]);
  };
  const auto is_finite = [](Point p) { return std::isfinite(p.x) && std::isfinite(p.y); };
  if (!std::all_of(points.begin(), points.end(), is_finite)) {
    std::vector<Corner> all(points.size());
    std::iota(all.begin(), all.end(), 0);
    visit_fan(all);
    return;
  }
  Ring ring(points, is_taken);
  ring.find_ears();
  Leniency strictest = Leniency::strict, leniency = Leniency::strict;
  std::size_t next_check = looks_between_signals;
  for (std::size_t made = 0; made + 2 < points.size();) {
    if (ring.looks() > next_check) {
      next_check = ring.looks() + looks_between_signals;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    if (strictest == Leniency::strict && ring.looks() > most_looks * points.size()) {
      strictest = leniency = Leniency::allows_any;
      ring.find_ears();
    }
    const Corner tip = ring.pop_cheapest();
    if (tip < 0) {
      if (leniency == Leniency::allows_any) {
        visit_fan(ring.corners());
        return;
      }
      leniency = leniency == Leniency::strict ? Leniency::allows_touching : Leniency::allows_any;
      ring.find_ears();
    } else if (leniency == Leniency::allows_any || !ring.is_occupied(tip, leniency == Leniency::allows_touching)) {
      const auto [a, b, c] = ring.cut_off(tip);
      visit(a, b, c);
      leniency = strictest;
      ++made;
    }
  }
}

// Triangles (k, n - 2, 3), local corners, of k counter-clockwise polygons (k, n, 2) of the size of 1, each by itself.
// is_taken: whether the diagonal between two corners is to be avoided; may be empty.
Places clip_ears(const Numbers& polygons, const IsTaken& is_taken) {
  const View<double, 3> place("polygons", polygons, {any_length, any_length, 2});
  const py::ssize_t count = place.length(), size = place.length(1);
  if (size < 3 || size > std::numeric_limits<Corner>::max()) {
    refuse("WRONG_SHAPE", "polygons have " + std::to_string(size) + " corners; pass at least 3.");
  }
  Places triangles({count, size - 2, py::ssize_t{3}});
  auto out = triangles.mutable_unchecked<3>();
  std::vector<Point> points(static_cast<std::size_t>(size));
  for (py::ssize_t k = 0; k < count; ++k) {
    for (py::ssize_t i = 0; i < size; ++i) points[static_cast<std::size_t>(i)] = {place(k, i, 0), place(k, i, 1)};
    py::ssize_t made = 0;
    clip_ears_of_one(points, is_taken, [&](Corner a, Corner b, Corner c) {
      out(k, made, 0) = a;
      out(k, made, 1) = b;
      out(k, made++, 2) = c;
    });
  }
  return triangles;
}

}  // namespace

void define_ear_clipping(py::module_& module) {
  using py::literals::operator""_a;
  module.def(
      "clip_ears",
      [](const Numbers& polygons, const std::optional<IsTaken>& is_taken) {
        return clip_ears(polygons, is_taken.value_or(nullptr));
      },
      "polygons"_a, "is_taken"_a);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/layout_search.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/text.hpp"
#include "lsgp/errors.hpp"
#include "packing/gaps.hpp"

namespace lsgp {

namespace {

// What of the area the first layout that is tried fills, and by how much its side grows until one is found.
constexpr double first_fill = 0.65, growth = 1.02, failed_growth = 1.12;
constexpr double room_to_grow = 1.7;
constexpr int most_growths = 16;
// Where so little of the area is filled, sides along the axes are given up for a layout whose side is so much shorter,
// as of strips along the diagonal. Unfolded boxes fill more.
constexpr double hardly_filled = 0.3, shorter_unaligned = 0.9;
// How long better orders are looked for at each effort, in about nanoseconds.
constexpr double work_of_search[]{5e6, 3e8, 1e10};
// By how much gaps are wider than asked for, so that rounding never makes them narrower, of the side.
constexpr double widened = 1e-9;
// Outlines are simplified by so much of the side, and by this divided by the root of the number of bodies.
constexpr double coarsest = 1e-4, coarsest_of_many = 1e-3;

}  // namespace

LayoutSearch::LayoutSearch(const Array<Body>& bodies, const PackingOptions& options, ProgressMonitor& monitor)
    : bodies_(bodies), options_(options), monitor_(monitor), has_area_(options.area.has_value()) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    has_obstacles_ |= bodies[b].keeps_place;
    has_own_scales_ |= options.fill && bodies[b].keeps_scale && !bodies[b].keeps_place;
    if (!bodies[b].keeps_place) free_.push_back(static_cast<Index>(b));
  }
  has_area_ |= options.fill || has_obstacles_ || options.tiles > 1;
  inside_ = options.area.value_or(UvRectangle{});
  const double snap = options.snap;
  const double margin = snap > 0 ? std::ceil(options.margin / snap) * snap : options.margin;
  if (has_area_) {
    inside_ = {inside_.left + margin, inside_.bottom + margin, inside_.right - margin, inside_.top - margin};
  } else {
    inside_ = {margin, margin, margin + 1, margin + 1};
  }
}

// Whether the side that bodies fill is found by placing them in a tile that is larger than they need.
bool LayoutSearch::grows() const { return !has_obstacles_ && options_.tiles == 1 && !sizes_depend_on_side(); }

// Whether some bodies have other sizes, in texels, at another side.
bool LayoutSearch::sizes_depend_on_side() const { return options_.fill && (has_own_scales_ || options_.snap > 0); }

// In the unit of bodies.
double LayoutSearch::gap(double side) const {
  const double scale = options_.fill ? side : 1.0;
  return 2 * options_.margin * scale + 2 * tolerance_ + widened * expected_side_;
}

double LayoutSearch::estimated_side() const {
  const double width = inside_.right - inside_.left, height = inside_.top - inside_.bottom;
  double area = 0, around = 0, longest = 0;
  for (const Index b : free_) {
    const Box box = bodies_[b].outline.box();
    area += bodies_[b].area;
    around += (box.right - box.left) + (box.top - box.bottom);
    longest = std::max({longest, box.right - box.left, box.top - box.bottom});
  }
  const double room = width * height * options_.tiles * first_fill;
  double side = std::max(std::sqrt(area / room), longest / std::max(width, height) / 2);
  for (int i = 0; i < 4; ++i) {
    const double gap = 2 * options_.margin * (options_.fill ? side : 1.0);
    side = std::max(side, std::sqrt((area + gap * around + gap * gap * static_cast<double>(free_.size())) / room));
  }
  return side;
}

LayoutSearch::Order LayoutSearch::by_size() const {
  Order out;
  out.pose.assign(bodies_.size(), -1);
  out.bodies = free_;
  if (free_.size() == 1) out.rule = PlaceRule::least_side;
  Array<double> size(bodies_.size(), 0);
  for (const Index b : free_) {
    const Box box = outline_[b].box();
    size[b] = (box.right - box.left) + (box.top - box.bottom);
  }
  std::stable_sort(out.bodies.begin(), out.bodies.end(), [&](Index a, Index b) { return size[a] > size[b]; });
  return out;
}

void LayoutSearch::rasterize(double side) {
  now_.texel = options_.snap > 0 ? options_.snap * (options_.fill ? side : 1.0) : expected_side_ / texels_;
  now_.rasterized_for = side;
  now_.poses.assign(bodies_.size(), {});
  for (const Index b : free_) {
    const double scale = options_.fill && bodies_[b].keeps_scale ? side : 1.0;
    now_.poses[b] = poses_of(outline_[b], turns_of(bodies_[b], directions_, also_along_axes_), scale / now_.texel);
  }
}

Array<TileSpace> LayoutSearch::tiles(double side) const {
  const double scale = options_.fill || grows() ? side : 1.0;
  const double width = (inside_.right - inside_.left) * scale - 2 * tolerance_;
  const double height = (inside_.top - inside_.bottom) * scale - 2 * tolerance_;
  Array<TileSpace> out(options_.tiles, {width / now_.texel, height / now_.texel, {}});
  for (const Body& body : bodies_) {
    if (!body.keeps_place) continue;
    const Complex low(inside_.left, inside_.bottom);
    const double texels = (options_.fill ? side : 1.0) / now_.texel;
    const Complex shift = (body.origin - low) * texels - Complex(tolerance_, tolerance_) / now_.texel;
    out[0].obstacles.push_back(body.outline.moved(texels, shift));
  }
  return out;
}

// room: of the tile, in which bodies are placed, if these may take less of it or more.
LayoutSearch::Attempt LayoutSearch::attempt(const Order& order, double side, double room) {
  if (now_.poses.empty() || (sizes_depend_on_side() && now_.rasterized_for != side)) rasterize(side);
  ConstructionOptions how;
  how.gap = gap(side) / now_.texel;
  how.on_texels = options_.snap > 0;
  how.rule = order.rule;
  constexpr std::size_t few = 128;
  how.skips_full_rows = free_.size() > few;
  Attempt out;
  out.found = construct(now_.poses, tiles(grows() ? room * side : side), order.bodies, order.pose, how, true);
  work_ += out.found.work;
  if (out.found.missing > 0) {
    out.side = side * failed_growth;
  } else if (grows()) {
    const double width = out.found.width * now_.texel + 2 * tolerance_,
                 height = out.found.height * now_.texel + 2 * tolerance_;
    out.side = std::max(width / (inside_.right - inside_.left), height / (inside_.top - inside_.bottom));
    out.is_valid = options_.fill ? out.side <= side : !has_area_ || out.side <= 1;
  } else {
    out.side = side;
    out.is_valid = true;
  }
  return out;
}

bool LayoutSearch::take_if_better(const Order& order, Attempt attempt) {
  if (!attempt.is_valid || (now_.side > 0 && attempt.side >= now_.side)) return false;
  now_.order = order;
  now_.found = std::move(attempt.found);
  now_.side = attempt.side;
  return true;
}

void LayoutSearch::find_first(const Order& order) {
  double side = options_.fill || grows() ? expected_side_ : 1.0;
  for (int i = 0; i < most_growths; ++i) {
    Attempt found = attempt(order, side, room_to_grow);
    const double needed = found.side;
    if (take_if_better(order, std::move(found))) return;
    if (!options_.fill && !(grows() && found.found.missing > 0)) break;
    side = std::max(needed, side) * growth;
  }
  refuse(order, side);
}

// The same order in a smaller square.
void LayoutSearch::tighten() {
  if (!options_.fill) return;
  if (grows()) {
    constexpr int most = 3;
    constexpr double gain = 0.998;
    for (int i = 0; i < most; ++i) {
      const double before = now_.side;
      if (!take_if_better(now_.order, attempt(now_.order, now_.side)) || now_.side > gain * before) return;
    }
    return;
  }
  constexpr double near = 1.004;
  double area = 0;
  for (const Index b : free_) area += bodies_[b].keeps_scale ? 0 : bodies_[b].area;
  double low = std::sqrt(area / ((inside_.right - inside_.left) * (inside_.top - inside_.bottom) * options_.tiles));
  while (now_.side > near * low) {
    const double middle = (now_.side + std::max(low, now_.side / 2)) / 2;
    if (!take_if_better(now_.order, attempt(now_.order, middle))) low = middle;
  }
}

// The same layout with finer texels.
void LayoutSearch::refine() {
  if (sizes_depend_on_side()) return;
  const State coarse = now_;
  texels_ *= 2;
  rasterize(now_.side);
  if (!take_if_better(now_.order, attempt(now_.order, now_.side))) {
    now_ = coarse;
    texels_ /= 2;
  }
}

// Another order: some bodies change places in it, are placed earlier or later, or in another pose.
LayoutSearch::Order LayoutSearch::varied(const Order& order) {
  Order out = order;
  const auto count = static_cast<int>(free_.size());
  for (int change = 1 + below(3); change > 0; --change) {
    const int one = below(count), other = below(count);
    const Index body = out.bodies[one];
    switch (below(4)) {
      case 0: std::swap(out.bodies[one], out.bodies[other]); break;
      case 1:
        out.bodies.erase(out.bodies.begin() + one);
        out.bodies.insert(out.bodies.begin() + other, body);
        break;
      case 2: out.pose[body] = below(static_cast<int>(now_.poses[body].size())); break;
      default: out.pose[body] = -1; break;
    }
  }
  constexpr int seldom = 16;
  if (below(seldom) == 0) out.rule = static_cast<PlaceRule>(below(place_rules));
  return out;
}

void LayoutSearch::vary_order(double work) {
  using Clock = std::chrono::steady_clock;
  if (free_.size() < 2) return;  // all of its poses have been tried
  const bool is_timed = options_.effort == PackingEffort::best && options_.seconds.has_value();
  const auto begin = Clock::now();
  const double work_before = work_;
  const auto done = [&] {
    if (!is_timed) return (work_ - work_before) / work;
    return std::chrono::duration<double>(Clock::now() - begin).count() / *options_.seconds;
  };
  constexpr double smaller = 0.995;
  for (double share = 0; share < 1; share = done()) {
    monitor_.advance(share);
    Order order = varied(now_.order);
    Attempt found = attempt(order, grows() ? now_.side : now_.side * smaller);
    for (const Index b : free_) order.pose[b] = found.found.placed[b].pose;
    if (found.is_valid && found.side <= now_.side) {
      now_.order = order;
      now_.side = found.side;
      now_.found = std::move(found.found);
    }
  }
}

Array<Motion> LayoutSearch::best() {
  const auto count = static_cast<double>(free_.size());
  expected_side_ = estimated_side();
  double farthest = 0;
  for (const Body& body : bodies_) farthest = std::max(farthest, std::abs(body.origin));
  constexpr double no_size = 1e-200, last_digit = std::numeric_limits<double>::epsilon();
  constexpr double texels_of_body = 24, least_texels = 128, most_texels = 1024;
  texels_ = static_cast<int>(std::clamp(texels_of_body * std::sqrt(count / options_.tiles), least_texels, most_texels));
  if (expected_side_ <= std::max(texels_ * last_digit * farthest, no_size)) {
    throw Error(
        Code::wrong_parameter,
        concat("The square that the islands fill is ", rounded(expected_side_ / std::max(farthest, expected_side_), 2),
               " of their distance from the origin, too small to place them in. Move them to the origin, or "
               "leave out those that are points."));
  }
  if (options_.snap > 0) require_enough_blocks();
  if (options_.snap == 0) tolerance_ = expected_side_ * std::min(coarsest, coarsest_of_many / std::sqrt(count));
  for (const Body& body : bodies_)
    outline_.push_back(body.keeps_scale ? body.outline : body.outline.simplified(tolerance_));
  constexpr double few = 8, some = 64;
  directions_ = count <= few ? 16 : count <= some ? 4 : 0;
  if (options_.effort == PackingEffort::quick) directions_ = count <= few ? 8 : 0;
  search();
  if (is_hardly_filled()) {
    const State aligned = std::move(now_);
    now_ = {};
    also_along_axes_ = true;
    search();
    if (now_.side > shorter_unaligned * aligned.side) now_ = aligned;
  }
  return motions();
}

// Throws WRONG_PARAMETER where blocks are so small that a raster of them would not fit into memory, or so large that
// the area has none.
void LayoutSearch::require_enough_blocks() const {
  constexpr double most_blocks = 1 << 13;
  const double scale = has_area_ ? 1.0 : expected_side_;
  const double width = (inside_.right - inside_.left) * scale, height = (inside_.top - inside_.bottom) * scale;
  if (std::min(width, height) >= options_.snap && std::max(width, height) <= most_blocks * options_.snap) return;
  throw Error(Code::wrong_parameter,
              concat("snap is ", rounded(options_.snap), ", and the area inside the margins is ", rounded(width),
                     " by ", rounded(height), "; pass the side of blocks of which it has one, and at most ",
                     most_blocks, " on a side."));
}

void LayoutSearch::search() {
  find_first(by_size());
  tighten();
  for (const Index b : free_) now_.order.pose[b] = now_.found.placed[b].pose;
  vary_order(work_of_search[static_cast<std::size_t>(options_.effort)]);
}

// Whether other turns of bodies that lie along the axes may be worth it, as of long strips.
bool LayoutSearch::is_hardly_filled() const {
  double area = 0;
  bool any_aligned = false;
  for (const Index b : free_) {
    area += bodies_[b].area;
    any_aligned |= bodies_[b].turns == IslandTurns::any && lies_along_axes(bodies_[b].outline);
  }
  const double whole = (inside_.right - inside_.left) * (inside_.top - inside_.bottom) * options_.tiles;
  return any_aligned && area < hardly_filled * whole * now_.side * now_.side;
}

Array<Motion> LayoutSearch::motions() {
  // The last attempt may have been at another side.
  if (sizes_depend_on_side() && now_.rasterized_for != now_.side) rasterize(now_.side);
  Array<Motion> out(bodies_.size());
  Array<Outline> moved;
  Box all{1e300, -1e300, 1e300, -1e300};
  for (const Index b : free_) {
    const Placed& placed = now_.found.placed[b];
    const Pose& pose = now_.poses[b][placed.pose];
    const double scale = options_.fill && bodies_[b].keeps_scale ? now_.side : 1.0;
    out[b] = {placed.tile, pose.turn * scale, (pose.shift + placed.at) * now_.texel + Complex(tolerance_, tolerance_)};
    moved.push_back(bodies_[b].outline.moved(out[b].factor, out[b].shift));
    all = around(all, moved.back().box());
  }
  double side = options_.fill ? now_.side : 1.0;
  Complex low = 0;
  if (grows() && options_.snap == 0) {
    low = {all.left, all.bottom};
    if (options_.fill)
      side = std::max((all.right - all.left) / (inside_.right - inside_.left),
                      (all.top - all.bottom) / (inside_.top - inside_.bottom));
  }
  for (const Index b : free_) {
    out[b].factor /= side;
    out[b].shift = (out[b].shift - low) / side + Complex(inside_.left, inside_.bottom);
  }
  return out;
}

void LayoutSearch::refuse(const Order& order, double side) {
  ConstructionOptions how;
  how.gap = gap(side) / now_.texel;
  how.on_texels = options_.snap > 0;
  const double scale = options_.fill ? side : 1.0;
  Array<TileSpace> spaces = tiles(side);
  for (TileSpace& space : spaces) {
    space.width = ((inside_.right - inside_.left) * scale - 2 * tolerance_) / now_.texel;
    space.height = ((inside_.top - inside_.bottom) * scale - 2 * tolerance_) / now_.texel;
  }
  const Constructed found = construct(now_.poses, spaces, order.bodies, order.pose, how, false);
  std::vector<Index> left_out;
  Index fitting = 0;
  for (const Index b : free_) {
    const auto& islands = bodies_[b].islands;
    if (found.placed[b].tile < 0)
      left_out.insert(left_out.end(), islands.begin(), islands.end());
    else
      fitting += static_cast<Index>(islands.size());
  }
  std::sort(left_out.begin(), left_out.end());
  throw Error(
      Code::wrong_parameter,
      concat("With a margin of ", rounded(options_.margin), " only ", fitting, " of ", fitting + ssize(left_out),
             " islands fit into the area; left out are, for instance, ", list(left_out), ". Pass a smaller margin",
             options_.fill ? "." : ", a larger area or smaller islands."));
}

}  // namespace lsgp

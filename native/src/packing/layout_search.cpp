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
#include "plane/convex_hull.hpp"

namespace lsgp {

namespace {

// What of the side is open from the first body on, if not only what they take.
constexpr double usual_open_share = 0.95;
// What of the area the first layout of convex bodies that is tried fills, and by how much its side grows until one is
// found.
constexpr double first_fill = 0.7, growth = 1.02, failed_growth = 1.12;
constexpr double room_to_grow = 1.7;
constexpr int most_growths = 16;
// Of the expected side: beyond, margins leave no room, and rasters would get large.
constexpr double most_growth = 4;
// Where so little of the area is filled, sides along the axes are given up for a layout whose side is so much shorter,
// as of strips along the diagonal. Unfolded boxes fill more.
constexpr double hardly_filled = 0.3, shorter_unaligned = 0.9;
// How long smaller squares are looked for at each effort, or better orders where bodies may not overlap at first, in
// about nanoseconds: `good`: as long as doubling it fills .005 more of the square.
constexpr double work_of_separation[]{1.2e7, 6e7, 1e10}, work_of_orders[]{4e6, 2e7, 1e9};
// Of `best`: how often turns nearer to those of the best layout are tried, and how often their angle is halved; six
// layouts of Bake filled up to .03 more, two of them nothing.
constexpr int rounds_of_turning = 4, halvings = 4;
// Of `quick`: for fewer bodies, which have fewer layouts, less; for more, the first layout is taken. Islands of Bake
// fill .644 of the square, and .637 if only ten and more get all of it.
constexpr double whole_work_from = 4;
constexpr std::size_t most_quick = 32;
// Of more bodies, overlaps of pairs are not looked at.
constexpr std::size_t most_separated = 200;
// By how much gaps are wider than asked for, so that rounding never makes them narrower, of the side.
constexpr double widened = 1e-9;
// Texels of the area around obstacles, by the root of their number: what is placed there may be as small as it will.
constexpr double most_texels_around_obstacles = 4096;
// Outlines are simplified by so much of the side, and by this divided by the root of the number of bodies.
constexpr double coarsest = 1e-4, coarsest_of_many = 1e-3;

}  // namespace

LayoutSearch::LayoutSearch(const Array<Body>& bodies, const PackingOptions& options, double unit,
                           ProgressMonitor& monitor)
    : bodies_(bodies), options_(options), unit_(unit), monitor_(monitor), has_area_(options.area.has_value()) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    has_obstacles_ |= bodies[b].keeps_place;
    has_own_scales_ |= options.fill && bodies[b].keeps_scale && !bodies[b].keeps_place;
    if (!bodies[b].keeps_place) free_.push_back(static_cast<Index>(b));
  }
  has_area_ |= options.fill || has_obstacles_ || options.tiles > 1;
  const UvRectangle area = options.area.value_or(UvRectangle{});
  mean_length_ = std::sqrt((area.right - area.left) * (area.top - area.bottom));
  inside_ = inside_margins(options, has_area_);
}

// Whether the side that bodies fill is found by placing them in a tile that is larger than they need.
bool LayoutSearch::grows() const { return !has_obstacles_ && options_.tiles == 1 && !sizes_depend_on_side(); }

// Whether some bodies have other sizes, in texels, at another side.
bool LayoutSearch::sizes_depend_on_side() const { return options_.fill && (has_own_scales_ || options_.snap > 0); }

// In the unit of bodies.
double LayoutSearch::gap(double side) const {
  const double scale = texture_unit(side);
  return 2 * options_.margin * scale + 2 * tolerance_ + widened * expected_extent();
}

double LayoutSearch::estimated_side(double hull_share) const {
  const double width = inner_width(), height = inner_height();
  double area = 0, around = 0, longest = 0, widest = 0;
  for (const Index b : free_) {
    const Box box = bodies_[b].outline.box();
    area += bodies_[b].area + hull_share * std::max(area_of_hull(bodies_[b].hull) - bodies_[b].area, 0.0);
    around += (box.right - box.left) + (box.top - box.bottom);
    longest = std::max({longest, box.right - box.left, box.top - box.bottom});
    widest = std::max(widest, std::min(box.right - box.left, box.top - box.bottom));
  }
  const double room = width * height * options_.tiles * first_fill;
  double side =
      std::max({std::sqrt(area / room), longest / std::max(width, height) / 2, widest / std::min(width, height) / 2});
  for (int i = 0; i < 4; ++i) {
    const double gap = 2 * options_.margin * texture_unit(side);
    side = std::max(side, std::sqrt((area + gap * around + gap * gap * static_cast<double>(free_.size())) / room));
  }
  return side;
}

LayoutSearch::Order LayoutSearch::by_size() const {
  Order out;
  out.pose.assign(bodies_.size(), -1);
  out.bodies = free_;
  if (free_.size() == 1) out.rule = PlaceRule::least_side;
  return out;
}

void LayoutSearch::rasterize(double side) {
  now_.texel = options_.snap > 0 ? options_.snap * texture_unit(side) : expected_extent() / texels_;
  if (options_.snap == 0 && has_obstacles_)
    now_.texel = std::max(now_.texel, texture_unit(side) * mean_length_ / most_texels_around_obstacles);
  now_.rasterized_for = side;
  // Tiles become at most so large.
  const double most_side = options_.fill || grows() ? room_to_grow * std::max(side, most_growth * expected_side_) : 1.0;
  const Box room{0, inner_width() * most_side / now_.texel, 0, inner_height() * most_side / now_.texel};
  now_.poses.assign(bodies_.size(), {});
  for (const Index b : free_) {
    const double scale = options_.fill && bodies_[b].keeps_scale ? side : 1.0;
    now_.poses[b] = poses_of(outline_[b], turns_[b], scale / now_.texel, room);
  }
}

Array<TileSpace> LayoutSearch::tiles(double side) const {
  const double scale = options_.fill || grows() ? side : 1.0;
  const double width = inner_width() * scale - 2 * tolerance_;
  const double height = inner_height() * scale - 2 * tolerance_;
  Array<TileSpace> out(options_.tiles, {width / now_.texel, height / now_.texel, {}});
  for (const Body& body : bodies_) {
    if (!body.keeps_place) continue;
    const Complex low(inside_.left, inside_.bottom);
    const double texels = texture_unit(side) / now_.texel;
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
  how.stops_early = true;
  how.skips_full_rows = free_.size() > (options_.effort == PackingEffort::quick ? 128 : 2000);
  how.open_share = order.open_share / (grows() ? room : 1);
  Attempt out;
  out.found = construct(now_.poses, tiles(grows() ? room * side : side), order.bodies, order.pose, how);
  work_ += out.found.work;
  if (out.found.missing > 0) {
    out.side = side * failed_growth;
  } else if (grows()) {
    const double width = out.found.width * now_.texel + 2 * tolerance_,
                 height = out.found.height * now_.texel + 2 * tolerance_;
    out.side = std::max(width / inner_width(), height / inner_height());
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

// By how much of a difference of the sides that margins are for the needed sides differ: about as many gaps lie beside
// each other as bodies do in rows of equal ones.
double LayoutSearch::share_of_gaps() const {
  constexpr double most = 0.9;
  if (!options_.fill) return 0;
  return std::min(2 * options_.margin * std::sqrt(static_cast<double>(free_.size()) / (inner_width() * inner_height())),
                  most);
}

// The side at which an order may need just that side, if it needed `needed` with margins for another one.
double LayoutSearch::balanced_side(double needed, double with_margins_for) const {
  return (needed - share_of_gaps() * with_margins_for) / (1 - share_of_gaps());
}

void LayoutSearch::find_first(const Order& order) {
  double side = options_.fill || grows() ? expected_side_ : 1.0;
  for (int i = 0; i < most_growths; ++i) {
    Attempt found = attempt(order, side, room_to_grow);
    const double needed = found.side;
    const bool is_complete = found.found.missing == 0;
    if (take_if_better(order, std::move(found))) return tighten(side);
    const double most_side = most_growth * expected_side_;
    if ((!options_.fill && !(grows() && !is_complete)) || side >= most_side) break;
    side = std::max({needed, side, is_complete && grows() ? balanced_side(needed, side) : 0.0}) * growth;
    side = std::min(side, most_side);
  }
  if (!find_fitting_order(order, side)) refuse(order, side);
}

// Other orders, of those that place most bodies, until one places all; for bodies that keep their size.
bool LayoutSearch::find_fitting_order(Order order, double side) {
  if (options_.fill || free_.size() < 2) return false;
  const auto placed_by = [&](const Attempt& attempt) {
    return std::count_if(free_.begin(), free_.end(), [&](Index b) { return attempt.found.placed[b].tile >= 0; });
  };
  const Budget budget(work_of_orders[static_cast<std::size_t>(options_.effort)], options_.seconds);
  const double work_before = work_;
  std::ptrdiff_t most = 0;
  for (double share = 0; share < 1; share = budget.share(work_ - work_before)) {
    monitor_.advance(share);
    Order other = varied(order);
    Attempt found = attempt(other, side);
    const std::ptrdiff_t placed = placed_by(found);
    if (take_if_better(other, std::move(found))) return true;
    if (placed < most) continue;
    most = placed;
    order = std::move(other);
  }
  return false;
}

// The same order in a smaller square.  with_margins_for: the side for which margins have been.
void LayoutSearch::tighten(double with_margins_for) {
  if (!options_.fill && !grows()) return;
  if (grows()) {
    constexpr int most = 4;
    constexpr double above = 1.003, room = 1.03;
    const double enough = options_.effort == PackingEffort::quick ? 0.003 : 0.001;
    // Once more in a square that is open from the first, which is better most of the time.
    Order order = now_.order;
    order.open_share = usual_open_share;
    double side = with_margins_for, needed = now_.side;
    const auto is_done = [&] {
      return !options_.fill || (needed <= side && share_of_gaps() * (side - needed) <= enough * needed);
    };
    for (int i = 0; i < most && (i == 0 || !is_done()); ++i) {
      const double next = std::min(above * std::max(balanced_side(needed, side), 0.5 * now_.side), now_.side);
      if (i > 0) {
        if (next == side) return;
        order = now_.order;
      }
      side = next;
      Attempt found = attempt(order, side, room);
      needed = found.side;
      if (found.found.missing > 0) return;
      take_if_better(order, std::move(found));
    }
    return;
  }
  constexpr double near = 1.004;
  double area = 0;
  for (const Index b : free_) area += bodies_[b].keeps_scale ? 0 : bodies_[b].area;
  double low = std::sqrt(area / (inner_width() * inner_height() * options_.tiles));
  while (now_.side > near * low) {
    const double middle = (now_.side + std::max(low, now_.side / 2)) / 2;
    if (!take_if_better(now_.order, attempt(now_.order, middle))) low = middle;
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
  if (below(seldom) == 0) out.open_share = order.open_share > 0 ? 0 : usual_open_share;
  if (below(seldom) == 0) out.rule = static_cast<PlaceRule>(below(place_rules));
  return out;
}

void LayoutSearch::vary_order(const Budget& budget) {
  constexpr double smaller = 0.995;
  const double work_before = work_;
  for (double share = 0; share < 1; share = budget.share(work_ - work_before)) {
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

// Slides bodies, those nearest to the low corner first, along both axes until they touch others.
void LayoutSearch::settle(Constructed& found, double gap) {
  constexpr double cost_of_look = 8;  // nanoseconds
  constexpr int rounds = 4;
  constexpr double longest = 4;
  Array<Placed>& placed = found.placed;
  const auto outline = [&](Index b) { return now_.poses[b][placed[b].pose].outline.moved(1, placed[b].at); };
  for (int round = 0; round < rounds; ++round) {
    Array<Index> order = free_;
    const Axis axis = round % 2 == 0 ? Axis::v : Axis::u;
    const auto place = [&](Index b) { return axis == Axis::u ? placed[b].at.real() : placed[b].at.imag(); };
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return place(a) < place(b); });
    for (const Index b : order) {
      StillOutlines others(texels_, texels_, texels_ / std::sqrt(static_cast<double>(free_.size())));
      const Outline moving = outline(b);
      const Box box = moving.box();
      const double reach = longest + gap;
      const Box near{box.left - reach, box.right + reach, box.bottom - reach, box.top + reach};
      for (const Index other : free_) {
        const Pose& pose = now_.poses[other][placed[other].pose];
        const Complex at = placed[other].at;
        const Box around_other{at.real(), at.real() + pose.width, at.imag(), at.imag() + pose.height};
        if (other != b && meet(near, around_other)) others.add(outline(other));
      }
      double looks = 0;
      const double way = others.free_way(moving, axis, gap, std::min(longest, place(b)), looks);
      work_ += cost_of_look * looks;
      placed[b].at -= axis == Axis::u ? Complex(way, 0) : Complex(0, way);
    }
  }
  found.width = found.height = 0;
  for (const Index b : free_) {
    const Pose& pose = now_.poses[b][placed[b].pose];
    found.width = std::max(found.width, placed[b].at.real() + pose.width);
    found.height = std::max(found.height, placed[b].at.imag() + pose.height);
  }
}

// The layout of the earlier search, if that is better and has the same poses.
void LayoutSearch::take_up_earlier() {
  if (earlier_ == nullptr || earlier_->now_.texel != now_.texel || !(earlier_->now_.side < now_.side)) return;
  State there = earlier_->now_;
  for (const Index b : free_) {
    const auto& poses = now_.poses[b];
    int& pose = there.found.placed[b].pose;
    const Complex turn = earlier_->now_.poses[b][pose].turn;
    const auto same = std::find_if(poses.begin(), poses.end(), [&](const Pose& one) { return one.turn == turn; });
    if (same == poses.end()) return;
    pose = static_cast<int>(same - poses.begin());
    there.order.pose[b] = pose;
  }
  there.poses = std::move(now_.poses);
  now_ = std::move(there);
}

bool LayoutSearch::can_separate() const { return grows() && options_.snap == 0 && free_.size() <= most_separated; }

// Smaller squares, in which bodies overlap at first.
void LayoutSearch::separate(const Budget& budget) {
  // By how much smaller the square is tried, after this many failures; then again from the first on.
  constexpr double shrinks[]{0.99, 0.99, 0.995, 0.995, 0.9975, 0.9975, 0.9975};
  constexpr std::size_t shrink_count = sizeof(shrinks) / sizeof(shrinks[0]);
  constexpr int patience = 30;  // rounds
  const double work_before = work_;
  // Margins are for the side at which this begins, which is more than for smaller ones.
  constexpr double too_wide = 1.02;
  std::optional<Separation> separation;
  double gap_now = 0;
  const auto count = static_cast<int>(free_.size());
  std::size_t failures = 0;
  for (double share = 0; share < 1; share = budget.share(work_ - work_before)) {
    monitor_.advance(share);
    const double gap_needed = gap(now_.side) / now_.texel;
    if (!separation || gap_now > too_wide * gap_needed) separation.emplace(now_.poses, free_, gap_now = gap_needed);
    const double factor = shrinks[failures % shrink_count];
    const double side = now_.side * factor;
    const double width = (inner_width() * side - 2 * tolerance_) / now_.texel;
    const double height = (inner_height() * side - 2 * tolerance_) / now_.texel;
    Attempt tried;
    tried.found = now_.found;
    for (const Index b : free_) tried.found.placed[b].at *= factor;
    for (std::size_t swaps = 0; swaps < std::min<std::size_t>(failures, 3); ++swaps)
      std::swap(tried.found.placed[free_[below(count)]].at, tried.found.placed[free_[below(count)]].at);
    const bool is_done = separation->run({width, height, patience, budget.work()}, tried.found.placed, random_, work_);
    if (is_done) {
      settle(tried.found, gap_now);
      tried.side = std::max((tried.found.width * now_.texel + 2 * tolerance_) / inner_width(),
                            (tried.found.height * now_.texel + 2 * tolerance_) / inner_height());
      tried.is_valid = true;
    }
    Order order = now_.order;
    for (const Index b : free_) order.pose[b] = tried.found.placed[b].pose;
    failures = take_if_better(order, std::move(tried)) ? 0 : failures + 1;
  }
}

PackedLayout LayoutSearch::best() {
  const auto count = static_cast<double>(free_.size());
  // Others fill about half of what concave bodies leave of their hulls; and a little more, so that margins are rarely
  // too narrow.
  constexpr double lost_of_hull = 0.4, more = 1.05;
  expected_side_ = more * estimated_side(lost_of_hull);
  const double filled_side = estimated_side(0);
  double farthest = 0;
  for (const Body& body : bodies_) farthest = std::max(farthest, std::abs(body.origin));
  constexpr double no_size = 1e-200, last_digit = std::numeric_limits<double>::epsilon();
  // Of a body, about, and of the side: more for separation, less for many bodies.
  const bool is_fine = options_.effort != PackingEffort::quick && count <= most_separated;
  const double texels_of_body = is_fine ? 40 : 24, least_texels = is_fine ? 256 : 128;
  constexpr double most_texels = 1024;
  // Concave bodies, which take more than their area, get no coarser texels.
  constexpr double most_coarseness = 2;
  const double coarseness = std::min(expected_side_ / std::max(filled_side, no_size), most_coarseness);
  texels_ = static_cast<int>(std::clamp(coarseness * texels_of_body * std::sqrt(count / options_.tiles),
                                        coarseness * least_texels, most_texels));
  if (expected_extent() <= std::max(texels_ * last_digit * farthest, no_size)) {
    throw Error(Code::wrong_parameter,
                concat("The square that the islands fill is ",
                       rounded(expected_extent() / std::max(farthest, expected_extent()), 2),
                       " of their distance from the origin, too small to place them in. Move them to the origin, or "
                       "leave out those that are points."));
  }
  if (options_.snap > 0) require_enough_blocks();
  if (options_.snap == 0) tolerance_ = expected_extent() * std::min(coarsest, coarsest_of_many / std::sqrt(count));
  for (const Body& body : bodies_)
    outline_.push_back(body.keeps_scale ? body.outline : body.outline.simplified(tolerance_));
  directions_ = directions_among(count);
  search(false);
  if (is_hardly_filled()) {
    State aligned = std::move(now_);
    Array<Array<Complex>> turns = std::move(turns_);
    now_ = {};
    search(true);
    if (now_.side > shorter_unaligned * aligned.side) {
      now_ = std::move(aligned);
      turns_ = std::move(turns);  // by which its poses are numbered
    }
  }
  return layout();
}

// The directions in a quarter turn of one of so many equal bodies.
int LayoutSearch::directions_among(double count) const {
  constexpr double few = 8, some = 64;
  return count <= few ? 8 : count <= some && options_.effort != PackingEffort::quick ? 4 : 0;
}

// Throws WRONG_PARAMETER where blocks are so small that a raster of them would not fit into memory, or so large that
// the area has none.
void LayoutSearch::require_enough_blocks() const {
  constexpr double most_blocks = 1 << 13;
  const double scale = has_area_ ? 1.0 : expected_side_;
  const double width = inner_width() * scale, height = inner_height() * scale;
  if (std::min(width, height) >= options_.snap && std::max(width, height) <= most_blocks * options_.snap) return;
  throw Error(Code::wrong_parameter,
              concat("snap is ", rounded(options_.snap * unit_), ", and the area inside the margins is ",
                     rounded(width * unit_), " by ", rounded(height * unit_),
                     "; pass the side of blocks of which it has one, and at most ", most_blocks, " on a side."));
}

// also_along_axes: bodies that lie along the axes may be turned otherwise, too.
void LayoutSearch::search(bool also_along_axes) {
  // Those along the axes have none but for these.
  constexpr int least_directions = 4;
  const int directions =
      also_along_axes && free_.size() <= most_quick ? std::max(directions_, least_directions) : directions_;
  double area = 0;
  for (const Index b : free_) area += bodies_[b].area;
  turns_.clear();
  for (const Body& body : bodies_) {
    // One that is as large as many others together is turned like one of as few as would fill the area.
    const int own = body.keeps_place || !(body.area > 0) ? 0 : directions_among(area / body.area);
    turns_.push_back(turns_of(body, std::max(directions, own), also_along_axes));
  }
  find_first(by_size());
  for (const Index b : free_) now_.order.pose[b] = now_.found.placed[b].pose;
  const auto effort = static_cast<std::size_t>(options_.effort);
  if (free_.size() < 2) return;            // all of its poses have been tried
  if (!options_.fill && !grows()) return;  // they fit, and get no larger
  const bool is_quick = options_.effort == PackingEffort::quick;
  if (is_quick && free_.size() > most_quick) return;
  const double part_of_work = is_quick ? std::min(static_cast<double>(free_.size()) / whole_work_from, 1.0) : 1.0;
  const bool is_best = options_.effort == PackingEffort::best;
  const auto budget = [&](const double(&work)[3], int rounds) {
    const double part = part_of_work / rounds;
    return Budget(part * work[effort],
                  is_best && options_.seconds ? std::optional(part * *options_.seconds) : std::nullopt);
  };
  if (!can_separate()) return vary_order(budget(work_of_orders, 1));
  take_up_earlier();
  const int rounds = is_best ? rounds_of_turning : 1;
  for (int round = 0; round < rounds; ++round) {
    const ProgressMonitor::Interval part(monitor_, static_cast<double>(round) / rounds, (round + 1.0) / rounds);
    if (round > 0) turn_finely(also_along_axes, directions);
    separate(budget(work_of_separation, rounds));
  }
}

// Bodies may also take turns near those that they have in the best layout. directions: of `search`.
void LayoutSearch::turn_finely(bool also_along_axes, int directions) {
  const Box room{0, room_to_grow * inner_width() * now_.side / now_.texel, 0,
                 room_to_grow * inner_height() * now_.side / now_.texel};
  for (const Index b : free_) {
    int& pose = now_.found.placed[b].pose;
    const Complex now = now_.poses[b][pose].turn;
    Array<Complex> turns{now};
    // By roots alone, which have the same bytes everywhere.
    const auto halve = [](Complex& turn) { turn = (1.0 + turn) / std::sqrt(std::norm(1.0 + turn)); };
    if (bodies_[b].turns == IslandTurns::any && (also_along_axes || !lies_along_axes(bodies_[b].outline))) {
      Complex step(0, 1);  // a quarter turn
      for (int count = directions; count > 1; count /= 2) halve(step);
      for (int halved = 0; halved < halvings; ++halved) {
        halve(step);
        turns.push_back(now * step);
        turns.push_back(now * std::conj(step));
      }
    }
    turns.insert(turns.end(), turns_[b].begin(), turns_[b].end());
    now_.poses[b] = poses_of(outline_[b], turns, 1 / now_.texel, room);
    pose = now_.order.pose[b] = 0;
  }
}

// Whether other turns of bodies that lie along the axes may be worth it, as of long strips.
bool LayoutSearch::is_hardly_filled() const {
  double area = 0;
  bool has_other_turns = false;
  for (const Index b : free_) {
    area += bodies_[b].area;
    if (bodies_[b].turns != IslandTurns::any) continue;
    has_other_turns |= lies_along_axes(bodies_[b].outline) || (directions_ == 0 && free_.size() <= most_quick);
  }
  const double whole = inner_width() * inner_height() * options_.tiles;
  return has_other_turns && area < hardly_filled * whole * now_.side * now_.side;
}

PackedLayout LayoutSearch::layout() {
  // The last attempt may have been at another side.
  if (sizes_depend_on_side() && now_.rasterized_for != now_.side) rasterize(now_.side);
  Array<BodyMotion> out(bodies_.size());
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
  double side = texture_unit(now_.side), needed = now_.side;
  Complex low = 0;
  if (grows() && options_.snap == 0) {
    low = {all.left, all.bottom};
    needed = std::max((all.right - all.left) / inner_width(), (all.top - all.bottom) / inner_height());
    if (options_.fill) side = needed;
  }
  for (const Index b : free_) {
    out[b].factor /= side;
    out[b].shift = (out[b].shift - low) / side + Complex(inside_.left, inside_.bottom);
  }
  return {options_.fill ? side : needed, std::move(out)};
}

void LayoutSearch::refuse(const Order& order, double side) {
  ConstructionOptions how;
  how.gap = gap(side) / now_.texel;
  how.on_texels = options_.snap > 0;
  const double scale = texture_unit(side);
  Array<TileSpace> spaces = tiles(side);
  for (TileSpace& space : spaces) {
    space.width = (inner_width() * scale - 2 * tolerance_) / now_.texel;
    space.height = (inner_height() * scale - 2 * tolerance_) / now_.texel;
  }
  const Constructed found = construct(now_.poses, spaces, order.bodies, order.pose, how);
  Array<Index> left_out;
  Index fitting = 0;
  for (const Index b : free_) {
    const auto& islands = bodies_[b].islands;
    if (found.placed[b].tile < 0)
      left_out.insert(left_out.end(), islands.begin(), islands.end());
    else
      fitting += static_cast<Index>(islands.size());
  }
  std::sort(left_out.begin(), left_out.end());
  const std::string message =
      concat("With a margin of ", rounded(options_.margin * unit_), " only ", fitting, " of ",
             fitting + ssize(left_out), " islands fit into the area; left out are, for instance, ", list(left_out),
             ". Pass a smaller margin", options_.fill ? "." : ", a larger area or smaller islands.");
  throw NoRoom{message, std::move(left_out)};
}

}  // namespace lsgp

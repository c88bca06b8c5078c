// SPDX-License-Identifier: GPL-3.0-or-later
// The best layout of bodies: the scale at which they fill a rectangle, and the order in which they are placed.
#pragma once

#include <chrono>
#include <optional>
#include <random>
#include <string>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "packing/body.hpp"
#include "packing/construction.hpp"
#include "packing/separation.hpp"

namespace lsgp {

// How long something is looked for: an amount of work, as of `Constructed`, or seconds.
class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  Budget(double work, std::optional<double> seconds) : work_(work), seconds_(seconds) {}

  double work() const { return work_; }

  // Which part of it is used up, if that much work has been done.
  double share(double work) const {
    return seconds_ ? std::chrono::duration<double>(Clock::now() - begin_).count() / *seconds_ : work / work_;
  }

 private:
  const double work_;
  const std::optional<double> seconds_;
  const Clock::time_point begin_ = Clock::now();
};

// That bodies do not fit, and the islands that are left out of a layout of the others.
struct NoRoom {
  std::string message;
  Array<Index> islands;
};

class LayoutSearch {
 public:
  // bodies, options: have to live longer. unit: of the lengths of options, for errors.
  LayoutSearch(const Array<Body>& bodies, const PackingOptions& options, double unit, ProgressMonitor& monitor);

  // The layout of another search of the same bodies in the same texels, which lives longer: smaller squares are looked
  // for from there, unless better orders have a smaller one.
  void go_on_from(const LayoutSearch& other) { earlier_ = &other; }

  // Throws NoRoom, and WRONG_PARAMETER where numbers are too small or blocks too many.
  PackedLayout best();

 private:
  // In which order bodies are placed, and how.
  struct Order {
    Array<Index> bodies;
    Array<int> pose;  // (bodies) that it has to take, -1: any
    PlaceRule rule = PlaceRule::lowest;
    double open_share = 0;  // of the side
  };
  struct Attempt {
    Constructed found;
    // The side that it fills; if bodies were left out, or it is wider than margins were for, it is not valid.
    double side = 0;
    bool is_valid = false;
  };

  // The best layout so far, and the bodies in texels.
  struct State {
    double texel = 0;           // in the unit of bodies
    double rasterized_for = 0;  // the side
    Array<Array<Pose>> poses;   // (bodies)
    Order order;
    Constructed found;
    double side = 0;  // 0: there is none
  };

  bool grows() const;
  bool sizes_depend_on_side() const;
  // Without an area 1, whatever is lost of it beyond a wide margin.
  double inner_width() const { return has_area_ ? inside_.right - inside_.left : 1.0; }
  double inner_height() const { return has_area_ ? inside_.top - inside_.bottom : 1.0; }
  // The side of a square as large as the area at the expected side, in the unit of bodies.
  double expected_extent() const { return expected_side_ * mean_length_; }
  // A length of 1 in texture coordinates, in the unit of bodies.
  double texture_unit(double side) const { return options_.fill ? side : 1.0; }
  double gap(double side) const;
  double estimated_side(double hull_share) const;
  Order by_size() const;
  int directions_among(double count) const;
  void rasterize(double side);
  Array<TileSpace> tiles(double side) const;
  Attempt attempt(const Order& order, double side, double room = 1);
  bool take_if_better(const Order& order, Attempt attempt);
  void search(bool also_along_axes);
  bool is_hardly_filled() const;
  void require_enough_blocks() const;
  void find_first(const Order& order);
  bool find_fitting_order(Order order, double side);
  double share_of_gaps() const;
  double balanced_side(double needed, double with_margins_for) const;
  void tighten(double with_margins_for);
  void vary_order(const Budget& budget);
  void take_up_earlier();
  bool can_separate() const;
  void separate(const Budget& budget);
  void turn_finely(bool also_along_axes, int directions);
  void settle(Constructed& found, double gap);
  Order varied(const Order& order);
  int below(int most) { return lsgp::uniform_below(random_, most); }
  PackedLayout layout();
  [[noreturn]] void refuse(const Order& order, double side);

  const Array<Body>& bodies_;
  const PackingOptions& options_;
  const double unit_;
  ProgressMonitor& monitor_;
  UvRectangle inside_;  // the area without the margin at its border
  double mean_length_;  // of the area: the side of a square as large
  bool has_area_;       // islands that keep their size have to fit into it
  bool has_obstacles_ = false, has_own_scales_ = false;
  Array<Index> free_;  // bodies that do not keep their place

  double tolerance_ = 0;    // of the outlines
  Array<Outline> outline_;  // (bodies) simplified
  Array<Array<Complex>> turns_;
  double expected_side_ = 0;
  int directions_ = 0;
  int texels_ = 0;  // of the expected side

  const LayoutSearch* earlier_ = nullptr;
  State now_;
  double work_ = 0;  // done so far, as of `Constructed`
  std::mt19937 random_;
};

}  // namespace lsgp

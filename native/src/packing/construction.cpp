// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/construction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr double operations_a_searched_row = 50;
// Nanoseconds, as measured: a row that is searched, a look at a span, one at a pair of segments, a texel of a new
// raster and of one drawn.
constexpr double cost_of_row = 20, cost_of_look = 2.5, cost_of_pair = 8, cost_of_texel = 0.3, cost_of_drawn = 0.5;
// A body is slid along both axes in turn, so often at most and by so many texels each time; less than `least_slide` is
// not worth another turn.
constexpr int most_slides = 6;
constexpr double longest_slide = 2, least_slide = 0.02;
// Bodies that are not smaller than this part of the first of their class skip the rows in which that found no room.
constexpr double class_size = 0.8;

// What a place costs; less is better.
struct Cost {
  double growth = std::numeric_limits<double>::infinity(), further = 0;

  friend bool operator<(const Cost& a, const Cost& b) {
    return a.growth != b.growth ? a.growth < b.growth : a.further < b.further;
  }
};

struct Candidate {
  Cost cost;
  int pose = -1, column = 0, row = 0;
};

class Tile {
 public:
  Tile(const TileSpace& space, double cell, const ConstructionOptions& options)
      : width_(space.width),
        height_(space.height),
        options_(options),
        // A body at the far sides touches the texels beyond them.
        taken_(static_cast<int>(height_) + 2, static_cast<int>(width_) + 2),
        still_(width_, height_, cell) {
    work_ = cost_of_texel * width_ * height_;
    for (const Outline& outline : space.obstacles) keep(outline);
    has_obstacles_ = !space.obstacles.empty();
  }

  double work() const { return work_; }
  double used_width() const { return used_width_; }
  double used_height() const { return used_height_; }

  std::optional<Placed> place(const Array<Pose>& poses, int wanted) {
    const double extent = size_of(poses);
    if (!options_.skips_full_rows || extent < class_size * class_extent_) {
      class_extent_ = extent;
      first_row_ = 0;
    }
    Candidate best;
    int untried = std::numeric_limits<int>::max();  // the first row that may have room
    const auto for_each_pose = [&](auto visit) {
      for (int p = 0; p < static_cast<int>(poses.size()); ++p) {
        if (wanted < 0 || p == wanted) visit(poses[p], p);
      }
    };
    for_each_pose([&](const Pose& pose, int p) { untried = std::min(untried, search_inside(pose, p, best)); });
    first_row_ = std::max(first_row_, untried);
    if (best.pose < 0) for_each_pose([&](const Pose& pose, int p) { search_beyond(pose, p, best); });
    if (best.pose < 0) return std::nullopt;
    const Pose& pose = poses[best.pose];
    const Complex at = slid(pose, Complex(best.column, best.row));
    keep(pose.outline.moved(1, at));
    if (at.real() + pose.width > used_width_) first_row_ = 0;
    used_width_ = std::max(used_width_, at.real() + pose.width);
    used_height_ = std::max(used_height_, at.imag() + pose.height);
    Placed out;
    out.pose = best.pose;
    out.at = at;
    return out;
  }

 private:
  static double size_of(const Array<Pose>& poses) {
    double least = std::numeric_limits<double>::infinity();
    for (const Pose& pose : poses) least = std::min(least, pose.width + pose.height);
    return least;
  }

  Cost cost_of(const Pose& pose, int column, int row) const {
    const double right = column + pose.width, top = row + pose.height;
    const double wide = std::max(used_width_, right) / width_, high = std::max(used_height_, top) / height_;
    const double side = std::max(wide, high);
    switch (options_.rule) {
      case PlaceRule::lowest: return {side * side + wide * high, row * width_ + column};
      case PlaceRule::nearest_corner: return {side * side + wide * high, std::max(right / width_, top / height_)};
      default: return {side, wide * high};
    }
  }

  // Places where the rectangle around all does not grow. Returns the row up to which all are full.
  int search_inside(const Pose& pose, int number, Candidate& best) {
    const int last_row = static_cast<int>(std::floor(used_height_ - pose.height));
    const int last_column = static_cast<int>(std::floor(used_width_ - pose.width));
    if (last_column < 0) return std::numeric_limits<int>::max();
    for (int row = first_row_; row <= last_row; ++row) {
      if (!(cost_of(pose, 0, row) < best.cost)) return row;
      if (search_row(pose, number, {row, 0, last_column}, best)) return row;
    }
    return std::max(last_row + 1, first_row_);
  }

  // Places where it grows.
  void search_beyond(const Pose& pose, int number, Candidate& best) {
    // Beyond the gap around what is there, all is free but for obstacles.
    const double beyond = has_obstacles_ ? std::max(width_, height_) : options_.gap + 2;
    const int last_row = static_cast<int>(std::floor(std::min(used_height_ + beyond, height_ - pose.height)));
    const int last_column = static_cast<int>(std::floor(std::min(used_width_ + beyond, width_ - pose.width)));
    const double last_inside = used_height_ - pose.height;
    const int beside = std::max(static_cast<int>(std::floor(used_width_ - pose.width)), 0);
    for (int row = 0; row <= last_row && cost_of(pose, 0, row) < best.cost; ++row)
      search_row(pose, number, {row, row <= last_inside ? beside : 0, last_column}, best);
  }

  // Places from the first column to the last one.
  struct PlacesInRow {
    int row, first, last;
  };

  // Whether one of the places is free.
  bool search_row(const Pose& pose, int number, const PlacesInRow& places, Candidate& best) {
    double looks = 0;
    const int column = taken_.first_free(pose.footprint, places.row, places.first, places.last, looks);
    checkpoint(operations_a_searched_row);
    work_ += cost_of_row + cost_of_look * looks;
    if (column < 0) return false;
    const Cost cost = cost_of(pose, column, places.row);
    if (cost < best.cost) best = {cost, number, column, places.row};
    return true;
  }

  Complex slid(const Pose& pose, Complex at) {
    if (options_.on_texels) return at;
    double moved = longest_slide;
    for (int slide = 0; slide < most_slides; ++slide) {
      double looks = 0;
      const Axis axis = slide % 2 == 0 ? Axis::v : Axis::u;
      const double limit = std::min(longest_slide, axis == Axis::u ? at.real() : at.imag());
      const double way = still_.free_way(pose.outline.moved(1, at), axis, options_.gap, limit, looks);
      work_ += cost_of_pair * looks;
      at -= axis == Axis::u ? Complex(way, 0) : Complex(0, way);
      if (slide > 0 && moved < least_slide && way < least_slide) break;
      moved = way;
    }
    return at;
  }

  void keep(const Outline& outline) {
    const Box box = outline.box();
    work_ += cost_of_drawn * (box.right - box.left + 2 * options_.gap) * (box.top - box.bottom + 2 * options_.gap);
    taken_.take(outline, options_.gap);
    still_.add(outline);
  }

  const double width_, height_;
  const ConstructionOptions& options_;
  TakenTexels taken_;
  StillOutlines still_;
  double used_width_ = 0, used_height_ = 0;
  double class_extent_ = std::numeric_limits<double>::infinity();
  double work_ = 0;
  bool has_obstacles_ = false;
  int first_row_ = 0;  // in those before is no room for bodies of the class
};

double mean_extent(const Array<Array<Pose>>& poses) {
  double sum = 0;
  for (const Array<Pose>& of_body : poses) {
    if (!of_body.empty()) sum += std::max(of_body[0].width, of_body[0].height);
  }
  return sum / static_cast<double>(std::max<std::size_t>(poses.size(), 1));
}

}  // namespace

Constructed construct(const Array<Array<Pose>>& poses, const Array<TileSpace>& tiles, const Array<Index>& order,
                      const Array<int>& pose, const ConstructionOptions& options) {
  Constructed out;
  out.placed.resize(poses.size());
  Array<Tile> filled;
  filled.reserve(tiles.size());
  const double cell = std::max(mean_extent(poses), 1.0);
  for (const Index body : order) {
    Placed& placed = out.placed[body];
    for (std::size_t t = 0; t < tiles.size() && placed.tile < 0; ++t) {
      if (t == filled.size()) filled.emplace_back(tiles[t], cell, options);
      if (const std::optional<Placed> found = filled[t].place(poses[body], pose.empty() ? -1 : pose[body])) {
        placed = *found;
        placed.tile = static_cast<int>(t);
      }
    }
    if (placed.tile >= 0) continue;
    ++out.missing;
    if (options.stops_early) break;
  }
  for (const Tile& tile : filled) {
    out.width = std::max(out.width, tile.used_width());
    out.height = std::max(out.height, tile.used_height());
    out.work += tile.work();
  }
  return out;
}

}  // namespace lsgp

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
// Bodies of which neither size nor area is smaller than these parts of those of the first of their class skip the rows
// in which that found no room.
constexpr double class_size = 0.8, class_area = 0.65;
// By so much of a body's extent what is open grows at least where nothing was at first and full rows are skipped: after
// each step all of it is looked at again.
constexpr double step_of_many = 0.25;

// What a place costs; less is better.
struct Cost {
  double growth = std::numeric_limits<double>::infinity(), further = 0;

  friend bool operator<(const Cost& a, const Cost& b) {
    return a.growth != b.growth ? a.growth < b.growth : a.further < b.further;
  }
};

struct Candidate {
  Cost cost;
  int pose = -1;
  Complex at;
};

class Tile {
  static constexpr int unknown = -1;

 public:
  Tile(const TileSpace& space, double cell, const ConstructionOptions& options)
      : width_(space.width),
        height_(space.height),
        options_(options),
        // A body at the far sides touches the texels beyond them.
        taken_(static_cast<int>(height_) + 2, static_cast<int>(width_) + 2),
        longest_free_(taken_.rows(), unknown),
        still_(width_, height_, cell) {
    work_ = cost_of_texel * width_ * height_;
    open_width_ = options.open_share * width_;
    open_height_ = options.open_share * height_;
    for (const Outline& outline : space.obstacles) keep(outline);
    has_obstacles_ = !space.obstacles.empty();
  }

  double work() const { return work_; }
  double used_width() const { return used_width_; }
  double used_height() const { return used_height_; }

  std::optional<Placed> place(const Array<Pose>& poses, int wanted) {
    const double extent = size_of(poses), area = area_of(poses);
    if (!options_.skips_full_rows || extent < class_size * class_extent_ || area < class_area * class_area_) {
      class_extent_ = extent;
      class_area_ = area;
      first_row_ = 0;
    }
    Candidate best;
    Array<Searched> searched;
    for (int p = 0; p < static_cast<int>(poses.size()); ++p) {
      if (wanted < 0 || p == wanted) searched.push_back({&poses[p], p});
    }
    search_holes(searched, extent, best);
    if (best.pose < 0) {
      const int full_rows = search_inside(searched, best);
      if (class_area * area <= class_area_) first_row_ = std::max(first_row_, full_rows);
    }
    if (best.pose < 0) {
      for (const Searched& one : searched) search_beyond(one, best);
    }
    if (best.pose < 0) return std::nullopt;
    const Pose& pose = poses[best.pose];
    const Complex at = slid(pose, best.at);
    keep(pose.outline.moved(1, at));
    for (const Box& hole : pose.holes)
      keep_hole({hole.left + at.real(), hole.right + at.real(), hole.bottom + at.imag(), hole.top + at.imag()});
    used_width_ = std::max(used_width_, at.real() + pose.width);
    used_height_ = std::max(used_height_, at.imag() + pose.height);
    const double step = options_.skips_full_rows && options_.open_share == 0 ? step_of_many * extent : 0.0;
    if (used_width_ > open_width_) {
      open_width_ = std::max(used_width_, std::min(open_width_ + step, width_));
      std::fill(longest_free_.begin(), longest_free_.end(), unknown);
      first_row_ = 0;
    }
    if (used_height_ > open_height_) open_height_ = std::max(used_height_, std::min(open_height_ + step, height_));
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

  // In texels.
  static double area_of(const Array<Pose>& poses) {
    double area = 0;
    if (!poses.empty()) {
      for (const Span& span : poses[0].footprint.spans()) area += span.end - span.begin;
    }
    return area;
  }

  Cost cost_of(const Pose& pose, int column, int row) const {
    const double right = column + pose.width, top = row + pose.height;
    const double wide = std::max(open_width_, right) / width_, high = std::max(open_height_, top) / height_;
    const double side = std::max(wide, high);
    switch (options_.rule) {
      case PlaceRule::lowest: return {side * side + wide * high, row * width_ + column};
      case PlaceRule::nearest_corner: return {side * side + wide * high, std::max(right / width_, top / height_)};
      default: return {side, wide * high};
    }
  }

  struct Searched {
    const Pose* pose;
    int number;
    bool is_done = false;
  };

  struct Hole {
    Box box;
    double full_for;  // the size of the smallest body that was not placed in it
    double size() const { return box.right - box.left + box.top - box.bottom; }
  };

  void keep_hole(const Box& box) {
    const Hole hole{box, std::numeric_limits<double>::infinity()};
    holes_.insert(std::upper_bound(holes_.begin(), holes_.end(), hole,
                                   [](const Hole& a, const Hole& b) { return a.size() < b.size(); }),
                  hole);
  }

  // Places in holes of bodies, of which nothing else can make use, the smallest ones first.
  void search_holes(const Array<Searched>& searched, double size, Candidate& best) {
    constexpr double hardly_smaller = 0.98;
    for (Hole& hole : holes_) {
      if (best.pose >= 0) return;
      if (size > hardly_smaller * hole.full_for || size >= hole.size()) continue;
      for (const Searched& one : searched) {
        const int last_column = static_cast<int>(std::floor(hole.box.right - one.pose->width));
        const int last_row = static_cast<int>(std::floor(hole.box.top - one.pose->height));
        const int first_column = static_cast<int>(hole.box.left);
        for (int row = static_cast<int>(hole.box.bottom); row <= last_row; ++row) {
          if (first_column <= last_column && search_row(one, {row, first_column, last_column}, best)) break;
        }
      }
      if (best.pose < 0 && !options_.on_texels) search_middle(searched, hole.box, best);
      if (best.pose < 0) hole.full_for = size;
      checkpoint(operations_a_searched_row * (hole.box.top - hole.box.bottom));
    }
  }

  // In the middle of a hole, exactly, where texels are too coarse for what hardly fits.
  void search_middle(const Array<Searched>& searched, const Box& hole, Candidate& best) {
    const Complex middle((hole.left + hole.right) / 2, (hole.bottom + hole.top) / 2);
    for (const Searched& one : searched) {
      const double width = one.pose->width, height = one.pose->height, gaps = 2 * options_.gap;
      if (width + gaps > hole.right - hole.left || height + gaps > hole.top - hole.bottom) continue;
      const Complex at = middle - Complex(width, height) / 2.0;
      double looks = 0;
      const bool is_free = still_.has_room(one.pose->outline.moved(1, at), options_.gap, looks);
      work_ += cost_of_pair * looks;
      if (!is_free) continue;
      best = {{}, one.number, at};
      return;
    }
  }

  // Places in what is open. Returns the row up to which all are full.
  int search_inside(Array<Searched>& searched, Candidate& best) {
    int untried = std::numeric_limits<int>::max();
    std::size_t left = searched.size();
    for (int row = first_row_; left > 0; ++row) {
      for (Searched& one : searched) {
        if (one.is_done) continue;
        const Pose& pose = *one.pose;
        const int last_row = static_cast<int>(std::floor(open_height_ - pose.height));
        const int last_column = static_cast<int>(std::floor(open_width_ - pose.width));
        one.is_done = last_column < 0 || row > last_row || !(cost_of(pose, 0, row) < best.cost) ||
                      (has_room(pose.footprint, row) && search_row(one, {row, 0, last_column}, best));
        if (!one.is_done) continue;
        --left;
        if (last_column >= 0) untried = std::min(untried, row);
      }
      checkpoint(operations_a_searched_row);
    }
    return untried;
  }

  // False: a footprint is wider than what is free in a row.
  bool has_room(const Footprint& footprint, int row) {
    constexpr std::size_t looks = 4;
    const Array<Span>& spans = footprint.spans();
    const int end = static_cast<int>(open_width_) + 1;
    for (std::size_t s = 0; s < spans.size(); s += spans.size() / looks + 1) {
      int& longest = longest_free_[row + spans[s].row];
      if (longest == unknown) longest = taken_.longest_free(row + spans[s].row, end);
      if (longest < spans[s].end - spans[s].begin) return false;
    }
    return true;
  }

  // Places beyond.
  void search_beyond(const Searched& one, Candidate& best) {
    const Pose& pose = *one.pose;
    // Beyond the gap around what is there, all is free but for obstacles.
    const double beyond = has_obstacles_ ? std::max(width_, height_) : options_.gap + 2;
    const int last_row = static_cast<int>(std::floor(std::min(open_height_ + beyond, height_ - pose.height)));
    const int last_column = static_cast<int>(std::floor(std::min(open_width_ + beyond, width_ - pose.width)));
    const double last_inside = open_height_ - pose.height;
    const int beside = std::max(static_cast<int>(std::floor(open_width_ - pose.width)), 0);
    for (int row = 0; row <= last_row && cost_of(pose, 0, row) < best.cost; ++row) {
      const int first = row <= last_inside ? beside : 0;
      if (cost_of(pose, first, row) < best.cost) search_row(one, {row, first, last_column}, best);
      checkpoint(operations_a_searched_row);
    }
  }

  // Places from the first column to the last one.
  struct PlacesInRow {
    int row, first, last;
  };

  // Whether one of the places is free.
  bool search_row(const Searched& one, const PlacesInRow& places, Candidate& best) {
    double looks = 0;
    const int column = taken_.first_free(one.pose->footprint, places.row, places.first, places.last, looks);
    work_ += cost_of_row + cost_of_look * looks;
    if (column < 0) return false;
    const Cost cost = cost_of(*one.pose, column, places.row);
    if (cost < best.cost) best = {cost, one.number, Complex(column, places.row)};
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
    const auto row = [&](double at) { return std::clamp(static_cast<int>(at), 0, taken_.rows()); };
    std::fill(longest_free_.begin() + row(box.bottom - options_.gap),
              longest_free_.begin() + row(box.top + options_.gap + 2), unknown);
    still_.add(outline);
  }

  const double width_, height_;
  const ConstructionOptions& options_;
  TakenTexels taken_;
  Array<Hole> holes_;
  Array<int> longest_free_;  // (rows) texels of a row, as far as all reach
  StillOutlines still_;
  double used_width_ = 0, used_height_ = 0;
  double open_width_ = 0, open_height_ = 0;  // where bodies lie before it grows; at least what is used
  double class_extent_ = std::numeric_limits<double>::infinity(), class_area_ = class_extent_;
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

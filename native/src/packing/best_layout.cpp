// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/best_layout.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "packing/gaps.hpp"
#include "packing/layout_search.hpp"
#include "plane/aabb_tree.hpp"

namespace lsgp {

namespace {

// Of the side: what coordinates that have been packed and stored may be off.
constexpr double rounding = 1e-12;

// Whether bodies lie on blocks of which each belongs to one, as far as this can be told.
bool are_on_blocks(const Array<Body>& bodies, const UvRectangle& inside, double snap) {
  constexpr double nearly = 1e-9;  // of a block
  Array<std::pair<int, int>> taken;
  for (const Body& body : bodies) {
    if (body.keeps_place) return false;
    const Complex at = (body.origin - Complex(inside.left, inside.bottom)) / snap;
    const int column = static_cast<int>(std::lround(at.real())), row = static_cast<int>(std::lround(at.imag()));
    if (std::abs(at - Complex(column, row)) > nearly) return false;
    const Footprint footprint(body.outline.moved(1 / snap, 0));
    for (const Span& span : footprint.spans()) {
      for (int x = span.begin; x < span.end; ++x) taken.emplace_back(row + span.row, column + x);
    }
  }
  std::sort(taken.begin(), taken.end());
  return std::adjacent_find(taken.begin(), taken.end()) == taken.end();
}

// The layout as it is given.
class Given {
 public:
  Given(const Array<Body>& bodies, const PackingOptions& options) : bodies_(bodies), options_(options) {
    bool has_obstacles = false, has_own_scales = false;
    for (const Body& body : bodies) {
      has_obstacles |= body.keeps_place;
      has_own_scales |= body.keeps_scale && !body.keeps_place;
    }
    is_fixed_ = has_obstacles || options.snap > 0 || (options.fill && has_own_scales);
    inside_ = inside_margins(options, options.fill || has_obstacles || options.tiles > 1 || options.area.has_value());
    if (!is_fixed_ && options.tiles == 1) from_ = lowest_origin();
    for (const Body& body : bodies) {
      const Outline outline = body.outline.moved(1, body.origin - from_);
      tile_.push_back(body.keeps_place ? 0 : tile_of(outline.box()));
      if (tile_.back() < 0) return;
      outlines_.push_back(outline);
    }
    if (!is_fixed_) leave_out_empty_tiles();
    find_boxes();
    find_side();
  }

  // Without margins between bodies, by how much it has to be scaled down; 0: it is none.
  double side() const { return side_; }

  bool keeps_margins() const {
    for (int tile = 0; tile < options_.tiles; ++tile) {
      Array<Outline> in_tile;
      Outline obstacles;
      for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (bodies_[b].keeps_place && tile == 0) obstacles.append(outlines_[b]);
        if (!bodies_[b].keeps_place && tile_[b] == tile) in_tile.push_back(outlines_[b]);
      }
      in_tile.push_back(std::move(obstacles));
      if (!keep_gap(in_tile, 2 * options_.margin * unit())) return false;
    }
    return options_.snap == 0 || are_on_blocks(bodies_, inside_, options_.snap);
  }

  PackedLayout layout() const {
    PackedLayout out;
    out.side = side_;
    out.motions.resize(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (bodies_[b].keeps_place) continue;
      const Box& box = boxes_[tile_[b]];
      const Complex low(box.left, box.bottom), corner(inside_.left, inside_.bottom);
      const Complex shift = is_fixed_ ? bodies_[b].origin - corner_of_tile(tile_[b])
                                      : (bodies_[b].origin - from_ - low) / unit() + corner;
      out.motions[b] = {tile_[b], 1 / unit(), shift};
    }
    return out;
  }

 private:
  double unit() const { return options_.fill ? side_ : 1.0; }

  Complex lowest_origin() const {
    constexpr double most = std::numeric_limits<double>::infinity();
    double left = most, bottom = most;
    for (const Body& body : bodies_) {
      left = std::min(left, body.origin.real());
      bottom = std::min(bottom, body.origin.imag());
    }
    return {left, bottom};
  }

  // -1: it is in none.
  int tile_of(const Box& box) const {
    if (options_.tiles == 1) return 0;
    const double column = std::floor((box.left + box.right) / 2), row = std::floor((box.bottom + box.top) / 2);
    if (!(column >= 0 && column < tiles_in_row && row >= 0 && column + tiles_in_row * row < options_.tiles)) return -1;
    return static_cast<int>(column + tiles_in_row * row);
  }

  void leave_out_empty_tiles() {
    Array<int> number(options_.tiles, 0);
    for (const int tile : tile_) number[tile] = 1;
    int count = 0;
    for (int& used : number) used = used > 0 ? count++ : -1;
    for (int& tile : tile_) tile = number[tile];
  }

  void find_boxes() {
    constexpr double most = std::numeric_limits<double>::infinity();
    boxes_.assign(options_.tiles, Box{most, -most, most, -most});
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (!bodies_[b].keeps_place) boxes_[tile_[b]] = around(boxes_[tile_[b]], outlines_[b].box());
    }
  }

  void find_side() {
    double side = is_fixed_ ? 1 : 0;
    for (int tile = 0; tile < options_.tiles; ++tile) {
      const Box& box = boxes_[tile];
      if (box.left > box.right) continue;
      const Complex low = Complex(inside_.left, inside_.bottom) + corner_of_tile(tile);
      const Complex high = Complex(inside_.right, inside_.top) + corner_of_tile(tile);
      if (!is_fixed_) {
        side = std::max({side, (box.right - box.left) / (inside_.right - inside_.left),
                         (box.top - box.bottom) / (inside_.top - inside_.bottom)});
      } else if (box.left < low.real() - rounding || box.bottom < low.imag() - rounding ||
                 box.right > high.real() + rounding || box.top > high.imag() + rounding) {
        return;
      }
    }
    if (options_.fill || !options_.area || side <= 1) side_ = side;
  }

  const Array<Body>& bodies_;
  const PackingOptions& options_;
  UvRectangle inside_;
  bool is_fixed_ = false;    // nothing can be scaled
  Complex from_ = 0;         // where outlines lie from, so that they keep their digits far from the origin
  Array<Outline> outlines_;  // (bodies) where they lie
  Array<int> tile_;          // (bodies)
  Array<Box> boxes_;         // (tiles) around bodies
  double side_ = 0;
};

}  // namespace

std::optional<PackedLayout> best_layout(const Array<Body>& bodies, const PackingOptions& options, double unit,
                                        std::optional<double> side_of_quick, ProgressMonitor& monitor) {
  // What searches of less effort take of the progress of all, about as of the time: quick 0.03 to 0.1 of good with 10
  // to 100 islands and 0.3 with more, good 0.02 of best.
  constexpr double share_of_less = 0.05;
  std::optional<PackedLayout> best;
  double side = side_of_quick.value_or(std::numeric_limits<double>::infinity());
  std::optional<NoRoom> refused;
  std::optional<LayoutSearch> earlier;
  const auto begin = Budget::Clock::now();
  const auto last = static_cast<int>(options.effort);
  Array<PackingOptions> how(last + 1, options);
  for (int effort = side_of_quick ? 1 : 0; effort <= last; ++effort) {
    how[effort].effort = static_cast<PackingEffort>(effort);
    how[effort].seconds.reset();
    if (how[effort].effort == PackingEffort::best && options.seconds) {
      const double left = *options.seconds - std::chrono::duration<double>(Budget::Clock::now() - begin).count();
      if (left <= 0) break;
      how[effort].seconds = left;
    }
    const auto end_of = [&](int of) { return of < 0 ? 0.0 : std::pow(share_of_less, last - of); };
    const ProgressMonitor::Interval part(monitor, end_of(effort - 1), end_of(effort));
    try {
      LayoutSearch search(bodies, how[effort], unit, monitor);
      if (earlier) search.go_on_from(*earlier);
      PackedLayout found = search.best();
      if (found.side < (1 - rounding) * side) {
        side = found.side;
        best = std::move(found);
      }
      if (effort == static_cast<int>(PackingEffort::good)) earlier.emplace(std::move(search));
    } catch (NoRoom& error) {
      refused = std::move(error);
    }
  }
  const Given given(bodies, options);
  if (given.side() > 0 && given.side() < side && given.keeps_margins()) return given.layout();
  if (!best && !side_of_quick) throw *refused;
  return best;
}

}  // namespace lsgp

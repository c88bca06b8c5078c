// SPDX-License-Identifier: GPL-3.0-or-later
#include "island_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "arrays.hpp"

namespace py = pybind11;

namespace {

using Word = std::uint64_t;

constexpr int word_bits = 64;
constexpr Word all_ones = ~Word{0};

// Rows of bits, with zeros beyond.
class Bits {
 public:
  Bits(int rows, int columns)
      : words_(static_cast<std::size_t>(columns / word_bits) + 2), bits_(static_cast<std::size_t>(rows) * words_, 0) {}

  Word* row(int number) { return bits_.data() + static_cast<std::size_t>(number) * words_; }
  const Word* row(int number) const { return bits_.data() + static_cast<std::size_t>(number) * words_; }
  std::size_t words() const { return words_; }

  // The 64 bits from this column on.
  Word from(int row_number, int column) const {
    const Word* word = row(row_number) + column / word_bits;
    const int shift = column % word_bits;
    return word[0] >> shift | word[1] << 1 << (word_bits - 1 - shift);
  }

  void set(int row_number, int begin, int end) {
    Word* word = row(row_number);
    for (int column = begin; column < end;) {
      const int shift = column % word_bits, count = std::min(end - column, word_bits - shift);
      word[column / word_bits] |= all_ones >> (word_bits - count) << shift;
      column += count;
    }
  }

 private:
  std::size_t words_;
  std::vector<Word> bits_;
};

// In single precision, as xatlas computes.
struct Point {
  float x, y;
};
using Triangle = std::array<Point, 3>;

// Texels of a row, from `begin` up to `end`, of which 2^level, the most that is not more than they are, are looked up
// at once.
struct Span {
  int row, begin, end;
  std::size_t level;
};

std::size_t level_of(int length) {
  std::size_t level = 0;
  while (length >> (level + 1)) ++level;
  return level;
}

// An island as xatlas has it: each side stretched to whole texels.
struct Island {
  std::vector<Triangle> triangles;
  int width = 0, height = 0;

  // Returns false for one that is not smaller than a square with this side.
  bool stretch(int inside) {
    constexpr float most = std::numeric_limits<float>::max();
    Point low{most, most}, size{0, 0};
    for (const Triangle& triangle : triangles)
      for (const Point& corner : triangle) low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    for (Triangle& triangle : triangles) {
      for (Point& corner : triangle) {
        corner = {corner.x - low.x, corner.y - low.y};
        size = {std::max(size.x, corner.x), std::max(size.y, corner.y)};
      }
    }
    const Point whole{std::ceil(size.x), std::ceil(size.y)};
    if (!(std::max(whole.x, whole.y) < static_cast<float>(inside))) return false;
    width = static_cast<int>(whole.x);
    height = static_cast<int>(whole.y);
    const auto stretched = [](float at, float of, float to) { return of > 0 ? at / of * to : 0; };
    for (Triangle& triangle : triangles)
      for (Point& corner : triangle)
        corner = {stretched(corner.x, size.x, whole.x), stretched(corner.y, size.y, whole.y)};
    return true;
  }
};

// The texels that a triangle meets, widened along the rows.
void draw(const Triangle& triangle, int padding, Bits& texels) {
  std::array<std::array<double, 2>, 3> corner{};
  for (std::size_t k = 0; k < 3; ++k) corner[k] = {triangle[k].x + 0.5 + padding, triangle[k].y + 0.5 + padding};
  const auto [lowest, highest] = std::minmax({corner[0][1], corner[1][1], corner[2][1]});
  for (int row = static_cast<int>(lowest); row < highest; ++row) {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& tail = corner[k];
      const auto& head = corner[(k + 1) % 3];
      const double below = std::max(std::min(tail[1], head[1]), static_cast<double>(row));
      const double above = std::min(std::max(tail[1], head[1]), row + 1.0), rise = head[1] - tail[1];
      if (below > above) continue;
      for (const double share : {rise == 0 ? 0 : (below - tail[1]) / rise, rise == 0 ? 1 : (above - tail[1]) / rise}) {
        const double x = tail[0] + share * (head[0] - tail[0]);
        left = std::min(left, x);
        right = std::max(right, x);
      }
    }
    if (left < right) texels.set(row, static_cast<int>(left) - padding, static_cast<int>(std::ceil(right)) + padding);
  }
}

// The texels that an island takes with its padding, the longest spans first: these rule out most places.
std::vector<Span> spans_of(const Island& island, int padding) {
  const int width = island.width + 1 + 2 * padding, height = island.height + 1 + 2 * padding;
  Bits texels(height, width);
  for (const Triangle& triangle : island.triangles) draw(triangle, padding, texels);
  std::vector<Span> spans;
  std::vector<Word> taken(texels.words());
  for (int row = 0; row < height; ++row) {
    std::fill(taken.begin(), taken.end(), 0);
    for (int other = std::max(row - padding, 0); other <= std::min(row + padding, height - 1); ++other)
      for (std::size_t k = 0; k < taken.size(); ++k) taken[k] |= texels.row(other)[k];
    int begin = -1;
    for (int column = 0; column <= width; ++column) {
      const bool is_taken = taken[static_cast<std::size_t>(column / word_bits)] >> (column % word_bits) & 1;
      if (is_taken && begin < 0) begin = column;
      if (is_taken || begin < 0) continue;
      spans.push_back({row, begin, column, level_of(column - begin)});
      begin = -1;
    }
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.end - a.begin > b.end - b.begin; });
  return spans;
}

// The texels of the square that are taken, and, level by level, whether any of the 1, 2, 4, … from one on is.
class Square {
 public:
  explicit Square(int side) : side_(side), levels_(level_of(side) + 1, Bits(side, 2 * side)) {}

  void take(const std::vector<Span>& spans, int x, int y) {
    for (const Span& span : spans) levels_[0].set(y + span.row, x + span.begin, x + span.end);
    for (std::size_t level = 1; level < levels_.size(); ++level) {
      const Bits& half = levels_[level - 1];
      const int step = 1 << (level - 1);
      for (const Span& span : spans) {
        Word* row = levels_[level].row(y + span.row);
        for (int column = 0; column < side_; column += word_bits)
          row[column / word_bits] = half.from(y + span.row, column) | half.from(y + span.row, column + step);
      }
    }
  }

  // The first column in which an island can lie, or one after `last`.
  int first_free(const std::vector<Span>& spans, int y, int column, int last) const {
    for (; column <= last; column += word_bits) {
      Word taken = 0;
      for (const Span& span : spans) {
        const Bits& any = levels_[span.level];
        const int row = y + span.row, from = column + span.begin, until = column + span.end;
        taken |= any.from(row, from) | any.from(row, until - (1 << span.level));
        if (taken == all_ones) break;
      }
      if (taken == all_ones) continue;
      while (taken & 1) {
        taken >>= 1;
        ++column;
      }
      return column;
    }
    return last + 1;
  }

 private:
  int side_;
  std::vector<Bits> levels_;
};

// Islands one by one, the largest first, each where the square around all of them grows least.
bool fit(std::vector<Island>& islands, int inside, int padding) {
  if (islands.empty()) return true;
  for (Island& island : islands) {
    if (!island.stretch(inside)) return false;
  }
  const auto extent = [&](std::size_t k) { return islands[k].width + islands[k].height; };
  std::vector<std::size_t> order(islands.size());
  std::iota(order.rbegin(), order.rend(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return extent(a) > extent(b); });
  const int most = extent(order.front()), least = extent(order.back());
  constexpr float buckets = 16;
  const float bucket_size = static_cast<float>(most - least) / buckets;
  int bucket = 0, width = 0, height = 0, start_x = 0, start_y = 0;
  const int side = inside + 2 * padding;
  Square square(side);
  for (const std::size_t number : order) {
    const Island& island = islands[number];
    const std::vector<Span> spans = spans_of(island, padding);
    const int across = island.width + 1 + 2 * padding, up = island.height + 1 + 2 * padding;
    // Places before that of the last island are looked at again only for a much smaller one, or once the square grew.
    if (extent(number) > least &&
        static_cast<float>(extent(number)) <= static_cast<float>(most) - bucket_size * static_cast<float>(bucket + 1)) {
      start_x = start_y = 0;
      ++bucket;
    }
    int best_cost = std::numeric_limits<int>::max(), best_x = 0, best_y = 0;
    for (int y = start_y; y <= std::min(height + 1, side - up); ++y) {
      const int last = std::min(width + 1, side - across);
      const int x = square.first_free(spans, y, y == start_y ? start_x : 0, last);
      if (x > last) continue;
      const int wide = std::max(width, x + across), high = std::max(height, y + up);
      const int cost = std::max(wide, high) * std::max(wide, high) + wide * high;
      if (cost > best_cost || (cost == best_cost && std::max(x, y) >= std::max(best_x, best_y))) continue;
      best_cost = cost;
      best_x = x;
      best_y = y;
      if (wide == width && high == height) break;
    }
    if (best_cost == std::numeric_limits<int>::max()) return false;
    square.take(spans, best_x, best_y);
    const bool grows = best_x + across > width || best_y + up > height;
    start_x = grows ? 0 : best_x;
    start_y = grows ? 0 : best_y;
    width = std::max(width, best_x + across);
    height = std::max(height, best_y + up);
  }
  return true;
}

// Whether xatlas, which takes ten times as long, finds a place for all islands; rounding aside, it always agrees.
// corners: (t, 3, 2), in texels. island: (t), those of one island one after another. inside: texels of the square
// without its margin. padding: texels around each island.
bool islands_fit(const Numbers& corners, const Vertices& island, int inside, int padding) {
  constexpr int most_texels = 1 << 14;  // of a side: a square of them takes 1 GB
  const View<double, 3> place("corners", corners, {any_length, 3, 2});
  const View<std::int32_t, 1> owner("island", island, {place.length()});
  place.require_finite();
  if (inside < 0 || padding < 0 || inside > most_texels || padding > (most_texels - inside) / 2) {
    refuse("WRONG_PARAMETER", "The square has " + std::to_string(inside) + " texels inside a padding of " +
                                  std::to_string(padding) + "; pass numbers from 0, up to " +
                                  std::to_string(most_texels) + " together.");
  }
  // Beyond single precision nothing fits.
  constexpr double most = std::numeric_limits<float>::max();
  if (std::any_of(place.begin(), place.end(), [](double at) { return std::abs(at) > most; })) return false;
  std::vector<Island> islands;
  for (py::ssize_t t = 0; t < owner.length(); ++t) {
    if (t == 0 || owner(t) != owner(t - 1)) islands.emplace_back();
    Triangle triangle{};
    for (py::ssize_t k = 0; k < 3; ++k)
      triangle[static_cast<std::size_t>(k)] = {static_cast<float>(place(t, k, 0)), static_cast<float>(place(t, k, 1))};
    islands.back().triangles.push_back(triangle);
  }
  const py::gil_scoped_release without_gil;
  return fit(islands, inside, padding);
}

}  // namespace

void define_island_fit(py::module_& module) {
  using py::literals::operator""_a;
  module.def("islands_fit", &islands_fit, "corners"_a, "island"_a, "inside"_a, "padding"_a);
}

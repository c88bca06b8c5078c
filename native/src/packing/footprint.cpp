// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/footprint.hpp"

#include <cmath>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

int level_of(int length) {
  int level = 0;
  while (length >> (level + 1)) ++level;
  return level;
}

}  // namespace

Footprint::Footprint(const Outline& outline) {
  const Box box = outline.box();
  BitRows raster(static_cast<int>(std::floor(box.top)) + 1, static_cast<int>(std::floor(box.right)) + 1);
  draw(outline, 0, raster);
  for (int row = 0; row < raster.rows(); ++row) {
    const int columns = raster.columns();
    for (int begin = raster.next(true, row, 0, columns); begin < columns;) {
      const int end = raster.next(false, row, begin, columns);
      spans_.push_back({row, begin, end, level_of(end - begin)});
      begin = raster.next(true, row, end, columns);
    }
  }
  std::stable_sort(spans_.begin(), spans_.end(),
                   [](const Span& a, const Span& b) { return a.end - a.begin > b.end - b.begin; });
}

TakenTexels::TakenTexels(int rows, int columns)
    // As many columns again are free, so that what reaches beyond the raster need not be told apart.
    : levels_(level_of(columns) + 1, BitRows(rows, 2 * columns + 2 * BitRows::word_bits)) {}

int TakenTexels::longest_free(int row, int end) const {
  int longest = 0;
  for (int begin = 0, taken = 0; taken < end; begin = taken) {
    begin = levels_[0].next(false, row, begin, end);
    taken = levels_[0].next(true, row, begin, end);
    longest = std::max(longest, taken - begin);
  }
  return longest;
}

void TakenTexels::take(const Outline& outline, double reach) {
  const Box box = outline.box();
  draw(outline, reach, levels_[0]);
  const int first = std::max(static_cast<int>(std::floor(box.bottom - reach)), 0);
  const int end = std::min(static_cast<int>(std::ceil(box.top + reach)) + 1, rows());
  const int last_word =
      std::min(static_cast<int>(std::max(box.right + reach, 0.0)) + 1, levels_[0].columns() / 2) / BitRows::word_bits;
  for (int level = 1; level < static_cast<int>(levels_.size()); ++level) {
    const BitRows& half = levels_[level - 1];
    const int step = 1 << (level - 1);
    const int first_word =
        std::max(static_cast<int>(std::max(box.left - reach, 0.0)) - 2 * step, 0) / BitRows::word_bits;
    for (int row = first; row < end; ++row) {
      for (int word = first_word; word <= last_word; ++word) {
        levels_[level].row(row)[word] =
            half.from(row, word * BitRows::word_bits) | half.from(row, word * BitRows::word_bits + step);
      }
    }
    checkpoint(2.0 * std::max(end - first, 0) * std::max(last_word - first_word, 0));
  }
}

}  // namespace lsgp

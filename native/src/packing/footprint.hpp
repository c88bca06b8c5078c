// SPDX-License-Identifier: GPL-3.0-or-later
// The texels that an island takes, and the raster in which free places are looked for.
#pragma once

#include "base/array.hpp"
#include "packing/bit_rows.hpp"
#include "packing/outline.hpp"

namespace lsgp {

// Texels of a row, from `begin` up to `end`; 2^level is the greatest power of two that is not more than they are.
struct Span {
  int row, begin, end, level;
};

// The texels that an outline touches, the longest spans first: these rule out most places.
class Footprint {
 public:
  // outline: in texels, its box with the low corner at the origin.
  explicit Footprint(const Outline& outline);

  const Array<Span>& spans() const { return spans_; }

 private:
  Array<Span> spans_;
};

// The texels that are taken and, level by level, whether any of the 1, 2, 4, ... from one on is.
class TakenTexels {
 public:
  TakenTexels(int rows, int columns);

  int rows() const { return levels_[0].rows(); }

  // How many texels of a row in a sequence are free at most, of those before `end`.
  int longest_free(int row, int end) const;

  // Takes what lies less than `reach` from an outline, in texels.
  void take(const Outline& outline, double reach);

  // The first column from `begin` to `last` in which a footprint is free in a row; -1 where there is none.
  // looks: counts the spans that are looked up.
  int first_free(const Footprint& footprint, int row, int begin, int last, double& looks) const {
    for (int column = begin; column <= last; column += BitRows::word_bits) {
      BitRows::Word taken = 0;
      int looked = 0;
      for (const Span& span : footprint.spans()) {
        ++looked;
        const BitRows& any = levels_[span.level];
        taken |= any.from(row + span.row, column + span.begin);
        taken |= any.from(row + span.row, column + span.end - (1 << span.level));
        if (taken == BitRows::all_ones) break;
      }
      looks += looked;
      if (taken == BitRows::all_ones) continue;
      column += first_bit(~taken);
      return column <= last ? column : -1;
    }
    return -1;
  }

 private:
  Array<BitRows> levels_;
};

}  // namespace lsgp

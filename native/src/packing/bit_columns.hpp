// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters of one bit per texel that are compared with others at any place.
#pragma once

#include <cstddef>
#include <cstdint>

#include "packing/bit_rows.hpp"

namespace lsgp {

// Words of 64 texels of a row; those of one column of words follow each other, so that many rows are compared at once.
class BitColumns {
 public:
  using Word = BitRows::Word;
  static constexpr int word_bits = BitRows::word_bits;

  explicit BitColumns(const BitRows& rows);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int words() const { return words_; }  // of a row that have columns
  // (rows) number: from -1, as there is a column of empty words before the first and behind the last.
  const Word* column(int number) const { return bits_.data() + (number + 1) * std::ptrdiff_t{rows_}; }

 private:
  int rows_, columns_, words_;
  Array<Word> bits_;
};

struct TexelShift {
  int right, up;
};

// The number of texels that are set in both, or more than `most` if that is less.  shift: by which the second lies
// further.  words: the pairs of words that were compared are added.
int shared_bits(const BitColumns& a, const BitColumns& b, TexelShift shift, int most, std::ptrdiff_t& words);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters of one bit per texel, 64 of a row at once, and the texels that outlines touch.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/array.hpp"
#include "packing/outline.hpp"

namespace lsgp {

// How many bits are set of each eight, in as many bytes: pairs and fours of bits added up.
inline std::uint64_t bits_of_bytes(std::uint64_t word) {
  constexpr std::uint64_t twos = 0x5555555555555555, fours = 0x3333333333333333, bytes = 0x0f0f0f0f0f0f0f0f;
  word -= word >> 1 & twos;
  word = (word & fours) + (word >> 2 & fours);
  return (word + (word >> 4)) & bytes;
}

// What all processors have, and as fast as their instruction if most words are 0.
inline int bit_count(std::uint64_t word) {
  constexpr std::uint64_t ones = 0x0101010101010101;
  return word == 0 ? 0 : static_cast<int>(bits_of_bytes(word) * ones >> 56);
}

// The number of the first bit that is set; 64: none is.
inline int first_bit(std::uint64_t word) { return bit_count(~word & (word - 1)); }

class BitRows {
 public:
  using Word = std::uint64_t;
  static constexpr int word_bits = 64;
  static constexpr Word all_ones = ~Word{0};

  BitRows(int rows, int columns)
      : rows_(rows), columns_(columns), words_(columns / word_bits + 2), bits_(rows * std::ptrdiff_t{words_}, 0) {}

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int words() const { return words_; }  // of a row, one of them beyond its columns
  Word* row(int number) { return bits_.data() + number * std::ptrdiff_t{words_}; }
  const Word* row(int number) const { return bits_.data() + number * std::ptrdiff_t{words_}; }

  // The 64 bits from a column on.
  Word from(int row_number, int column) const {
    const Word* word = row(row_number) + column / word_bits;
    const int shift = column % word_bits;
    return word[0] >> shift | word[1] << 1 << (word_bits - 1 - shift);
  }

  bool is_set(int row_number, int column) const { return from(row_number, column) & 1; }

  // The first column from this one on that is set, or is not; `end` if there is none before.
  int next(bool is_set, int row_number, int column, int end) const {
    while (column < end) {
      const Word found = is_set ? from(row_number, column) : ~from(row_number, column);
      if (found != 0) return std::min(column + first_bit(found), end);
      column += word_bits;
    }
    return end;
  }

  // Sets the columns from begin up to end, as far as there are such.
  void set(int row_number, int begin, int end) {
    begin = std::max(begin, 0);
    end = std::min(end, columns_);
    Word* word = row(row_number);
    while (begin < end) {
      const int shift = begin % word_bits, count = std::min(end - begin, word_bits - shift);
      word[begin / word_bits] |= all_ones >> (word_bits - count) << shift;
      begin += count;
    }
  }

  friend bool operator==(const BitRows& a, const BitRows& b) {
    return a.rows_ == b.rows_ && a.columns_ == b.columns_ && a.bits_ == b.bits_;
  }

 private:
  int rows_, columns_, words_;
  Array<Word> bits_;
};

// Sets the texels, squares of side 1, that contain a point less than `reach` from the outline or its inside; or, with
// reach 0, a point of these. What lies beyond the raster is left out.
void draw(const Outline& outline, double reach, BitRows& raster);

}  // namespace lsgp

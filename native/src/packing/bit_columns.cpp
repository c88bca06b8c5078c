// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/bit_columns.hpp"

#include <algorithm>

#include "packing/bit_kernels.hpp"

namespace lsgp {

namespace {

int floor_divided(int number, int by) { return number >= 0 ? number / by : -((by - 1 - number) / by); }

}  // namespace

BitColumns::BitColumns(const BitRows& rows)
    : rows_(rows.rows()),
      columns_(rows.columns()),
      words_((rows.columns() + word_bits - 1) / word_bits),
      bits_((words_ + 2) * std::ptrdiff_t{rows_}, 0) {
  for (int y = 0; y < rows_; ++y) {
    for (int k = 0; k < words_; ++k) bits_[(k + 1) * std::ptrdiff_t{rows_} + y] = rows.row(y)[k];
  }
}

int shared_bits(const BitColumns& a, const BitColumns& b, TexelShift shift, int most, std::ptrdiff_t& words) {
  const auto [right, up] = shift;
  const int first = std::max(floor_divided(right, BitColumns::word_bits), 0);
  const int end = std::min(floor_divided(right + b.columns() - 1, BitColumns::word_bits) + 1, a.words());
  const int top = std::min(a.rows(), up + b.rows());
  static const SharedBitsOfWords shared = kernels_of_shared_bits().front();
  int count = 0;
  for (int y = std::max(up, 0); y < top && count <= most; y += most_words_at_once) {
    const int rows = std::min(top - y, most_words_at_once);
    for (int k = first; k < end; ++k) {
      const int from = k * BitColumns::word_bits - right;
      const int number = floor_divided(from, BitColumns::word_bits);
      count += shared(a.column(k) + y, b.column(number) + y - up, b.column(number + 1) + y - up,
                      from - number * BitColumns::word_bits, rows);
    }
    words += std::ptrdiff_t{rows} * std::max(end - first, 0);
  }
  return count;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/radix_order.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <numeric>

namespace lsgp {

Array<Index> radix_order(const Array<double>& numbers) {
  constexpr int digit_bits = 11, key_bits = 64;
  constexpr std::size_t digits = std::size_t{1} << digit_bits;
  struct Entry {
    std::uint64_t key;  // the bits of a number that is not negative are in its order
    Index place;
  };
  Array<Entry> entries(numbers.size()), sorted(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::memcpy(&entries[i].key, &numbers[i], sizeof(double));
    entries[i].place = static_cast<Index>(i);
  }
  for (int shift = 0; shift < key_bits; shift += digit_bits) {
    const auto digit = [&](const Entry& entry) { return static_cast<std::size_t>(entry.key >> shift) % digits; };
    std::array<Index, digits + 1> begin{};
    for (const Entry& entry : entries) ++element(begin, digit(entry) + 1);
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const Entry& entry : entries) sorted[element(begin, digit(entry))++] = entry;
    entries.swap(sorted);
  }
  Array<Index> out(numbers.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = entries[i].place;
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of an input, read as numbers and choices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "lsgp/surface.hpp"

// One byte after the other, zeros after their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  int byte() { return at_ == end_ ? 0 : *at_++; }
  int below(int count) { return byte() % count; }
  bool once_in(int count) { return below(count) == count - 1; }

  template <typename Choice>
  Choice choice(int count) {
    return static_cast<Choice>(below(count));
  }

  // Mostly plain numbers near 0, some extreme, some that are none.
  double number() {
    const int kind = byte();
    if (kind < 0xe0) return (kind - 0x70) / 16.0;
    constexpr double special[] = {1e-300, 1e-30, 1e-12, 1e-7, 1e7, 1e30, 1e150, 1e300};
    if (kind < 0xf8) return special[kind & 7] * (byte() - 127.5);
    if (kind < 0xfc) return std::numeric_limits<double>::denorm_min();
    return kind == 0xff ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  }

  // A number below count, rarely one outside the range.
  lsgp::Index index(Eigen::Index count) {
    const auto limit = static_cast<lsgp::Index>(count);
    const int value = byte();
    if (value == 0xff) return -1;
    return value == 0xfe || limit == 0 ? limit + byte() : value % limit;
  }

 private:
  const std::uint8_t *at_, *end_;
};

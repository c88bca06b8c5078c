// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/array.hpp"

namespace lsgp {

// The least of these that at least one in four does not exceed. values: not empty.
template <typename Values>
double lower_quartile(const Values& values) {
  Array<double> sorted(values.begin(), values.end());
  const auto at = sorted.begin() + (ssize(sorted) - 1) / 4;
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace lsgp

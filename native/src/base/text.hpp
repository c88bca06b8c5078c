// SPDX-License-Identifier: GPL-3.0-or-later
// Text helpers for errors and findings.
#pragma once

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>
#include <string>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Concatenates the arguments; numbers have six digits and a decimal point in every locale.
template <typename... Parts>
std::string concat(const Parts&... parts) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.exceptions(std::ios_base::badbit);  // otherwise the stream would swallow std::bad_alloc
  (out << ... << parts);
  return out.str();
}

template <typename Integer>
std::string count(Integer n, const char* one, const char* many) {
  return concat(n, " ", n == 1 ? one : many);
}

// A number with a few significant digits.
inline std::string rounded(double value, int digits = 4) {
  if (value == 0 || !std::isfinite(value)) return concat(value);
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - (digits - 1));
  return std::isfinite(unit) && unit > 0 ? concat(std::round(value / unit) * unit) : concat(value);
}

// An angle in degrees, rounded so that noise around whole degrees disappears.
inline std::string degrees(double radians) {
  constexpr double parts = 1e4;  // of a degree
  const double shown = std::round(radians * 180 / M_PI * parts) / parts;
  return concat(shown == 0 ? 0.0 : shown, " degrees");
}

// A factor given by its natural logarithm; above a million written as a power of ten.
inline std::string factor(double log) {
  constexpr double millions = 6;  // digits
  const double power = log / std::log(10.0);
  return power < millions ? rounded(std::exp(log), 3) : concat("10^", std::round(power));
}

// The first few indices, with an ellipsis if there are more.
inline std::string list(const std::vector<Index>& indices) {
  constexpr std::size_t shown = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(shown, indices.size()); ++i) out += concat(i ? ", " : "", indices[i]);
  return indices.size() > shown ? out + ", ..." : out;
}

}  // namespace lsgp

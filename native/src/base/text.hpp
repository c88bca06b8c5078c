// SPDX-License-Identifier: GPL-3.0-or-later
// Text helpers for errors and findings.
#pragma once

#include <algorithm>
#include <locale>
#include <sstream>
#include <string>

#include "base/array.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// Everything written one after the other, numbers with six digits and a point whatever the locale.
template <typename... Parts>
std::string concat(const Parts&... parts) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.exceptions(std::ios_base::badbit);  // a stream would keep it to itself when memory ends
  (out << ... << parts);
  return out.str();
}

template <typename Integer>
std::string count(Integer n, const char* one, const char* many) {
  return concat(n, " ", n == 1 ? one : many);
}

// The first few indices, and that there are more.
inline std::string list(const std::vector<Index>& indices) {
  constexpr std::size_t shown = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(shown, indices.size()); ++i) out += concat(i ? ", " : "", indices[i]);
  return indices.size() > shown ? out + ", ..." : out;
}

}  // namespace lsgp

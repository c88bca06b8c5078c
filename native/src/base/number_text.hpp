// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in the words of a trace.
#pragma once

#include <iomanip>
#include <locale>
#include <sstream>
#include <string>

namespace lsgp {

// With so many significant digits at most, as a power of ten where it is large.
inline std::string significant(double value, int digits) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(digits) << value;
  return out.str();
}

// With so many digits after the point.
inline std::string decimals(double value, int digits) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/conditions.hpp"

#include <cmath>

#include "base/text.hpp"
#include "lsgp/errors.hpp"

namespace lsgp {

void require_few_conditions(double conditions, const std::string& what, const std::string& unit) {
  if (conditions <= most_conditions) return;
  constexpr double giga = 1e9;
  const double operations = operations_of_conditions * conditions * conditions * conditions;
  const double bytes = bytes_of_conditions * conditions * conditions;
  throw Error(Code::solver_failed,
              concat(what, " ", std::ceil(conditions), " ", unit, ", which would take some ",
                     rounded(operations / giga, 2), " billion multiplications and ", rounded(bytes / giga, 2),
                     " GB of memory; the limit is ", most_conditions, " ", unit,
                     ". Cut it into components with fewer handles along seams, "
                     "or use fewer cones."));
}

}  // namespace lsgp

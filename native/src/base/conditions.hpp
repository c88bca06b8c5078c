// SPDX-License-Identifier: GPL-3.0-or-later
// Limits of dense systems, whose work grows with the cube of their size.
#pragma once

#include <string>

namespace lsgp {

// Conditions of a dense system: automatic cones of one component, or lattice points of its layout. A quadratic program
// of 2,000 takes seconds and 0.2 GB, and some ten of them are solved for one choice of cones.
constexpr double most_conditions = 2048;
// Multiplications, by the cube of the number of conditions, and bytes, by its square.
constexpr double operations_of_conditions = 40, bytes_of_conditions = 48;

// Throws SOLVER_FAILED, with both estimates and the limit, for more than `most_conditions`. It is called before
// anything that grows with them is begun.  what: "The curvature of this component takes", for instance.  unit: of the
// conditions.
void require_few_conditions(double conditions, const std::string& what, const std::string& unit);

}  // namespace lsgp

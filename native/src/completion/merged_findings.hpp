// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "lsgp/errors.hpp"

namespace lsgp {

// Findings of placement, and then those of a map, without what both say.
std::vector<Finding> merged(std::vector<Finding> of_placement, const std::vector<Finding>& of_map);

}  // namespace lsgp

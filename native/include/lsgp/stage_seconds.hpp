// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lsgp {

// The stages of a call in the order in which they began, and the wall-clock time of each.
using StageSeconds = std::vector<std::pair<std::string, double>>;

}  // namespace lsgp

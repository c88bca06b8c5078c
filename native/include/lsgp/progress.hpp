// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace lsgp {

// Called at intervals from the calling thread with the fraction done, 0 to 1, never less than before. Returns whether
// to continue; if not, the function throws CANCELLED.
using Progress = std::function<bool(double done)>;

}  // namespace lsgp

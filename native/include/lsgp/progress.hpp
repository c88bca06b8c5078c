// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace lsgp {

// Called now and then from the calling thread with how much is done, 0 to 1, never less than before. Returns whether
// to go on; if not, the verb throws CANCELLED.
using Progress = std::function<bool(double done)>;

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// The queue of searches that go on from what is nearest.
#pragma once

#include <functional>
#include <queue>

#include "base/array.hpp"

namespace lsgp {

// A queue whose top is its least entry.
template <typename Entry>
using LeastFirst = std::priority_queue<Entry, Array<Entry>, std::greater<>>;

}  // namespace lsgp

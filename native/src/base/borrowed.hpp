// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace lsgp {

// What a constructor takes to keep a reference to it: it has to live longer than the object. Does not take temporaries.
template <typename T>
using Borrowed = std::reference_wrapper<T>;

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// The words for artists of what solvers and memory checks report by cause.
#pragma once

#include "lsgp/errors.hpp"

namespace lsgp {

// The error with a message that names a remedy. Messages of other errors have one already and stay.
Error in_words(const Error& error);

}  // namespace lsgp

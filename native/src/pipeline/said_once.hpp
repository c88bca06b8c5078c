// SPDX-License-Identifier: GPL-3.0-or-later
// Findings of all components together.
#pragma once

#include "lsgp/errors.hpp"

namespace lsgp {

// A finding that says how many elements it concerns and nothing else about them: DEGENERATE_FACES, CONE_ON_BOUNDARY.
Finding counted(Code code, Elements elements);

// Joins the findings of several components that say the same, or the same of other numbers of elements, at the place of
// the first. A surface of a thousand components would otherwise repeat a sentence a thousand times.
void say_once(std::vector<Finding>& findings);

}  // namespace lsgp

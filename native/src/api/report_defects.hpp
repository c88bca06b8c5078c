// SPDX-License-Identifier: GPL-3.0-or-later
// Names what is wrong with a result.
#pragma once

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"

namespace lsgp {

// Elements at which a result is less exact than it should be, in the caller's numbering.
struct InexactElements {
  Array<Index> seams;   // vertex pairs
  Array<Index> angles;  // vertices
};

// Sorts the lists of defects of a result and adds a warning for each that is not empty.
void report_defects(const Options& options, InexactElements inexact, Result& result);

}  // namespace lsgp

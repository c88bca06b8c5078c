// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the defects of a result.
#pragma once

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "lsgp/result.hpp"

namespace lsgp {

// Defects that are not listed in a result, in the caller's numbering.
struct Defects {
  Array<Index> inexact_seams;   // vertex pairs
  Array<Index> inexact_angles;  // vertices
  Array<Index> on_own_face;     // ascending triangles that overlap others of their face, none of them flipped
  bool pinned = false;          // whether an island has several pins, so that it is not split
};

// Sorts the lists of defects of a result and adds a warning for each that is not empty.
void report_defects(const Options& options, Defects found, Result& result);

}  // namespace lsgp

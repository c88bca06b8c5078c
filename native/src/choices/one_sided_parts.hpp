// SPDX-License-Identifier: GPL-3.0-or-later
// One-sided components, such as Moebius bands, before they are mapped: cut open, they have two sides.
#pragma once

#include "lsgp/result.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

struct OpenedParts {
  VertexPairs ends;              // edges at which one-sided components end, so that they have two sides
  std::vector<Index> triangles;  // of these components
};

// Where components are to end that are one-sided also if they are opened along their seams. They stay one-sided if
// edges that may not be cut make them so.
OpenedParts ends_of_one_sided_parts(const Surface& surface);

// What the caller is told of it.
void tell_opened(const OpenedParts& opened, Result& result);

}  // namespace lsgp

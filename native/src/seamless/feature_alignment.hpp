// SPDX-License-Identifier: GPL-3.0-or-later
// Maps whose features run along the axes, before any lattice (Bommes, Zimmer and Kobbelt 2009, section 4: alignment
// constraints).
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "lsgp/result.hpp"
#include "repair/feature_lines.hpp"
#include "seamless/feature_task.hpp"

namespace lsgp {

// The same for lattices of any size.
struct FeatureAlignment {
  Array<FeatureLine> lines;
  Eigen::VectorXcd start;              // (copies) the map with these lines along the axes; empty without any
  PerHalfedge<ReleaseReason> reasons;  // of the others; meaningless without features
};

struct AlignmentBounds {
  double most_l2;           // stretch that features may cost
  double least_of_creases;  // share of their length: where nothing is marked and fewer can run along the axes, none do
  double least_common;      // share of their length that turns the map, of which less is chance
};

// feature: the FeatureKind of halfedges.  start: (copies) a valid map of the surface's area, without a lattice. As many
// as possible run along the axes, marked ones before others, those of least cost first.
FeatureAlignment align_with_axes(const FeatureTask& task, const PerHalfedge<char>& feature,
                                 const Eigen::VectorXcd& start, const AlignmentBounds& bounds);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of lines of features that run along the axes of one map: their length, and the release of edges where they fail.
#pragma once

#include <utility>

#include "base/array.hpp"
#include "lsgp/result.hpp"
#include "mesh/geometry.hpp"
#include "repair/feature_lines.hpp"
#include "repair/line_constraints.hpp"

namespace lsgp {

// Of marked lines, and of the others.
std::pair<double, double> length_of(const Array<FeatureLine>& lines);
double total_length(const Array<FeatureLine>& lines);

DirectedEdges edges_of(const Array<FeatureLine>& lines);

// Corners that a curved line would get are the reason why it cannot be aligned.
void release(Index h, ReleaseReason reason, PerHalfedge<ReleaseReason>& reasons);

// Where lines could not be aligned.
struct LineFailure {
  Array<Index> vertices;
  bool is_of_lines = false;  // releasing their edges there has not helped
};

// Whether releasing edges at these vertices can help.
bool are_few(const Array<Index>& vertices, const HalfedgeMesh& mesh);

// Releases the edges of lines, or the whole lines, at vertices where they failed, or where no line is, at vertices near
// these; whether there are any, and others left. No distance between cones follows from what is left of a line.
// released: gets the edges, if wanted.
bool trim(const MetricMesh& surface, const LineFailure& failure, Array<FeatureLine>& lines,
          Array<FeatureLine>* released);

}  // namespace lsgp

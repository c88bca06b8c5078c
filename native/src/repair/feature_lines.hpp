// SPDX-License-Identifier: GPL-3.0-or-later
// Features in a layout, marked edges and creases of hard surfaces, and the axes along which they nearly run.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"

namespace lsgp {

// Edges of a feature from one corner, junction or cone to the next; a line that bends from one axis to the other has a
// corner in the middle of the bend.
struct FeatureLine {
  Array<Index> halfedges;     // one of each edge
  Array<Complex> directions;  // the axis of each in the layout: 1, i, -1 or -i
  double bend = 0;            // root mean square of the edges' angles to it, radians
  double length = 0;          // on the surface
  bool is_marked = false;
  bool is_whole = true;     // none of its edges is released
  bool comes_last = false;  // among lines that are as marked: between both axes, or part of a line that turns
};

struct FeatureLines {
  Array<FeatureLine> straight;  // edges are nearer to one axis than to the other; marked ones first, then those that
                                // come last, then by cost, the square of the bend times the length
  Array<Index> curved;          // halfedges of the lines that are divided into parts, and of those between both axes
};

// The rotation of a layout that aligns its features, marked ones if there are any, with the axes in the least squares
// sense, or exactly, if most of their length has the same direction.  feature: the FeatureKind of halfedges.
// least_common: where less of their length has a direction in common, as on circles, the result is 1.
Complex turn_to_features(const CutSurface& surface, const PerHalfedge<char>& feature, const Eigen::VectorXcd& position,
                         double least_common = 0);

// What axes lines get, and where they end.
enum class LineReading {
  nearest,  // the axis nearest to each line
  opened,   // another one where lines beside each other at a vertex would have the same axis and direction
  divided,  // and lines end where they turn at junctions of marked edges, those of borders included
  whole,    // one axis for each line however it turns, the nearest to its mean direction
};

// ends: vertices at which lines end in addition, (n).
FeatureLines trace_features(const CutSurface& surface, const PerHalfedge<char>& feature, const PerVertex<char>& ends,
                            const Eigen::VectorXcd& position, LineReading reading = LineReading::nearest);

}  // namespace lsgp

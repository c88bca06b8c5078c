// SPDX-License-Identifier: GPL-3.0-or-later
// The creases of a hard surface in a layout, and the axes along which they nearly run.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"

namespace lsgp {

// Edges of a crease from one corner, junction or cone to the next.
struct FeatureLine {
  Array<Index> halfedges;     // one of each edge
  Array<Complex> directions;  // the axis of each in the layout: 1, i, -1 or -i
  double bend;                // root mean square of the edges' angles to it, radians
  double length;              // on the surface
};

// The rotation of a layout that aligns its features with the axes in the least squares sense.
Complex turn_to_features(const CutSurface& surface, const PerHalfedge<char>& feature, const Eigen::VectorXcd& position);

// Lines whose edges are nearer to one axis than to the other; those of least cost first, the square of the bend times
// the length.  ends: vertices at which lines end in addition, (n).
Array<FeatureLine> trace_features(const CutSurface& surface, const PerHalfedge<char>& feature,
                                  const PerVertex<char>& ends, const Eigen::VectorXcd& position);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Parts bounded by marked seams that are no disks, and the cuts that they lack.
#pragma once

#include <vector>

#include "base/array.hpp"
#include "pipeline/components.hpp"
#include "prescription/component_system.hpp"

namespace lsgp {

// Halfedges, one of each edge besides marked seams whose cutting leaves a component, opened along its seams, as a disk
// but for holes about which its metric nearly turns once: cuts from boundary to boundary, and loops that open handles.
// None of a closed component without handles, which needs no particular cut.
Array<Index> missing_seams(ComponentSystem& system, const ComponentTask& task);

// Throws SEAMS_INCOMPLETE for a component that is closed and has no cones, with loops that open its handles, or its
// triangles.
void require_opened(ComponentSystem& system, const ComponentCones& cones);

// Throws SEAMS_INCOMPLETE if some of these cuts, halfedges, are no seams, with their edges.
void require_seams(const HalfedgeMesh& mesh, const Array<Index>& cuts, bool has_cones);

// Reports as SEAMS_INCOMPLETE what is missing in a component that was mapped with its holes, if that is predicted to be
// stretched much more, as a tube laid out as a ring.  curvature: of this map.
void report_missing_seams(ComponentSystem& system, const ComponentTask& task, const Curvature& curvature,
                          std::vector<Finding>& findings);

}  // namespace lsgp

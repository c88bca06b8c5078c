// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/opened_component.hpp"

#include <limits>
#include <utility>

#include "assembly/vertex_pairs.hpp"
#include "lsgp/lsgp.hpp"

namespace lsgp {

namespace {

// The component as a surface of its own.
Surface surface_of(const HalfedgeMesh& mesh) {
  Array<Index> seams, edges;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] > h && mesh.seam[h]) seams.insert(seams.end(), {mesh.origin(h), mesh.target(h)});
    if (mesh.twin[h] < h && mesh.cuttable[h]) edges.insert(edges.end(), {mesh.origin(h), mesh.target(h)});
  }
  Surface surface;
  surface.positions = mesh.positions;
  surface.scale = mesh.scale;
  surface.triangles = mesh.triangles;
  surface.seams = to_vertex_pairs(seams);
  surface.edges = to_vertex_pairs(edges);
  return surface;
}

}  // namespace

bool is_opened(const Component& component, const PlacedCones& placed, const PlacementOptions& options) {
  Options of_map;
  of_map.seams = options.seams;
  return opens_along_seams(component, placed.cones, of_map);
}

void describe_opened(const Component& component, const PlacementOptions& options, ProgressMonitor& monitor,
                     PlacedCones& placed) {
  const Progress progress = [&](double) {
    monitor.tick();
    return true;
  };
  const Surface surface = surface_of(component.mesh);
  Prescription prescription = prescribe_curvature(surface, {}, {}, progress);
  placed.curvature.log_scale = std::move(prescription.log_scale);
  placed.curvature.predicted_l2 = prescription.predicted_l2;
  const Result map = parameterize(surface, {}, {}, {}, progress);
  const bool is_valid = map.flipped.empty() && map.wrong_angle_sums.empty();
  placed.mapped_l2 = is_valid ? map.distortion.l2_stretch : std::numeric_limits<double>::infinity();
  ++placed.maps;
  placed.reached = placed.mapped_l2 <= options.target;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <optional>

#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/wording.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

namespace {

// place_of: of the caller's vertices in the list of cones.
LedgerPart account(const Component& component, ComponentCones cones, const Options& options,
                   const PerVertex<Index>& place_of) {
  const HalfedgeMesh& mesh = component.mesh;
  LedgerPart out;
  out.triangles = component.source_triangle;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] == none) out.inside.push_back(component.source_vertex[v]);
  }
  out.euler = mesh.euler;
  out.borders = static_cast<int>(mesh.boundary_loops.size());
  out.required = 2 * M_PI * mesh.euler;
  Index free_border = 0;
  for (const Array<Index>& loop : mesh.boundary_loops) free_border += static_cast<Index>(loop.size());
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Index v = cones.vertices[i];
    std::optional<double>& angle = cones.angles[i];
    if (options.prescription != PrescriptionRule::manual) angle.reset();
    out.cones.push_back(place_of[component.source_vertex[v]]);
    out.curvature.push_back(angle ? mesh.flat_angle(v) - *angle : std::numeric_limits<double>::quiet_NaN());
    if (angle) out.assigned += out.curvature.back();
    free_border -= mesh.loop_of_vertex[v] != none;
  }
  out.border_takes_up = free_border > 0 && options.border == BorderMode::free;
  const auto [least, most] = room_of_automatic(mesh, cones);
  out.room = {least, most};
  return out;
}

}  // namespace

bool closes(const LedgerPart& part) {
  constexpr double rounding = 1e-6;  // of sums of angles, radians
  const double missing = part.required - part.assigned;
  return part.border_takes_up || (part.room[0] - rounding <= missing && missing <= part.room[1] + rounding);
}

std::vector<LedgerPart> build_ledger(const Surface& surface, const Cones& cones, const Options& options,
                                     LedgerOf of) try {
  const Work work =
      prepare_topology({surface, cones, options}, of == LedgerOf::map ? MoreCones::none : MoreCones::some);
  PerVertex<Index> place_of(surface.positions.rows(), none);
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) place_of[cones.vertices[i]] = static_cast<Index>(i);
  std::vector<LedgerPart> out;
  out.reserve(work.tasks.size());
  for (std::size_t i = 0; i < work.tasks.size(); ++i) {
    out.push_back(account(work.topology.components[i], work.tasks[i].cones, options, place_of));
  }
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

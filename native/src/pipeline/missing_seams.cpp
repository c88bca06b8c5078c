// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/missing_seams.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/text.hpp"

namespace lsgp {

namespace {

constexpr auto remedy = " Mark these edges as well, or allow automatic cuts besides the seams.";

Array<Index> besides_seams(const HalfedgeMesh& mesh, const Array<Index>& cuts) {
  Array<Index> out;
  std::copy_if(cuts.begin(), cuts.end(), std::back_inserter(out), [&](Index h) { return !mesh.seam[h]; });
  return out;
}

Elements edges_of(const HalfedgeMesh& mesh, const Array<Index>& halfedges) {
  Elements out{ElementKind::edges, {}};
  for (const Index h : halfedges) out.indices.insert(out.indices.end(), {mesh.origin(h), mesh.target(h)});
  return out;
}

bool is_disk(const HalfedgeMesh& mesh) { return mesh.genus == 0 && mesh.boundary_loops.size() == 1; }

// The metric with only those holes that nearly are some.
Curvature with_open_holes(ComponentSystem& system, const ComponentTask& task) {
  ComponentCones cones = task.cones;
  cones.holes = Holes::as_they_are;
  std::vector<Finding> unsaid;
  return prescribe(system, cones, PrescriptionRule::least_distortion, unsaid);
}

Array<Index> missing_with(const ComponentSystem& system, const Curvature& opened) {
  return besides_seams(system.mesh(), halfedges_of(system.connect({}, opened.needs_no_cut)));
}

}  // namespace

Array<Index> missing_seams(ComponentSystem& system, const ComponentTask& task) {
  const HalfedgeMesh& mesh = system.mesh();
  if (is_disk(mesh)) return {};
  if (mesh.closed()) return besides_seams(mesh, halfedges_of(system.connect({}, {})));
  return missing_with(system, with_open_holes(system, task));
}

void require_opened(ComponentSystem& system, const ComponentCones& cones) {
  const HalfedgeMesh& mesh = system.mesh();
  if (!mesh.closed() || !cones.vertices.empty()) return;
  if (mesh.genus > 0) require_seams(mesh, halfedges_of(system.all_cuts()), false);
  Elements all{ElementKind::triangles, {}};
  for (Index f = 0; f < mesh.triangle_count(); ++f) all.indices.push_back(f);
  throw Error(Code::seams_incomplete,
              "A part of the surface is closed, and no marked seam opens it. Mark seams there, or allow automatic cuts "
              "besides the seams.",
              std::move(all));
}

void require_seams(const HalfedgeMesh& mesh, const Array<Index>& cuts, bool has_cones) {
  const Array<Index> missing = besides_seams(mesh, cuts);
  if (missing.empty()) return;
  const char* why = has_cones        ? "The marked seams do not join all cones and boundaries of a part."
                    : mesh.genus > 0 ? "The marked seams leave a handle closed, so that a part cannot be laid flat."
                                     : "The marked seams leave a tube that is too long to be laid out as a ring.";
  throw Error(Code::seams_incomplete, concat(why, remedy), edges_of(mesh, missing));
}

void report_missing_seams(ComponentSystem& system, const ComponentTask& task, const Curvature& curvature,
                          std::vector<Finding>& findings) {
  const HalfedgeMesh& mesh = system.mesh();
  if (is_disk(mesh) || mesh.closed() || !task.cones.vertices.empty()) return;
  const Curvature opened = with_open_holes(system, task);
  if (curvature.predicted_l2 <= cheap_holes * opened.predicted_l2) return;
  const Array<Index> missing = missing_with(system, opened);
  if (missing.empty()) return;
  findings.push_back({Code::seams_incomplete,
                      concat("The marked seams leave a part that is no disk: it was laid out with a hole, which "
                             "stretches it.",
                             remedy),
                      edges_of(mesh, missing)});
}

}  // namespace lsgp

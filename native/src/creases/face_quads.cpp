// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/face_quads.hpp"

namespace lsgp {

namespace {

// The side of each triangle across which it is half of a quad, or none.
PerTriangle<Index> find_diagonals(const MetricMesh& surface) {
  const auto& [mesh, geometry] = surface;
  const auto is_hidden = [&, &mesh = mesh](Index h) { return mesh.twin[h] != none && !mesh.cuttable[h]; };
  bool has_hidden = false;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) has_hidden |= is_hidden(h);
  PerTriangle<Index> out(mesh.triangle_count(), none);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    Index longest = 3 * f;
    int hidden = 0;
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (is_hidden(h)) out[f] = h;
      hidden += is_hidden(h);
      if (geometry.length[h] > geometry.length[longest]) longest = h;
    }
    if (hidden > 1) out[f] = none;  // of a polygon with more sides
    if (!has_hidden) out[f] = longest;
  }
  return out;
}

}  // namespace

Array<Quad> find_quads(const MetricMesh& surface) {
  const HalfedgeMesh& mesh = surface.mesh;
  const PerTriangle<Index> diagonal = find_diagonals(surface);
  Array<Quad> out;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const Index here = diagonal[f], there = here == none ? none : mesh.twin[here];
    if (there <= here || diagonal[there / 3] != there) continue;  // none is the least
    out.push_back({{next(here), prev(here), next(there), prev(there)}});
  }
  return out;
}

}  // namespace lsgp

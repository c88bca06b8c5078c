// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/parts.hpp"

#include <utility>

#include "cut/cut_graph.hpp"
#include "cut/cut_mesh.hpp"

namespace lsgp {

PerPart<PartTopology> measure_parts(const HalfedgeMesh& mesh, const PerHalfedge<char>& open) {
  const Index halfedge_count = mesh.halfedge_count();
  PerHalfedge<char> is_cut(halfedge_count), is_border(halfedge_count), is_traced(halfedge_count, 0);
  for (Index h = 0; h < halfedge_count; ++h) {
    is_cut[h] = open[h] && mesh.twin[h] != none;
    is_border[h] = open[h] || mesh.twin[h] == none;
  }
  PerTriangle<Index> part;
  PerPart<PartTopology> out(label_parts(mesh, open, part));
  const CutMesh cut_mesh = cut_open(mesh, trace_cuts(mesh, PerVertex<char>(mesh.vertex_count(), 0), std::move(is_cut)));
  PerCopy<char> is_counted(cut_mesh.copy_count(), 0);
  for (Index h = 0; h < halfedge_count; ++h) {
    PartTopology& own = out[part[h / 3]];
    char& vertex_is_counted = is_counted[cut_mesh.copy_of_corner[h]];
    own.euler += !vertex_is_counted + (h % 3 == 0) - (is_border[h] || h < mesh.twin[h]);
    vertex_is_counted = 1;
    if (!is_border[h] || is_traced[h]) continue;
    ++own.borders;
    for (Index along = h; !is_traced[along];) {
      is_traced[along] = 1;
      along = next(along);
      while (!is_border[along]) along = next(mesh.twin[along]);
    }
  }
  return out;
}

}  // namespace lsgp

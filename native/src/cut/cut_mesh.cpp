// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/cut_mesh.hpp"

#include <numeric>

namespace lsgp {

namespace {

// The halfedge from which a vertex's sectors are counted: at its boundary, or its first cut.
Index first_of_sectors(const HalfedgeMesh& mesh, const CutGraph& cut_graph, Index v) {
  Index first = mesh.outgoing[v];
  if (mesh.twin[first] == none) return first;
  while (!cut_graph.is_cut[first]) {
    first = mesh.rotate(first);
    if (first == mesh.outgoing[v]) break;
  }
  return first;
}

}  // namespace

CutMesh cut_open(const HalfedgeMesh& mesh, const CutGraph& cut_graph) {
  CutMesh cut_mesh;
  cut_mesh.copy_of_corner.assign(mesh.triangles.data(), mesh.triangles.data() + mesh.halfedge_count());
  cut_mesh.source.resize(mesh.vertex_count());
  std::iota(cut_mesh.source.begin(), cut_mesh.source.end(), 0);
  const PerVertex<char> on_cut = on_cuts(mesh, cut_graph);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!on_cut[v]) continue;
    const Index first = first_of_sectors(mesh, cut_graph, v);
    Index copy = v;
    for (Index h = mesh.rotate(first); h != none && h != first; h = mesh.rotate(h)) {
      if (cut_graph.is_cut[h]) {
        copy = cut_mesh.copy_count();
        cut_mesh.source.push_back(v);
      }
      cut_mesh.copy_of_corner[h] = copy;
    }
  }
  return cut_mesh;
}

Eigen::VectorXcd at_corners(const CutMesh& cut_mesh, const Eigen::VectorXcd& of_copies) {
  Eigen::VectorXcd out(cut_mesh.copy_of_corner.size());
  for (Eigen::Index corner = 0; corner < out.size(); ++corner) out[corner] = of_copies[cut_mesh.copy_of_corner[corner]];
  return out;
}

Array<Sector> sectors(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CutMesh& cut_mesh, Index v) {
  const Index first = first_of_sectors(mesh, cut_graph, v);
  Array<Sector> out{{cut_mesh.copy_of_corner[first], cut_graph.is_cut[first] ? first : none}};
  for (Index h = mesh.rotate(first); h != none && h != first; h = mesh.rotate(h)) {
    if (cut_graph.is_cut[h]) out.push_back({cut_mesh.copy_of_corner[h], h});
  }
  return out;
}

}  // namespace lsgp

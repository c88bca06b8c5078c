// SPDX-License-Identifier: GPL-3.0-or-later
// The surface opened along its cut graph: copies of vertices, and the sister edges (the paper's term) on both sides of
// every cut.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "cut/cut_graph.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

struct CopyKind;
template <typename T>
using PerCopy = ArrayPer<CopyKind, T>;  // copies of vertices

struct CutMesh {
  PerHalfedge<Index> copy_of_corner;  // copies below n are the vertices themselves, further copies follow
  PerCopy<Index> source;              // the vertex of each
  Index copy_count() const { return static_cast<Index>(source.size()); }
};

class CutFactor;
class FrameTree;

// A surface and its cuts. Data computed for a cut graph that contains these cuts can be reused.
struct CutSurface : MetricMesh {
  const CutGraph& cut_graph;
  const CutMesh& cut_mesh;
  const CutFactor* factor = nullptr;  // of this geometry, or null
  const FrameTree* frame_tree = nullptr;
};

// Values of copies, (copies), at the corners, (3m).
Eigen::VectorXcd at_corners(const CutMesh& cut_mesh, const Eigen::VectorXcd& of_copies);

// The copies of one vertex: sectors between outgoing cut halfedges, counter-clockwise.
struct Sector {
  Index copy;
  Index opened_by;  // the cut halfedge on its right, none for the first of a boundary vertex or of an uncut one
};

CutMesh cut_open(const HalfedgeMesh& mesh, const CutGraph& cut_graph);

// The sectors of v from the first outgoing cut halfedge on; those of an interior vertex end at that halfedge again.
Array<Sector> sectors(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CutMesh& cut_mesh, Index v);

// Whether a halfedge lies on the boundary of the opened surface.
inline bool is_open(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, Index h) {
  const Index twin = mesh.twin[h];
  return twin == none || cut_mesh.copy_of_corner[twin] != cut_mesh.copy_of_corner[next(h)] ||
         cut_mesh.copy_of_corner[next(twin)] != cut_mesh.copy_of_corner[h];
}

// Both copies of the origin of a cut's halfedge, and of its target.
struct Sisters {
  Index left, right;
};
inline Sisters origin_sisters(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, Index h) {
  return {cut_mesh.copy_of_corner[h], cut_mesh.copy_of_corner[next(mesh.twin[h])]};
}
inline Sisters target_sisters(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, Index h) {
  return {cut_mesh.copy_of_corner[next(h)], cut_mesh.copy_of_corner[mesh.twin[h]]};
}

}  // namespace lsgp

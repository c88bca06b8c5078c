// SPDX-License-Identifier: GPL-3.0-or-later
// The dual graph of a layout: its faces, and the edges that may be opened between them.
#pragma once

#include <utility>

#include "base/array.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"
#include "solvers/smallest_cut.hpp"

namespace lsgp {

struct FaceKind;
template <typename T>
using PerFace = ArrayPer<FaceKind, T>;  // of a FaceGraph

// A surface and where its layout ends.
struct OpenedSurface : MetricMesh {
  const PerHalfedge<char>& open;  // on both sides of an edge
};

struct FaceGraph {
  using Units = SmallestCut::Units;

  struct Link {
    Index faces[2];
    Index halfedge;  // in the first of them
    Units cost;      // its length times its factor as a cut; without factors less along sharp edges; least on seams
  };

  PerTriangle<Index> face_of;  // triangles that no cut may part are one face
  PerFace<double> area;
  double total_area = 0;
  double unit = 0;  // length of one unit of cost
  Array<Link> links;
  Array<Index> link_begin, link_of_face;  // (faces + 1), (2 links)

  Index face_count() const { return static_cast<Index>(area.size()); }
  Index link_count(Index face) const { return link_begin[face + 1] - link_begin[face]; }
  bool are_linked(Index face, Index other) const {
    if (link_count(face) > link_count(other)) std::swap(face, other);
    bool found = false;
    for_each_link(face, [&](Index beside, const Link&) { found |= beside == other; });
    return found;
  }

  // Calls visit(other face, link).
  template <typename Visit>
  void for_each_link(Index face, Visit visit) const {
    for (Index i = link_begin[face]; i < link_begin[face + 1]; ++i) {
      const Link& link = links[link_of_face[i]];
      visit(link.faces[link.faces[0] == face], link);
    }
  }
};

// What an edge's length counts as a cut, of the median edge's and within bounds; empty where all cost the same.
PerHalfedge<double> relative_cut_factors(const HalfedgeMesh& mesh);

// The mesh where the length of a cut counts as much as its cost. Cuts that are only to be cheap would take long ways
// and leave small islands.  mesh: with factors.
HalfedgeMesh weighing_length(const HalfedgeMesh& mesh);

FaceGraph build_face_graph(const OpenedSurface& surface);

}  // namespace lsgp

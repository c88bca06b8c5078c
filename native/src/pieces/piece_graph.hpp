// SPDX-License-Identifier: GPL-3.0-or-later
// A layout divided into pieces that can be assembled along other cuts than its own.
#pragma once

#include <complex>

#include "base/array.hpp"
#include "division/cut_apart.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// The pieces into which a network of paths divides a surface; the cuts are among the paths. All paths outside a
// spanning tree of the pieces, without dead ends, are cuts for the same cones.
struct PieceGraph {
  // From node to node of the network.
  struct Path {
    Array<Index> halfedges;  // in the left piece
    Index left, right;       // pieces
    Motion across;           // of the left piece, to coincide with the right one along the path
    double cost;             // of a cut along it, by price_paths
    Index nodes[2];
    bool is_cut;
    Index across_from(Index piece) const { return left == piece ? right : left; }
  };
  struct Side {
    Complex tail, head;
  };

  PerTriangle<Index> piece_of;
  PerPart<Array<Side>> boundary;  // of every piece, the layout on the left
  Array<Path> paths;
  Array<char> is_end;  // (nodes) whether cuts have to reach it: a cone or a boundary vertex

  Index piece_count() const { return static_cast<Index>(boundary.size()); }
};

// network: on both halfedges, with the map's cuts; paths around small pieces are removed.
// resolution: sides of boundaries inside the surface are merged up to about this length.
PieceGraph build_piece_graph(const MetricMesh& surface, const ComponentMap& map, PerHalfedge<char> network,
                             double resolution);

// The paths beside each piece that lead to other ones.
PerPart<Array<Index>> paths_of_pieces(const PieceGraph& graph);

// All paths outside a spanning forest, except dead ends: at a node that needs no cut, a last open path is closed as
// well.  in_tree, return: (paths) 0 or 1.
Array<char> open_paths(const PieceGraph& graph, const Array<char>& in_tree);
// Of the open paths, (paths) 0 or 1: the cost of cuts along them, and their halfedges, on both sides.
double cost_of_cuts(const PieceGraph& graph, const Array<char>& open);
PerHalfedge<char> cuts_along(const PieceGraph& graph, const HalfedgeMesh& mesh, const Array<char>& open);

// costs: the surface, with those of cuts.
void price_paths(const MetricMesh& costs, PieceGraph& graph);

}  // namespace lsgp

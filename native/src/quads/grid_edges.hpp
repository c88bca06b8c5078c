// SPDX-License-Identifier: GPL-3.0-or-later
// The sides of the grid's cells, traced over the surface from corner to corner.
#pragma once

#include "base/array.hpp"
#include "mesh/topology.hpp"
#include "quads/exact_grid.hpp"
#include "quads/grid_vertices.hpp"

namespace lsgp {

// The end of a side of cells at a corner of cells.
struct Port {
  Index vertex;    // of the grid
  Index triangle;  // into which, or along whose edge, on its left
  int direction;   // in that triangle's chart
  GridPoint from;  // the vertex in that chart
};

struct GridEdges {
  Array<Port> ports;        // those of a vertex one after the other, counter-clockwise
  Array<Index> first_port;  // (v + 1) of each vertex
  Array<Index> opposite;    // the port at which the side that leaves by a port arrives

  // The port before in the counter-clockwise order around the same vertex.
  Index clockwise(Index port) const {
    const Index vertex = ports[port].vertex;
    return (port == first_port[vertex] ? first_port[vertex + 1] : port) - 1;
  }
};

// Each side is traced from both of its ends. Throws SOLVER_FAILED if these disagree.
GridEdges trace_edges(const HalfedgeMesh& mesh, const ExactGrid& grid, const GridVertices& vertices);

}  // namespace lsgp

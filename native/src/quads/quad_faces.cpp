// SPDX-License-Identifier: GPL-3.0-or-later
#include "quads/quad_faces.hpp"

#include <algorithm>
#include <string>

#include "base/checkpoint.hpp"
#include "base/text.hpp"

namespace lsgp {

namespace {

[[noreturn]] void fail() {
  throw Error(Code::solver_failed, "The grid's cells do not close over the surface. Please report this mesh.");
}

// The cost of a corner of cells and its sides, in multiplications.
constexpr double operations_a_neighborhood = 200, operations_a_cell = 200;

// Vertices that occur twice in a cell, and the lower ones of pairs joined by more than one side.
Array<Index> find_doubled(const GridVertices& vertices, const GridEdges& edges) {
  Array<Index> out, joined;
  for (Index from = 0; from < vertices.count(); ++from) {
    checkpoint(operations_a_neighborhood);
    joined.clear();
    for (Index port = edges.first_port[from]; port < edges.first_port[from + 1]; ++port) {
      const Index to = edges.ports[edges.opposite[port]].vertex;
      const Index across = edges.ports[edges.opposite[edges.clockwise(edges.opposite[port])]].vertex;
      if (from == to || from == across) out.push_back(from);
      if (from < to) joined.push_back(to);
    }
    std::sort(joined.begin(), joined.end());
    if (std::adjacent_find(joined.begin(), joined.end()) != joined.end()) out.push_back(from);
  }
  return out;
}

void require_fine(const GridVertices& vertices, const GridEdges& edges) {
  Array<Index> triangles;
  for (const Index v : find_doubled(vertices, edges)) triangles.push_back(vertices[v].triangle);
  if (triangles.empty()) return;
  sort_unique(triangles);
  const std::string what =
      concat("The grid is too coarse for a mesh at ", count(triangles.size(), "place", "places"),
             ": a quad would have a vertex twice, or two vertices more than one edge. Choose smaller cells, or "
             "more quads.");
  throw Error(Code::grid_too_coarse, what, {ElementKind::triangles, std::move(triangles)});
}

}  // namespace

Quads walk_faces(const HalfedgeMesh& mesh, const GridVertices& vertices, const GridEdges& edges) {
  const Index ports = static_cast<Index>(edges.ports.size());
  if (ports % 4 != 0 || vertices.count() - ports / 4 != mesh.euler) fail();
  Quads out(ports / 4, 4);
  Array<char> walked(ports, 0);
  Index quad = 0;
  for (Index first = 0; first < ports; ++first) {
    if (walked[first]) continue;
    checkpoint(operations_a_cell);
    // The cell on the left of a side: at its end, the next side is the first one clockwise from it.
    Index port = first;
    for (int corner = 0; corner < 4; ++corner) {
      if (walked[port]) fail();
      walked[port] = 1;
      out(quad, corner) = edges.ports[port].vertex;
      port = edges.clockwise(edges.opposite[port]);
    }
    if (port != first) fail();
    ++quad;
  }
  require_fine(vertices, edges);
  return out;
}

}  // namespace lsgp

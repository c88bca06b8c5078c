// SPDX-License-Identifier: GPL-3.0-or-later
#include "quads/grid_edges.hpp"

#include <array>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

// Costs in multiplications.
constexpr double operations_a_triangle = 50, operations_a_start = 100, operations_a_port = 50;

// A straight line of the grid traced through the triangles, in the chart of the current one.
struct Ray {
  Index triangle;
  int direction;
  GridPoint from, to;

  void cross(const ExactGrid& grid, const HalfedgeMesh& mesh, Index halfedge) {
    const GridTransition& across = grid.across[halfedge];
    triangle = mesh.twin[halfedge] / 3;
    direction = across.direction(direction);
    from = across(from);
    to = across(to);
  }
};

class Tracer {
 public:
  Tracer(const HalfedgeMesh& mesh, const ExactGrid& grid, const GridVertices& vertices)
      : mesh_(mesh), grid_(grid), vertices_(vertices) {}

  GridEdges trace() {
    for (Index v = 0; v < vertices_.count(); ++v) {
      checkpoint(operations_a_start);
      edges_.first_port.push_back(port_count());
      add_ports(v);
    }
    edges_.first_port.push_back(port_count());
    edges_.opposite.reserve(edges_.ports.size());
    for (const Port& port : edges_.ports) edges_.opposite.push_back(arrival(port));
    for (Index port = 0; port < port_count(); ++port) {
      checkpoint(operations_a_port);
      const Index other = edges_.opposite[port];
      if (other == none || other == port || edges_.opposite[other] != port) fail();
    }
    return std::move(edges_);
  }

 private:
  Index port_count() const { return static_cast<Index>(edges_.ports.size()); }

  [[noreturn]] static void fail() {
    throw Error(Code::solver_failed, "The grid could not be traced over the surface. Please report this mesh.");
  }

  void add_ports(Index v) {
    const auto& [triangle, at, place] = vertices_[v];
    const Index edge = place.edge, corner = place.corner;
    const auto everywhere = [](int) { return true; };
    if (corner != none) {
      mesh_.for_each_outgoing(mesh_.origin(corner), [&](Index h) {
        add_ports({v, h / 3, 0, grid_.at[h]}, [&](int direction) { return grid_.leads_into(h, direction); });
      });
    } else if (edge != none) {
      const Index twin = mesh_.twin[edge];
      add_ports({v, triangle, 0, at}, [&](int direction) { return grid_.leads_beside(edge, direction); });
      add_ports({v, twin / 3, 0, grid_.across[edge](at)},
                [&](int direction) { return grid_.leads_beside(twin, direction); });
    } else {
      add_ports({v, triangle, 0, at}, everywhere);
    }
  }

  // The ports in the directions that belong to one triangle, counter-clockwise.
  template <typename IsIts>
  void add_ports(Port port, IsIts is_its) {
    int first = 0;
    for (int direction = 1; direction < 4; ++direction) {
      if (is_its(direction) && !is_its(direction - 1)) first = direction;
    }
    for (int step = 0; step < 4; ++step) {
      port.direction = (first + step) & 3;
      if (is_its(port.direction)) edges_.ports.push_back(port);
    }
  }

  // Follows a side to the next corner of cells and returns the port that it arrives at.
  Index arrival(const Port& port) const {
    const GridPoint way = axis(port.direction);
    const GridPoint side{way.x * grid_.cell(), way.y * grid_.cell()};
    Ray ray{port.triangle, port.direction, port.from, port.from + side};
    for (;;) {
      checkpoint(operations_a_triangle);
      if (const auto place = find_place(grid_, ray.triangle, ray.to)) return port_at(ray, *place);
      leave(ray);
    }
  }

  // Advances the ray into the next triangle.
  void leave(Ray& ray) const {
    std::array<std::int64_t, 3> side{};
    for (int c = 0; c < 3; ++c) {
      const GridPoint corner = grid_.at[3 * ray.triangle + c];
      element(side, c) = orient(ray.from, ray.to, corner);
      if (element(side, c) == 0 && dot(corner - ray.from, axis(ray.direction)) > 0) {
        pass(ray, 3 * ray.triangle + c);
        return;
      }
    }
    for (int c = 0; c < 3; ++c) {
      if (element(side, c) < 0 && element(side, (c + 1) % 3) > 0) {
        ray.cross(grid_, mesh_, 3 * ray.triangle + c);
        return;
      }
    }
    fail();
  }

  // Through a vertex of the surface between two corners of cells, which is not a cone: exactly one triangle around it
  // lies in the direction of the ray.
  void pass(Ray& ray, Index corner) const {
    for (int visited = 0; !grid_.leads_into(corner, ray.direction); ++visited) {
      if (visited > mesh_.triangle_count()) fail();
      ray.cross(grid_, mesh_, prev(corner));
      corner = mesh_.rotate(corner);
    }
    ray.from = grid_.at[corner];
  }

  // The port back along a ray that has ended at a place of its triangle.
  Index port_at(Ray ray, const Place& place) const {
    const Index vertex = vertices_.find(ray.triangle, ray.to, place);
    if (vertex == none) fail();
    const int back = (ray.direction + 2) & 3;
    // Along an edge on its right it belongs to the triangle on the other side of that.
    if (place.corner != none && !grid_.leads_into(place.corner, back)) {
      ray.cross(grid_, mesh_, prev(place.corner));
    } else if (place.edge != none && !grid_.leads_beside(place.edge, back)) {
      ray.cross(grid_, mesh_, place.edge);
    }
    for (Index port = edges_.first_port[vertex]; port < edges_.first_port[vertex + 1]; ++port) {
      const Port& found = edges_.ports[port];
      if (found.triangle == ray.triangle && found.direction == ((ray.direction + 2) & 3)) return port;
    }
    return none;
  }

  const HalfedgeMesh& mesh_;
  const ExactGrid& grid_;
  const GridVertices& vertices_;
  GridEdges edges_;
};

}  // namespace

GridEdges trace_edges(const HalfedgeMesh& mesh, const ExactGrid& grid, const GridVertices& vertices) {
  return Tracer(mesh, grid, vertices).trace();
}

}  // namespace lsgp

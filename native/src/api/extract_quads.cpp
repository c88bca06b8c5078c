// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <string>
#include <utility>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "base/memory.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "plane/predicates.hpp"
#include "quads/exact_grid.hpp"
#include "quads/grid_edges.hpp"
#include "quads/grid_vertices.hpp"
#include "quads/quad_faces.hpp"

namespace lsgp {

namespace {

void require_valid(const Surface& surface, const CornerUv& corner_uv, double cell) {
  require_valid(surface);
  require_one_each(surface, corner_uv);
  if (!(std::isfinite(cell) && cell > 0)) {
    throw Error(Code::wrong_parameter, concat("The cell's side is ", cell, ". Choose one above 0."));
  }
  Array<Index> without;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (!(corner_uv.middleRows<3>(3 * f) / cell).allFinite()) without.push_back(f);
  }
  if (without.empty()) return;
  const std::string what = concat(count(without.size(), "triangle has", "triangles have"),
                                  " no texture coordinates. Lay out the whole surface.");
  throw Error(Code::wrong_parameter, what, {ElementKind::triangles, std::move(without)});
}

void require_closed(const Component& component) {
  if (!component.orientable) {
    throw Error(Code::not_orientable, "A component is one-sided, and quads cannot cover it. Cut it open.",
                {ElementKind::triangles, component.source_triangle});
  }
  Array<Index> border;
  for (Index h = 0; h < component.mesh.halfedge_count(); ++h) {
    if (component.mesh.twin[h] != none) continue;
    border.push_back(component.source_vertex[component.mesh.origin(h)]);
    border.push_back(component.source_vertex[component.mesh.target(h)]);
  }
  if (border.empty()) return;
  const std::string what =
      concat("The surface has a boundary of ", count(border.size() / 2, "edge", "edges"),
             ", along which the grid would be cut off between its lines. Close the surface: fill its holes, "
             "merge vertices by distance, and remove interior faces.");
  throw Error(Code::open_surface, what, {ElementKind::edges, std::move(border)});
}

// Without seams, across which the mesh continues.
Topology build_closed_topology(const Surface& surface) {
  Surface whole = surface;
  whole.seams.resize(0, 2);
  std::vector<Finding> unsaid;
  Topology topology = build_topology(whole, {}, unsaid);
  for (const Component& component : topology.components) require_closed(component);
  return topology;
}

// The cost of collecting a vertex or a quad, in multiplications.
constexpr double operations_an_element = 100;
// What all arrays together take while a mesh is made.
constexpr double bytes_a_quad = 280;

// uv: (3m), in cells.
double cell_count(const Eigen::VectorXcd& uv) {
  double doubled_area = 0;
  for (Eigen::Index corner = 0; corner < uv.size(); corner += 3)
    doubled_area += cross(uv[corner + 1] - uv[corner], uv[corner + 2] - uv[corner]);
  return doubled_area / 2;
}

// The mesh of all components.
class Collector {
 public:
  explicit Collector(const Surface& surface) : surface_(surface) {}

  void add(const Component& component, const ExactGrid& grid, const GridVertices& vertices, const Quads& quads) {
    const auto first = static_cast<Index>(out_.triangles.size());
    for (Index i = 0; i < vertices.count(); ++i) {
      checkpoint(operations_an_element);
      add(component, grid, vertices[i]);
    }
    for (Index q = 0; q < quads.rows(); ++q) {
      checkpoint(operations_an_element);
      for (int c = 0; c < 4; ++c) corners_.push_back(first + quads(q, c));
    }
  }

  QuadMesh collect() {
    const auto count = static_cast<Index>(out_.triangles.size());
    out_.quads = Eigen::Map<const Quads>(corners_.data(), static_cast<Eigen::Index>(corners_.size() / 4), 4);
    out_.weights = Eigen::Map<const Positions>(weights_.data(), count, 3);
    out_.positions.resize(count, 3);
    for (Index v = 0; v < count; ++v) {
      checkpoint(operations_an_element);
      out_.positions.row(v).setZero();
      for (int c = 0; c < 3; ++c) {
        const double weight = out_.weights(v, c);
        const Index corner = surface_.triangles(element(out_.triangles, v), c);
        if (weight != 0) out_.positions.row(v) += weight * surface_.positions.row(corner);
      }
    }
    return std::move(out_);
  }

 private:
  void add(const Component& component, const ExactGrid& grid, const GridVertex& vertex) {
    const Index corner = 3 * vertex.triangle;
    const double area = static_cast<double>(orient(grid.at[corner], grid.at[corner + 1], grid.at[corner + 2]));
    const std::size_t first = weights_.size();
    weights_.resize(first + 3);
    for (int c = 0; c < 3; ++c) {
      const std::int64_t opposite = orient(grid.at[corner + (c + 1) % 3], grid.at[corner + (c + 2) % 3], vertex.at);
      weights_[first + static_cast<std::size_t>(component.source_corner(corner + c) % 3)] =
          static_cast<double>(opposite) / area;
    }
    out_.triangles.push_back(component.source_triangle[vertex.triangle]);
    const Index at = vertex.place.corner == none ? none : component.mesh.origin(vertex.place.corner);
    out_.surface_vertices.push_back(at == none ? none : component.source_vertex[at]);
    out_.valences.push_back(at == none ? 4 : grid.quarter_turns[at]);
  }

  const Surface& surface_;
  QuadMesh out_;
  Array<Index> corners_;
  Array<double> weights_;
};

void extract(const Component& component, const Eigen::VectorXcd& uv, Collector& out) {
  const ExactGrid grid = build_exact_grid(component.mesh, uv);
  require_memory(bytes_a_quad * cell_count(uv), GrowsWith::quads);
  const GridVertices vertices(component.mesh, grid);
  const GridEdges edges = trace_edges(component.mesh, grid, vertices);
  out.add(component, grid, vertices, walk_faces(component.mesh, vertices, edges));
}

}  // namespace

void require_closed(const Surface& surface) try {
  require_valid(surface);
  build_closed_topology(surface);
} catch (const Error& error) {
  throw in_words(error);
}

QuadMesh extract_quads(const Surface& surface, const CornerUv& corner_uv, double cell, const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface, corner_uv, cell);
  const Topology topology = build_closed_topology(surface);
  Collector out(surface);
  for (std::size_t i = 0; i < topology.components.size(); ++i) {
    const Component& component = topology.components[i];
    monitor.advance(static_cast<double>(i) / static_cast<double>(topology.components.size()));
    Eigen::VectorXcd uv(component.mesh.halfedge_count());
    for (Index corner = 0; corner < component.mesh.halfedge_count(); ++corner) {
      const auto row = corner_uv.row(component.source_corner(corner));
      uv[corner] = Complex(row[0], row[1]) / cell;
    }
    try {
      extract(component, uv, out);
    } catch (const Error& error) {
      throw failure_of(component, error).error;
    }
  }
  monitor.advance(1);
  return out.collect();
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "components.hpp"
#include "distortion.hpp"
#include "lsgp/lsgp.hpp"
#include "validation.hpp"

namespace lsgp {

namespace {

// Texture coordinates of one copy agree to single precision of the layout's size.
constexpr double same_position = 1e-6;
// Without given cones, vertices whose angles miss a full turn by more than this count as cones.
constexpr double cone_threshold = 1e-3;

struct Part {
  Surface surface;               // the measured triangles, the caller's vertices
  std::vector<Index> triangles;  // the caller's
};

Part finite_part(const Surface& surface, const CornerUv& corner_uv) {
  Part part;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (corner_uv.middleRows<3>(3 * f).allFinite()) part.triangles.push_back(f);
  }
  part.surface.positions = surface.positions;
  part.surface.triangles.resize(part.triangles.size(), 3);
  for (std::size_t i = 0; i < part.triangles.size(); ++i)
    part.surface.triangles.row(i) = surface.triangles.row(part.triangles[i]);
  part.surface.seams.resize(0, 2);
  return part;
}

// Edges at which the two sides have different coordinates.
std::vector<char> find_open_edges(const HalfedgeMesh& mesh, const Eigen::VectorXcd& position, double tolerance) {
  std::vector<char> is_cut(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == none) continue;
    is_cut[h] = std::abs(position[h] - position[next(twin)]) > tolerance ||
                std::abs(position[next(h)] - position[twin]) > tolerance;
  }
  return is_cut;
}

}  // namespace

Measurement measure_distortion(const Surface& surface, const CornerUv& corner_uv, const std::vector<Index>* cones) {
  require_valid(surface);
  Measurement out;
  out.island.assign(surface.triangles.rows(), none);
  const Part part = finite_part(surface, corner_uv);
  out.cut_edges.resize(0, 2);
  if (part.triangles.empty()) return out;
  if (cones) require_valid(surface, {*cones, std::vector<std::optional<double>>(cones->size())});
  out.distortion = measure_triangles(surface, corner_uv, part.triangles);

  std::vector<char> given(surface.positions.rows(), 0);
  if (cones) {
    for (const Index v : *cones) given[v] = 1;
  }
  std::vector<Finding> ignored;
  std::vector<Index> cut_edges;
  Index island_count = 0;
  const Topology topology = build_topology(part.surface, {}, ignored);
  for (const Component& component : topology.components) {
    if (!component.orientable) continue;
    const HalfedgeMesh& mesh = component.mesh;
    Eigen::VectorXcd position(mesh.halfedge_count());
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      const Index at = component.source_corner(corner), source = 3 * part.triangles[at / 3] + at % 3;
      position[corner] = {corner_uv(source, 0), corner_uv(source, 1)};
    }
    const double size = std::max(position.real().maxCoeff() - position.real().minCoeff(),
                                 position.imag().maxCoeff() - position.imag().minCoeff());
    const std::vector<char> is_cut = find_open_edges(mesh, position, same_position * size);

    std::vector<Index> label;
    const Index count = label_parts(mesh, is_cut, label);
    std::vector<Index> positive(count, 0), total(count, 0);
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      positive[label[f]] += doubled_area(position, f) > 0;
      ++total[label[f]];
    }
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      const Index source = part.triangles[component.source_triangle[f]];
      const bool mirrored = 2 * positive[label[f]] < total[label[f]];
      out.island[source] = island_count + label[f];
      if (!((mirrored ? -1 : 1) * doubled_area(position, f) > 0)) out.flipped.push_back(source);
    }
    island_count += count;

    const Eigen::VectorXd sums = angle_sums(mesh, position);
    std::vector<char> is_node(mesh.vertex_count(), 0);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      is_node[v] = cones ? given[component.source_vertex[v]] : std::abs(std::abs(sums[v]) - 2 * M_PI) > cone_threshold;
    }
    const CutGraph graph = trace_cuts(mesh, is_node, is_cut);
    out.seams = worse(out.seams, measure_seams(mesh, graph, position, nullptr));
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (!is_cut[h] || mesh.twin[h] < h) continue;
      cut_edges.push_back(component.source_vertex[mesh.origin(h)]);
      cut_edges.push_back(component.source_vertex[mesh.target(h)]);
    }
  }
  for (const auto& [f, original] : topology.duplicates)
    out.island[part.triangles[f]] = out.island[part.triangles[original]];
  std::sort(out.flipped.begin(), out.flipped.end());
  out.cut_edges = Eigen::Map<VertexPairs>(cut_edges.data(), static_cast<Eigen::Index>(cut_edges.size() / 2), 2);
  return out;
}

}  // namespace lsgp

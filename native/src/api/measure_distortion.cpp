// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "assembly/vertex_pairs.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "plane/boundary_polygon.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

namespace {

// Texture coordinates of one copy agree to single precision of the layout's size.
constexpr double same_position = 1e-6;
// Without given cones, vertices whose angles miss a full turn by more than this count as cones.
constexpr double cone_threshold = 1e-3;

struct MeasuredSurface {
  Surface surface;         // the measured triangles, the caller's vertices
  Array<Index> triangles;  // the caller's
};

MeasuredSurface finite_triangles(const Surface& surface, const CornerUv& corner_uv) {
  MeasuredSurface measured;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (corner_uv.middleRows<3>(3 * f).allFinite()) measured.triangles.push_back(f);
  }
  measured.surface.positions = surface.positions;
  measured.surface.scale = surface.scale;
  measured.surface.triangles.resize(ssize(measured.triangles), 3);
  for (Eigen::Index i = 0; i < ssize(measured.triangles); ++i)
    measured.surface.triangles.row(i) = surface.triangles.row(measured.triangles[i]);
  measured.surface.seams.resize(0, 2);
  return measured;
}

// The power of two that brings the layout to about unit size, so that no area overflows.
double unit_scale(const CornerUv& corner_uv, const Array<Index>& triangles) {
  double largest = 0;
  for (const Index f : triangles) largest = std::max(largest, corner_uv.middleRows<3>(3 * f).cwiseAbs().maxCoeff());
  return largest > 0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
}

// One side of an edge: its vertices, the lower one first, and where they are in the layout.
struct EdgeSide {
  Index low, high;
  Complex at_low, at_high;
};

Array<EdgeSide> edge_sides(const MeasuredSurface& measured, const CornerUv& uv, const Array<Index>& triangles) {
  Array<EdgeSide> out;
  for (const Index f : triangles) {
    for (Index c = 0; c < 3; ++c) {
      const Index tail = measured.surface.triangles(f, c), head = measured.surface.triangles(f, (c + 1) % 3);
      const auto at = [&](Index corner) {
        const auto row = uv.row(3 * measured.triangles[f] + corner);
        return Complex(row[0], row[1]);
      };
      const Complex first = at(c), second = at((c + 1) % 3);
      out.push_back(tail < head ? EdgeSide{tail, head, first, second} : EdgeSide{head, tail, second, first});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const EdgeSide& a, const EdgeSide& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  return out;
}

// Vertex pairs of the edges between two of the triangles, all or those whose sides have different coordinates.
enum class Between { all, different };
Array<Index> edges_between(const MeasuredSurface& measured, const CornerUv& uv, const Array<Index>& triangles,
                           Between wanted) {
  PositionBox box;
  const Array<EdgeSide> sides = edge_sides(measured, uv, triangles);
  for (const EdgeSide& side : sides) box.add(side.at_low);
  const double tolerance = same_position * box.size();
  Array<Index> out;
  const auto same_edge = [&](std::size_t i, std::size_t j) {
    return j < sides.size() && sides[i].low == sides[j].low && sides[i].high == sides[j].high;
  };
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i + 1; same_edge(i, end);) ++end;
    if (end - i != 2) continue;
    const EdgeSide &a = sides[i], &b = sides[i + 1];
    const bool differs = std::abs(a.at_low - b.at_low) > tolerance || std::abs(a.at_high - b.at_high) > tolerance;
    if (wanted == Between::all || differs) out.insert(out.end(), {a.low, a.high});
  }
  return out;
}

// Non-orientable components are cut along the layout's seams; if an island is still non-orientable, along every edge.
// cut_edges: gets the edges whose sides have different coordinates.
Topology build_two_sided(MeasuredSurface& measured, const CornerUv& uv, Array<Index>& cut_edges) {
  std::vector<Finding> ignored;
  Topology topology = build_topology(measured.surface, {}, ignored);
  OpenSeams open(measured.triangles.size(), 0);
  Array<Index> seams;
  for (const Between wanted : {Between::different, Between::all}) {
    const std::size_t before = seams.size();
    for (const Component& component : topology.components) {
      if (component.orientable) continue;
      for (const Index f : component.source_triangle) open[f] = 1;
      const Array<Index> edges = edges_between(measured, uv, component.source_triangle, wanted);
      seams.insert(seams.end(), edges.begin(), edges.end());
    }
    if (seams.size() == before) continue;
    if (wanted == Between::different) cut_edges.insert(cut_edges.end(), seams.begin(), seams.end());
    measured.surface.seams = to_vertex_pairs(seams);
    topology = build_topology(measured.surface, open, ignored);
  }
  return topology;
}

// Edges at which the two sides have different coordinates.
PerHalfedge<char> find_open_edges(const HalfedgeMesh& mesh, const Eigen::VectorXcd& position, double tolerance) {
  PerHalfedge<char> is_cut(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == none) continue;
    is_cut[h] = std::abs(position[h] - position[next(twin)]) > tolerance ||
                std::abs(position[next(h)] - position[twin]) > tolerance;
  }
  return is_cut;
}

}  // namespace

Measurement measure_distortion(const Surface& surface, const CornerUv& corner_uv, const std::vector<Index>* cones,
                               const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface);
  require_one_each(surface, corner_uv);
  if (cones) require_valid(surface, {*cones, Array<std::optional<double>>(cones->size())});
  Measurement out;
  out.island.assign(static_cast<std::size_t>(surface.triangles.rows()), none);
  MeasuredSurface measured = finite_triangles(surface, corner_uv);
  out.cut_edges.resize(0, 2);
  if (measured.triangles.empty()) return out;
  const CornerUv uv = unit_scale(corner_uv, measured.triangles) * corner_uv;
  out.distortion = measure_triangles(surface, uv, measured.triangles);

  PerVertex<char> given(surface.positions.rows(), 0);
  if (cones) {
    for (const Index v : *cones) given[v] = 1;
  }
  Array<Index> cut_edges;
  Index island_count = 0;
  const Topology topology = build_two_sided(measured, uv, cut_edges);
  for (const Component& component : topology.components) {
    const HalfedgeMesh& mesh = component.mesh;
    monitor.tick();
    Eigen::VectorXcd position(mesh.halfedge_count());
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      const Index at = component.source_corner(corner), source = 3 * measured.triangles[at / 3] + at % 3;
      position[corner] = {uv(source, 0), uv(source, 1)};
    }
    const double size = std::max(position.real().maxCoeff() - position.real().minCoeff(),
                                 position.imag().maxCoeff() - position.imag().minCoeff());
    const PerHalfedge<char> is_cut = find_open_edges(mesh, position, same_position * size);

    PerTriangle<Index> label;
    const Index count = label_parts(mesh, is_cut, label);
    PerPart<Index> positive(count, 0), total(count, 0);
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      positive[label[f]] += doubled_area(position, f) > 0;
      ++total[label[f]];
    }
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      const Index source = measured.triangles[component.source_triangle[f]];
      const bool mirrored = 2 * positive[label[f]] < total[label[f]];
      element(out.island, source) = island_count + label[f];
      if (!((mirrored ? -1 : 1) * doubled_area(position, f) > 0)) out.flipped.push_back(source);
    }
    island_count += count;

    const Eigen::VectorXd sums = angle_sums(mesh, position);
    PerVertex<char> is_node(mesh.vertex_count(), 0);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      is_node[v] = cones ? given[component.source_vertex[v]] : std::abs(std::abs(sums[v]) - 2 * M_PI) > cone_threshold;
    }
    const CutGraph graph = trace_cuts(mesh, is_node, is_cut);
    out.seams = worse(out.seams, measure_seams(mesh, graph, position, nullptr));
    append_ends(component, is_cut, cut_edges);
  }
  for (const auto& [f, original] : topology.duplicates)
    element(out.island, measured.triangles[f]) = element(out.island, measured.triangles[original]);
  std::sort(out.flipped.begin(), out.flipped.end());
  out.cut_edges = to_vertex_pairs(cut_edges);
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <optional>
#include <utility>

#include "api/map_surface.hpp"
#include "assembly/vertex_pairs.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/missing_seams.hpp"
#include "pipeline/wording.hpp"
#include "prescription/component_system.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

namespace {

// None where no chart has one.
std::optional<Result> map_along_seams(const Surface& surface, Options options, const Progress& progress) {
  options.seams = SeamMode::exact;
  try {
    return map_surface(surface, {{}, options, {}, OverlapSearch::made}, progress);
  } catch (const Error& error) {
    const bool is_of_charts = error_kind(error.code()) == ErrorKind::topology || error.code() == Code::solver_failed ||
                              error_kind(error.code()) == ErrorKind::curvature || error.code() == Code::degenerate_mesh;
    if (!is_of_charts) throw;
    return std::nullopt;
  }
}

// None where the geometry or the edges do not allow any.
VertexPairs cuts_missing_in(const Component& component, const ComponentTask& task) {
  Array<Index> edges;
  try {
    std::vector<Finding> unsaid;
    const Geometry geometry = require_geometry(component, unsaid);
    ComponentSystem system({component.mesh, geometry}, task.cones, Factorization::automatic);
    for (const Index h : missing_seams(system, task)) {
      edges.push_back(component.source_vertex[component.mesh.origin(h)]);
      edges.push_back(component.source_vertex[component.mesh.target(h)]);
    }
  } catch (const Error& error) {
    if (error.code() == Code::cancelled) throw;
    edges.clear();
  }
  return to_vertex_pairs(edges);
}

}  // namespace

std::vector<Chart> measure_charts(const Surface& surface, const Options& options, const Progress& progress) try {
  constexpr double of_map = 0.8;  // of the time
  const auto share_of = [&](double begin, double end) -> Progress {
    if (!progress) return {};
    return [&progress, begin, end](double done) { return progress(begin + (end - begin) * done); };
  };
  const std::optional<Result> map = map_along_seams(surface, options, share_of(0, of_map));
  StageSeconds seconds;
  const Progress rest = share_of(of_map, 1);
  ProgressMonitor monitor(rest, seconds);
  Options opened;
  opened.seams = SeamMode::boundary;
  std::vector<Finding> unsaid;
  const Work work = prepare({surface, {}, opened}, unsaid);
  PerTriangle<char> is_flipped(surface.triangles.rows(), 0), is_overlapping(surface.triangles.rows(), 0);
  if (map) {
    for (const Index f : map->flipped) is_flipped[f] = 1;
    for (const Index f : map->overlapping) is_overlapping[f] = 1;
  }
  std::vector<Chart> out;
  for (std::size_t i = 0; i < work.tasks.size(); ++i) {
    const Component& component = work.topology.components[i];
    monitor.advance(static_cast<double>(i) / static_cast<double>(work.tasks.size()));
    Chart chart;
    chart.triangles = component.source_triangle;
    chart.euler = component.mesh.euler;
    chart.borders = static_cast<int>(component.mesh.boundary_loops.size());
    chart.is_mapped = map && element(map->island, component.source_triangle.front()) != none;
    for (const Index f : component.source_triangle) {
      chart.flipped += is_flipped[f];
      chart.overlapping += is_overlapping[f];
    }
    chart.l2_stretch = chart.is_mapped
                           ? measure_triangles(surface, map->corner_uv, component.source_triangle).l2_stretch
                           : std::numeric_limits<double>::infinity();
    chart.missing = cuts_missing_in(component, work.tasks[i]);
    out.push_back(std::move(chart));
  }
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

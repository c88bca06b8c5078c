// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/marked_seams.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/progress_share.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "measures/made_map.hpp"
#include "measures/map_comparison.hpp"
#include "measures/surface_parts.hpp"
#include "mesh/edge_set.hpp"
#include "mesh/part_of_surface.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// Without cones no texture runs on across seams, which is what seamless layouts are conformal for.
MapOptions with_least_stretch(MapOptions options) {
  if (options.of_map.seamless) options.of_map.mode = Mode::low_stretch;
  return options;
}

bool is_good(const Chart& chart, double target) {
  return chart.is_mapped && chart.flipped == 0 && chart.l2_stretch <= target;
}

// Which triangles are in good charts.
PerTriangle<char> in_good_charts(const std::vector<Chart>& charts, const Surface& surface, double target) {
  PerTriangle<char> out(surface.triangles.rows(), 0);
  for (const Chart& chart : charts) {
    for (const Index f : chart.triangles) out[f] = is_good(chart, target);
  }
  return out;
}

bool are_all_in(const PerTriangle<char>& flags, const std::vector<Index>& triangles) {
  return std::all_of(triangles.begin(), triangles.end(), [&](Index f) { return flags[f]; });
}

VertexPairs missing_in(const Array<Chart>& charts) {
  VertexPairs out(0, 2);
  for (const Chart& chart : charts) out = joined(out, chart.missing);
  return out;
}

Surface with_seams(Surface surface, const VertexPairs& seams) {
  surface.seams = joined(surface.seams, seams);
  return surface;
}

Surface without_seams(Surface surface) {
  surface.seams.resize(0, 2);
  return surface;
}

// Which triangles are in components without given cones all of whose triangles are good.
PerTriangle<char> in_good_components(const Surface& surface, const Cones& given, PerTriangle<char> good) {
  const Surface whole = without_seams(surface);
  const SurfaceParts parts{std::cref(whole)};
  PerComponent<char> is_bad(parts.count(), 0);
  for (std::size_t f = 0; f < good.size(); ++f) {
    if (parts.of_triangle()[f] != none && !good[f]) is_bad[parts.of_triangle()[f]] = 1;
  }
  for (const Index cone : given.vertices) {
    if (parts.of_vertex()[cone] != none) is_bad[parts.of_vertex()[cone]] = 1;
  }
  for (std::size_t f = 0; f < good.size(); ++f) {
    good[f] = parts.of_triangle()[f] != none && !is_bad[parts.of_triangle()[f]];
  }
  return good;
}

// The map of a seamless layout across whose seams the texture runs on, without cones; none where there is no map.
std::optional<Result> running_on(const Surface& surface, const MapOptions& options) try {
  return parameterize(surface, {}, options.through({}));
} catch (const Error& error) {
  if (error.code() == Code::cancelled) throw;
  return {};
}

// The options of a seamless layout, and which triangles get no cones in it: the texture runs on across seams where that
// is stretched no more than the target; otherwise it ends at them, where no component gets cones.
void choose_on_lattice(double target, AlongSeams& along) {
  const Surface whole = without_seams(along.surface);
  const SurfaceParts parts{std::cref(whole)};
  PerTriangle<char>& good = along.given.without;
  bool is_all = true;
  for (std::size_t f = 0; f < good.size(); ++f) is_all = is_all && (parts.of_triangle()[f] == none || good[f]);
  MapOptions least = is_all ? with_least_stretch(along.options) : along.options;
  const std::optional<Result> found = running_on(along.surface, least);
  PerComponent<char> is_reached(parts.count(), 0);
  if (found) {
    const PerComponent<double> stretches = stretches_on(parts, *found);
    const PerComponent<Index> defects = defects_on(parts, *found);
    for (Index i = 0; i < parts.count(); ++i) is_reached[i] = stretches[i] <= target && defects[i] == 0;
  }
  const bool runs_on = found && defect_count(*found) == 0 &&
                       std::all_of(is_reached.begin(), is_reached.end(), [](char is) { return is; });
  if (is_all && !runs_on) {
    least.of_map.seams = SeamMode::boundary;
  } else {
    for (std::size_t f = 0; f < good.size(); ++f) {
      good[f] = good[f] && parts.of_triangle()[f] != none && is_reached[parts.of_triangle()[f]];
    }
  }
  along.options = least;
}

}  // namespace

AlongSeams along_seams(const Surface& surface, const GivenCones& given, const MapOptions& options,
                       const Progress& progress) {
  AlongSeams out{surface, given, options, VertexPairs(0, 2)};
  const Options& of_map = options.of_map;
  if (of_map.seams == SeamMode::exact) {
    if (given.count) {
      throw Error(Code::wrong_parameter,
                  concat("count is ", *given.count, "; leave it out: with SeamMode::exact no cones are placed."));
    }
    out.given.without.assign(surface.triangles.rows(), 1);
    if (given.cones.vertices.empty()) out.options = with_least_stretch(options);
    return out;
  }
  const bool is_plain = of_map.border != BorderMode::straight && of_map.loop_turning.empty() &&
                        of_map.unfold == UnfoldMethod::poisson && of_map.method == Method::lsgp;
  if (of_map.seams != SeamMode::follow || surface.seams.rows() == 0 || !is_plain) return out;
  Options of_charts = with_least_stretch(options).through({});
  of_charts.seamless.reset();
  const std::vector<Chart> charts = measure_charts(surface, of_charts, share_of(progress, 0, 0.5));
  PerTriangle<char>& good = out.given.without;
  good = in_good_charts(charts, surface, given.target);
  Array<Chart> lacking;
  std::copy_if(charts.begin(), charts.end(), std::back_inserter(lacking),
               [&](const Chart& chart) { return chart.missing.rows() > 0 && !are_all_in(good, chart.triangles); });
  if (!lacking.empty()) {
    std::vector<Index> triangles;
    for (const Chart& chart : lacking)
      triangles.insert(triangles.end(), chart.triangles.begin(), chart.triangles.end());
    std::sort(triangles.begin(), triangles.end());
    const Surface own = part_of(with_seams(surface, missing_in(lacking)), triangles);
    const PerTriangle<char> own_good =
        in_good_charts(measure_charts(own, of_charts, share_of(progress, 0.5, 1)), own, given.target);
    for (std::size_t i = 0; i < triangles.size(); ++i) good[triangles[i]] = own_good[i];
  }
  const bool is_whole = of_map.seamless || !given.cones.vertices.empty();
  if (is_whole) good = in_good_components(surface, given.cones, good);
  lacking.erase(std::remove_if(lacking.begin(), lacking.end(),
                               [&](const Chart& chart) { return !are_all_in(good, chart.triangles); }),
                lacking.end());
  out.further = missing_in(lacking);
  out.surface = with_seams(surface, out.further);
  if (!is_whole) {
    out.options.of_map.seams = SeamMode::boundary;
  } else if (of_map.seamless) {
    choose_on_lattice(given.target, out);
  }
  return out;
}

void tell_further_cuts(const VertexPairs& further, Result& result) {
  if (further.rows() == 0) return;
  const EdgeSet edges(further);
  std::vector<std::vector<Index>> paths;
  std::vector<CutPathKind> kinds;
  for (std::size_t i = 0; i < result.cut_paths.size(); ++i) {
    const std::vector<Index>& path = result.cut_paths[i];
    const auto is_further = [&](std::size_t place) { return edges.has(path[place], path[place + 1]); };
    for (std::size_t e = 0; e + 1 < path.size(); ++e) {
      if (e == 0 || is_further(e) != is_further(e - 1)) {
        const bool is_new = result.cut_kinds[i] == CutPathKind::seam && is_further(e);
        paths.push_back({path[e]});
        kinds.push_back(is_new ? CutPathKind::required : result.cut_kinds[i]);
      }
      paths.back().push_back(path[e + 1]);
    }
  }
  result.cut_paths = std::move(paths);
  result.cut_kinds = std::move(kinds);
  result.required_cuts = joined(result.required_cuts, further);
  result.warnings.push_back({Code::cuts_added,
                             concat(count(further.rows(), "edge was", "edges were"),
                                    " cut besides the marked seams, which leave parts that are no disks and would be "
                                    "stretched too much. Mark seams there to choose other routes."),
                             {ElementKind::edges, {further.data(), further.data() + further.size()}}});
}

}  // namespace lsgp

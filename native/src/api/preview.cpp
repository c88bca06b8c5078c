// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/preview.hpp"

#include <algorithm>
#include <utility>

#include "api/map_surface.hpp"
#include "assembly/carried_map.hpp"
#include "assembly/cut_paths.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/thread_team.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/refined_surface.hpp"
#include "mesh/thinned_surface.hpp"
#include "mesh/vertex_costs.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"

namespace lsgp {

namespace {

// The edges of thinned triangles that stay when vertices are added.
PerHalfedge<char> fixed_edges(const Surface& surface, const EdgeTable& edges, const ThinnedSurface& thinned) {
  PerEdge<char> is_fixed(edges.count(), 0);
  for (const VertexPairs* pairs : {&surface.seams, &surface.borders, &surface.features}) {
    for (Eigen::Index row = 0; row < pairs->rows(); ++row) {
      const Index edge = edges.find((*pairs)(row, 0), (*pairs)(row, 1));
      if (edge != none) is_fixed[edge] = 1;
    }
  }
  PerHalfedge<char> out(thinned.twin.size(), 0);
  for (Index h = 0; h < ssize(out); ++h) {
    const Index edge = edges.find(thinned.triangles.data()[h], thinned.triangles.data()[next(h)]);
    out[h] = edge != none && is_fixed[edge];
  }
  return out;
}

// The smaller surface with the cones among its vertices, as one of its own.
class ConedSurface {
 public:
  // without_cones: the smaller surface.  place: of vertices on it.  left: its own ones.
  ConedSurface(RefinedSurface without_cones, const PerVertex<SurfacePlace>& place, VerticesLeft left,
               const std::vector<Index>& cones)
      : refined(std::move(without_cones)), nodes_(std::move(left)) {
    for (const Index v : cones) {
      if (nodes_.number[v] != none) continue;
      refined.add(v, place[v]);
      nodes_.number[v] = node_count();
      nodes_.vertex.push_back(v);
    }
    for (Index f = 0; f < refined.triangle_count(); ++f) {
      if (!refined.is_replaced(f)) triangle_of_row_.push_back(f);
    }
  }

  Triangles triangles() const {
    Triangles out(ssize(triangle_of_row_), 3);
    for (Index row = 0; row < out.rows(); ++row) {
      const auto& corners = refined.triangle(triangle_of_row_[row]);
      for (int c = 0; c < 3; ++c) out(row, c) = nodes_.number[corners[static_cast<std::size_t>(c)]];
    }
    return out;
  }

  Index vertex_of(Index node) const { return nodes_.vertex[node]; }
  Index node_count() const { return static_cast<Index>(nodes_.vertex.size()); }
  Index node(Index vertex) const { return nodes_.number[vertex]; }
  const Array<Index>& triangle_of_row() const { return triangle_of_row_; }

  RefinedSurface refined;

 private:
  VerticesLeft nodes_;            // cones that were added come last
  Array<Index> triangle_of_row_;  // of `refined`
};

}  // namespace

struct Preview::Kept {
  Kept(Surface given, Index triangles);

  // The smaller surface with the cones, as one to map.
  Surface smaller(const ConedSurface& coned) const;
  // The result there on the whole surface.
  Result carried(const ConedSurface& coned, Result small) const;

  const Surface surface;
  PerHalfedge<Index> twin;  // of the surface
  ThinnedSurface thinned;
  PerHalfedge<char> fixed;  // of the thinned triangles
  Eigen::VectorXd cost;     // (n) of cuts, or empty
  Positions directions;     // of the thinned triangles, or empty
  VerticesLeft left;
};

Preview::Kept::Kept(Surface given, Index triangles) : surface(std::move(given)) {
  const EdgeTable edges(surface, PerTriangle<char>(surface.triangles.rows(), 0));
  twin = find_twins(surface, edges);
  thinned = thin(surface, edges, twin, triangles);
  fixed = fixed_edges(surface, edges, thinned);
  cost = costs_at_vertices(surface);
  if (surface.directions.rows() > 0) {
    directions = Positions::Zero(thinned.triangles.rows(), 3);
    for (Index f = 0; f < surface.directions.rows(); ++f) {
      directions.row(triangle_left(surface.triangles, thinned, f)) += surface.directions.row(f);
    }
  }
  left = vertices_left(thinned);
}

namespace {

// Triangles have no counterpart.
Elements on_whole_surface(const ConedSurface& coned, Elements elements) {
  if (elements.kind == ElementKind::triangles) return {};
  for (Index& v : elements.indices) v = coned.vertex_of(v);
  return elements;
}

}  // namespace

Surface Preview::Kept::smaller(const ConedSurface& coned) const {
  Surface out;
  out.triangles = coned.triangles();
  out.positions.resize(coned.node_count(), 3);
  for (Index i = 0; i < coned.node_count(); ++i) out.positions.row(i) = surface.positions.row(coned.vertex_of(i));
  const auto renumbered = [&](VertexPairs pairs) {
    for (Index& v : pairs.reshaped()) v = coned.node(v);
    return pairs;
  };
  out.seams = renumbered(surface.seams);
  out.borders = renumbered(surface.borders);
  out.features = renumbered(surface.features);
  out.may_collapse = surface.may_collapse;
  if (surface.importance.size() > 0) {
    out.importance.resize(coned.node_count());
    for (Index i = 0; i < coned.node_count(); ++i) out.importance[i] = surface.importance[coned.vertex_of(i)];
  }
  if (surface.scale.size() > 0) {
    out.scale.resize(coned.node_count());
    for (Index i = 0; i < coned.node_count(); ++i) out.scale[i] = surface.scale[coned.vertex_of(i)];
  }
  if (directions.rows() > 0) {
    out.directions.resize(out.triangles.rows(), 3);
    for (Index row = 0; row < out.triangles.rows(); ++row) {
      out.directions.row(row) = directions.row(coned.refined.thinned_at(coned.triangle_of_row()[row]));
    }
  }
  if (cost.size() > 0) {
    Eigen::VectorXd own(coned.node_count());
    for (Index i = 0; i < coned.node_count(); ++i) own[i] = cost[coned.vertex_of(i)];
    take_costs(own, out);
  }
  return out;
}

Result Preview::Kept::carried(const ConedSurface& coned, Result small) const {
  const Array<Index>& triangle_of_row = coned.triangle_of_row();
  PerHalfedge<Complex> position(3 * coned.refined.triangle_count());
  PerTriangle<Index> row_of_triangle(coned.refined.triangle_count(), none);
  for (Index row = 0; row < ssize(triangle_of_row); ++row) {
    row_of_triangle[triangle_of_row[row]] = row;
    for (Index c = 0; c < 3; ++c) {
      position[3 * triangle_of_row[row] + c] = {small.corner_uv(3 * row + c, 0), small.corner_uv(3 * row + c, 1)};
    }
  }
  const CarriedMap map(surface.triangles, thinned, coned.refined, position);
  Result out = std::move(small);
  PerTriangle<Index> row(surface.triangles.rows());
  for (Index f = 0; f < ssize(row); ++f) row[f] = row_of_triangle[map.home(f)];
  out.corner_uv = map.corner_uv();
  const std::vector<Index> island = std::move(out.island);
  out.island.resize(row.size());
  for (std::size_t f = 0; f < row.size(); ++f) out.island[f] = element(island, row[f]);
  if (out.direction_errors.size() > 0) {
    out.direction_errors = Eigen::VectorXd::NullaryExpr(
        ssize(row), [&, errors = out.direction_errors](Eigen::Index f) { return errors[row[f]]; });
  }
  Eigen::VectorXd log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  for (Index i = 0; i < coned.node_count(); ++i) log_scale[coned.vertex_of(i)] = out.log_scale[i];
  out.log_scale = map.interpolated(log_scale);
  for (Index& cone : out.cones) cone = coned.vertex_of(cone);
  out.cut_edges = out.required_cuts = map.cuts(out.corner_uv, twin);
  out.flipped.clear();
  out.wrong_angle_sums.clear();
  out.overlapping.clear();
  if (out.features) {
    for (ReleasedFeature& feature : out.features->released) {
      for (Index& v : feature.path) v = coned.vertex_of(v);
    }
  }
  for (Finding& finding : out.warnings) finding.elements = on_whole_surface(coned, std::move(finding.elements));
  trace_cut_paths(surface, out);
  return out;
}

Preview::Preview(Surface surface, Index triangles, const Progress& progress) try {
  require_valid(surface);
  if (triangles < 1) throw Error(Code::wrong_parameter, "The number of triangles is not positive. Pass at least 1.");
  StageSeconds seconds;
  const ProgressMonitor monitor(progress, seconds);
  kept_ = std::make_unique<const Kept>(std::move(surface), triangles);
} catch (const Error& error) {
  throw in_words(error);
}
Preview::~Preview() = default;
Preview::Preview(Preview&&) noexcept = default;

Result Preview::parameterize(const Cones& cones, const Options& options, const Progress& progress) const try {
  if (options.seamless) {
    throw Error(Code::wrong_parameter, "A seamless layout must be exact. Preview it without the option `seamless`.");
  }
  const ThinnedSurface& thinned = kept_->thinned;
  if (thinned.triangles.rows() == kept_->surface.triangles.rows()) {
    return lsgp::parameterize(kept_->surface, cones, options, {}, progress);
  }
  require_valid(kept_->surface, cones);
  const ConedSurface coned({thinned, kept_->surface.positions, kept_->fixed}, thinned.place, kept_->left,
                           cones.vertices);
  Cones of_nodes = cones;
  for (Index& v : of_nodes.vertices) v = coned.node(v);
  const Surface small = kept_->smaller(coned);
  Options of_small = options;
  for (auto& [vertex, turning] : of_small.loop_turning) {
    // Others are refused by their number.
    if (vertex >= 0 && vertex < kept_->surface.positions.rows()) vertex = coned.node(vertex);
  }
  const ThreadCount threads(options.threads);
  const Pins unpinned;
  try {
    Result of_surface = map_surface(small, {of_nodes, of_small, unpinned, OverlapSearch::left_out}, progress);
    return kept_->carried(coned, std::move(of_surface));
  } catch (const Error& error) {
    throw Error(error.code(), in_words(error).what(), on_whole_surface(coned, error.elements()));
  }
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/cut_costs.hpp"

#include <algorithm>
#include <cmath>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "cut/cut_cost.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/geometry.hpp"
#include "mesh/visibility.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"

namespace lsgp {

namespace {

// The factor of a crease: 1 where the surface is smooth, the least from the largest angle on.
double crease_factor(double angle) {
  constexpr double largest = 50 * M_PI / 180, least = 0.12;
  const double bend = std::clamp((angle - smooth_bend) / (largest - smooth_bend), 0.0, 1.0);
  return 1 - (1 - least) * bend * bend * (3 - 2 * bend);
}

// The largest angle between the normals of two triangles at each edge, radians.
Eigen::VectorXd crease_angles(const Surface& surface, const EdgeTable& edges) {
  Positions normal(surface.triangles.rows(), 3);
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    normal.row(f) = area_normal(surface.positions, surface.triangles, f).stableNormalized();
  }
  Eigen::VectorXd angle = Eigen::VectorXd::Zero(edges.count());
  for (Index edge = 0; edge < edges.count(); ++edge) {
    const Eigen::Vector3d first = normal.row(edges.halfedge(edge, 0) / 3);
    for (Index i = 1; i < edges.halfedge_count(edge); ++i) {
      const Eigen::Vector3d other = normal.row(edges.halfedge(edge, i) / 3);
      angle[edge] = std::max(angle[edge], angle_between(other, first));
    }
  }
  return angle;
}

// The factor of creases and sharp edges for each row of the surface's edges.
Eigen::VectorXd crease_factors(const Surface& surface, const CutPreferences& preferences) {
  const EdgeTable edges(surface, PerTriangle<char>(surface.triangles.rows(), 0));
  Eigen::VectorXd angle = Eigen::VectorXd::Zero(edges.count());
  if (preferences.creases) angle = crease_angles(surface, edges);
  const VertexPairs& sharp = preferences.sharp;
  for (Index i = 0; i < sharp.rows(); ++i) {
    const Index edge = edges.find(sharp(i, 0), sharp(i, 1));
    if (edge != none) angle[edge] = M_PI;
  }
  Eigen::VectorXd out = Eigen::VectorXd::Ones(surface.edges->rows());
  for (Index row = 0; row < out.size(); ++row) {
    const Index edge = edges.find((*surface.edges)(row, 0), (*surface.edges)(row, 1));
    if (edge != none) out[row] = crease_factor(angle[edge]);
  }
  return out;
}

void require_preferences(const Surface& surface, const CutPreferences& preferences) {
  if (!surface.edges) {
    throw Error(Code::wrong_parameter,
                "Cut costs need the list of edges that cuts may follow. Set the surface's `edges`.");
  }
  if (preferences.front && !(preferences.front->allFinite() && preferences.front->cwiseAbs().maxCoeff() > 0)) {
    throw Error(Code::wrong_parameter, "The front is not a direction. Give three finite numbers that are not all 0.");
  }
  require_vertices(surface, preferences.sharp, "sharp edges");
  const Eigen::VectorXd& paint = preferences.paint;
  if (paint.size() == 0) return;
  if (paint.size() != surface.positions.rows()) {
    throw Error(Code::wrong_parameter, concat("There are ", paint.size(), " painted costs for ",
                                              surface.positions.rows(), " vertices. Give one for each."));
  }
  Array<Index> bad;
  for (Index v = 0; v < paint.size(); ++v) {
    if (!(paint[v] >= 0 && paint[v] <= 1)) bad.push_back(v);
  }
  if (bad.empty()) return;
  throw Error(Code::wrong_parameter,
              concat("The painted cost of ", count(bad.size(), "vertex", "vertices"),
                     " does not lie between 0 and 1. Give 0 where cuts should run and 1 where they should not."),
              {ElementKind::vertices, bad});
}

}  // namespace

Eigen::VectorXd cut_costs(const Surface& surface, const CutPreferences& preferences, const Progress& progress) try {
  // Hidden cuts are short as well. A cut in full sight costs as much as 300 times its length behind, so that only one
  // without a way around crosses the front; at an outline, which half of the views see, it is 40 times. A crease is
  // where one looks for a cut, also in front: what sight adds is less there once more, so that an outline along a
  // crease is cheaper than a smooth back.
  constexpr double hidden = 0.1, in_full_sight = 30;
  constexpr double decades = 2;  // between paint of 0 and of 1
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface);
  require_preferences(surface, preferences);
  const VertexPairs& edges = *surface.edges;
  Eigen::VectorXd crease = Eigen::VectorXd::Ones(edges.rows());
  if (preferences.creases || preferences.sharp.rows() > 0) crease = crease_factors(surface, preferences);
  Eigen::VectorXd out = crease;
  if (preferences.front) {
    Positions middle(edges.rows(), 3);
    for (Index row = 0; row < edges.rows(); ++row) {
      middle.row(row) = (surface.positions.row(edges(row, 0)) + surface.positions.row(edges(row, 1))) / 2;
    }
    const Eigen::ArrayXd seen = visible_share(surface, middle, *preferences.front).array().cube();
    out.array() *= hidden + in_full_sight * seen * crease.array();
  }
  if (preferences.paint.size() > 0) {
    for (Index row = 0; row < edges.rows(); ++row) {
      const double paint = (preferences.paint[edges(row, 0)] + preferences.paint[edges(row, 1)]) / 2;
      out[row] *= std::pow(10.0, decades * (paint - 0.5));
    }
  }
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

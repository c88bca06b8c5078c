// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/cut_costs.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/visibility.hpp"
#include "pipeline/validation.hpp"

namespace lsgp {

namespace {

// Rows of `edges` by their vertices.
class EdgeRows {
 public:
  explicit EdgeRows(const VertexPairs& edges) {
    for (Index row = 0; row < edges.rows(); ++row) rows_.push_back({key(edges(row, 0), edges(row, 1)), row});
    std::sort(rows_.begin(), rows_.end());
  }
  // Calls visit(row) for every row with these vertices.
  template <typename Visit>
  void for_each(Index a, Index b, Visit visit) const {
    const Key wanted = key(a, b);
    for (auto at = std::lower_bound(rows_.begin(), rows_.end(), std::pair(wanted, Index{0}));
         at != rows_.end() && at->first == wanted; ++at) {
      visit(at->second);
    }
  }

 private:
  using Key = std::pair<Index, Index>;
  static Key key(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }
  Array<std::pair<Key, Index>> rows_;
};

// The factor of a crease: 1 up to the smaller angle, the least from the larger one on.
double crease_factor(double angle) {
  constexpr double smallest = 30 * M_PI / 180, largest = 50 * M_PI / 180, least = 0.12;
  const double bend = std::clamp((angle - smallest) / (largest - smallest), 0.0, 1.0);
  return 1 - (1 - least) * bend * bend * (3 - 2 * bend);
}

// The largest angle between the normals of two triangles at each edge, radians; pi at edges marked sharp.
Eigen::VectorXd crease_angles(const Surface& surface, const VertexPairs& sharp) {
  const VertexPairs& edges = *surface.edges;
  const EdgeRows rows(edges);
  Eigen::VectorXd angle = Eigen::VectorXd::Zero(edges.rows());
  Positions first = Positions::Zero(edges.rows(), 3);  // the normal of the first triangle at the edge
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    const Index* v = surface.triangles.data() + 3 * f;
    const Eigen::Vector3d a = surface.positions.row(v[0]), b = surface.positions.row(v[1]);
    const Eigen::Vector3d c = surface.positions.row(v[2]);
    const Eigen::Vector3d normal = (b - a).cross(c - a).stableNormalized();
    for (int corner = 0; corner < 3; ++corner) {
      rows.for_each(v[corner], v[(corner + 1) % 3], [&](Index row) {
        if (first.row(row).isZero()) {
          first.row(row) = normal;
          return;
        }
        const Eigen::Vector3d other = first.row(row);
        angle[row] = std::max(angle[row], std::atan2(other.cross(normal).norm(), other.dot(normal)));
      });
    }
  }
  for (Index i = 0; i < sharp.rows(); ++i) {
    rows.for_each(sharp(i, 0), sharp(i, 1), [&](Index row) { angle[row] = M_PI; });
  }
  return angle;
}

void require_preferences(const Surface& surface, const CutPreferences& preferences) {
  if (!surface.edges) {
    throw Error(
        Code::wrong_parameter,
        "Costs are those of the edges that a cut may follow, and these are not named. Name the surface's edges.");
  }
  if (preferences.front && !(preferences.front->allFinite() && preferences.front->norm() > 0)) {
    throw Error(Code::wrong_parameter, "The front is no direction. Give three numbers that are not all 0.");
  }
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

Eigen::VectorXd cut_costs(const Surface& surface, const CutPreferences& preferences, const Progress& progress) {
  constexpr double least_visible = 0.1;  // so that hidden cuts are short as well
  constexpr double decades = 2;          // between paint of 0 and of 1
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface);
  require_preferences(surface, preferences);
  const VertexPairs& edges = *surface.edges;
  Eigen::VectorXd out = Eigen::VectorXd::Ones(edges.rows());
  if (preferences.front) {
    Positions middle(edges.rows(), 3);
    for (Index row = 0; row < edges.rows(); ++row) {
      middle.row(row) = (surface.positions.row(edges(row, 0)) + surface.positions.row(edges(row, 1))) / 2;
    }
    out = visible_share(surface, middle, *preferences.front).array() + least_visible;
  }
  if (preferences.creases || preferences.sharp.rows() > 0) {
    Eigen::VectorXd angle = crease_angles(surface, preferences.sharp);
    if (!preferences.creases) angle = (angle.array() < M_PI).select(0, angle);
    for (Index row = 0; row < edges.rows(); ++row) out[row] *= crease_factor(angle[row]);
  }
  if (preferences.paint.size() > 0) {
    for (Index row = 0; row < edges.rows(); ++row) {
      const double paint = (preferences.paint[edges(row, 0)] + preferences.paint[edges(row, 1)]) / 2;
      out[row] *= std::pow(10.0, decades * (paint - 0.5));
    }
  }
  monitor.advance(1);
  return out;
}

}  // namespace lsgp

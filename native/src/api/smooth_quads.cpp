// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/array.hpp"
#include "base/checkpoint.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/validation.hpp"
#include "quads/surface_points.hpp"

namespace lsgp {

namespace {

constexpr double share_of_way = 0.5;  // the whole of it would swing to and fro
constexpr double operations_a_vertex = 500;

void require_valid(const Surface& surface, const QuadMesh& mesh, int steps) {
  require_valid(surface);
  const Eigen::Index count = mesh.positions.rows();
  const auto fits = [&](const auto& values) { return static_cast<Eigen::Index>(values.size()) == count; };
  const auto names = [](const auto& indices, Eigen::Index least, Eigen::Index end) {
    return std::all_of(indices.begin(), indices.end(), [&](Index i) { return i >= least && i < end; });
  };
  const std::vector<Index> corners(mesh.quads.data(), mesh.quads.data() + mesh.quads.size());
  if (!(fits(mesh.valences) && fits(mesh.triangles) && fits(mesh.surface_vertices) && mesh.weights.rows() == count &&
        names(corners, 0, count) && names(mesh.triangles, 0, surface.triangles.rows()) && mesh.positions.allFinite() &&
        mesh.weights.allFinite())) {
    throw Error(Code::wrong_parameter, "The quads are not of this surface. Give those that were extracted from it.");
  }
  if (steps < 0) throw Error(Code::wrong_parameter, concat("There are ", steps, " steps. Choose 0 or more."));
}

// The middle of each vertex's neighbours: every side of a quad leads to one of them.
Positions middles(const QuadMesh& mesh) {
  Positions sum = Positions::Zero(mesh.positions.rows(), 3);
  Eigen::VectorXd neighbours = Eigen::VectorXd::Zero(mesh.positions.rows());
  for (Eigen::Index q = 0; q < mesh.quads.rows(); ++q) {
    for (int c = 0; c < 4; ++c) {
      sum.row(mesh.quads(q, c)) += mesh.positions.row(mesh.quads(q, (c + 1) % 4));
      neighbours[mesh.quads(q, c)] += 1;
    }
  }
  for (Eigen::Index v = 0; v < sum.rows(); ++v) sum.row(v) /= std::max(1.0, neighbours[v]);
  return sum;
}

}  // namespace

QuadMesh smooth_quads(const Surface& surface, const QuadMesh& mesh, int steps, const Progress& progress) {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface, mesh, steps);
  const SurfacePoints points(surface);
  QuadMesh out = mesh;
  for (int step = 0; step < steps; ++step) {
    monitor.advance(static_cast<double>(step) / steps);
    const Positions middle = middles(out);
    for (Index v = 0; v < out.positions.rows(); ++v) {
      if (element(out.valences, v) != 4) continue;
      checkpoint(operations_a_vertex);
      const SurfacePoint from{element(out.triangles, v), out.weights.row(v)};
      const Eigen::Vector3d at = out.positions.row(v), normal = points.normal(from.triangle);
      const Eigen::Vector3d way = share_of_way * (middle.row(v).transpose() - at);
      const SurfacePoint to = points.nearest(from, at + way - way.dot(normal) * normal);
      element(out.triangles, v) = to.triangle;
      element(out.surface_vertices, v) = -1;
      out.weights.row(v) = to.weights;
      out.positions.row(v) = points.position(to);
    }
  }
  monitor.advance(1);
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/frames.hpp"

#include <cmath>

#include "base/thread_team.hpp"
#include "solvers/sparse_assembly.hpp"

namespace lsgp {

namespace {

// The edge's direction in the frame on its left minus that in the frame on its right, radians.
double turn_across(const MetricMesh& surface, Index h) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  return edge_direction(geometry, h) - (edge_direction(geometry, mesh.twin[h]) + M_PI);
}

}  // namespace

FrameTree::FrameTree(const MetricMesh& surface, const CutGraph& cut_graph)
    : triangle_count_(surface.mesh.triangle_count()) {
  const HalfedgeMesh& mesh = surface.mesh;
  steps_.reserve(triangle_count_);
  Array<Index> across;  // (steps) the halfedge that each one crosses
  across.reserve(triangle_count_);
  PerTriangle<char> reached(triangle_count_, 0);
  const auto leave = [&](Index f) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index twin = mesh.twin[h];
      if (twin == none || cut_graph.is_cut[h] || reached[twin / 3]) continue;
      reached[twin / 3] = 1;
      steps_.push_back({f, twin / 3, mesh.origin(h), mesh.target(h), 0, 0});
      across.push_back(h);
    }
  };
  reached[0] = 1;
  leave(0);
  for (std::size_t i = 0; i < steps_.size(); ++i) leave(steps_[i].to);
  for_each_at_once(ssize(steps_), [&](std::ptrdiff_t i) {
    steps_[i].turn = turn_across(surface, across[i]);
    steps_[i].weight = cotangent_weight(surface, across[i]);
  });
}

Eigen::VectorXd FrameTree::integrate(const Eigen::VectorXd& log_scale) const {
  Eigen::VectorXd frames = Eigen::VectorXd::Zero(triangle_count_);
  for (const Step& step : steps_) {
    const double scale_change = log_scale[step.head] - log_scale[step.tail];
    frames[step.to] = frames[step.from] + step.turn - step.weight * scale_change;
  }
  return frames;
}

Eigen::VectorXd read_rotations(const MetricMesh& surface, const CutGraph& cut_graph, const Eigen::VectorXd& log_scale,
                               const Eigen::VectorXd& frames) {
  const HalfedgeMesh& mesh = surface.mesh;
  Eigen::VectorXd rotation(cut_graph.cuts.size());
  for (Eigen::Index p = 0; p < rotation.size(); ++p) {
    const Index h = cut_graph.cuts[p].halfedges.front();
    const double scale_change = log_scale[mesh.target(h)] - log_scale[mesh.origin(h)];
    const double step = turn_across(surface, h) - cotangent_weight(surface, h) * scale_change;
    rotation[p] = frames[mesh.twin[h] / 3] - frames[h / 3] - step;
  }
  return rotation;
}

// Differences across edges are weighted by the ratio of the edge's length to that of the path between centroids.
double HarmonicOneForm::weight(Index h) const {
  return geometry_.length[h] * geometry_.length[h] / (geometry_.area[h / 3] + geometry_.area[mesh_.twin[h] / 3]);
}

template <typename Visit>
void HarmonicOneForm::for_each_crossing(Visit visit) const {
  for (std::size_t p = 0; p < cut_graph_.cuts.size(); ++p) {
    for (const Index h : cut_graph_.cuts[p].halfedges) {
      visit(static_cast<Eigen::Index>(p), h / 3, mesh_.twin[h] / 3, weight(h));
    }
  }
}

HarmonicOneForm::HarmonicOneForm(const MetricMesh& surface, const CutGraph& cut_graph)
    : mesh_(surface.mesh), geometry_(surface.geometry), cut_graph_(cut_graph) {
  const HalfedgeMesh& mesh = surface.mesh;
  LowerAssembly<double> assembly(mesh.triangle_count() - 1, 2 * static_cast<std::size_t>(mesh.halfedge_count()));
  const auto add = [&](Index row, Index column, double value) {
    if (row > 0 && column > 0) assembly.add(row - 1, column - 1, value);  // the first triangle stays
  };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] < h) continue;
    const Index f = h / 3, g = mesh.twin[h] / 3;
    add(f, f, weight(h));
    add(g, g, weight(h));
    if (f != g) add(f, g, -weight(h));
  }
  factor_.emplace(assembly.build());
}

Eigen::VectorXd HarmonicOneForm::spread(const Eigen::VectorXd& change) const {
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(mesh_.triangle_count());
  for_each_crossing([&](Eigen::Index cut, Index left, Index right, double weight) {
    pull[left] -= weight * change[cut];
    pull[right] += weight * change[cut];
  });
  Eigen::VectorXd out = Eigen::VectorXd::Zero(pull.size());
  out.tail(out.size() - 1) = factor_->solve(Eigen::VectorXd(pull.tail(pull.size() - 1)));
  return out;
}

Eigen::MatrixXd HarmonicOneForm::energy(const Eigen::MatrixXd& changes) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(changes.cols(), changes.cols());
  for (Eigen::Index k = 0; k < changes.cols(); ++k) {
    // The remainder of change minus spread is orthogonal to every spread.
    const Eigen::VectorXd turned = spread(changes.col(k));
    for_each_crossing([&](Eigen::Index cut, Index left, Index right, double weight) {
      out.col(k) += weight * (changes(cut, k) - turned[right] + turned[left]) * changes.row(cut).transpose();
    });
  }
  return out;
}

Eigen::VectorXd metric_directions(const MetricMesh& surface, const Eigen::VectorXd& log_scale,
                                  const Eigen::VectorXd& frames, const Array<Index>& edges) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  Eigen::VectorXd out(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index h = edges[i];
    const double bend = geometry.half_cotangent[h] * (log_scale[mesh.target(h)] - log_scale[mesh.origin(h)]);
    out[static_cast<Eigen::Index>(i)] = frames[h / 3] + edge_direction(geometry, h) - bend;
  }
  return out;
}

}  // namespace lsgp

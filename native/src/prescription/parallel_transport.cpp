// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/parallel_transport.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "base/checkpoint.hpp"
#include "prescription/quantize_curvature.hpp"
#include "unfold/frames.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

Eigen::VectorXd curvature_of_nodes(const HalfedgeMesh& mesh, const NodeGraph& nodes, const Eigen::VectorXd& at_vertex) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(ssize(nodes.vertex));
  for (Eigen::Index node = 0; node < out.size(); ++node) {
    if (nodes.vertex[node] != none) {
      out[node] = at_vertex[nodes.vertex[node]];
    } else {
      for (const Index v : mesh.boundary_loops[nodes.loop[node]]) out[node] += at_vertex[v];
    }
  }
  return out;
}

namespace {

// The changes of all rotations, (cuts, loops), that turn each of the loops about handles by 1.
Eigen::MatrixXd loop_changes(const NodeGraph& nodes) {
  const Eigen::Index cuts = static_cast<Eigen::Index>(nodes.tail.size());
  Array<Eigen::VectorXd> columns;
  for (Eigen::Index p = 0; p < cuts; ++p) {
    if (nodes.in_tree[p]) continue;
    columns.push_back(
        find_rotations(nodes, Eigen::VectorXd::Zero(ssize(nodes.vertex)), Eigen::VectorXd::Unit(cuts, p)));
  }
  Eigen::MatrixXd out(cuts, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) out.col(static_cast<Eigen::Index>(k)) = columns[k];
  return out;
}

// Whole numbers near `exact` with small (x - exact)^T form (x - exact): the nearest ones, changed one or two at a time.
Eigen::VectorXd round_by_energy(const Eigen::MatrixXd& form, const Eigen::VectorXd& exact) {
  constexpr int most_rounds = 100;  // over all pairs; the cost falls in each, and a handful is usual
  Eigen::VectorXd x = exact.array().round();
  Eigen::VectorXd slope = form * (x - exact);  // half the gradient
  double least = (x - exact).dot(slope);
  bool lowered = true;
  for (int round = 0; lowered && round < most_rounds; ++round) {
    lowered = false;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      for (Eigen::Index j = i; j < x.size(); ++j) {
        for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
          if ((b == 0) != (i == j)) continue;
          const double change =
              2 * (a * slope[i] + b * slope[j]) + form(i, i) + b * b * form(j, j) + 2 * a * b * form(i, j);
          if (change >= -1e-9 * least) continue;
          x[i] += a;
          x[j] += b;
          slope += a * form.col(i) + b * form.col(j);
          least = (x - exact).dot(slope);
          lowered = true;
        }
      }
      checkpoint(10.0 * static_cast<double>(x.size()));
    }
  }
  return x;
}

// A price of turning loops about handles by x radians: x^T form x + 2 gradient . x.
struct TurningPrice {
  Eigen::MatrixXd form;
  Eigen::VectorXd gradient;
};

// What strokes miss, by the same x.  frames: (m) of the metric.
StrokeFit fit_of_turning(const Strokes& strokes, const HarmonicOneForm& twist, const Eigen::MatrixXd& loops,
                         const Eigen::VectorXd& frames, double unit) {
  Eigen::MatrixXd effect(ssize(strokes.triangles), loops.cols());
  for (Eigen::Index k = 0; k < loops.cols(); ++k) effect.col(k) = twist.spread(loops.col(k))(strokes.triangles);
  return {strokes.weight, strokes.angle + frames(strokes.triangles), std::move(effect), unit};
}

// By how much the loops about handles turn otherwise than in the metric, radians, for rotations that are multiples of a
// unit and have the lowest price.
Eigen::VectorXd choose_turning(const TurningPrice& price, const NodeGraph& nodes, const Eigen::VectorXd& natural,
                               double unit) {
  Eigen::VectorXd exact(price.gradient.size());
  Eigen::Index k = 0;
  for (Eigen::Index p = 0; p < natural.size(); ++p) {
    if (!nodes.in_tree[p]) exact[k++] = natural[p] / unit;
  }
  Eigen::VectorXd wanted = exact;
  if (!price.gradient.isZero(0)) wanted -= price.form.ldlt().solve(price.gradient) / unit;
  return unit * (round_by_energy(price.form, wanted) - exact);
}

Eigen::VectorXd integrate(const CutSurface& surface, const Eigen::VectorXd& log_scale) {
  if (surface.frame_tree != nullptr) return surface.frame_tree->integrate(log_scale);
  return FrameTree(surface, surface.cut_graph).integrate(log_scale);
}

// The better a root, the farther its curvature is from whole turns.
NodeGraph nodes_of_cuts(const CutSurface& surface, const Curvature& curvature) {
  return build_node_graph(surface.mesh, surface.cut_graph,
                          [&](Index v) { return std::abs(std::sin(curvature.at_vertex[v] / 2)); });
}

// Quarter turns that come out of sums and solves are exact again, so that both sides of a cut can run along the axes.
Eigen::VectorXd without_rounding(Eigen::VectorXd angles) {
  constexpr double rounding = 1e-11, quarter = M_PI / 2;
  for (double& angle : angles) {
    const double turned = quarter * std::round(angle / quarter);
    if (std::abs(angle - turned) < rounding) angle = turned;
  }
  return angles;
}

// How the metric turns by itself.
struct MetricConnection {
  NodeGraph nodes;
  Eigen::VectorXd node_curvature;  // (nodes)
  Eigen::VectorXd frames;          // (m)
  Eigen::VectorXd natural;         // (cuts) rotations, those about handles among them

  MetricConnection(const CutSurface& surface, const Curvature& curvature)
      : nodes(nodes_of_cuts(surface, curvature)),
        node_curvature(without_rounding(curvature_of_nodes(surface.mesh, nodes, curvature.at_vertex))),
        frames(integrate(surface, curvature.log_scale)),
        natural(without_rounding(read_rotations(surface, surface.cut_graph, curvature.log_scale, frames))) {}
};

}  // namespace

ParallelTransportChoice::ParallelTransportChoice(const CutSurface& surface, const Curvature& curvature,
                                                 int rotation_order, const std::optional<FollowedStrokes>& strokes)
    : surface_(surface), rotation_order_(rotation_order) {
  if (surface.mesh.genus == 0) return;
  const MetricConnection metric(surface, curvature);
  // The holonomy of a flat torus without cones is trivial.
  const bool flat =
      surface.mesh.closed() && metric.node_curvature.size() > 0 && metric.node_curvature.cwiseAbs().maxCoeff() == 0;
  if (rotation_order == 0 && !flat) return;
  const Eigen::MatrixXd loops = loop_changes(metric.nodes);
  const HarmonicOneForm twist(surface, surface.cut_graph);
  const double unit = 2 * M_PI / (flat ? 1 : rotation_order);
  const Eigen::VectorXd as_in_metric = Eigen::VectorXd::Zero(loops.cols());
  TurningPrice price{twist.energy(loops), as_in_metric};
  if (strokes) {
    const Strokes sample = sample_strokes(surface.geometry, strokes->directions);
    const LogScale::Variance misfit = fit_of_turning(sample, twist, loops, metric.frames, unit).form_near(as_in_metric);
    price.form += strokes->price * misfit.hessian;
    price.gradient += strokes->price * misfit.gradient;
  }
  change_ = loops * choose_turning(price, metric.nodes, metric.natural, unit);
  twist_ = twist.spread(change_);
}

ParallelTransport ParallelTransportChoice::at(double share, const Curvature& curvature) const {
  MetricConnection metric(surface_, curvature);
  ParallelTransport out{
      std::move(metric.frames), find_rotations(metric.nodes, metric.node_curvature, metric.natural), {}};
  if (is_twisted()) {
    out.frames += share * twist_;
    out.rotation += share * change_;
  }
  if (rotation_order_ > 0 && share == 1) {
    for (double& rotation : out.rotation)
      rotation = angle_of_turns(turns_of(rotation, rotation_order_), rotation_order_);
  }
  out.reduction = impose_transitions(surface_, metric.nodes, metric.node_curvature, out.rotation);
  return out;
}

ParallelTransport connection_of_map(const CutSurface& surface, const Curvature& curvature,
                                    const Eigen::VectorXd& rotation, const Eigen::VectorXcd& position) {
  const NodeGraph nodes = nodes_of_cuts(surface, curvature);
  const Eigen::VectorXd node_curvature = curvature_of_nodes(surface.mesh, nodes, curvature.at_vertex);
  return {measure_jacobians(surface, surface.cut_mesh, position).f_z.array().arg(), rotation,
          impose_transitions(surface, nodes, node_curvature, rotation)};
}

}  // namespace lsgp

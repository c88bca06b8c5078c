// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/stroke_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "base/checkpoint.hpp"
#include "unfold/frames.hpp"

namespace lsgp {

namespace {

constexpr double largest_part = 0.5;  // of the area, for strokes
constexpr Index most_samples = 256;   // that represent them

Complex edge_in_frame(const Geometry& geometry, Index h) {
  return std::polar(geometry.length[h], edge_direction(geometry, h));
}

}  // namespace

bool are_strokes(const TextureDirections& directions, const Geometry& geometry) {
  double area = 0;
  Index count = 0;
  for (Index f = 0; f < directions.weight.size(); ++f) {
    if (!(directions.weight[f] > 0)) continue;
    area += geometry.area[f];
    ++count;
  }
  return count > 1 && area <= largest_part * geometry.total_area;
}

Strokes sample_strokes(const Geometry& geometry, const TextureDirections& directions) {
  Array<Index> all;
  for (Index f = 0; f < directions.weight.size(); ++f) {
    if (directions.weight[f] > 0) all.push_back(f);
  }
  Strokes out;
  const Index step = (static_cast<Index>(all.size()) + most_samples - 1) / most_samples;
  for (Index i = 0; i < static_cast<Index>(all.size()); i += step) out.triangles.push_back(all[i]);
  const auto count = static_cast<Eigen::Index>(out.triangles.size());
  out.angle.resize(count);
  out.weight.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Index f = out.triangles[i];
    const Complex first = edge_in_frame(geometry, 3 * f), last = -edge_in_frame(geometry, 3 * f + 2);
    out.angle[i] = std::arg(directions.along_first[f] * first + directions.along_last[f] * last);
    out.weight[i] = directions.weight[f];
  }
  out.weight /= out.weight.sum();
  return out;
}

StrokeFit::StrokeFit(Eigen::VectorXd weight, Eigen::VectorXd angle, Eigen::MatrixXd effect, double period)
    : weight_(std::move(weight)), angle_(std::move(angle)), effect_(std::move(effect)), period_(period) {}

Eigen::VectorXd StrokeFit::deviations(const Eigen::VectorXd& x) const {
  Eigen::VectorXd angle = angle_ + effect_ * x;
  Complex sum = 0;
  for (Eigen::Index s = 0; s < angle.size(); ++s) sum += std::polar(weight_[s], 2 * M_PI / period_ * angle[s]);
  const double common = period_ / (2 * M_PI) * std::arg(sum);
  for (double& at : angle) at = std::remainder(at - common, period_);
  angle.array() -= weight_.dot(angle);
  return angle;
}

double StrokeFit::misfit(const Eigen::VectorXd& x) const { return weight_.dot(deviations(x).cwiseAbs2()); }

LogScale::Variance StrokeFit::form_near(const Eigen::VectorXd& x) const {
  const Eigen::MatrixXd effect = effect_.rowwise() - weight_.transpose() * effect_;
  const Eigen::MatrixXd weighted = weight_.asDiagonal() * effect;
  LogScale::Variance out{effect.transpose() * weighted, weighted.transpose() * deviations(x)};
  out.gradient -= out.hessian * x;
  return out;
}

StrokeFit fit_of_curvature(const LogScale& scale, const CutGraph& cut_graph, const TextureDirections& directions,
                           int rotation_order) {
  const Strokes strokes = sample_strokes(scale.geometry(), directions);
  const FrameTree tree(scale.surface(), cut_graph);
  const auto turns_at_strokes = [&](const Eigen::VectorXd& log_scale) {
    checkpoint(static_cast<double>(scale.mesh().triangle_count()));
    return Eigen::VectorXd(tree.integrate(log_scale)(strokes.triangles));
  };
  const Eigen::VectorXd flat = turns_at_strokes(Eigen::VectorXd::Zero(scale.mesh().vertex_count()));
  const Eigen::VectorXd without = turns_at_strokes(scale.evaluate_held(Eigen::VectorXd::Zero(scale.cone_count())));
  Eigen::MatrixXd effect(flat.size(), scale.cone_count());
  for (Index c = 0; c < scale.cone_count(); ++c) effect.col(c) = turns_at_strokes(scale.effect(c)) - flat;
  return {strokes.weight, strokes.angle + without, std::move(effect), 2 * M_PI / std::max(rotation_order, 1)};
}

}  // namespace lsgp

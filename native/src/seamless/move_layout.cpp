// SPDX-License-Identifier: GPL-3.0-or-later
// The part of LayoutQuantizer that moves a valid layout to other lattice points and keeps it valid.
#include <algorithm>
#include <cmath>
#include <utility>

#include "prescription/parallel_transport.hpp"
#include "repair/low_stretch.hpp"
#include "repair/newton.hpp"
#include "repair/untangle.hpp"
#include "seamless/quantize_layout.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

// Continuation.
constexpr int most_moves = 20;
constexpr double shortest_step = 0.01;  // of the way
// Smoothing by the symmetric Dirichlet energy.
constexpr int smoothed_rings = 4;  // around stretched triangles
// Automatic grids.
constexpr double most_stretched = 0.1;  // of the triangles, stretched, that are smoothed
constexpr double easy_share = 2e-4;     // of the triangles, flipped, that are repaired

}  // namespace

Validity LayoutQuantizer::check(const Eigen::VectorXcd& position) const {
  return check_map(mesh_, at_corners(cut_mesh_, position), curvature_.at_vertex, curvature_.is_free);
}

// before: a valid map from which the current one was moved.
bool LayoutQuantizer::repair(double scale, const Eigen::VectorXcd& before, Eigen::VectorXcd& position) const {
  Curvature target = curvature_;
  target.log_scale = rest_.array() + std::log(scale);
  const ParallelTransport connection{
      measure_jacobians({mesh_, geometry_}, cut_mesh_, before).f_z.array().arg(), rotation_, {}};
  position = untangle(surface(), {connection, target}, {Effort::local, DistortionEnergy::Kind::framed_foldover_free},
                      before_step_, {position, PerVertex<char>(mesh_.vertex_count(), 0)});
  return check(position).defects() == 0;
}

// Newton steps on the symmetric Dirichlet energy over the marked vertices.
void LayoutQuantizer::smooth(double scale, PerVertex<char> marked, int steps, Eigen::VectorXcd& position) const {
  NewtonMinimizer(surface(), {rest_.array() + std::log(scale), Eigen::VectorXd::Zero(mesh_.triangle_count())},
                  free_vertices(mesh_, cut_mesh_, motion_of_copies_, without_cones(std::move(marked))), before_step_,
                  position)
      .smooth(DistortionEnergy::Kind::symmetric_dirichlet, steps, least_decrease);
}

// Relative to the rest scale, 4 for an isometry.
Eigen::VectorXd LayoutQuantizer::triangle_energies(double scale, const Jacobians& jacobians) const {
  constexpr DistortionEnergy energy{DistortionEnergy::Kind::symmetric_dirichlet};
  Eigen::VectorXd out(mesh_.triangle_count());
  for (Index f = 0; f < mesh_.triangle_count(); ++f) {
    double rest = 0;
    for (int c = 0; c < 3; ++c) rest += rest_[mesh_.triangles(f, c)] / 3;
    const double unit = scale * std::exp(rest);
    out[f] = energy.value(jacobians.f_z[f] / unit, jacobians.f_zbar[f] / unit);
  }
  return out;
}

// Triangles that are much more distorted than in the initial map, which may be distorted itself: coarse meshes have no
// conformal maps.
Array<Index> LayoutQuantizer::find_stretched(double scale, const Jacobians& jacobians) const {
  const Eigen::VectorXd energies = triangle_energies(scale, jacobians);
  Array<Index> out;
  for (Index f = 0; f < mesh_.triangle_count(); ++f) {
    if (!(energies[f] < stretched_energy * strain_[f])) out.push_back(f);
  }
  return out;
}

// Whether a little smoothing may lower a layout to that energy, which detects too coarse grids early.
bool LayoutQuantizer::looks_easy(double scale, double most_energy, const Validity& validity,
                                 const Eigen::VectorXcd& position) const {
  if (static_cast<double>(validity.flipped.size()) > 1 + easy_share * mesh_.triangle_count()) return false;
  Jacobians jacobians = measure_jacobians({mesh_, geometry_}, cut_mesh_, position);
  const Array<Index> stretched = find_stretched(scale, jacobians);
  if (static_cast<double>(stretched.size()) > most_stretched * mesh_.triangle_count()) return false;
  for (const Index f : stretched) {
    jacobians.f_z[f] = scale;
    jacobians.f_zbar[f] = 0;
  }
  return symmetric_dirichlet_energy(geometry_, jacobians) <= most_energy;
}

// Moves the integers of a valid map by `change` at once.
bool LayoutQuantizer::move(double scale, const LayoutEffort& effort, const Eigen::VectorXcd& change,
                           Eigen::VectorXcd& position) const {
  const Eigen::VectorXcd before = position;
  position += lattice_energy_->displacement(change);
  const Validity validity = check(position);
  if (effort.quick && !looks_easy(scale, effort.most_growth * energy_, validity, position)) return false;
  if (validity.defects() > 0 && !repair(scale, before, position)) return false;
  const Array<Index> stretched = find_stretched(scale, measure_jacobians({mesh_, geometry_}, cut_mesh_, position));
  if (!stretched.empty()) smooth(scale, mark_around(mesh_, stretched, smoothed_rings), smoothing_steps, position);
  return true;
}

// The same in steps over which the map stays valid (continuation).
bool LayoutQuantizer::follow(double scale, const Eigen::VectorXcd& change, Eigen::VectorXcd& position) const {
  double reached = 0;
  double step = 0.5;
  for (int moves = 0; reached < 1 && step > shortest_step && moves < most_moves; ++moves) {
    const double share = std::min(step, 1 - reached);
    Eigen::VectorXcd tried = position;
    if (!move(scale, {}, share * change, tried)) {
      step /= 2;
      continue;
    }
    reached = share == 1 - reached ? 1 : reached + share;
    step *= 1.7;
    position = std::move(tried);
  }
  return reached == 1;
}

void LayoutQuantizer::lower_stretch(double stretch, const Eigen::VectorXd& importance, QuantizedLayout& layout) const {
  if (layout.has_features) {
    features_->relax(layout.keeps_corners, importance_of_triangles({mesh_, geometry_}, importance), layout.position);
    layout.energy = measure_energy(layout.position);
    return;
  }
  if (cut_graph_.cuts.empty()) return;  // no translation was rounded, and its sides may have been made straight
  const Eigen::VectorXd rest = scale_at_rest(surface(), curvature_, stretch, layout.position);
  NewtonMinimizer newton(
      surface(), {rest, Eigen::VectorXd::Zero(mesh_.triangle_count())},
      free_vertices(mesh_, cut_mesh_, motion_of_copies_, without_cones(PerVertex<char>(mesh_.vertex_count(), 1))),
      before_step_, layout.position);
  newton.weigh(importance_of_triangles({mesh_, geometry_}, importance));
  newton.smooth(DistortionEnergy::Kind::symmetric_dirichlet, smoothing_steps, least_decrease);
  layout.energy = measure_energy(layout.position);
}

PerVertex<char> LayoutQuantizer::without_cones(PerVertex<char> marked) const {
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (mesh_.loop_of_vertex[v] == none && curvature_.at_vertex[v] != 0) marked[v] = 0;
  }
  return marked;
}

}  // namespace lsgp

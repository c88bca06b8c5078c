// SPDX-License-Identifier: GPL-3.0-or-later
#include "quantize_layout.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cone_triangulation.hpp"
#include "connection.hpp"
#include "energies/quadratic_forms.hpp"
#include "layout.hpp"
#include "quantize_curvature.hpp"
#include "relaxation.hpp"
#include "solvers/sparse_assembly.hpp"
#include "unfold.hpp"
#include "untangle.hpp"

namespace lsgp {

namespace {

constexpr int tried_angles = 16;          // of the layout, within one turn of the lattice
constexpr std::size_t tried_targets = 4;  // choices of points that are worth a repair
constexpr int smoothing_steps = 3;
constexpr double shortest_step = 1e-3;  // of the way to the lattice points

std::vector<int> turns_of_cuts(const Eigen::VectorXd& rotation, int symmetry) {
  std::vector<int> out;
  for (const double r : rotation) out.push_back(turns_of(r, symmetry));
  return out;
}

// Roots from which all cones come out on the lattice: the nearer 1 - e^{i curvature} is to a unit the better.
Eigen::VectorXd rank_roots(const Eigen::VectorXd& curvature) {
  Eigen::VectorXd rank(curvature.size());
  for (Eigen::Index v = 0; v < rank.size(); ++v) {
    const double gap = std::abs(1.0 - std::polar(1.0, curvature[v]));
    rank[v] = gap < 1e-6 ? 0 : 1 / (1 + gap);
  }
  return rank;
}

}  // namespace

double symmetric_dirichlet_energy(const Geometry& geometry, const Jacobians& jacobians) {
  double grown = 0, shrunk = 0;
  for (Eigen::Index f = 0; f < geometry.area.size(); ++f) {
    const double p = std::norm(jacobians.f_z[f]), q = std::norm(jacobians.f_zbar[f]);
    grown += geometry.area[f] * (p + q);
    shrunk += geometry.area[f] * (p + q) / ((p - q) * (p - q));
  }
  return std::sqrt(grown * shrunk) / geometry.area.sum();
}

LayoutQuantizer::LayoutQuantizer(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map,
                                 const PointLattice& lattice, bool parity)
    : mesh_(mesh),
      geometry_(geometry),
      cut_graph_(map.cut_graph),
      cut_mesh_(map.cut_mesh),
      curvature_(map.curvature),
      lattice_(lattice),
      rotation_(*map.rotation) {
  const double scale = std::sqrt(geometry.total_area / map.uv_area);
  start_ = scale * map.position * std::conj(upright(map.position));
  extent_ = start_.real().maxCoeff() - start_.real().minCoeff();
  energy_ = symmetric_dirichlet_energy(geometry, measure_jacobians(mesh, geometry, map.cut_mesh, start_));
  rest_ = curvature_.log_scale.array() + std::log(scale);

  const NodeGraph nodes = build_node_graph(mesh, map.cut_graph, rank_roots(map.curvature.at_vertex));
  reduction_ = impose_on_lattice(mesh, map.cut_graph, map.cut_mesh, nodes,
                                 curvature_of_nodes(mesh, nodes, map.curvature.at_vertex),
                                 turns_of_cuts(rotation_, lattice.symmetry()), lattice, parity);
  if (reduction_.origin != none) start_.array() -= start_[reduction_.origin];
  integers_ = integers_of(start_);

  // The Dirichlet form by blocks: what moves freely, and the integers.
  const auto form = assemble_form(Form::dirichlet, mesh, geometry, map.cut_mesh, reduction_.reduction);
  const Index unknowns = reduction_.reduction.unknown_count, count = static_cast<Index>(reduction_.integers.size());
  std::vector<Index> column_of_unknown(unknowns, none);
  for (Index k = 0; k < count; ++k) column_of_unknown[reduction_.integers[k]] = k;
  row_of_unknown_.assign(unknowns, none);
  Index rows = 0;
  for (Index i = 0; i < unknowns; ++i) {
    if (column_of_unknown[i] == none) row_of_unknown_[i] = rows++;
  }
  LowerAssembly<Complex> free(rows, static_cast<std::size_t>(form.nonZeros()));
  std::vector<Eigen::Triplet<Complex>> coupling;
  Eigen::MatrixXcd schur = Eigen::MatrixXcd::Zero(count, count);
  for (int j = 0; j < form.outerSize(); ++j) {
    for (Eigen::SparseMatrix<Complex>::InnerIterator it(form, j); it; ++it) {
      const Index i = static_cast<Index>(it.row());
      const Index row_i = row_of_unknown_[i], row_j = row_of_unknown_[j];
      const Index column_i = column_of_unknown[i], column_j = column_of_unknown[j];
      if (row_i != none && row_j != none) {
        free.add(row_i, row_j, it.value());
      } else if (row_i != none) {
        coupling.emplace_back(row_i, column_j, it.value());
      } else if (row_j != none) {
        coupling.emplace_back(row_j, column_i, std::conj(it.value()));
      } else {
        schur(column_i, column_j) += it.value();
        if (i != j) schur(column_j, column_i) += std::conj(it.value());
      }
    }
  }
  factor_.emplace(free.build());
  coupling_.resize(rows, count);
  coupling_.setFromTriplets(coupling.begin(), coupling.end());
  constexpr Index block = 16;  // right sides at a time
  for (Index first = 0; first < count; first += block) {
    const Index width = std::min(block, count - first);
    const Eigen::MatrixXcd columns = coupling_.middleCols(first, width);
    schur.middleCols(first, width) -= coupling_.adjoint() * factor_->solve(columns);
  }
  const Eigen::MatrixXcd restricted = reduction_.basis.adjoint() * schur * reduction_.basis;
  search_.emplace((restricted + restricted.adjoint()) / 2, moving_triangles(map), lattice);
}

std::vector<MovingTriangle> LayoutQuantizer::moving_triangles(const ComponentMap& map) const {
  std::vector<MovingTriangle> out;
  if (!mesh_.closed() || map.cones.empty()) return out;
  std::vector<Complex> turn;
  for (const int t : turns_of_cuts(rotation_, lattice_.symmetry())) turn.push_back(lattice_.unit(t));
  const auto triangulation = triangulate_cones(mesh_, cut_graph_, cut_mesh_, turn, map.cones, start_);
  if (!triangulation) return out;
  const Eigen::Index count = static_cast<Eigen::Index>(reduction_.integers.size());
  const auto corner_slope = [&](const ConeCorner& corner) {
    Eigen::RowVectorXcd slope = Eigen::RowVectorXcd::Zero(count);
    if (corner.cone == reduction_.root) slope = corner.turn * reduction_.root_position;
    const auto found = std::find(reduction_.cones.begin(), reduction_.cones.end(), corner.cone);
    if (found != reduction_.cones.end()) slope[found - reduction_.cones.begin()] = corner.turn;
    for (const auto& [cut, coefficient] : corner.translations) slope += coefficient * reduction_.translation.row(cut);
    return Eigen::RowVectorXcd(slope * reduction_.basis);
  };
  for (const auto& corners : triangulation->triangles) {
    MovingTriangle triangle;
    for (int c = 0; c < 3; ++c) {
      triangle.offset[c] = 0;
      triangle.slope[c] = corner_slope(corners[c]);
    }
    out.push_back(std::move(triangle));
  }
  return out;
}

// The values that the integers have in a layout.
Eigen::VectorXcd LayoutQuantizer::integers_of(const Eigen::VectorXcd& position) const {
  Eigen::VectorXcd out(reduction_.integers.size());
  Eigen::Index k = 0;
  for (const Index v : reduction_.cones) out[k++] = position[v];
  for (const Index p : reduction_.cuts) {
    const Index h = cut_graph_.cuts[p].halfedges.front();
    const Sisters sisters = origin_sisters(mesh_, cut_mesh_, h);
    out[k++] = position[sisters.right] - std::polar(1.0, rotation_[p]) * position[sisters.left];
  }
  return out;
}

std::vector<LayoutQuantizer::Target> LayoutQuantizer::find_targets(double density) const {
  std::vector<Target> out;
  const Eigen::PartialPivLU<Eigen::MatrixXcd> basis(reduction_.basis);
  const Eigen::VectorXcd wanted = integers_.size() > 0 ? Eigen::VectorXcd(basis.solve(integers_)) : integers_;
  for (int i = 0; i < tried_angles; ++i) {
    const double angle = 2 * M_PI / lattice_.symmetry() * i / tried_angles;
    out.push_back({angle, search_->find(std::polar(density, angle) * wanted)});
    if (integers_.size() == 0) break;
  }
  std::stable_sort(out.begin(), out.end(), [](const Target& a, const Target& b) {
    if (a.choice.valid() != b.choice.valid()) return a.choice.valid();
    return a.choice.cost < b.choice.cost;
  });
  if (out.size() > tried_targets) out.resize(tried_targets);
  return out;
}

Eigen::VectorXcd LayoutQuantizer::displacement(const Eigen::VectorXcd& change) const {
  const Eigen::VectorXcd moved = factor_->solve(Eigen::VectorXcd(coupling_ * change));
  Eigen::VectorXcd unknowns(row_of_unknown_.size());
  for (std::size_t i = 0; i < row_of_unknown_.size(); ++i) {
    if (row_of_unknown_[i] != none) unknowns[static_cast<Eigen::Index>(i)] = -moved[row_of_unknown_[i]];
  }
  for (std::size_t k = 0; k < reduction_.integers.size(); ++k) {
    unknowns[reduction_.integers[k]] = change[static_cast<Eigen::Index>(k)];
  }
  return expand(reduction_.reduction, unknowns);
}

bool LayoutQuantizer::is_valid(const Eigen::VectorXcd& position) const {
  return check_map(mesh_, at_corners(cut_mesh_, position), curvature_.at_vertex, curvature_.is_free).defects() == 0;
}

// before: a valid map from which the present one was moved.
bool LayoutQuantizer::repair(double density, const Eigen::VectorXcd& before, Eigen::VectorXcd& position) const {
  if (is_valid(position)) return true;
  Curvature target = curvature_;
  target.log_scale = rest_.array() + std::log(density);
  const Eigen::VectorXd frames = measure_jacobians(mesh_, geometry_, cut_mesh_, before).f_z.array().arg();
  position = untangle(mesh_, geometry_, cut_graph_, cut_mesh_, rotation_, target, frames,
                      std::vector<char>(mesh_.vertex_count(), 0), position);
  return is_valid(position);
}

// Moves the integers of a valid map by `change` at once.
bool LayoutQuantizer::move(double density, const Eigen::VectorXcd& change, Eigen::VectorXcd& position) const {
  const Eigen::VectorXcd before = position;
  position += displacement(change);
  return repair(density, before, position);
}

// The same in steps over which the map stays valid, smoothed after each.
bool LayoutQuantizer::follow(double density, const Eigen::VectorXcd& change, Eigen::VectorXcd& position) const {
  std::vector<char> marked(mesh_.vertex_count(), 1);
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (mesh_.loop_of_vertex[v] == none && curvature_.at_vertex[v] != 0) marked[v] = 0;
  }
  const Freedom freedom =
      free_vertices(mesh_, cut_mesh_, motion_of_copies(mesh_, cut_graph_, cut_mesh_, rotation_), marked);
  const Eigen::VectorXd rest = rest_.array() + std::log(density);
  double reached = 0;
  for (double step = 0.5; reached < 1 && step > shortest_step;) {
    const double share = std::min(step, 1 - reached);
    Eigen::VectorXcd tried = position;
    if (!move(density, share * change, tried)) {
      step /= 2;
      continue;
    }
    reached = share == 1 - reached ? 1 : reached + share;
    step *= 1.7;
    position = std::move(tried);
    Relaxation(mesh_, geometry_, cut_mesh_, rest, Eigen::VectorXd::Zero(mesh_.triangle_count()), freedom, position)
        .smooth(DistortionEnergy::Kind::symmetric_dirichlet, smoothing_steps, 1e-3);
  }
  return reached == 1;
}

std::optional<QuantizedLayout> LayoutQuantizer::quantize(double density) const {
  const std::vector<Target> targets = find_targets(density);
  for (const bool in_steps : {false, true}) {
    for (const Target& target : targets) {
      if (!target.choice.valid()) continue;
      const Complex motion = std::polar(density, target.angle);
      const Eigen::VectorXcd change = reduction_.basis * target.choice.x - motion * integers_;
      QuantizedLayout out{motion * start_, 1, {}};
      if (!(in_steps ? follow(density, change, out.position) : move(density, change, out.position))) continue;
      out.energy = symmetric_dirichlet_energy(geometry_, measure_jacobians(mesh_, geometry_, cut_mesh_, out.position));
      return out;
    }
  }
  return std::nullopt;
}

}  // namespace lsgp

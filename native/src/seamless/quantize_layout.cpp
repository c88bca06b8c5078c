// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/quantize_layout.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/conditions.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "creases/features.hpp"
#include "plane/layout.hpp"
#include "plane/predicates.hpp"
#include "prescription/parallel_transport.hpp"
#include "prescription/quantize_curvature.hpp"
#include "repair/newton.hpp"
#include "solvers/dense_products.hpp"
#include "systems/stiffness.hpp"
#include "transitions/cone_triangulation.hpp"
#include "unfold/jacobians.hpp"

namespace lsgp {

namespace {

// Number of simultaneous matrices over the lattice's unknowns: the lattice energy, its restriction, reduced bases and
// moves.
constexpr double lattice_blocks = 8;
// Products of coefficients in a form over a layout's unknowns, one for each edge and each pair of unknowns that its
// ends depend on, and the bytes that Newton's method takes for each, measured: 1 GB. A sheet with fifty holes through
// it, all of whose vertices are cones, has some 1.4 million.
constexpr double most_products = 2 << 20, bytes_of_product = 512;
// Choices of lattice points.
constexpr int tried_angles = 16;          // of the layout, within one turn of the lattice
constexpr int few_angles = 4;             // of those that are searched from on an automatic grid
constexpr std::size_t tried_targets = 4;  // that are repaired
constexpr std::size_t few_targets = 2;    // that are worth following, and all that are tried on an automatic grid
// An initial map that is smoothed first.
constexpr double poor_energy = 1.5;  // 1 for an isometry
constexpr int poor_steps = 20;

PerCut<int> turns_of_cuts(const Eigen::VectorXd& rotation, int rotation_order) {
  PerCut<int> out;
  for (const double r : rotation) out.push_back(turns_of(r, rotation_order));
  return out;
}

// Candidate roots for which all cones lie on the lattice: the nearer 1 - e^{i curvature} is to a unit, the better.
double rank_of_root(double curvature) {
  const double gap = std::abs(1.0 - std::polar(1.0, curvature));
  return gap < 1e-6 ? 0 : 1 / (1 + gap);
}

struct Side {
  double angle, length;
};

double length_of(const Array<Side>& sides) {
  return std::accumulate(sides.begin(), sides.end(), 0.0,
                         [](double sum, const Side& side) { return sum + side.length; });
}

// Of sides, sorted by angle, those of the greatest length together whose angles differ by no more than this.
Array<Side> most_parallel(const Array<Side>& sides, double tolerance) {
  double most = 0, length = 0;
  auto end = sides.begin(), best = end, end_of_best = end;
  for (auto first = sides.begin(); first != sides.end(); ++first) {
    for (; end != sides.end() && end->angle <= first->angle + tolerance; ++end) length += end->length;
    if (length > most) {
      most = length;
      best = first;
      end_of_best = end;
    }
    length -= first->length;
  }
  return {best, end_of_best};
}

// Throws SOLVER_FAILED if those of a form over these unknowns are too many.
void require_few_products(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const Reduction& reduction) {
  const auto terms = [&](Index corner) {
    const Index copy = cut_mesh.copy_of_corner[corner];
    return static_cast<double>(reduction.begin[copy + 1] - reduction.begin[copy]);
  };
  double products = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_open(mesh, cut_mesh, h) || h < mesh.twin[h]) products += terms(h) * terms(next(h));
  }
  if (products <= most_products) return;
  constexpr double mega = 1e6, giga = 1e9;
  throw Error(Code::solver_failed,
              concat("Rounding the layout of this component would take ", rounded(products / mega, 2),
                     " million products of coefficients and ", rounded(bytes_of_product * products / giga, 2),
                     " GB of memory; the limit is ", rounded(most_products / mega, 2),
                     " million. Use fewer cones, or cut it into components with fewer handles along seams."));
}

bool is_below_root(const NodeGraph& nodes, Index vertex) {
  return vertex != none && nodes.vertex[nodes.order.front()] != vertex;
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

LayoutQuantizer::LayoutQuantizer(ComponentSystem& system, Borrowed<const ComponentMap> map,
                                 const LatticeDemands& demands, StepHook before_step)
    : system_(system),
      mesh_(system.mesh()),
      geometry_(system.geometry()),
      cones_(map.get().cones),
      cut_graph_(map.get().cut_graph),
      cut_mesh_(map.get().cut_mesh),
      curvature_(map.get().curvature),
      natural_l2_(map.get().natural_l2),
      demands_(demands),
      before_step_(std::move(before_step)),
      rotation_(*map.get().rotation) {
  const Array<Index>& relaxed = demands.relaxed;
  require_few_conditions(static_cast<double>(cones_.size()) + 2.0 * mesh_.genus,
                         "A layout of this component on a lattice has", "lattice points");
  // With relaxed cones the root leaves the lattice, too: preferably one of a pair that is too close.
  const NodeGraph nodes = build_node_graph(mesh_, cut_graph_, [&](Index v) {
    return !relaxed.empty() && v == relaxed.front() ? 1 : rank_of_root(curvature_.at_vertex[v]);
  });
  const Eigen::VectorXd node_curvature = curvature_of_nodes(mesh_, nodes, curvature_.at_vertex);
  const PerCut<int> turns = turns_of_cuts(rotation_, lattice_.rotation_order());
  reduction_ = impose_on_lattice(surface(), nodes, node_curvature, turns, {lattice_, demands.parity, relaxed});
  if (has_many_terms() && relaxed.empty() && is_below_root(nodes, reduction_.origin)) {
    local_ = reduce_locally(surface(), nodes, node_curvature, units_of(lattice_, turns), reduction_.origin);
  }
  require_few_products(mesh_, cut_mesh_, moving_reduction());
  motion_of_copies_ = motion_of_copies(mesh_, cut_graph_, cut_mesh_, rotation_);
  set_start(map);
  if (relaxed.empty() && lattice_.square()) align_features();
  integers_ = integers_of(start_);
}

// With hundreds of cones or handles most copies near cuts depend on many integers.
bool LayoutQuantizer::has_many_terms() const {
  return ssize(reduction_.reduction.terms) > 4 * static_cast<std::ptrdiff_t>(mesh_.triangle_count());
}

// Layouts along features need none of it.
void LayoutQuantizer::prepare_search() {
  if (search_) return;
  const double integers = static_cast<double>(integers_.size());
  require_memory(lattice_blocks * sizeof(Complex) * integers * integers, GrowsWith::conditions);
  if (const CutFactor* factor = system_.stiff_factor(cones_, cut_graph_)) {
    lattice_energy_ = lattice_energy_on_cut(mesh_, cut_mesh_, *factor, reduction_);
  } else {
    require_few_products(mesh_, cut_mesh_, reduction_.reduction);
    const Geometry stiffened = stiffen_around({mesh_, geometry_}, cones_);
    lattice_energy_ = sparse_lattice_energy({{mesh_, stiffened}, cut_graph_, cut_mesh_}, reduction_);
  }
  if (integers_.size() > 0) inverse_of_basis_.compute(reduction_.basis);
  checkpoint(integers * integers * integers);
  const Eigen::MatrixXcd restricted =
      multiplied(multiplied(reduction_.basis.adjoint(), lattice_energy_->schur()), reduction_.basis);
  // Relaxed cones may be anywhere, so collapsing triangles cannot be detected.
  const bool sees_triangles = demands_.relaxed.empty();
  search_.emplace((restricted + restricted.adjoint()) / 2,
                  sees_triangles ? cone_triangles().triangles : Array<MovingTriangle>{}, lattice_);
}

// Of a layout without cuts, so that most of its straight sides run along the lattice; none if few are parallel.
std::optional<Complex> LayoutQuantizer::turn_along_sides(const Eigen::VectorXcd& position) const {
  constexpr double parallel = 1e-4, exactly_parallel = 1e-9;  // radians
  constexpr double least_share = 0.25;                        // of the boundaries' length
  const double turn = 2 * M_PI / lattice_.rotation_order();
  Array<Side> sides;
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (mesh_.twin[h] != none) continue;
    const Complex side = position[cut_mesh_.copy_of_corner[next(h)]] - position[cut_mesh_.copy_of_corner[h]];
    const double angle = std::remainder(std::arg(side), turn);
    sides.push_back({angle < -turn / 2 + parallel ? angle + turn : angle, std::abs(side)});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.angle < b.angle; });
  const double all = length_of(sides);
  sides = most_parallel(sides, parallel);
  if (!(length_of(sides) > least_share * all)) return std::nullopt;
  sides = most_parallel(sides, exactly_parallel);  // those that were made straight
  const auto longest =
      std::max_element(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.length < b.length; });
  return std::polar(1.0, -longest->angle);
}

void LayoutQuantizer::set_start(const ComponentMap& map) {
  std::optional<Complex> turn = find_upward_turn(map.position).turn_to_lattice();
  is_turned_ = turn.has_value();
  if (!turn && cut_graph_.cuts.empty()) turn = turn_along_sides(map.position);
  start_ =
      std::sqrt(geometry_.total_area / map.uv_area) * map.position * turn.value_or(std::conj(upright(map.position)));
  energy_ = measure_energy(start_);
  if (energy_ > poor_energy) {
    DegreesOfFreedom all{moving_reduction(), Array<Index>(mesh_.triangle_count())};
    std::iota(all.triangles.begin(), all.triangles.end(), 0);
    NewtonMinimizer(surface(),
                    {Eigen::VectorXd::Zero(mesh_.vertex_count()), Eigen::VectorXd::Zero(mesh_.triangle_count())},
                    std::move(all), before_step_, start_)
        .smooth(DistortionEnergy::Kind::symmetric_dirichlet, poor_steps, least_decrease);
  }
  misalignment_ = measure_misalignment(start_);
  const Jacobians jacobians = measure_jacobians({mesh_, geometry_}, cut_mesh_, start_);
  energy_ = symmetric_dirichlet_energy(geometry_, jacobians);
  extent_ = std::max(start_.real().maxCoeff() - start_.real().minCoeff(),
                     start_.imag().maxCoeff() - start_.imag().minCoeff());
  if (reduction_.origin != none) start_.array() -= start_[reduction_.origin];
  // Its scale at the vertices is the mean over the triangles around.
  rest_ = Eigen::VectorXd::Zero(mesh_.vertex_count());
  for (Index f = 0; f < mesh_.triangle_count(); ++f) {
    const double determinant = std::norm(jacobians.f_z[f]) - std::norm(jacobians.f_zbar[f]);
    for (int c = 0; c < 3; ++c) {
      const Index v = mesh_.triangles(f, c);
      rest_[v] += geometry_.area[f] / 3 * std::log(determinant) / 2 / geometry_.vertex_area[v];
    }
  }
  strain_ = triangle_energies(1, jacobians);
}

// Leaves features_ empty on soft surfaces without marked features and where no feature can be aligned.
void LayoutQuantizer::align_features() {
  const bool is_coarse = demands_.feature_places != FeaturePlaces::anywhere;
  const double most_growth = is_coarse ? 1.2 : 1.1;  // of the L2 stretch
  // Quads may follow any creases; a texture gets its direction from most of them.
  const double least_of_creases = is_coarse ? 0 : 0.75;
  const double least_common = is_turned_ ? 0.1 : 0;  // arcs do not turn what is upright
  const PerHalfedge<char> feature =
      features_to_align({mesh_, geometry_}, demands_.creases && lattice_.rotation_order() == 4);
  if (std::count(feature.begin(), feature.end(), no_feature) == ssize(feature)) return;
  // What straight sides have cost already counts.
  const double l2 =
      natural_l2_ > 0 ? natural_l2_ : l2_stretch(geometry_, measure_jacobians({mesh_, geometry_}, cut_mesh_, start_));
  most_l2_ = most_growth * l2;
  most_l2_with_corners_ = (l2 + most_l2_) / 2;
  const FeatureTask task{surface(), curvature_, rotation_, reduction_, moving_reduction(), before_step_};
  std::optional<FeatureAlignment>& alignment = demands_.alignment;
  if (!alignment) alignment = align_with_axes(task, feature, start_, {most_l2_, least_of_creases, least_common});
  release_reasons_ = alignment->reasons;
  if (alignment->lines.empty()) return;
  features_ =
      std::make_unique<FeatureLayout>(task, *alignment, demands_.feature_places == FeaturePlaces::half ? 0.5 : 1);
  energy_ = std::max(energy_, measure_energy(features_->start()));
}

bool LayoutQuantizer::loosen_features() {
  if (features_ == nullptr || !features_->loosen()) return false;
  release_reasons_ = features_->reasons();
  energy_ = std::max(energy_, measure_energy(features_->start()));
  return true;
}

PerHalfedge<ReleaseReason> LayoutQuantizer::release_reasons(const QuantizedLayout& layout) const {
  if (features_ == nullptr || layout.has_features) return release_reasons_;
  return PerHalfedge<ReleaseReason>(mesh_.halfedge_count(), ReleaseReason::lattice);
}

std::optional<QuantizedLayout> LayoutQuantizer::quantize_with_features(double density,
                                                                       const LayoutEffort& effort) const {
  const bool must_be_coarse =
      demands_.feature_places != FeaturePlaces::anywhere && effort.features == LayoutEffort::Features::required;
  for (const bool keeps_corners : {true, false}) {
    if (keeps_corners && !must_be_coarse) continue;
    double energy = 0;
    const auto accepts = [&](const Eigen::VectorXcd& position) {
      const Jacobians jacobians = measure_jacobians({mesh_, geometry_}, cut_mesh_, position);
      energy = symmetric_dirichlet_energy(geometry_, jacobians);
      return energy <= effort.most_growth * energy_ &&
             l2_stretch(geometry_, jacobians) <= (keeps_corners ? most_l2_with_corners_ : most_l2_);
    };
    std::optional<Eigen::VectorXcd> position = features_->quantize(density, must_be_coarse, keeps_corners, accepts);
    if (!position) continue;
    if (!demands_.directions.empty()) {
      *position *= lattice_.unit(find_upward_turn(*position).turns_on_lattice());
    }
    return QuantizedLayout{std::move(*position), energy, true, keeps_corners};
  }
  return std::nullopt;
}

UpwardTurn LayoutQuantizer::find_upward_turn(const Eigen::VectorXcd& position) const {
  return upward_turn(demands_.directions, at_corners(cut_mesh_, position), lattice_.rotation_order());
}

// Rotates by a rotation of the lattice, which preserves it.
void LayoutQuantizer::turn_upwards(Eigen::VectorXcd& position) const {
  if (is_turned_) position *= lattice_.unit(find_upward_turn(position).turns_on_lattice());
}

// The mean angle between directions and v, modulo the lattice's rotations, radians; 0 without directions.
double LayoutQuantizer::measure_misalignment(const Eigen::VectorXcd& position) const {
  if (!is_turned_) return 0;
  return mean_angle_to_v(demands_.directions, at_corners(cut_mesh_, position), lattice_.rotation_order());
}

// The triangles between the cones; computed when it is needed.
const LayoutQuantizer::ConeTriangles& LayoutQuantizer::cone_triangles() {
  if (!cone_triangles_) cone_triangles_ = find_cone_triangles();
  return *cone_triangles_;
}

LayoutQuantizer::ConeTriangles LayoutQuantizer::find_cone_triangles() const {
  ConeTriangles out;
  if (!mesh_.closed() || cones_.empty()) return out;
  const PerCut<Complex> turn = units_of(lattice_, turns_of_cuts(rotation_, lattice_.rotation_order()));
  const auto triangulation = triangulate_cones(surface(), turn, cones_, start_);
  if (!triangulation) return out;
  const auto translation_at_start = [&](Index cut) {
    const Sisters sisters = origin_sisters(mesh_, cut_mesh_, cut_graph_.cuts[cut].halfedges.front());
    return start_[sisters.right] - turn[cut] * start_[sisters.left];
  };
  const Eigen::Index count = static_cast<Eigen::Index>(reduction_.integers.size());
  // Slopes have few terms of hundreds, and a product with all of the basis for each corner takes seconds.
  const Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> basis = reduction_.basis;
  std::map<std::pair<Index, Index>, double> nearest;
  for (const auto& corners : triangulation->triangles) {
    MovingTriangle triangle;
    std::array<Complex, 3> at_start;
    for (std::size_t c = 0; c < 3; ++c) {
      const ConeCorner& corner = corners[c];
      Eigen::RowVectorXcd slope = Eigen::RowVectorXcd::Zero(count);
      if (corner.cone == reduction_.root) slope = corner.turn * reduction_.root_position;
      const auto found = std::find(reduction_.cones.begin(), reduction_.cones.end(), corner.cone);
      if (found != reduction_.cones.end()) slope[found - reduction_.cones.begin()] = corner.turn;
      at_start[c] = corner.turn * start_[corner.cone];
      for (const auto& [cut, coefficient] : corner.translations) {
        checkpoint(4.0 * static_cast<double>(count));
        slope += coefficient * reduction_.translation.row(cut);
        at_start[c] += coefficient * translation_at_start(cut);
      }
      triangle.slope[c] = Eigen::RowVectorXcd::Zero(basis.cols());
      for (Eigen::Index k = 0; k < count; ++k) {
        if (slope[k] == 0.0) continue;
        checkpoint(4.0 * static_cast<double>(count));
        triangle.slope[c] += slope[k] * basis.row(k);
      }
    }
    out.triangles.push_back(std::move(triangle));
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [first, second] = std::minmax(corners[c].cone, corners[(c + 1) % 3].cone);
      if (first == second) continue;
      const double distance = std::abs(at_start[(c + 1) % 3] - at_start[c]);
      const auto [entry, added] = nearest.try_emplace({first, second}, distance);
      if (!added) entry->second = std::min(entry->second, distance);
    }
  }
  for (const auto& [pair, distance] : nearest) out.pairs.push_back({distance, pair.first, pair.second});
  std::stable_sort(out.pairs.begin(), out.pairs.end(),
                   [](const ConePair& a, const ConePair& b) { return a.distance < b.distance; });
  return out;
}

// Whether the triangles between the cones, each of which takes at least half a cell, would need more than twice the
// area of the layout.
bool LayoutQuantizer::lacks_area(double density) {
  return 0.5 * static_cast<double>(cone_triangles().triangles.size()) * lattice_.cell_area() >
         2 * density * density * geometry_.total_area;
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

Array<LayoutQuantizer::Target> LayoutQuantizer::find_targets(double density, int searched_angles) {
  prepare_search();
  if (integers_.size() == 0) return {{density, integers_, 0}};
  Array<Target> out;
  const Eigen::VectorXcd wanted = inverse_of_basis_.solve(integers_);
  const Eigen::VectorXcd pull = lattice_energy_->schur() * integers_;
  struct Candidate {
    Complex motion;
    LatticeSearch::Choice choice;
  };
  Array<Candidate> candidates;
  for (int i = 0; i < (is_turned_ ? 1 : tried_angles); ++i) {
    const Complex motion = std::polar(density, 2 * M_PI / lattice_.rotation_order() * i / tried_angles);
    candidates.push_back({motion, search_->nearest(motion * wanted)});
  }
  // The cheapest ones are used directly if they are valid; if few are, they are worth a search.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.choice.cost < b.choice.cost; });
  for (Candidate& candidate : candidates) {
    if (!candidate.choice.valid() && searched_angles-- > 0) {
      candidate.choice = search_->improve(candidate.motion * wanted, candidate.choice);
    }
    if (!candidate.choice.valid()) continue;
    // A similarity of the whole layout costs nothing.
    Target target{0, reduction_.basis * candidate.choice.x, candidate.choice.cost};
    target.motion = pull.dot(target.integers) / pull.dot(integers_);
    const double growth = std::abs(target.motion) / density;
    if (!(growth > 0.5 && growth < 2)) target.motion = candidate.motion;  // only the layout's place is rounded
    out.push_back(std::move(target));
    if (out.size() == tried_targets) break;
  }
  std::stable_sort(out.begin(), out.end(), [](const Target& a, const Target& b) { return a.cost < b.cost; });
  return out;
}

double LayoutQuantizer::measure_energy(const Eigen::VectorXcd& position) const {
  return symmetric_dirichlet_energy(geometry_, measure_jacobians({mesh_, geometry_}, cut_mesh_, position));
}

double LayoutQuantizer::measure_scale(const Eigen::VectorXcd& position) const {
  const PerHalfedge<Index>& copy = cut_mesh_.copy_of_corner;
  double area = 0;
  for (Index f = 0; f < mesh_.triangle_count(); ++f) {
    area += 0.5 * doubled_area(position[copy[3 * f]], position[copy[3 * f + 1]], position[copy[3 * f + 2]]);
  }
  return std::sqrt(std::abs(area) / geometry_.total_area);
}

std::optional<QuantizedLayout> LayoutQuantizer::quantize(double density, const LayoutEffort& effort) {
  const bool quick = effort.quick;
  if (features_ && effort.features != LayoutEffort::Features::ignored) {
    auto out = quantize_with_features(density, effort);
    if (out || effort.features == LayoutEffort::Features::required) return out;
  }
  if (quick && demands_.relaxed.empty() && lacks_area(density)) return std::nullopt;
  const Array<Target> targets = find_targets(density, quick ? few_angles : tried_angles);
  // With relaxed cones it is unknown whether the points can be reached, and continuation would take too long.
  const int ways = !demands_.relaxed.empty() || quick ? 1 : 2;
  for (int in_steps = 0; in_steps < ways; ++in_steps) {
    const std::size_t count = std::min(targets.size(), in_steps || quick ? few_targets : tried_targets);
    for (std::size_t i = 0; i < count; ++i) {
      const Target& target = targets[i];
      const double scale = std::abs(target.motion);
      const Eigen::VectorXcd change = target.integers - target.motion * integers_;
      QuantizedLayout out{target.motion * start_, 1};
      if (!(in_steps ? follow(scale, change, out.position) : move(scale, effort, change, out.position))) continue;
      out.energy = measure_energy(out.position);
      if (!quick && out.energy > stretched_energy * energy_) {
        smooth(scale, PerVertex<char>(mesh_.vertex_count(), 1), smoothing_steps, out.position);
        out.energy = measure_energy(out.position);
      }
      if (!(out.energy <= effort.most_growth * energy_)) continue;
      if (measure_misalignment(out.position) > misalignment_ + effort.most_turned) continue;
      turn_upwards(out.position);
      return out;
    }
  }
  return std::nullopt;
}

}  // namespace lsgp

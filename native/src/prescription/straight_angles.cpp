// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/straight_angles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/text.hpp"
#include "cut/cut_mesh.hpp"
#include "prescription/component_system.hpp"
#include "prescription/straightness.hpp"
#include "systems/cut_factor.hpp"

namespace lsgp {

namespace {

constexpr double enough = 1.5;  // of the L2 stretch of least distortion
constexpr Index most_trees = 128;
constexpr double most_triangles = 6e5;  // of all trees together
constexpr Index patience = 16;          // trees without progress, after which the search begins anew
constexpr double operations_a_vertex = 100;
// Angles beyond these leave flips, whose repair stretches, unless those of least distortion are beyond as well.
constexpr double least_straight_angle = widest_angles.smallest;
constexpr double largest_straight_share = 0.75;  // of pi per triangle
// What such an angle adds to the predicted L2 stretch: any other choice is better.
constexpr double strained = 1e3;

// Smooth random fields over the surface: sums of a few bumps.
class RandomField {
 public:
  explicit RandomField(const HalfedgeMesh& mesh)
      : mesh_(mesh),
        radius_(width * (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm()) {}

  void add_to(PerVertex<double>& field) {
    for (int bump = 0; bump < bumps; ++bump) {
      const Index center = static_cast<Index>(uniform() * mesh_.vertex_count());
      const double most = height * (2 * uniform() - 1);
      for (Index v = 0; v < mesh_.vertex_count(); ++v) {
        const double far = (mesh_.positions.row(v) - mesh_.positions.row(center)).norm() / radius_;
        field[v] += most * std::exp(-far * far);
      }
      checkpoint(operations_a_vertex * mesh_.vertex_count());
    }
  }

 private:
  static constexpr int bumps = 3;
  static constexpr double width = 0.15;  // of the surface's diagonal
  static constexpr double height = 1.2;  // of the logarithm of a factor

  double uniform() { return static_cast<double>(engine_()) * 0x1p-32; }  // below 1

  const HalfedgeMesh& mesh_;
  const double radius_;
  std::mt19937 engine_;  // its numbers are the same everywhere, those of distributions are not
};

class TreeSearch {
 public:
  TreeSearch(ComponentSystem& system, const ComponentCones& cones, const Eigen::VectorXd& least)
      : system_(system),
        cones_(cones),
        scale_(system.log_scale()),
        least_(least),
        curvature_(Eigen::VectorXd::Zero(system.mesh().vertex_count())),
        log_scale_(scale_.evaluate_held(least)),
        enough_l2_(enough * scale_.predicted_l2(log_scale_)),
        varied_(system.mesh()) {
    for (Eigen::Index i = 0; i < least.size(); ++i) curvature_[cones.vertices[i]] = least[i];
  }

  StraightAngles best();

 private:
  struct Angles {
    Eigen::VectorXd curvature;
    double at_junctions = 0;
    double l2 = std::numeric_limits<double>::infinity();  // predicted, with what strained angles add; if usable
    std::string failure;
  };

  // Whether a tree's angles are good enough; the best are kept.
  bool suffices(const CutGraph& cuts, const CutSurface& surface);
  int count_strained(const Eigen::VectorXd& curvature) const;
  Array<StraightenedLayout> lay_out(const CutSurface& surface, bool is_conformal) const;
  Angles read(const StraightenedLayout& layout) const;
  bool search_other_trees();
  CutGraph connect_varied(const PerVertex<double>& field);
  std::vector<Finding> findings() const;
  Array<Index> junctions() const;

  ComponentSystem& system_;
  const ComponentCones& cones_;
  const LogScale& scale_;
  const Eigen::VectorXd& least_;
  Eigen::VectorXd curvature_;  // of least distortion, at all vertices
  const Eigen::VectorXd log_scale_;
  const double enough_l2_;
  HalfedgeMesh varied_;  // with other costs of cuts
  Index trees_ = 0;
  Angles best_;
  std::optional<CutGraph> best_cuts_;  // none: the system's
  Index best_tree_ = 0;                // which one, from 1
  std::pair<int, double> last_;        // crossings and L2 stretch of the last tree
  std::string first_failure_;
};

TreeSearch::Angles TreeSearch::read(const StraightenedLayout& layout) const {
  const HalfedgeMesh& mesh = system_.mesh();
  Angles out;
  out.failure = layout.failure;
  out.curvature = layout.curvature(cones_.vertices);
  if (mesh.closed()) {  // otherwise the boundary takes it up
    out.at_junctions = layout.curvature.sum() - out.curvature.sum();
    out.curvature.array() += out.at_junctions / static_cast<double>(out.curvature.size());
  }
  for (Eigen::Index i = 0; i < out.curvature.size() && out.failure.empty(); ++i) {
    if (is_possible(mesh, cones_.vertices[i], out.curvature[i])) continue;
    out.failure = concat("a cone would keep an angle of ", degrees(2 * M_PI - out.curvature[i]));
  }
  if (out.failure.empty()) {
    out.l2 = scale_.predicted_l2(scale_.evaluate_held(out.curvature)) + strained * count_strained(out.curvature);
  }
  return out;
}

int TreeSearch::count_strained(const Eigen::VectorXd& curvature) const {
  int out = 0;
  for (Eigen::Index i = 0; i < curvature.size(); ++i) {
    const double angle = 2 * M_PI - curvature[i], least_angle = 2 * M_PI - least_[i];
    const double most = largest_straight_share * M_PI * valence(system_.mesh(), cones_.vertices[i]);
    out += angle < std::min(least_straight_angle, least_angle) || angle > std::max(most, least_angle);
  }
  return out;
}

Array<StraightenedLayout> TreeSearch::lay_out(const CutSurface& surface, bool is_conformal) const {
  try {
    return is_conformal ? straighten(surface) : straighten_beside(surface, curvature_, log_scale_);
  } catch (const Error& error) {
    if (error.code() != Code::solver_failed) throw;
    StraightenedLayout none_found;
    none_found.curvature = Eigen::VectorXd::Zero(system_.mesh().vertex_count());
    none_found.crossings = std::numeric_limits<int>::max();
    none_found.failure = "triangles are too thin to straighten cuts beside them";
    return {none_found};
  }
}

bool TreeSearch::suffices(const CutGraph& cuts, const CutSurface& surface) {
  ++trees_;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  last_ = {std::numeric_limits<int>::max(), infinity};
  for (const bool is_conformal : {true, false}) {
    // An eigenvector takes long without a factor.
    const bool is_dear = trees_ > 1 && surface.factor == nullptr;
    if (is_conformal && (is_dear || !system_.mesh().closed())) continue;
    for (const StraightenedLayout& layout : lay_out(surface, is_conformal)) {
      Angles angles = read(layout);
      last_ = std::min(last_, {layout.crossings, angles.l2});
      if (first_failure_.empty()) first_failure_ = angles.failure;
      if (!(angles.l2 < best_.l2)) continue;
      best_ = std::move(angles);
      best_tree_ = trees_;
      if (trees_ > 1) best_cuts_ = cuts;
    }
    if (best_.l2 <= enough_l2_) return true;
  }
  return false;
}

CutGraph TreeSearch::connect_varied(const PerVertex<double>& field) {
  const HalfedgeMesh& mesh = system_.mesh();
  varied_.cut_factor.assign(mesh.halfedge_count(), 1.0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const double usual = mesh.cut_factor.empty() ? 1 : mesh.cut_factor[h];
    varied_.cut_factor[h] = usual * std::exp((field[mesh.origin(h)] + field[mesh.target(h)]) / 2);
  }
  return connect_cones({varied_, system_.geometry()}, inside_only(mesh, cones_.vertices), {});
}

// Descends in the number of crossings, then in stretch.
bool TreeSearch::search_other_trees() {
  const HalfedgeMesh& mesh = system_.mesh();
  const Index most = std::min(most_trees, static_cast<Index>(most_triangles / mesh.triangle_count()));
  RandomField random(mesh);
  PerVertex<double> field(mesh.vertex_count(), 0.0);
  const std::pair<int, double> usual = last_;
  std::pair<int, double> least = usual;
  for (Index waited = 0; trees_ < most; ++waited) {
    if (waited == patience) {
      std::fill(field.begin(), field.end(), 0.0);
      least = usual;
      waited = 0;
    }
    PerVertex<double> tried = field;
    random.add_to(tried);
    const CutGraph cuts = connect_varied(tried);
    const CutMesh cut_mesh = cut_open(mesh, cuts);
    CutSurface surface{system_.surface(), cuts, cut_mesh};
    std::optional<CutFactor> factor;
    if (CutFactor::is_chosen(Factorization::automatic, mesh, cuts)) factor.emplace(system_.surface(), cuts);
    surface.factor = factor ? &*factor : nullptr;
    if (suffices(cuts, surface)) return true;
    if (last_ > least) continue;
    if (last_ < least) waited = -1;
    least = last_;
    field = std::move(tried);
  }
  return false;
}

Array<Index> TreeSearch::junctions() const {
  const CutGraph& cut_graph = best_cuts_ ? *best_cuts_ : system_.all_cuts();
  Array<Index> out;
  for (const Cut& cut : cut_graph.cuts) {
    for (const Index v : {cut.tail, cut.head}) {
      const bool is_cone = std::find(cones_.vertices.begin(), cones_.vertices.end(), v) != cones_.vertices.end();
      if (!is_cone && std::find(out.begin(), out.end(), v) == out.end()) out.push_back(v);
    }
  }
  return out;
}

std::vector<Finding> TreeSearch::findings() const {
  std::vector<Finding> out;
  const Elements cones{ElementKind::vertices, cones_.vertices};
  if (!std::isfinite(best_.l2)) {
    out.push_back({Code::straightness_failed,
                   concat("Straight cuts give no usable cone angles here: ", first_failure_, ", and ",
                          count(trees_ - 1, "other tree", "other trees"),
                          " of cuts did no better. The least-distortion angles were used instead."),
                   cones});
    return out;
  }
  const Array<Index> at = junctions();
  if (system_.mesh().closed() && !at.empty()) {
    out.push_back(
        {Code::junction_share,
         concat("Straight cuts left a curvature of ", degrees(best_.at_junctions), " at ",
                count(at.size(), "junction", "junctions"), " of the cut; it was distributed evenly over the cones.",
                best_tree_ > 1 ? concat(" It is the best of ", trees_, " trees of cuts.") : ""),
         {ElementKind::vertices, at}});
  }
  return out;
}

StraightAngles TreeSearch::best() {
  const CutGraph& cuts = system_.all_cuts();
  const CutMesh cut_mesh = cut_open(system_.mesh(), cuts);
  if (!suffices(cuts, system_.open(cuts, cut_mesh))) search_other_trees();
  StraightAngles out;
  out.findings = findings();
  if (!std::isfinite(best_.l2)) return out;
  out.curvature = std::move(best_.curvature);
  out.cuts = std::move(best_cuts_);
  return out;
}

}  // namespace

StraightAngles find_straight_angles(ComponentSystem& system, const ComponentCones& cones,
                                    const Eigen::VectorXd& least) {
  const HalfedgeMesh& mesh = system.mesh();
  const bool are_inside = inside_only(mesh, cones.vertices).size() == cones.vertices.size();
  if (mesh.closed() || (cones.border == BorderMode::free && are_inside)) {
    return TreeSearch(system, cones, least).best();
  }
  StraightAngles out;
  out.findings.push_back({Code::straightness_failed,
                          "Straight cuts give no usable cone angles where a boundary is straight or has corners. The "
                          "least-distortion angles were used instead.",
                          {ElementKind::vertices, cones.vertices}});
  return out;
}

}  // namespace lsgp

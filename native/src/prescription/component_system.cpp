// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/component_system.hpp"

#include <algorithm>
#include <utility>

#include "base/thread_team.hpp"
#include "cut/cut_across.hpp"
#include "cut/mirrored_cuts.hpp"
#include "systems/stiffness.hpp"

namespace lsgp {

Array<Index> inside_only(const HalfedgeMesh& mesh, const Array<Index>& vertices) {
  Array<Index> out;
  for (const Index v : vertices) {
    if (mesh.loop_of_vertex[v] == none) out.push_back(v);
  }
  return out;
}

ComponentSystem::ComponentSystem(const MetricMesh& surface, const ComponentCones& cones, Factorization factorization,
                                 Eigen::VectorXd memory)
    : surface_(surface),
      cones_(cones.vertices),
      mirroring_(cones.mirroring),
      factorization_(factorization),
      border_(border_conditions(surface, cones)),
      memory_(std::move(memory)) {}

Eigen::VectorXd ComponentSystem::take_memory() { return factor_ ? factor_->take_memory() : std::move(memory_); }

const CutGraph& ComponentSystem::all_cuts() {
  if (!all_cuts_) all_cuts_ = connect(inside_only(surface_.mesh, cones_), {});
  return *all_cuts_;
}

const StraightAngles& ComponentSystem::straight_angles(const ComponentCones& cones, const Eigen::VectorXd& least) {
  if (!straight_angles_) straight_angles_ = find_straight_angles(*this, cones, least);
  return *straight_angles_;
}

const CutGraph& ComponentSystem::straight_cuts() {
  return straight_angles_ && straight_angles_->cuts ? *straight_angles_->cuts : all_cuts();
}

CutGraph ComponentSystem::connect(const Array<Index>& interior_cones, const PerLoop<char>& uncut) const {
  // Of straight cuts: a tight bend is so much longer outside than inside. Their length is compared, not what they cost:
  // where a tube winds, a row of its quads comes to the front however it is chosen, and a cut that stays out of sight
  // leaves a strip with ragged sides.
  constexpr double most_length = 3;
  const auto length_of = [&](const CutGraph& graph) {
    double out = 0;
    for (const Cut& cut : graph.cuts) {
      for (const Index h : cut.halfedges) out += surface_.geometry.length[h];
    }
    return out;
  };
  CutGraph usual = connect_symmetrically({surface_, interior_cones, uncut}, mirroring_);
  const bool is_torus = surface_.mesh.is_torus() && mirroring_.empty();  // straight loops need not be symmetric
  const bool is_tube = is_torus || (surface_.mesh.is_ring() && usual.cuts.size() == 1);
  if (!interior_cones.empty() || !is_tube) return usual;
  std::optional<CutGraph> straight = is_torus ? cut_around(surface_) : cut_across(surface_);
  return straight && length_of(*straight) <= most_length * length_of(usual) ? std::move(*straight) : usual;
}

bool ComponentSystem::has_all_cuts() {
  if (all_cuts_ || is_blocked_) return !is_blocked_;
  try {
    all_cuts();
  } catch (const Error& error) {
    if (error.code() != Code::cuts_blocked) throw;
    is_blocked_ = true;  // angles need no cuts, and neither do holes that close without
  }
  return !is_blocked_;
}

bool ComponentSystem::is_on_cut() {
  if (!is_on_cut_) is_on_cut_ = has_all_cuts() && CutFactor::is_chosen(factorization_, surface_.mesh, all_cuts());
  return *is_on_cut_;
}

bool ComponentSystem::covers(const CutGraph& cut_graph) {
  if (!has_all_cuts()) return false;
  const PerHalfedge<char>&cut = cut_graph.is_cut, &cut_here = all_cuts().is_cut;
  return std::equal(cut.begin(), cut.end(), cut_here.begin(), [](char a, char b) { return a <= b; });
}

// Of large surfaces the frame tree, which one thread makes, goes beside the factor: maps need it next, and the factor's
// order leaves the others idle.
const CutFactor* ComponentSystem::factor() {
  if (!is_on_cut()) return nullptr;
  if (factor_) return &*factor_;
  const CutGraph& cuts = all_cuts();
  const bool makes_tree = !frame_tree_ && is_worth_threads(surface_.mesh.triangle_count());
  if (!makes_tree) return &factor_.emplace(surface_, cuts, std::move(memory_));
  team_of_this_call().run_each(2, [&](int i) {
    if (i == 0)  // on this thread, which counts factorizations
      factor_.emplace(surface_, cuts, std::move(memory_));
    else
      frame_tree_.emplace(surface_, cuts);
  });
  return &*factor_;
}

CutSurface ComponentSystem::open(const CutGraph& cut_graph, const CutMesh& cut_mesh) {
  CutSurface out{surface_, cut_graph, cut_mesh};
  if (!covers(cut_graph)) return out;
  if (!frame_tree_) frame_tree_.emplace(surface_, all_cuts());
  out.factor = factor();
  out.frame_tree = &*frame_tree_;
  return out;
}

const CutFactor* ComponentSystem::stiff_factor(const Array<Index>& cones, const CutGraph& cut_graph) {
  if (!is_on_cut() || !covers(cut_graph)) return nullptr;
  if (!stiff_factor_ || stiff_factor_->cones != cones) {
    stiff_factor_.reset();
    stiff_factor_.emplace(StiffFactor{cones, CutFactor({surface_.mesh, stiffen_around(surface_, cones)}, all_cuts())});
  }
  return &stiff_factor_->factor;
}

void ComponentSystem::release() {
  factor_.reset();
  log_scale_.reset();
  frame_tree_.reset();
  stiff_factor_.reset();
}

const LogScale& ComponentSystem::log_scale() {
  if (!log_scale_) log_scale_.emplace(surface_, border_, cones_, factor());
  return *log_scale_;
}

ComponentSystem& KeptSystem::of(const MetricMesh& surface, const ComponentCones& cones, Factorization factorization) {
  if (!has(cones) || factorization_ != factorization) {
    Eigen::VectorXd memory = system_ ? system_->take_memory() : Eigen::VectorXd();
    system_.reset();
    system_ = std::make_unique<ComponentSystem>(surface, cones, factorization, std::move(memory));
    cones_ = cones;
    factorization_ = factorization;
  }
  return *system_;
}

KeptSystem KeptSystem::take(const ComponentCones& cones) { return has(cones) ? std::move(*this) : KeptSystem(); }

// All of the cones but their angles has an effect on it.
bool KeptSystem::has(const ComponentCones& cones) const {
  return system_ && cones_.vertices == cones.vertices && cones_.border == cones.border &&
         cones_.mirroring.image == cones.mirroring.image;
}

}  // namespace lsgp

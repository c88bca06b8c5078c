// SPDX-License-Identifier: GPL-3.0-or-later
#include "component_system.hpp"

#include <algorithm>
#include <utility>

namespace lsgp {

std::vector<Index> inside_only(const HalfedgeMesh& mesh, const std::vector<Index>& vertices) {
  std::vector<Index> out;
  for (const Index v : vertices) {
    if (mesh.loop_of_vertex[v] == none) out.push_back(v);
  }
  return out;
}

ComponentSystem::ComponentSystem(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                                 Factorization factorization)
    : mesh_(mesh),
      geometry_(geometry),
      cones_(cones.vertices),
      factorization_(factorization),
      border_(border_conditions(mesh, geometry, cones)) {}

const CutGraph& ComponentSystem::all_cuts() {
  if (!all_cuts_) all_cuts_ = connect_cones(mesh_, geometry_, inside_only(mesh_, cones_), {});
  return *all_cuts_;
}

const CutFactor* ComponentSystem::factor() {
  if (!is_on_cut_) is_on_cut_ = CutFactor::is_chosen(factorization_, mesh_, all_cuts());
  if (!*is_on_cut_) return nullptr;
  if (!factor_) factor_.emplace(mesh_, geometry_, all_cuts());
  return &*factor_;
}

CutSurface ComponentSystem::open(const CutGraph& cut_graph, const CutMesh& cut_mesh) {
  CutSurface out{mesh_, geometry_, cut_graph, cut_mesh};
  const std::vector<char>&cut = cut_graph.is_cut, &cut_here = all_cuts().is_cut;
  if (!std::equal(cut.begin(), cut.end(), cut_here.begin(), [](char a, char b) { return a <= b; })) return out;
  if (!frame_tree_) frame_tree_.emplace(mesh_, geometry_, all_cuts());
  out.factor = factor();
  out.frame_tree = &*frame_tree_;
  return out;
}

const LogScale& ComponentSystem::log_scale() {
  if (!log_scale_) log_scale_.emplace(mesh_, geometry_, border_, cones_, factor());
  return *log_scale_;
}

}  // namespace lsgp

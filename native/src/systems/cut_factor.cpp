// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/cut_factor.hpp"

#include <cmath>
#include <utility>

#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

// Dense problems of k copies cost k^3, sparse ones of n vertices n^1.5: measured to be equal at about this k / sqrt(n).
constexpr double worth_while = 9;

}  // namespace

bool CutFactor::is_chosen(Factorization asked, const HalfedgeMesh& mesh, const CutGraph& cut_graph) {
  if (asked != Factorization::automatic) return asked == Factorization::cut;
  double copies = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) copies += cut_graph.is_cut[h] || mesh.twin[h] == none;
  return copies <= worth_while * std::sqrt(static_cast<double>(mesh.vertex_count()));
}

CutFactor::CutFactor(const MetricMesh& surface, Borrowed<const CutGraph> cut_graph, Eigen::VectorXd memory)
    : cut_graph_(cut_graph), cut_mesh_(cut_open(surface.mesh, cut_graph_)) {
  const HalfedgeMesh& mesh = surface.mesh;
  const PerVertex<char> on_cut = on_cuts(mesh, cut_graph_);
  const Index copies = cut_mesh_.copy_count();
  row_of_copy_.resize(copies);
  Index row = 0;
  for (Index copy = 0; copy < copies; ++copy) {
    const Index v = cut_mesh_.source[copy];
    if (on_cut[v] || mesh.loop_of_vertex[v] != none)
      retained_.push_back(copy);
    else
      row_of_copy_[copy] = row++;
  }
  for (const Index copy : retained_) row_of_copy_[copy] = row++;
  factor_.emplace(assemble_dirichlet(surface, cut_mesh_, row_of_copy_), retained_count(), std::move(memory));
  for (Index& own : row_of_copy_) own = factor_->place(own);
}

}  // namespace lsgp

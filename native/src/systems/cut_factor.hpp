// SPDX-License-Identifier: GPL-3.0-or-later
// The factorization of the opened surface's Dirichlet form, shared by prescription and unfolding.
//
// The form is real and the same for u and v. Cone angles, transitions across cuts and conditions along boundaries
// involve
// only the copies on cuts and boundaries: after elimination of all others, prescription and unfolding are dense
// problems of their number.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "cut/cut_mesh.hpp"
#include "lsgp/options.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"
#include "solvers/cholesky.hpp"

namespace lsgp {

class CutFactor {
 public:
  // memory: reused from a factor that is no longer needed.
  CutFactor(const MetricMesh& surface, Borrowed<const CutGraph> cut_graph, Eigen::VectorXd memory = {});
  Eigen::VectorXd take_memory() { return factor_->take_memory(); }

  // Whether to solve systems with such a factor: as requested, otherwise if cuts and boundaries are short enough for
  // the dense problems to pay off.
  static bool is_chosen(Factorization asked, const HalfedgeMesh& mesh, const CutGraph& cut_graph);

  const CutGraph& cut_graph() const { return cut_graph_; }
  const CutMesh& cut_mesh() const { return cut_mesh_; }

  // Copies that are not eliminated: those on cuts and boundaries.
  const Array<Index>& retained() const { return retained_; }
  Index eliminated_count() const { return cut_mesh_.copy_count() - retained_count(); }
  Index retained_count() const { return static_cast<Index>(retained_.size()); }

  // The discrete Dirichlet-to-Neumann operator of the retained copies.
  const Eigen::MatrixXd& schur() const { return factor_->schur(); }

  // A solve in two halves, as in Cholesky. Values are by rows, those of retained copies last.
  using Rows = Cholesky<double>::Rows;
  Index row_of_copy(Index copy) const { return row_of_copy_[copy]; }
  void eliminate(Rows& right_sides) const { factor_->eliminate(right_sides); }
  void substitute(Rows& half_solved) const { factor_->substitute(half_solved); }

 private:
  const CutGraph& cut_graph_;
  CutMesh cut_mesh_;
  Array<Index> retained_;
  PerCopy<Index> row_of_copy_;
  std::optional<Cholesky<double>> factor_;
};

}  // namespace lsgp

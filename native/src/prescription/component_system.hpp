// SPDX-License-Identifier: GPL-3.0-or-later
// The linear systems of one component, factored on first use and kept while its cones stay.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "prescription/curvature.hpp"
#include "systems/cut_factor.hpp"
#include "unfold/unfold.hpp"

namespace lsgp {

class ComponentSystem {
 public:
  // cones: their angles do not matter here.  memory: of a system that is not needed any more.
  ComponentSystem(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                  Factorization factorization, Eigen::VectorXd memory = {});
  Eigen::VectorXd take_memory();

  const HalfedgeMesh& mesh() const { return mesh_; }
  const Geometry& geometry() const { return geometry_; }
  const BorderConditions& border() const { return border_; }

  // Cuts through all cones that lie inside and to all borders.
  const CutGraph& all_cuts();
  // What is shared by prescription and unfolding, or null where they are better solved one by one.
  const CutFactor* factor();
  // The surface opened along these cuts, with what serves it here: all of it where the cuts are among `all_cuts`.
  CutSurface open(const CutGraph& cut_graph, const CutMesh& cut_mesh);
  // That of the component's metric, all cones added.
  const LogScale& log_scale();
  // A factor of the form that is stiffened around these cones, or null where other cuts are opened than `all_cuts`, or
  // where it is better solved another way. Stays until it is asked for other cones.
  const CutFactor* stiff_factor(const Array<Index>& cones, const CutGraph& cut_graph);

  // Frees what is large and can be made again.
  void release();

 private:
  struct StiffFactor {
    Array<Index> cones;
    CutFactor factor;
  };

  bool has_all_cuts();
  bool covers(const CutGraph& cut_graph);
  bool is_on_cut();

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const Array<Index> cones_;
  const Factorization factorization_;
  const BorderConditions border_;
  Eigen::VectorXd memory_;  // for the factor, until there is one
  std::optional<CutGraph> all_cuts_;
  bool is_blocked_ = false;        // edges do not lead everywhere
  std::optional<bool> is_on_cut_;  // known once the cuts are
  std::optional<CutFactor> factor_;
  std::optional<LogScale> log_scale_;
  std::optional<FrameTree> frame_tree_;
  std::optional<StiffFactor> stiff_factor_;
};

// Those of the vertices that lie on no border.
Array<Index> inside_only(const HalfedgeMesh& mesh, const Array<Index>& vertices);

}  // namespace lsgp

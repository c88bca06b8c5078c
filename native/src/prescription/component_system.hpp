// SPDX-License-Identifier: GPL-3.0-or-later
// The linear systems of one component, factored on first use and kept while its cones do not move.
#pragma once

#include <memory>
#include <optional>

#include "base/array.hpp"
#include "lsgp/options.hpp"
#include "prescription/curvature.hpp"
#include "prescription/straight_angles.hpp"
#include "systems/cut_factor.hpp"
#include "unfold/frames.hpp"

namespace lsgp {

class ComponentSystem {
 public:
  // cones: their angles have no effect here.  memory: reused from a system that is no longer needed.
  ComponentSystem(const MetricMesh& surface, const ComponentCones& cones, Factorization factorization,
                  Eigen::VectorXd memory = {});
  Eigen::VectorXd take_memory();

  const MetricMesh& surface() const { return surface_; }
  const HalfedgeMesh& mesh() const { return surface_.mesh; }
  const Geometry& geometry() const { return surface_.geometry; }
  const BorderConditions& border() const { return border_; }
  const Mirroring& mirroring() const { return mirroring_; }

  // Cuts through all interior cones and to all boundaries.
  const CutGraph& all_cuts();
  // Angles of straight cuts, found at the first call. cones: those of the system.  least: of least distortion.
  const StraightAngles& straight_angles(const ComponentCones& cones, const Eigen::VectorXd& least);
  // The cuts that these straightened, `all_cuts` otherwise.
  const CutGraph& straight_cuts();
  // Cuts to these interior cones, and to the boundary loops that `uncut` does not mark.
  CutGraph connect(const Array<Index>& interior_cones, const PerLoop<char>& uncut) const;
  // The factor shared by prescription and unfolding, or null if separate solves are cheaper.
  const CutFactor* factor();
  // The surface opened along these cuts, with the reusable data: all of it if the cuts are among `all_cuts`.
  CutSurface open(const CutGraph& cut_graph, const CutMesh& cut_mesh);
  // The log scale of the component's metric, with all cones added.
  const LogScale& log_scale();
  // A factor of the form stiffened around these cones, or null if cuts other than `all_cuts` are opened or another
  // solver is cheaper. Kept until requested for other cones.
  const CutFactor* stiff_factor(const Array<Index>& cones, const CutGraph& cut_graph);

  // Frees large data that can be recomputed.
  void release();

 private:
  struct StiffFactor {
    Array<Index> cones;
    CutFactor factor;
  };

  bool has_all_cuts();
  bool covers(const CutGraph& cut_graph);
  bool is_on_cut();

  const MetricMesh surface_;
  const Array<Index> cones_;
  const Mirroring mirroring_;
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
  std::optional<StraightAngles> straight_angles_;
};

// The latest system of one component, for as long as only the angles of its cones change.
class KeptSystem {
 public:
  // The system of these cones. If they moved, it replaces the previous one and reuses its memory.
  ComponentSystem& of(const MetricMesh& surface, const ComponentCones& cones,
                      Factorization factorization = Factorization::automatic);

  ComponentSystem* get() { return system_.get(); }  // null if there is none
  // Passes it on if it is that of these cones; otherwise returns none, and keeps it.
  KeptSystem take(const ComponentCones& cones);

 private:
  bool has(const ComponentCones& cones) const;

  ComponentCones cones_;
  Factorization factorization_ = Factorization::automatic;
  std::unique_ptr<ComponentSystem> system_;
};

// The interior ones of the vertices.
Array<Index> inside_only(const HalfedgeMesh& mesh, const Array<Index>& vertices);

}  // namespace lsgp

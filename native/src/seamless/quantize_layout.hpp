// SPDX-License-Identifier: GPL-3.0-or-later
// Snaps cones and translations to a lattice (the paper's section 8).
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <limits>
#include <memory>
#include <optional>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "lsgp/options.hpp"
#include "pipeline/component_map.hpp"
#include "plane/point_lattice.hpp"
#include "repair/newton.hpp"
#include "seamless/feature_alignment.hpp"
#include "seamless/feature_layout.hpp"
#include "seamless/lattice_energy.hpp"
#include "seamless/lattice_search.hpp"
#include "seamless/lattice_transitions.hpp"
#include "systems/poisson_system.hpp"
#include "unfold/texture_direction.hpp"

namespace lsgp {

// A layout whose transitions are a lattice's, 1 being the side of a cell.
struct QuantizedLayout {
  Eigen::VectorXcd position;   // (copies)
  double energy = 1;           // symmetric Dirichlet energy, 1 is isometric
  bool has_features = false;   // along lines of the lattice
  bool keeps_corners = false;  // of features, at corners of cells
};

// Which layouts on a grid are acceptable.
struct LayoutEffort {
  double most_growth = 1e4;  // of the energy by rounding: with more, triangles collapse in single precision
  double most_turned = std::numeric_limits<double>::infinity();  // radians, of directions by rounding, on average
  bool quick = false;  // accept only layouts that need little repair; otherwise continuation in steps is tried, too
  enum class Features { if_possible, required, ignored } features = Features::if_possible;
};

// Two cones next to each other.
struct ConePair {
  double distance;  // in the flat metric, where it has the surface's area
  Index first, second;
};

// How layouts are to lie on the lattice.
struct LatticeDemands {
  PointLattice lattice;
  bool parity;                                 // translations lead from white cells to white ones
  const Array<Index>& relaxed;                 // cones that need not lie on the lattice
  const TextureDirections& directions;         // what v is to run along
  bool creases;                                // run along lines of the lattice, as marked features do
  FeaturePlaces feature_places;                // of creases and marked features
  std::optional<FeatureAlignment>& alignment;  // of the map, or empty, which is filled where features are aligned
};

// The layouts of one map on grids of any size. What does not depend on the size is computed once, when it is needed.
class LayoutQuantizer {
 public:
  // system: of the map's cones, and others that are flat.
  // map: without flips and with the right angles, its rotations multiples of the lattice's turn.
  // Throws SEAMLESS_IMPOSSIBLE.
  LayoutQuantizer(ComponentSystem& system, Borrowed<const ComponentMap> map, const LatticeDemands& demands,
                  StepHook before_step);

  // The layout's longer side, where it has the surface's area.
  double extent() const { return extent_; }
  double energy() const { return energy_; }

  // Otherwise layouts of all sizes are similar.
  bool has_lattice_points() const { return integers_.size() > 0; }

  bool has_features() const { return features_ != nullptr; }
  // Whose layouts take long.
  bool has_many_features() const { return features_ != nullptr && features_->is_large(); }
  // Releases some of the features; false if none is left.
  bool loosen_features();
  // Why features of halfedges that do not run along an axis of a layout do not; empty: none does on this lattice.
  PerHalfedge<ReleaseReason> release_reasons(const QuantizedLayout& layout) const;

  // The nearest first; closed surfaces.
  const Array<ConePair>& cone_pairs() { return cone_triangles().pairs; }

  // The layout with `density` cells per unit of length, rounded to lattice points: by the displacement of least
  // Dirichlet energy, then repaired. None where no choice of points keeps it valid and its energy within bounds.
  std::optional<QuantizedLayout> quantize(double density, const LayoutEffort& effort);

  // Symmetric Dirichlet energy of positions of the copies.
  double measure_energy(const Eigen::VectorXcd& position) const;

  // The square root of the area of positions of the copies, over the surface's.
  double measure_scale(const Eigen::VectorXcd& position) const;

  // Moves all points but the lattice points to where they stretch least; see low_stretch.hpp.
  void lower_stretch(double stretch, const Eigen::VectorXd& importance, QuantizedLayout& layout) const;

 private:
  // Smoothing by the symmetric Dirichlet energy, 1 for an isometry.
  static constexpr double stretched_energy = 1.5;  // of a triangle, or of a layout beside its start, that calls for it
  static constexpr double least_decrease = 1e-3;   // of the energy, for which a further step is taken
  static constexpr int smoothing_steps = 4;

  struct Target {
    Complex motion;             // turn and scale of the start
    Eigen::VectorXcd integers;  // (d)
    double cost;
  };

  // A triangulation of the cones of a closed surface, and the pairs that share an edge of it.
  struct ConeTriangles {
    Array<MovingTriangle> triangles;
    Array<ConePair> pairs;  // the nearest first
  };

  CutSurface surface() const { return {{mesh_, geometry_}, cut_graph_, cut_mesh_}; }
  bool has_many_terms() const;
  const Reduction& moving_reduction() const { return local_ ? *local_ : reduction_.reduction; }
  std::optional<Complex> turn_along_sides(const Eigen::VectorXcd& position) const;
  void set_start(const ComponentMap& map);
  void align_features();
  std::optional<QuantizedLayout> quantize_with_features(double density, const LayoutEffort& effort) const;
  void prepare_search();
  const ConeTriangles& cone_triangles();
  bool lacks_area(double density);
  ConeTriangles find_cone_triangles() const;
  UpwardTurn find_upward_turn(const Eigen::VectorXcd& position) const;
  void turn_upwards(Eigen::VectorXcd& position) const;
  double measure_misalignment(const Eigen::VectorXcd& position) const;
  Eigen::VectorXcd integers_of(const Eigen::VectorXcd& position) const;
  Array<Target> find_targets(double density, int searched_angles);

  // In move_layout.cpp.
  Validity check(const Eigen::VectorXcd& position) const;
  bool repair(double scale, const Eigen::VectorXcd& before, Eigen::VectorXcd& position) const;
  void smooth(double scale, PerVertex<char> marked, int steps, Eigen::VectorXcd& position) const;
  Eigen::VectorXd triangle_energies(double scale, const Jacobians& jacobians) const;
  Array<Index> find_stretched(double scale, const Jacobians& jacobians) const;
  bool looks_easy(double scale, double most_energy, const Validity& validity, const Eigen::VectorXcd& position) const;
  bool move(double scale, const LayoutEffort& effort, const Eigen::VectorXcd& change, Eigen::VectorXcd& position) const;
  bool follow(double scale, const Eigen::VectorXcd& change, Eigen::VectorXcd& position) const;
  PerVertex<char> without_cones(PerVertex<char> marked) const;

  ComponentSystem& system_;
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const Array<Index>& cones_;  // of the map
  const CutGraph& cut_graph_;
  const CutMesh& cut_mesh_;
  const Curvature& curvature_;
  const double natural_l2_;
  const LatticeDemands demands_;
  const PointLattice& lattice_ = demands_.lattice;
  const StepHook before_step_;
  Eigen::VectorXd rotation_;
  bool is_turned_ = false;   // so that directions run along the lattice
  double misalignment_ = 0;  // of the start
  Eigen::VectorXcd start_;   // (copies) with the surface's area, the origin cone at 0
  Eigen::VectorXd rest_;     // (n) log of its scale
  Eigen::VectorXd strain_;   // (m) its triangles' energies against that scale, 4 for isometries
  Eigen::VectorXcd motion_of_copies_;
  double extent_ = 0, energy_ = 1;
  LatticeReduction reduction_;
  std::optional<Reduction> local_;                 // where its terms are many
  Eigen::VectorXcd integers_;                      // (d) at the start
  std::unique_ptr<LatticeEnergy> lattice_energy_;  // beside search_: of the Dirichlet form, stiffened around cones
  std::unique_ptr<FeatureLayout> features_;        // or null
  PerHalfedge<ReleaseReason> release_reasons_;     // without a lattice, or empty
  // Stretch with features along the lattice, and with their corners on it as well.
  double most_l2_ = 0, most_l2_with_corners_ = 0;
  std::optional<ConeTriangles> cone_triangles_;             // where needed
  Eigen::PartialPivLU<Eigen::MatrixXcd> inverse_of_basis_;  // beside search_
  std::optional<LatticeSearch> search_;                     // where needed
};

// Symmetric Dirichlet energy of a map, area-weighted, at its best scale; 1 is isometric.
double symmetric_dirichlet_energy(const Geometry& geometry, const Jacobians& jacobians);

}  // namespace lsgp

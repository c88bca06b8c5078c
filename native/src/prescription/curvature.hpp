// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature prescription (the paper's section 5): the angle of every cone.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/options.hpp"
#include "mesh/border.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mirror.hpp"
#include "mesh/topology.hpp"
#include "systems/laplace_solver.hpp"

namespace lsgp {

// The log scale y of the metric with given curvatures: L y = kappa - K where y is not held at 0, so y is affine in the
// cone curvatures, y = y_0 + sum of kappa_c G_c. One factorization; one more back-substitution for every cone. With
// nothing held, y is known up to a constant, Gauss-Bonnet has to hold, and y is held at one vertex, a cone if any.
class LogScale {
 public:
  // cones: interior, distinct.  factor: if given, an existing one with the cones on its cuts.
  LogScale(const HalfedgeMesh& mesh, const Geometry& geometry, const BorderConditions& border,
           const Array<Index>& cones = {}, const CutFactor* factor = nullptr);

  const HalfedgeMesh& mesh() const { return mesh_; }
  const Geometry& geometry() const { return geometry_; }
  const BorderConditions& border() const { return border_; }

  void add_cones(const Array<Index>& vertices);  // distinct, not held
  void remove_cones();                           // all of them
  Index cone_count() const { return static_cast<Index>(cones_.size()); }
  const Array<Index>& cones() const { return cones_; }
  bool balanced() const { return border_.balanced; }
  // The required sum of the cone curvatures when balanced.
  double required_sum() const { return 2 * M_PI * mesh_.euler - border_.curvature.sum(); }

  // y at every vertex (n), shifted to area-weighted mean 0.
  Eigen::VectorXd evaluate(const Eigen::VectorXd& cone_curvature) const;
  // The same, unshifted: 0 where held.
  Eigen::VectorXd evaluate_held(const Eigen::VectorXd& cone_curvature) const;
  // The same with curvatures at any vertices, which need not be cones; one back-substitution.
  Eigen::VectorXd evaluate_held(const Array<Index>& vertices, const Eigen::VectorXd& curvature) const;
  // The change of that per unit of a cone's curvature.
  auto effect(Index cone) const { return green_.col(cone); }

  // Solves L y = right side, (n), where y is not held; the sum of the right side is 0 when balanced.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right_sides) const;  // (n, k)

  // The cone curvatures for which y is 0 (balanced: constant) at all cones (Ben-Chen et al. 2008).
  Eigen::VectorXd harmonic_curvature() const;

  // The minimum of log mean e^{2y} + log mean e^{-2y} (area-weighted; the logarithm of the squared L2 stretch of the
  // map) over low <= kappa <= high from a feasible start: convex, Newton's method with a quadratic program a step.
  Eigen::VectorXd least_distortion_curvature(const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                                             Eigen::VectorXd start) const;

  // The L2 stretch of the map, (area-weighted mean e^{2y} mean e^{-2y})^{1/2}: with y at the midpoints of edges, which
  // is most accurate, and lumped at the vertices, which is faster and minimised by the prescription.
  double predicted_l2(const Eigen::VectorXd& log_scale) const;
  double lumped_l2(const Eigen::VectorXd& log_scale) const;

  // The area-weighted variance of y: constant + 2 gradient . kappa + kappa . hessian kappa.
  struct Variance {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
  };
  Variance variance() const;

 private:
  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  BorderConditions border_;
  Array<Index> cones_;
  std::unique_ptr<LaplaceSolver> laplace_;
  Eigen::VectorXd weight_;         // (n) share of the area
  Eigen::VectorXd without_cones_;  // (n) y_0
  Eigen::MatrixXd green_;          // (n, k) G_c
};

// Bounds of the angles of automatic cones, radians; widened if Gauss-Bonnet requires it.
struct AngleRange {
  double smallest, largest;
  bool widened = true;  // to the harmonic angles: a sharp tip may need less and a branching limb more
};
constexpr AngleRange widest_angles{M_PI / 4, 4 * M_PI};

// An L2 stretch that causes a warning.
constexpr double high_l2 = 3;

// For wider ranges of the log scale, maps without flips can hardly be computed.
constexpr double wide_range = 15;

// The largest L2 stretch that is predicted: its square is a number.
constexpr double largest_l2 = 1e100;

// Which holes of a planar component, one without handles and interior cones, close without a cut.
enum class Holes {
  where_cheap,  // those that cost hardly any stretch
  all,          // all, as far as a map can be computed
  as_they_are,  // those about which the metric turns nearly once
  as_given,     // those whose turning is prescribed
};

// The requirements on one component's metric, in its own vertex numbers.
struct ComponentCones {
  Array<Index> vertices;                // cones, and corners on a boundary
  Array<std::optional<double>> angles;  // radians, none: automatic
  BorderMode border = BorderMode::free;
  PerLoop<std::optional<double>> loop_turning;  // radians, none: free
  Holes holes = Holes::where_cheap;
  AngleRange range = widest_angles;  // of automatic ones
  int symmetry = 0;                  // q: angles of cones and turning of boundaries are multiples of 2 pi / q; 0: any
  Mirroring mirroring;               // cuts are symmetric in it if it is not empty
};

// The target of a component's map.
struct Curvature {
  Eigen::VectorXd at_vertex;  // (n) imposed: of cones, 0 in the interior, the resulting one on a free boundary
  PerVertex<char> is_free;    // boundary vertices with a free angle, at_vertex being approximate there
  Eigen::VectorXd log_scale;  // (n) area-weighted mean 0
  double predicted_l2 = 1;
  // (loops) holes about which the metric turns exactly once: they need no cut.
  PerLoop<char> needs_no_cut;
};

class ComponentSystem;

BorderConditions border_conditions(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones);

// cones: those of the system. Throws TOO_FEW_CONES, CONE_ANGLE_RANGE, GAUSS_BONNET, LOOP_TURNING with the component's
// own vertex numbers.
Curvature prescribe(ComponentSystem& system, const ComponentCones& cones, PrescriptionRule rule,
                    std::vector<Finding>& findings);

// The same with the cones' curvatures given, and the log scale that they make, (n) and 0 where held. Throws
// LOOP_TURNING.
Curvature impose(const LogScale& scale, const ComponentCones& asked, const Eigen::VectorXd& curvature,
                 Eigen::VectorXd log_scale, std::vector<Finding>& findings);

// Refuses what no choice of the automatic angles can mend. Throws TOO_FEW_CONES, CONE_ANGLE_RANGE, GAUSS_BONNET.
void require_feasible(const HalfedgeMesh& mesh, const ComponentCones& cones, const BorderConditions& border);

// The least and the most curvature that the cones without an angle can take up together.
std::pair<double, double> room_of_automatic(const HalfedgeMesh& mesh, const ComponentCones& cones);

// Throws ANGLES_IMPOSSIBLE for given angles that no map has, whatever the automatic ones are.
void require_possible(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones);

// The number of triangles around a vertex.
int valence(const HalfedgeMesh& mesh, Index vertex);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature prescription (the paper's section 5): how much angle every cone keeps.
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
#include "mesh/topology.hpp"
#include "systems/laplace_solver.hpp"

namespace lsgp {

// The log scale y of the metric with given curvatures: L y = kappa - K where y is not held at 0, so y is affine in the
// cone curvatures, y = y_0 + sum of kappa_c G_c. One factorization; one more back-substitution for every cone. With
// nothing held, y is known up to a constant, Gauss-Bonnet has to hold, and y is held at one vertex, a cone if any.
class LogScale {
 public:
  // cones: inside, none twice.  factor: where given, one that is there already and has them on its cuts.
  LogScale(const HalfedgeMesh& mesh, const Geometry& geometry, const BorderConditions& border,
           const Array<Index>& cones = {}, const CutFactor* factor = nullptr);

  const HalfedgeMesh& mesh() const { return mesh_; }
  const Geometry& geometry() const { return geometry_; }
  const BorderConditions& border() const { return border_; }

  void add_cones(const Array<Index>& vertices);  // none twice, none held
  void remove_cones();                           // all of them
  Index cone_count() const { return static_cast<Index>(cones_.size()); }
  const Array<Index>& cones() const { return cones_; }
  bool balanced() const { return border_.balanced; }
  // What the cone curvatures have to add up to when balanced.
  double required_sum() const { return 2 * M_PI * mesh_.euler - border_.curvature.sum(); }

  // y at every vertex (n), shifted to area-weighted mean 0.
  Eigen::VectorXd evaluate(const Eigen::VectorXd& cone_curvature) const;
  // The same, unshifted: 0 where held.
  Eigen::VectorXd evaluate_held(const Eigen::VectorXd& cone_curvature) const;
  // The same with curvatures at any vertices, which need not be cones; one back-substitution.
  Eigen::VectorXd evaluate_held(const Array<Index>& vertices, const Eigen::VectorXd& curvature) const;
  // What a cone's curvature adds to that, each unit of it.
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

  // The L2 stretch of the map, (area-weighted mean e^{2y} mean e^{-2y})^{1/2}: with y at the middles of edges, which
  // tells it best, and lumped at the vertices, which is quicker and what the prescription minimises.
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

// Bounds of the angles of automatic cones, radians; widened where Gauss-Bonnet wants more.
struct AngleRange {
  double smallest, largest;
  bool widened = true;  // to the harmonic angles: a sharp tip may need less and a branching limb more
};
constexpr AngleRange widest_angles{M_PI / 4, 4 * M_PI};

// An L2 stretch that is warned of.
constexpr double high_l2 = 3;

// From wider ranges of the log scale maps without flips can hardly be computed.
constexpr double wide_range = 15;

// The largest L2 stretch that is predicted: its square is a number.
constexpr double largest_l2 = 1e100;

// Which holes of a planar part, one without handles and cones inside, close without a cut.
enum class Holes {
  where_cheap,  // those for which that costs hardly any stretch
  all,          // and the others too, as far as a map can be computed
  as_they_are,  // those that do so nearly by themselves
};

// What the caller asks of one component's metric, in its own vertex numbers.
struct ComponentCones {
  Array<Index> vertices;                // cones, and corners on a border
  Array<std::optional<double>> angles;  // radians, none: automatic
  BorderMode border = BorderMode::free;
  Array<std::optional<double>> loop_turning;  // (loops) radians, none: as it comes out
  Holes holes = Holes::where_cheap;
  AngleRange range = widest_angles;  // of automatic ones
  int symmetry = 0;                  // q: angles of cones and turning of borders are multiples of 2 pi / q; 0: any
};

// What a component's map has to realise.
struct Curvature {
  Eigen::VectorXd at_vertex;  // (n) imposed: cones theirs, 0 inside, what comes out on a free border
  Array<char> is_free;        // (n) border vertices whose angle comes out only about as said here
  Eigen::VectorXd log_scale;  // (n) area-weighted mean 0
  double predicted_l2 = 1;
  // (loops) holes about which the metric turns exactly once: they need no cut.
  Array<char> needs_no_cut;
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

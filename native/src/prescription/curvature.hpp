// SPDX-License-Identifier: GPL-3.0-or-later
// Curvature prescription (the paper's section 5): the angle of every cone.
#pragma once

#include <Eigen/Core>
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
#include "prescription/log_scale.hpp"

namespace lsgp {

// Bounds of the angles of automatic cones, radians; widened if Gauss-Bonnet requires it.
struct AngleRange {
  double smallest, largest;
  bool widened = true;  // to the harmonic angles: a sharp tip may need less and a branching limb more
};
constexpr AngleRange widest_angles{M_PI / 4, 4 * M_PI};

// An L2 stretch that causes a warning.
constexpr double high_l2 = 3;

// Holes are closed without a cut up to so many times the L2 stretch with cuts to them.
constexpr double cheap_holes = 1.1;

// For wider ranges of the log scale, maps without flips can hardly be computed.
constexpr double wide_range = 15;

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
  int rotation_order = 0;            // q: angles of cones and turning of boundaries are multiples of 2 pi / q; 0: any
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
struct TextureDirections;

BorderConditions border_conditions(const MetricMesh& surface, const ComponentCones& cones);

// cones: those of the system.  strokes: which automatic angles follow where that costs little, or null. Throws
// TOO_FEW_CONES, CONE_ANGLE_RANGE, GAUSS_BONNET, LOOP_TURNING with the component's own vertex numbers.
Curvature prescribe(ComponentSystem& system, const ComponentCones& cones, PrescriptionRule rule,
                    std::vector<Finding>& findings, const TextureDirections* strokes = nullptr);

// The same with the cones' curvatures given, and the log scale that they make, (n) and 0 where held. Throws
// LOOP_TURNING.
Curvature impose(const LogScale& scale, const ComponentCones& asked, const Eigen::VectorXd& curvature,
                 Eigen::VectorXd log_scale, std::vector<Finding>& findings);

// Refuses tasks that no choice of the automatic angles can satisfy. Throws TOO_FEW_CONES, CONE_ANGLE_RANGE,
// GAUSS_BONNET.
void require_feasible(const HalfedgeMesh& mesh, const ComponentCones& cones, const BorderConditions& border);

// The least and the most curvature that the cones without an angle can take up together.
std::pair<double, double> room_of_automatic(const HalfedgeMesh& mesh, const ComponentCones& cones);

// The sums of angles that a map has to have.
struct AngleSums {
  Eigen::VectorXd angle;    // (n)
  PerVertex<char> is_free;  // any sum will do
};
AngleSums required_angles(const MetricMesh& surface, const ComponentCones& cones);

// Throws ANGLES_IMPOSSIBLE if no map has the given angles, whatever the automatic ones are, or no map has cones at
// these vertices alone, whatever their angles.  log_scale: (n) of a metric with such angles; another one takes longer.
void require_possible(const MetricMesh& surface, const ComponentCones& cones, const Eigen::VectorXd& log_scale);

// Whether a map can have this curvature at a vertex.
bool is_possible(const HalfedgeMesh& mesh, Index vertex, double curvature);

// The number of triangles around a vertex.
int valence(const HalfedgeMesh& mesh, Index vertex);

}  // namespace lsgp

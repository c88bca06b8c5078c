// SPDX-License-Identifier: GPL-3.0-or-later
// Trial maps for judging choices of cones.
#pragma once

#include <limits>
#include <optional>

#include "base/progress_monitor.hpp"
#include "pipeline/component_map.hpp"

namespace lsgp {

// The measurements of the map with some cones.
struct TriedMap {
  double l2 = std::numeric_limits<double>::infinity();  // its L2 stretch; infinite with any of the following
  Index flipped = 0;                                    // triangles
  Index wrong_angles = 0;                               // vertices whose angles do not add up to what was imposed
  Index inexact_seams = 0;                              // cut edges, where sides disagree visibly
  bool failed = true;                                   // there is no map
  bool is_repaired = false;                             // as far as possible
  Holes holes = Holes::where_cheap;                     // those that were to close
  Eigen::VectorXd curvature;                            // (cones) that it has, in their order; empty where it failed

  Eigen::VectorXd stretch;  // (n) the triangles' around each vertex, by area and less 1; empty where it is not valid

  bool is_valid() const { return l2 < std::numeric_limits<double>::infinity(); }
  Index defects() const { return flipped + wrong_angles + inexact_seams; }
  // Angles or seams are off, which makes the map unusable.
  bool is_off() const { return failed || wrong_angles > 0 || inexact_seams > 0; }
};

// Computes maps of one component as unwrapping with default options does. Their linear algebra is not counted. The
// system of the latest one is kept.
class MapTrial {
 public:
  MapTrial(const MetricMesh& surface, ProgressMonitor& monitor)
      : mesh_(surface.mesh), geometry_(surface.geometry), monitor_(monitor) {}

  enum class Repairs { easy, all };
  // cones: with the angles that are to be imposed, others are chosen for least distortion.
  // Throws CANCELLED and OUT_OF_MEMORY; other errors are failures of the map.
  TriedMap make(const ComponentCones& cones, Repairs repairs);

  // u + iv at the corners, (3m), of the map with these angles; none where it fails.
  std::optional<Eigen::VectorXcd> corners_of_map(const ComponentCones& cones);

  int made() const { return made_; }
  // The system of the latest map, if it is that of these cones; none otherwise, and none from then on.
  KeptSystem take_system(const ComponentCones& cones) { return system_.take(cones); }

 private:
  // None where it fails.
  std::optional<ComponentMap> map(const ComponentCones& cones, Repairs repairs);
  TriedMap measured(ComponentMap map, const ComponentCones& cones) const;

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  ProgressMonitor& monitor_;
  int made_ = 0;
  KeptSystem system_;
};

}  // namespace lsgp

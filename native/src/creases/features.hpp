// SPDX-License-Identifier: GPL-3.0-or-later
// Hard surfaces: their curvature is at creases, along which a texture or a grid of quads is to run.
#pragma once

#include "base/array.hpp"
#include "lsgp/crease_borders.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

// Least angle between the normals at a crease, radians: that of CreaseOptions unless they have another.
inline constexpr double crease_angle = CreaseOptions::usual_angle;

// The angle defects of points inside, without signs: of all, and of those at creases. Vertices that coincide are one
// point.
class CreaseCurvature {
 public:
  CreaseCurvature(const MetricMesh& surface, const PerVertex<char>& is_at_crease);

  // Whether creases carry so much of the curvature that the surface is hard: four fifths, and not of hardly any.
  bool is_hard() const { return is_curved() && is_carried(least_share); }
  // Whether there is anything that creases could carry.
  bool is_curved() const;
  bool is_carried(double share) const { return at_creases_ >= share * all_; }
  // As many vertices as would have the curvature, were they alike.
  double vertex_count() const { return count(all_, all_squares_); }
  double vertex_count_at_creases() const { return count(at_creases_, squares_at_creases_); }
  double vertex_count_elsewhere() const { return count(all_ - at_creases_, all_squares_ - squares_at_creases_); }

  static constexpr double least_share = CreaseOptions::usual_share;

 private:
  static double count(double sum, double of_squares);

  double all_ = 0, at_creases_ = 0;  // radians
  double all_squares_ = 0, squares_at_creases_ = 0;
};

// What makes an edge a feature; marked ones have precedence.
enum FeatureKind : char { no_feature, crease_feature, marked_feature };

// Marks both halfedges of the edges at which the surface bends by `crease_angle`; none if the surface is not hard.
PerHalfedge<char> find_features(const MetricMesh& surface);

// The FeatureKind of every halfedge: of marked edges and, if asked for, those that find_features finds.
PerHalfedge<char> features_to_align(const MetricMesh& surface, bool with_creases);

}  // namespace lsgp

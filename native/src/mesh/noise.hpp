// SPDX-License-Identifier: GPL-3.0-or-later
// Noise at the scale of triangles, as that of scans: it is no shape, and no reason for creases or cones.
#pragma once

#include <optional>

#include "mesh/geometry.hpp"

namespace lsgp {

// Whether nearly all curvature is noise: where at least 500 triangles bend at nearly all edges, and three quarters of
// the curvature cancel within two edges of each vertex.
bool is_noisy(const MetricMesh& surface);

// The shape of a surface: itself or, if it is noisy, one without noise whose creases stay. Refers to the surface.
class Shape {
 public:
  // without_noise: otherwise it is the surface in any case.
  explicit Shape(const MetricMesh& surface, bool without_noise = true);
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;

  bool is_smoothed() const { return smoothed_.has_value(); }
  MetricMesh surface() const { return smoothed_ ? MetricMesh{smoothed_->mesh, smoothed_->geometry} : surface_; }

 private:
  struct Smoothed {
    HalfedgeMesh mesh;
    Geometry geometry;
  };

  const MetricMesh surface_;
  std::optional<Smoothed> smoothed_;
};

}  // namespace lsgp

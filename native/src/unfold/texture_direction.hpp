// SPDX-License-Identifier: GPL-3.0-or-later
// The images of directions on the surface in a layout, and the rotation of the layout that aligns them with v.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/array.hpp"
#include "mesh/topology.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

// Directions in triangles, as coefficients of two edges, which give their images in any map.
struct TextureDirections {
  Eigen::VectorXd along_first, along_last;  // (m) from corner 0 to corners 1 and 2
  Eigen::VectorXd weight;                   // (m) area times the direction's length, 0 without one

  bool empty() const { return weight.size() == 0; }
  // Its length is its weight; 0 if the image has no direction.
  Complex image(const CornerPositions& position, Index triangle) const;
};

// vectors: (m, 3) in space, for the triangles of this mesh; the component in the triangle's plane counts.
TextureDirections directions_in_triangles(const HalfedgeMesh& mesh, const Positions& vectors);

// The turning of boundaries in a layout in which directions, modulo rotations by 2 pi / rotation_order, are parallel:
// (loops) radians. None for a boundary without directions, or if they vary too much.
PerLoop<std::optional<double>> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int rotation_order);

// The vertices around which the directions are nearly parallel, so that a cone there would bend the texture.
PerVertex<char> runs_straight_around(const HalfedgeMesh& mesh, const Positions& vectors, int rotation_order);

// The rotation of a layout that aligns the images of directions with v.
class UpwardTurn {
 public:
  // rotation_order: of the layout's lattice.
  explicit UpwardTurn(int rotation_order = 1) : rotation_order_(rotation_order) {}
  void add(Complex image);

  // The least squares fit to v, or, if many images are opposite to others, to v or its opposite; if they all are along
  // the axes of one frame, as on an unfolded box, the nearest turn of that frame. None without images, or if they
  // cancel.
  std::optional<Complex> turn() const;
  // The same modulo rotations by 2 pi / rotation_order, and then the best of these, in multiples of that.
  std::optional<Complex> turn_to_lattice() const;
  int turns_on_lattice() const;

 private:
  bool remains(Complex sum) const;
  std::optional<Complex> fitted_turn() const;

  int rotation_order_;
  // Sums of e^{i k angle} over the angles from v, by weight.
  Complex once_ = 0, twice_ = 0, by_quarter_ = 0, by_rotation_ = 0;
  double weight_ = 0;
};
UpwardTurn upward_turn(const TextureDirections& directions, const CornerPositions& position, int rotation_order);

// The angle between an image and v, modulo rotations by 2 pi / rotation_order, radians; the mean of all, if there are
// any.
double angle_to_v(Complex image, int rotation_order);
double mean_angle_to_v(const TextureDirections& directions, const CornerPositions& position, int rotation_order);

// The remaining mean when the layout is rotated accordingly.
double misalignment_on_lattice(const TextureDirections& directions, const CornerPositions& position,
                               int rotation_order);

}  // namespace lsgp

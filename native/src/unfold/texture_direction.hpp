// SPDX-License-Identifier: GPL-3.0-or-later
// Where directions on the surface come to lie in a layout, and how it has to be turned so that they run along v.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/array.hpp"
#include "mesh/topology.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

// Directions within triangles, by their coefficients along two edges: the same ones give the image in any map.
struct TextureDirections {
  Eigen::VectorXd along_first, along_last;  // (m) from corner 0 to corners 1 and 2
  Eigen::VectorXd weight;                   // (m) area times the direction's length, 0 without one

  bool empty() const { return weight.size() == 0; }
  // As long as its weight; 0 where the map leaves no direction.
  Complex image(const CornerPositions& position, Index triangle) const;
};

// vectors: (m, 3) in space, of the triangles of this mesh; the part of each that lies in its triangle counts.
TextureDirections directions_in_triangles(const HalfedgeMesh& mesh, const Positions& vectors);

// How much the borders of a surface without cones turn in a layout in which directions, up to rotations by
// 2 pi / symmetry, are parallel: (loops) radians. None along a border without directions or where they vary too much to
// tell, and for all borders where they could not turn so without cones.
Array<std::optional<double>> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int symmetry);

// The images of directions as one, up to rotations by 2 pi / symmetry.
class UpwardTurn {
 public:
  explicit UpwardTurn(int symmetry) : symmetry_(symmetry) {}
  void add(Complex image);

  // The turn that brings the images to v as nearly as possible in the sense of least squares; none where there are none
  // or they cancel.
  std::optional<Complex> turn() const;

 private:
  int symmetry_;
  Complex sum_ = 0;
  double weight_ = 0;
};

// The same for the images of all directions of a map.
std::optional<Complex> upward_turn(const TextureDirections& directions, const CornerPositions& position, int symmetry);

// The angle between an image and v, up to rotations by 2 pi / symmetry, radians; the mean of all where there are some.
double angle_to_v(Complex image, int symmetry);
double mean_angle_to_v(const TextureDirections& directions, const CornerPositions& position, int symmetry);

}  // namespace lsgp

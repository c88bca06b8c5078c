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

// How much borders turn in a layout in which directions, up to rotations by 2 pi / symmetry, are parallel: (loops)
// radians. None along a border without directions, or where they vary too much to tell.
Array<std::optional<double>> turning_beside(const HalfedgeMesh& mesh, const Positions& vectors, int symmetry);

// (n) vertices around which the same directions are nearly parallel, so that a cone there would bend the texture.
Array<char> runs_straight_around(const HalfedgeMesh& mesh, const Positions& vectors, int symmetry);

// Which turn of a layout brings the images of directions to v.
class UpwardTurn {
 public:
  // symmetry: of the lattice that the layout has to lie on.
  explicit UpwardTurn(int symmetry = 1) : symmetry_(symmetry) {}
  void add(Complex image);

  // As nearly as possible in the sense of least squares, or where many images run against others, to v or its opposite.
  // None without images, or where they cancel.
  std::optional<Complex> turn() const;
  // The same up to rotations by 2 pi / symmetry, and then the best of these, in multiples of that.
  std::optional<Complex> turn_to_lattice() const;
  int turns_on_lattice() const;

 private:
  bool remains(Complex sum) const;

  int symmetry_;
  Complex once_ = 0, twice_ = 0, by_symmetry_ = 0;  // sums of e^{i k angle} over the angles from v, by weight
  double weight_ = 0;
};
UpwardTurn upward_turn(const TextureDirections& directions, const CornerPositions& position, int symmetry);

// The angle between an image and v, up to rotations by 2 pi / symmetry, radians; the mean of all where there are some.
double angle_to_v(Complex image, int symmetry);
double mean_angle_to_v(const TextureDirections& directions, const CornerPositions& position, int symmetry);

// What is left of that mean when the layout is turned for it.
double misalignment_on_lattice(const TextureDirections& directions, const CornerPositions& position, int symmetry);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Turns triangles of a rounded layout the right way round again: the heights of needles are below the last digit, so
// that they collapse or flip when their corners are rounded one by one.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "base/array.hpp"
#include "cut/cut_mesh.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// As single precision stores it.
Complex as_stored(Complex z);

// Triangles of no area or a negative one, as stored or before: on some lattices not all copies can be stored exactly.
Array<Index> find_flipped(const CutMesh& cut_mesh, const Eigen::VectorXcd& position);

// A copy of a vertex, and its move for a move of the vertex's first copy by 1.
struct MovingCopy {
  Index copy;
  Complex turn;
};

class RoundingRepair {
 public:
  // copies: of a vertex, which move together; empty if it stays.
  // step: between the numbers that copies may have.
  // position: (copies) rounded.
  RoundingRepair(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, std::function<Array<MovingCopy>(Index)> copies,
                 double step, Eigen::VectorXcd& position);

  // Moves vertices of triangles that are flipped or have collapsed by a few steps, and if that is not enough those of
  // flat triangles beside them. Edges of `kept` halfedges that run along an axis still do. Returns the triangles left.
  Array<Index> repair(Array<Index> flipped, const PerHalfedge<char>& kept);

 private:
  // Of a vertex that may move.
  struct Corner {
    Index halfedge;
    Complex turn;
  };
  struct Star {
    Array<MovingCopy> copies;
    Array<Corner> corners;
  };

  Star star_of(Index v) const;
  double flatness(Complex a, Complex b, Complex c) const;
  double exact_flatness(Complex a, Complex b, Complex c) const;
  double flatness(Index f) const;
  double flatness(const Star& star, Complex move) const;
  bool keeps_axes(const Star& star, const PerHalfedge<char>& kept, Complex move) const;
  Array<Index> vertices_near(const Array<Index>& triangles, int rings) const;
  bool improve(Index v, const PerHalfedge<char>& kept);
  Array<Index> triangles_around(const Array<Index>& vertices) const;
  Array<Index> corners_of(const Array<Index>& triangles) const;

  const HalfedgeMesh& mesh_;
  const CutMesh& cut_mesh_;
  const std::function<Array<MovingCopy>(Index)> copies_;
  const double step_;
  const Array<Complex> moves_;
  Eigen::VectorXcd& position_;
};

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on distortion energies of a map, with every transition kept as it is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cut_mesh.hpp"
#include "energies/distortion_energy.hpp"
#include "geometry.hpp"
#include "transitions.hpp"

namespace lsgp {

// What may move: displacements of all copies as functions of a few unknowns, and the triangles that move.
struct Freedom {
  Reduction displacement;
  std::vector<Index> triangles;
};

// The vertices marked, (n); translations stay.  motion: (copies) as from motion_of_copies.
Freedom free_vertices(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const Eigen::VectorXcd& motion,
                      const std::vector<char>& marked);

// The vertices within some rings of triangles, those of the triangles themselves being the first ring; (n).
std::vector<char> mark_around(const HalfedgeMesh& mesh, const std::vector<Index>& triangles, int rings);

class Relaxation {
 public:
  // Rest shapes are the surface's triangles scaled by e^{log_scale}, (n).  position: (copies) u + iv, which is moved.
  Relaxation(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
             const Eigen::VectorXd& log_scale, Freedom freedom, Eigen::VectorXcd& position);

  // Newton steps on the foldover-free energy (Garanzha et al. 2021) until every moving triangle is upright.  Returns
  // whether that was reached.  Throws SOLVER_FAILED.
  bool unfold();

  // Newton steps on a barrier from a map without flips; none arises on the way.  At most `steps`, fewer where the
  // energy falls by less than a share of itself.  Throws SOLVER_FAILED.
  void smooth(RadialTerms (*barrier)(double), int steps, double least_share = 0);

 private:
  struct Shape {
    Complex g[3], h[3];
    Index copy[3];
    Index begin, end;  // of its slopes
    double weight;
  };

  // How f_z and f_zbar of a triangle change with one unknown.
  struct Slope {
    Index unknown;
    Complex f_z, f_zbar;
  };

  void add_slope(Index begin, const Slope& slope);

  struct Jacobian {
    Complex f_z, f_zbar;
    double determinant() const { return std::norm(f_z) - std::norm(f_zbar); }
  };
  Jacobian jacobian(const Shape& shape) const;
  Jacobian change(const Shape& shape, const Eigen::VectorXcd& direction) const;
  double smallest_determinant() const;

  template <typename Terms>
  double energy(const Terms& terms_at) const;
  template <typename Terms>
  Eigen::VectorXcd newton_direction(const Terms& terms_at) const;

  // Halves the step until the energy falls; leaves the positions as they were where it never does.
  template <typename Terms>
  bool search(const Terms& terms, const Eigen::VectorXcd& direction, double longest, double before, double& after);

  // The step along a direction at which the first triangle has no area any more.
  double collapse_step(const Eigen::VectorXcd& direction) const;

  const Reduction displacement_;
  Eigen::VectorXcd& position_;
  std::vector<Shape> shapes_;
  std::vector<Slope> slopes_;
};

}  // namespace lsgp

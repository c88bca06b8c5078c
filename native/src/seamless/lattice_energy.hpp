// SPDX-License-Identifier: GPL-3.0-or-later
// The displacement of least Dirichlet energy that brings a layout to given lattice points, and its cost.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/borrowed.hpp"
#include "cut/cut_mesh.hpp"
#include "seamless/lattice_transitions.hpp"

namespace lsgp {

class LatticeEnergy {
 public:
  virtual ~LatticeEnergy() = default;
  // The Schur complement of the Dirichlet form on the integers, (d, d), Hermitian: change^H schur change is the energy.
  const Eigen::MatrixXcd& schur() const { return schur_; }
  // The displacement of all copies, (copies), for a change of the integers, (d).
  virtual Eigen::VectorXcd displacement(const Eigen::VectorXcd& change) const = 0;

 protected:
  Eigen::MatrixXcd schur_;
};

// One complex factorization and a back-substitution for every integer.
std::unique_ptr<LatticeEnergy> sparse_lattice_energy(const CutSurface& surface,
                                                     Borrowed<const LatticeReduction> lattice);
// With an existing factor whose cuts include those of the cut mesh: only dense problems.
std::unique_ptr<LatticeEnergy> lattice_energy_on_cut(Borrowed<const HalfedgeMesh> mesh, const CutMesh& cut_mesh,
                                                     Borrowed<const CutFactor> factor, const LatticeReduction& lattice);

}  // namespace lsgp

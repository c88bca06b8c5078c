// SPDX-License-Identifier: GPL-3.0-or-later
// Distortion energies of a triangle, most of them as functions of p = |f_z|^2 and q = |f_zbar|^2:
//   h = (p + q) phi(d) + psi(d),  d = p - q the determinant of its Jacobian.
// In this form the positive part of the Hessian is explicit.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>

namespace lsgp {

// phi and psi with their first and second derivatives at one d.
struct RadialTerms {
  double phi, phi1, phi2, psi, psi1, psi2;
};

// Foldover-free energy (Garanzha et al. 2021) with weight 1 for the area term: 2 (p + q) / chi + (d^2 + 1) / chi, where
// chi = (d + sqrt(epsilon^2 + d^2)) / 2 stays positive for d < 0.
inline double foldover_chi(double d, double epsilon) {
  const double r = std::hypot(epsilon, d);
  return d < 0 ? epsilon * epsilon / (2 * (r - d)) : (d + r) / 2;
}

inline RadialTerms foldover_free(double d, double epsilon) {
  const double r = std::hypot(epsilon, d), chi = foldover_chi(d, epsilon);
  const double chi1 = chi / r, chi2 = epsilon * epsilon / (2 * r * r * r);
  const double inverse = 1 / chi, inverse1 = -chi1 / (chi * chi),
               inverse2 = 2 * chi1 * chi1 / (chi * chi * chi) - chi2 / (chi * chi);
  const double area = d * d + 1;
  return {2 * inverse,
          2 * inverse1,
          2 * inverse2,
          area * inverse,
          2 * d * inverse + area * inverse1,
          2 * inverse + 4 * d * inverse1 + area * inverse2};
}

// Conformal barrier (MIPS, Hormann and Greiner 2000): (p + q) / d, infinite at d = 0.
inline RadialTerms conformal_barrier(double d) { return {1 / d, -1 / (d * d), 2 / (d * d * d), 0, 0, 0}; }

// Symmetric Dirichlet energy, the squared norms of the Jacobian and of its inverse: (p + q) (2 + 2 / d^2).
inline RadialTerms symmetric_dirichlet(double d) {
  const double square = d * d;
  return {2 + 2 / square, -4 / (d * square), 12 / (square * square), 0, 0, 0};
}

// Gradient and positive semidefinite Hessian in (Re f_z, Im f_z, Re f_zbar, Im f_zbar).
struct EnergyExpansion {
  Eigen::Vector4d gradient;
  Eigen::Matrix4d hessian;
};

// One of the energies, as a function of f_z and f_zbar.
struct DistortionEnergy {
  enum class Kind {
    foldover_free,
    // |f_z - 1|^2 + q + 1 / chi(D), D = Re f_z - sqrt(q + delta^2): if D is positive, the triangle is upright and
    // rotated by less than 90 degrees against the frame in which f_z is given (Lipman 2012). Convex, so such a map is
    // found if it exists.
    framed_foldover_free,
    conformal_barrier,
    symmetric_dirichlet,
  };
  Kind kind;
  double epsilon = 0;  // of the foldover-free ones

  // The quantity that the foldover-free energies make positive.
  double determinant(std::complex<double> f_z, std::complex<double> f_zbar) const;
  double value(std::complex<double> f_z, std::complex<double> f_zbar) const;
  EnergyExpansion expand(std::complex<double> f_z, std::complex<double> f_zbar) const;
};

}  // namespace lsgp

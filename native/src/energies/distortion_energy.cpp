// SPDX-License-Identifier: GPL-3.0-or-later
#include "energies/distortion_energy.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace lsgp {

namespace {

RadialTerms terms_at(const DistortionEnergy& energy, double d) {
  using Kind = DistortionEnergy::Kind;
  switch (energy.kind) {
    case Kind::conformal_barrier: return conformal_barrier(d);
    case Kind::symmetric_dirichlet: return symmetric_dirichlet(d);
    default: return foldover_free(d, energy.epsilon);
  }
}

EnergyExpansion expand_radial(std::complex<double> f_z, std::complex<double> f_zbar, const RadialTerms& terms) {
  const double p = std::norm(f_z), q = std::norm(f_zbar), sum = p + q;
  const double slope = sum * terms.phi1 + terms.psi1, bend = sum * terms.phi2 + terms.psi2;
  const double h_p = terms.phi + slope, h_q = terms.phi - slope;
  const double h_pp = 2 * terms.phi1 + bend, h_qq = -2 * terms.phi1 + bend, h_pq = -bend;

  EnergyExpansion out;
  out.gradient << 2 * h_p * f_z.real(), 2 * h_p * f_z.imag(), 2 * h_q * f_zbar.real(), 2 * h_q * f_zbar.imag();

  // The Hessian is diagonal but for the plane of the two radial directions; its positive part eigenvalue by eigenvalue.
  const double root_p = std::sqrt(p), root_q = std::sqrt(q);
  const Eigen::Vector2d along_p = root_p > 0 ? Eigen::Vector2d(f_z.real(), f_z.imag()) / root_p : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d along_q =
      root_q > 0 ? Eigen::Vector2d(f_zbar.real(), f_zbar.imag()) / root_q : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d across_p(-along_p[1], along_p[0]), across_q(-along_q[1], along_q[0]);
  out.hessian.setZero();
  out.hessian.topLeftCorner<2, 2>() += std::max(0.0, 2 * h_p) * across_p * across_p.transpose();
  out.hessian.bottomRightCorner<2, 2>() += std::max(0.0, 2 * h_q) * across_q * across_q.transpose();
  const double a = 2 * h_p + 4 * p * h_pp, b = 4 * root_p * root_q * h_pq, c = 2 * h_q + 4 * q * h_qq;
  const double middle = (a + c) / 2, radius = std::hypot((a - c) / 2, b);
  const double turn = 0.5 * std::atan2(2 * b, a - c);
  for (const auto& [eigenvalue, angle] : {std::pair{middle + radius, turn}, {middle - radius, turn + M_PI / 2}}) {
    if (!(eigenvalue > 0)) continue;
    Eigen::Vector4d direction;
    direction << std::cos(angle) * along_p, std::sin(angle) * along_q;
    out.hessian += eigenvalue * direction * direction.transpose();
  }
  return out;
}

// With d a function of a = Re f_z and f_zbar the Hessian has no simple eigenvectors any more.
EnergyExpansion expand_framed(std::complex<double> f_z, std::complex<double> f_zbar, const RadialTerms& terms) {
  const double a = f_z.real(), sum = std::norm(f_z) + std::norm(f_zbar);
  const Eigen::Vector4d x(a, f_z.imag(), f_zbar.real(), f_zbar.imag());
  const Eigen::Vector4d sum_slope = 2 * x;
  const Eigen::Vector4d d_slope(2 * std::abs(a), 0, -2 * x[2], -2 * x[3]);
  const double slope = sum * terms.phi1 + terms.psi1, bend = sum * terms.phi2 + terms.psi2;
  EnergyExpansion out;
  out.gradient = terms.phi * sum_slope + slope * d_slope;
  Eigen::Matrix4d hessian = terms.phi1 * (sum_slope * d_slope.transpose() + d_slope * sum_slope.transpose()) +
                            bend * d_slope * d_slope.transpose();
  hessian.diagonal().array() += 2 * terms.phi;
  hessian.diagonal() += slope * Eigen::Vector4d(std::copysign(2.0, a), 0, -2, -2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(hessian);
  out.hessian = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
  return out;
}

}  // namespace

double DistortionEnergy::determinant(std::complex<double> f_z, std::complex<double> f_zbar) const {
  const double a = f_z.real();
  return (kind == Kind::framed_foldover_free ? a * std::abs(a) : std::norm(f_z)) - std::norm(f_zbar);
}

double DistortionEnergy::value(std::complex<double> f_z, std::complex<double> f_zbar) const {
  const RadialTerms terms = terms_at(*this, determinant(f_z, f_zbar));
  return (std::norm(f_z) + std::norm(f_zbar)) * terms.phi + terms.psi;
}

EnergyExpansion DistortionEnergy::expand(std::complex<double> f_z, std::complex<double> f_zbar) const {
  const RadialTerms terms = terms_at(*this, determinant(f_z, f_zbar));
  return kind == Kind::framed_foldover_free ? expand_framed(f_z, f_zbar, terms) : expand_radial(f_z, f_zbar, terms);
}

}  // namespace lsgp

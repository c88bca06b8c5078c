// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/distortion_energy.hpp"

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

constexpr double delta = 1e-3;  // rounds the tip of the cone off

EnergyExpansion expand_framed(std::complex<double> f_z, std::complex<double> f_zbar, double d, double epsilon) {
  const double s = std::sqrt(std::norm(f_zbar) + delta * delta), r = std::hypot(epsilon, d);
  // 1 / chi = 2 (r - d) / epsilon^2.
  const double slope = -1 / (foldover_chi(d, epsilon) * r), bend = 2 / (r * r * r);
  const Eigen::Vector2d along = Eigen::Vector2d(f_zbar.real(), f_zbar.imag()) / s;
  const Eigen::Vector4d d_slope(1, 0, -along[0], -along[1]);
  EnergyExpansion out;
  out.gradient << 2 * (f_z.real() - 1), 2 * f_z.imag(), 2 * f_zbar.real(), 2 * f_zbar.imag();
  out.gradient += slope * d_slope;
  out.hessian = bend * d_slope * d_slope.transpose();
  out.hessian.bottomRightCorner<2, 2>() -= slope / s * (Eigen::Matrix2d::Identity() - along * along.transpose());
  out.hessian.diagonal().array() += 2;
  return out;
}

}  // namespace

double DistortionEnergy::determinant(std::complex<double> f_z, std::complex<double> f_zbar) const {
  if (kind == Kind::framed_foldover_free) return f_z.real() - std::sqrt(std::norm(f_zbar) + delta * delta);
  return std::norm(f_z) - std::norm(f_zbar);
}

double DistortionEnergy::value(std::complex<double> f_z, std::complex<double> f_zbar) const {
  const double d = determinant(f_z, f_zbar);
  if (kind == Kind::framed_foldover_free) {
    return std::norm(f_z - 1.0) + std::norm(f_zbar) + 1 / foldover_chi(d, epsilon);
  }
  const RadialTerms terms = terms_at(*this, d);
  return (std::norm(f_z) + std::norm(f_zbar)) * terms.phi + terms.psi;
}

EnergyExpansion DistortionEnergy::expand(std::complex<double> f_z, std::complex<double> f_zbar) const {
  const double d = determinant(f_z, f_zbar);
  return kind == Kind::framed_foldover_free ? expand_framed(f_z, f_zbar, d, epsilon)
                                            : expand_radial(f_z, f_zbar, terms_at(*this, d));
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/unfold.hpp"

#include <cmath>
#include <utility>

#include "base/thread_team.hpp"
#include "solvers/eigenproblem.hpp"
#include "solvers/saddle_point.hpp"
#include "solvers/sparse_assembly.hpp"
#include "systems/quadratic_forms.hpp"
#include "systems/schur_complement.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

namespace {

// The edge's direction in the frame on its left minus that in the frame on its right, radians.
double turn_across(const HalfedgeMesh& mesh, const Geometry& geometry, Index h) {
  return edge_direction(geometry, h) - (edge_direction(geometry, mesh.twin[h]) + M_PI);
}

// The copies along the open boundary that contains the lowest-numbered boundary copy.
Array<Index> open_border(const HalfedgeMesh& mesh, const CutMesh& cut_mesh) {
  PerCopy<Index> next_copy(cut_mesh.copy_count(), none);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_open(mesh, cut_mesh, h)) next_copy[cut_mesh.copy_of_corner[h]] = cut_mesh.copy_of_corner[next(h)];
  }
  Array<Index> border;
  for (Index copy = 0; copy < cut_mesh.copy_count() && border.empty(); ++copy) {
    if (next_copy[copy] == none) continue;
    for (Index at = copy; border.empty() || at != copy; at = next_copy[at]) border.push_back(at);
  }
  return border;
}

// An eigenvector multiplied by any complex number of modulus 1 is another, and rounding would choose among them: here
// the position farthest from the origin is put on the positive u axis, the first of those that are equally far but for
// rounding.
Eigen::VectorXcd with_fixed_rotation(const Eigen::VectorXcd& position) {
  constexpr double nearly = 1 - 1e-6;
  const double farthest = position.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  while (std::abs(position[first]) < nearly * farthest) ++first;
  return position * std::polar(1.0, -std::arg(position[first]));
}

}  // namespace

FrameTree::FrameTree(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph)
    : triangle_count_(mesh.triangle_count()) {
  steps_.reserve(triangle_count_);
  Array<Index> across;  // (steps) the halfedge that each one crosses
  across.reserve(triangle_count_);
  PerTriangle<char> reached(triangle_count_, 0);
  const auto leave = [&](Index f) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index twin = mesh.twin[h];
      if (twin == none || cut_graph.is_cut[h] || reached[twin / 3]) continue;
      reached[twin / 3] = 1;
      steps_.push_back({f, twin / 3, mesh.origin(h), mesh.target(h), 0, 0});
      across.push_back(h);
    }
  };
  reached[0] = 1;
  leave(0);
  for (std::size_t i = 0; i < steps_.size(); ++i) leave(steps_[i].to);
  for_each_at_once(ssize(steps_), [&](std::ptrdiff_t i) {
    steps_[i].turn = turn_across(mesh, geometry, across[i]);
    steps_[i].weight = cotangent_weight(mesh, geometry, across[i]);
  });
}

Eigen::VectorXd FrameTree::integrate(const Eigen::VectorXd& log_scale) const {
  Eigen::VectorXd frames = Eigen::VectorXd::Zero(triangle_count_);
  for (const Step& step : steps_) {
    const double scale_change = log_scale[step.head] - log_scale[step.tail];
    frames[step.to] = frames[step.from] + step.turn - step.weight * scale_change;
  }
  return frames;
}

Eigen::VectorXd read_rotations(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                               const Eigen::VectorXd& log_scale, const Eigen::VectorXd& frames) {
  Eigen::VectorXd rotation(cut_graph.cuts.size());
  for (Eigen::Index p = 0; p < rotation.size(); ++p) {
    const Index h = cut_graph.cuts[p].halfedges.front();
    const double scale_change = log_scale[mesh.target(h)] - log_scale[mesh.origin(h)];
    const double step = turn_across(mesh, geometry, h) - cotangent_weight(mesh, geometry, h) * scale_change;
    rotation[p] = frames[mesh.twin[h] / 3] - frames[h / 3] - step;
  }
  return rotation;
}

// Differences across edges are weighted by the ratio of the edge's length to that of the path between centroids.
double HarmonicOneForm::weight(Index h) const {
  return geometry_.length[h] * geometry_.length[h] / (geometry_.area[h / 3] + geometry_.area[mesh_.twin[h] / 3]);
}

template <typename Visit>
void HarmonicOneForm::for_each_crossing(Visit visit) const {
  for (std::size_t p = 0; p < cut_graph_.cuts.size(); ++p) {
    for (const Index h : cut_graph_.cuts[p].halfedges) {
      visit(static_cast<Eigen::Index>(p), h / 3, mesh_.twin[h] / 3, weight(h));
    }
  }
}

HarmonicOneForm::HarmonicOneForm(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph)
    : mesh_(mesh), geometry_(geometry), cut_graph_(cut_graph) {
  LowerAssembly<double> assembly(mesh.triangle_count() - 1, 2 * static_cast<std::size_t>(mesh.halfedge_count()));
  const auto add = [&](Index row, Index column, double value) {
    if (row > 0 && column > 0) assembly.add(row - 1, column - 1, value);  // the first triangle stays
  };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] < h) continue;
    const Index f = h / 3, g = mesh.twin[h] / 3;
    add(f, f, weight(h));
    add(g, g, weight(h));
    if (f != g) add(f, g, -weight(h));
  }
  factor_.emplace(assembly.build());
}

Eigen::VectorXd HarmonicOneForm::spread(const Eigen::VectorXd& change) const {
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(mesh_.triangle_count());
  for_each_crossing([&](Eigen::Index cut, Index left, Index right, double weight) {
    pull[left] -= weight * change[cut];
    pull[right] += weight * change[cut];
  });
  Eigen::VectorXd out = Eigen::VectorXd::Zero(pull.size());
  out.tail(out.size() - 1) = factor_->solve(Eigen::VectorXd(pull.tail(pull.size() - 1)));
  return out;
}

Eigen::MatrixXd HarmonicOneForm::energy(const Eigen::MatrixXd& changes) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(changes.cols(), changes.cols());
  for (Eigen::Index k = 0; k < changes.cols(); ++k) {
    // The remainder of change minus spread is orthogonal to every spread.
    const Eigen::VectorXd turned = spread(changes.col(k));
    for_each_crossing([&](Eigen::Index cut, Index left, Index right, double weight) {
      out.col(k) += weight * (changes(cut, k) - turned[right] + turned[left]) * changes.row(cut).transpose();
    });
  }
  return out;
}

Jacobians prescribed_jacobians(const HalfedgeMesh& mesh, const Eigen::VectorXd& log_scale,
                               const Eigen::VectorXd& frames) {
  Jacobians out{Eigen::VectorXcd(frames.size()), Eigen::VectorXcd::Zero(frames.size())};
  const Eigen::VectorXd share = (log_scale / 3).array().exp();  // contribution of a corner to its triangle's scale
  for_each_at_once(mesh.triangle_count(), [&](Index f) {
    const double scale = share[mesh.triangles(f, 0)] * share[mesh.triangles(f, 1)] * share[mesh.triangles(f, 2)];
    out.f_z[f] = std::polar(scale, frames[f]);
  });
  return out;
}

RelativeFit::RelativeFit(const CutSurface& surface, Jacobians jacobians)
    : surface_(surface), jacobians_(std::move(jacobians)) {
  constexpr double widest_range = 1e8;  // of the weights, so that the form can be factored
  Eigen::VectorXd weight = jacobians_.f_z.cwiseAbs2().cwiseInverse();
  weight = weight.cwiseMin(widest_range * weight.minCoeff());
  weighted_ = with_weights(surface.geometry, weight);
  jacobians_.f_z = jacobians_.f_z.cwiseProduct(weight);
  jacobians_.f_zbar = jacobians_.f_zbar.cwiseProduct(weight);
}

Jacobians measure_jacobians(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
                            const Eigen::VectorXcd& position) {
  Jacobians out{Eigen::VectorXcd::Zero(mesh.triangle_count()), Eigen::VectorXcd::Zero(mesh.triangle_count())};
  for_each_at_once(mesh.triangle_count(), [&](Index f) {
    for (Index corner = 3 * f; corner < 3 * f + 3; ++corner) {
      const Complex edge = edge_vector(geometry, next(corner)) / (4 * geometry.area[f]);
      const Complex z = position[cut_mesh.copy_of_corner[corner]];
      out.f_z[f] += Complex(0, -1) * std::conj(edge) * z;
      out.f_zbar[f] += Complex(0, 1) * edge * z;
    }
  });
  return out;
}

double l2_stretch(const Geometry& geometry, const Jacobians& jacobians) {
  L2Stretch stretch;
  for (Eigen::Index f = 0; f < jacobians.f_z.size(); ++f) {
    const double p = std::norm(jacobians.f_z[f]), q = std::norm(jacobians.f_zbar[f]);
    stretch.add(geometry.area[f], geometry.area[f] * (p - q), (p + q) / ((p - q) * (p - q)));
  }
  return stretch.value();
}

Eigen::VectorXd metric_directions(const HalfedgeMesh& mesh, const Geometry& geometry, const Eigen::VectorXd& log_scale,
                                  const Eigen::VectorXd& frames, const Array<Index>& edges) {
  Eigen::VectorXd out(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index h = edges[i];
    const double bend = geometry.half_cotangent[h] * (log_scale[mesh.target(h)] - log_scale[mesh.origin(h)]);
    out[static_cast<Eigen::Index>(i)] = frames[h / 3] + edge_direction(geometry, h) - bend;
  }
  return out;
}

Eigen::VectorXcd unfold_aligned(const CutSurface& surface, const Reduction& reduction, const Jacobians& jacobians,
                                const Array<Index>& edges, const Eigen::VectorXd& directions) {
  const CutMesh& cut_mesh = surface.cut_mesh;
  const Eigen::SparseMatrix<Complex> form =
      assemble_form(Form::dirichlet, surface.mesh, surface.geometry, cut_mesh, reduction);
  const Eigen::VectorXcd pull = gather(reduction, pull_of(surface, jacobians));
  // Unknown k becomes its real part, 2k, and its imaginary part, 2k + 1.
  const int size = 2 * reduction.unknown_count;
  LowerAssembly<double> assembly(size, 4 * static_cast<std::size_t>(form.nonZeros()));
  for (int column = 0; column < form.cols(); ++column) {
    for (Eigen::SparseMatrix<Complex>::InnerIterator it(form, column); it; ++it) {
      const int row = static_cast<int>(it.row());
      assembly.add(2 * row, 2 * column, it.value().real());
      assembly.add(2 * row + 1, 2 * column + 1, it.value().real());
      if (row == column) continue;
      assembly.add(2 * row, 2 * column + 1, -it.value().imag());
      assembly.add(2 * row + 1, 2 * column, it.value().imag());
    }
  }
  Eigen::VectorXd right(size);
  for (Index k = 0; k < reduction.unknown_count; ++k) right.segment<2>(2 * k) << pull[k].real(), pull[k].imag();

  // Im(e^{-i psi} (z_to - z_from)) = 0, psi the direction of the edge.
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows(static_cast<Eigen::Index>(edges.size()), size);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index h = edges[i];
    const Complex across = std::polar(1.0, -directions[static_cast<Eigen::Index>(i)]);
    const auto add = [&](Index corner, Complex factor) {
      reduction.for_each_term(cut_mesh.copy_of_corner[corner], [&](const Term& term) {
        const Complex coefficient = factor * term.coefficient;
        entries.emplace_back(static_cast<int>(i), 2 * term.unknown, coefficient.imag());
        entries.emplace_back(static_cast<int>(i), 2 * term.unknown + 1, coefficient.real());
      });
    };
    add(next(h), across);
    add(h, -across);
  }
  rows.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solution =
      minimize_under<double>(assembly.build(), right, rows, Eigen::VectorXd::Zero(rows.rows()));
  Eigen::VectorXcd unknowns(reduction.unknown_count);
  for (Index k = 0; k < reduction.unknown_count; ++k) unknowns[k] = {solution[2 * k], solution[2 * k + 1]};
  return expand(reduction, unknowns);
}

// Off the cuts both forms are the same, so that the eigenvectors are harmonic there.
Eigen::VectorXcd unfold_spectral(const CutSurface& surface, const Reduction& reduction) {
  if (surface.factor != nullptr) {
    const SchurComplement condensation(surface.mesh, surface.cut_mesh, *surface.factor, reduction);
    const Eigen::MatrixXcd dirichlet = condensation.dirichlet_form();
    return with_fixed_rotation(
        condensation.extend(smallest_eigenvector(condensation.conformal_form(dirichlet), dirichlet)));
  }
  const auto form = [&](Form kind) {
    return assemble_form(kind, surface.mesh, surface.geometry, surface.cut_mesh, reduction);
  };
  return with_fixed_rotation(expand(reduction, smallest_eigenvector(form(Form::conformal), form(Form::dirichlet))));
}

Eigen::VectorXcd unfold_lscm(const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh) {
  const Array<Index> border = open_border(mesh, cut_mesh);
  const Index first = border.front(), second = border[border.size() / 2];
  const Reduction reduction = leave_free(cut_mesh, first);
  const auto conformal = assemble_form(Form::conformal, mesh, geometry, cut_mesh, reduction);
  const auto dirichlet = assemble_form(Form::dirichlet, mesh, geometry, cut_mesh, reduction);
  // With one pin at the origin, a load at the other gives the map with both pinned, up to scale and rotation.
  Eigen::VectorXcd pull = Eigen::VectorXcd::Zero(reduction.unknown_count);
  pull[reduction.terms[reduction.begin[second]].unknown] = 1;
  const Cholesky<Complex> factor(regularized(conformal, dirichlet));
  return expand(reduction, factor.solve(pull));
}

}  // namespace lsgp

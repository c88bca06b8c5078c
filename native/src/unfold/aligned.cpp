// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/aligned.hpp"

#include <cmath>
#include <vector>

#include "solvers/saddle_point.hpp"
#include "solvers/sparse_assembly.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

Eigen::VectorXcd unfold_aligned(const CutSurface& surface, const Reduction& reduction, const Jacobians& jacobians,
                                const Array<Index>& edges, const Eigen::VectorXd& directions) {
  const CutMesh& cut_mesh = surface.cut_mesh;
  const Eigen::SparseMatrix<Complex> form = assemble_form(Form::dirichlet, surface, cut_mesh, reduction);
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
      minimize_under<double>(assembly.build(), right, rows, Eigen::VectorXd::Zero(rows.rows())).x;
  Eigen::VectorXcd unknowns(reduction.unknown_count);
  for (Index k = 0; k < reduction.unknown_count; ++k) unknowns[k] = {solution[2 * k], solution[2 * k + 1]};
  return expand(reduction, unknowns);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "energies/quadratic_forms.hpp"

#include "solvers/sparse_assembly.hpp"

namespace lsgp {

namespace {

// Calls visit(from, to, value) for one halfedge of every edge of the cut mesh, value the entry (from, to) of the form,
// and visit(copy, copy, value) for the diagonal.
template <typename Visit>
void for_each_entry(Form form, const HalfedgeMesh& mesh, const Geometry& geometry, const CutMesh& cut_mesh,
                    Visit visit) {
  std::vector<double> diagonal(cut_mesh.copy_count(), 0.0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index from = cut_mesh.copy_of_corner[h], to = cut_mesh.copy_of_corner[next(h)], twin = mesh.twin[h];
    const double weight = geometry.half_cotangent[h];
    diagonal[from] += weight;
    diagonal[to] += weight;
    if (is_open(mesh, cut_mesh, h)) {
      // Twice the signed area is the sum of Im(conj(z_from) z_to) over the open edges alone: inside, twins cancel.
      visit(from, to, Complex(-weight, form == Form::conformal ? 0.5 : 0.0));
    } else if (h < twin) {
      visit(from, to, Complex(-weight - geometry.half_cotangent[twin], 0.0));
    }
  }
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) visit(copy, copy, Complex(diagonal[copy], 0.0));
}

}  // namespace

Eigen::SparseMatrix<Complex> assemble_form(Form form, const HalfedgeMesh& mesh, const Geometry& geometry,
                                           const CutMesh& cut_mesh, const Reduction& reduction) {
  LowerAssembly<Complex> assembly(reduction.unknown_count, 4 * static_cast<std::size_t>(cut_mesh.copy_count()));
  for_each_entry(form, mesh, geometry, cut_mesh, [&](Index from, Index to, Complex value) {
    reduction.for_each_term(from, [&](const Term& row) {
      reduction.for_each_term(to, [&](const Term& column) {
        const Complex entry = std::conj(row.coefficient) * value * column.coefficient;
        if (from == to) {  // a diagonal entry visits both (row, column) and (column, row)
          if (row.unknown >= column.unknown) assembly.add(row.unknown, column.unknown, entry);
        } else if (row.unknown == column.unknown) {
          assembly.add(row.unknown, column.unknown, 2 * entry.real());
        } else {
          assembly.add(row.unknown, column.unknown, entry);
        }
      });
    });
  });
  return assembly.build();
}

Geometry with_weights(const Geometry& geometry, const Eigen::VectorXd& weight) {
  Geometry out = geometry;
  for (Eigen::Index h = 0; h < out.half_cotangent.size(); ++h) out.half_cotangent[h] *= weight[h / 3];
  return out;
}

Laplacian assemble_laplacian(const HalfedgeMesh& mesh, const Geometry& geometry, const std::vector<char>& held) {
  const Index n = mesh.vertex_count();
  Laplacian laplacian;
  laplacian.row_of_vertex.assign(n, none);
  Index rows = 0;
  for (Index v = 0; v < n; ++v) {
    if (!held[v]) laplacian.row_of_vertex[v] = rows++;
  }
  LowerAssembly<double> assembly(rows, 4 * static_cast<std::size_t>(n));
  std::vector<double> diagonal(n, 0.0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index from = mesh.origin(h), to = mesh.target(h), twin = mesh.twin[h];
    diagonal[from] += geometry.half_cotangent[h];
    diagonal[to] += geometry.half_cotangent[h];
    const Index row = laplacian.row_of_vertex[from], column = laplacian.row_of_vertex[to];
    if ((twin == none || h < twin) && row != none && column != none) {
      assembly.add(row, column, -cotangent_weight(mesh, geometry, h));
    }
  }
  for (Index v = 0; v < n; ++v) {
    if (!held[v]) assembly.add(laplacian.row_of_vertex[v], laplacian.row_of_vertex[v], diagonal[v]);
  }
  laplacian.lower = assembly.build();
  return laplacian;
}

Eigen::VectorXd apply_laplacian(const HalfedgeMesh& mesh, const Geometry& geometry, const Eigen::VectorXd& values) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const double flow = geometry.half_cotangent[h] * (values[mesh.origin(h)] - values[mesh.target(h)]);
    out[mesh.origin(h)] += flow;
    out[mesh.target(h)] -= flow;
  }
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "systems/quadratic_forms.hpp"

#include <algorithm>
#include <numeric>

#include "base/checkpoint.hpp"
#include "solvers/sparse_assembly.hpp"

namespace lsgp {

namespace {

constexpr double operations_a_product = 20;  // of two terms

// Calls visit(from, to, value) for one halfedge of every edge of the cut mesh, value the entry (from, to) of the form,
// and visit(copy, copy, value) for the diagonal.
template <typename Visit>
void for_each_entry(Form form, const MetricMesh& surface, const CutMesh& cut_mesh, Visit visit) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  PerCopy<double> diagonal(cut_mesh.copy_count(), 0.0);
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

// The cotangent Laplacian, lower triangle, without lists of entries: a column is a handful of numbers.
// row_of_corner(corner): none where held; corners of both sides of an edge have the same rows unless it is open.
template <typename RowOfCorner>
Eigen::SparseMatrix<double> assemble_cotangents(const MetricMesh& surface, Index rows, RowOfCorner row_of_corner) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const auto for_each_edge = [&](auto visit) {
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index from = row_of_corner(h), to = row_of_corner(next(h)), twin = mesh.twin[h];
      double weight = geometry.half_cotangent[h];
      if (twin != none && row_of_corner(next(twin)) == from && row_of_corner(twin) == to) {
        if (twin < h) continue;
        weight += geometry.half_cotangent[twin];
      }
      visit(from, to, weight);
    }
  };
  Array<int> begin(rows + 1, 1);  // one for the diagonal
  begin[0] = 0;
  for_each_edge([&](Index from, Index to, double) {
    if (from != none && to != none) ++begin[std::min(from, to) + 1];
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  Eigen::SparseMatrix<double> lower(rows, rows);
  lower.resizeNonZeros(begin[rows]);
  int* inner = lower.innerIndexPtr();
  double* value = lower.valuePtr();
  for (Index row = 0; row < rows; ++row) {
    inner[begin[row]] = row;
    value[begin[row]] = 0;
  }
  Array<int> end(begin.begin(), begin.end() - 1);
  for (int& at : end) ++at;
  for_each_edge([&](Index from, Index to, double weight) {
    if (from != none) value[begin[from]] += weight;
    if (to != none) value[begin[to]] += weight;
    if (from == none || to == none) return;
    const Index column = std::min(from, to), row = std::max(from, to);
    int at = end[column];
    while (inner[at - 1] > row) --at;
    if (inner[at - 1] == row) {  // edges side by side between the same vertices
      value[at - 1] -= weight;
      return;
    }
    std::copy_backward(inner + at, inner + end[column], inner + end[column] + 1);
    std::copy_backward(value + at, value + end[column], value + end[column] + 1);
    ++end[column];
    inner[at] = row;
    value[at] = -weight;
  });
  int filled = 0;
  for (Index column = 0; column < rows; ++column) {
    lower.outerIndexPtr()[column] = filled;
    for (int at = begin[column]; at < end[column]; ++at, ++filled) {
      inner[filled] = inner[at];
      value[filled] = value[at];
    }
  }
  lower.outerIndexPtr()[rows] = filled;
  lower.resizeNonZeros(filled);
  return lower;
}

}  // namespace

Eigen::SparseMatrix<Complex> assemble_form(Form form, const MetricMesh& surface, const CutMesh& cut_mesh,
                                           const Reduction& reduction) {
  LowerAssembly<Complex> assembly(reduction.unknown_count, 4 * static_cast<std::size_t>(cut_mesh.copy_count()));
  const auto terms = [&](Index copy) { return static_cast<double>(reduction.begin[copy + 1] - reduction.begin[copy]); };
  for_each_entry(form, surface, cut_mesh, [&](Index from, Index to, Complex value) {
    checkpoint(operations_a_product * terms(from) * terms(to));
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

Laplacian assemble_laplacian(const MetricMesh& surface, const PerVertex<char>& held) {
  const HalfedgeMesh& mesh = surface.mesh;
  Laplacian laplacian;
  laplacian.row_of_vertex.assign(mesh.vertex_count(), none);
  Index rows = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!held[v]) laplacian.row_of_vertex[v] = rows++;
  }
  laplacian.lower =
      assemble_cotangents(surface, rows, [&](Index corner) { return laplacian.row_of_vertex[mesh.origin(corner)]; });
  return laplacian;
}

Eigen::SparseMatrix<double> assemble_dirichlet(const MetricMesh& surface, const CutMesh& cut_mesh,
                                               const PerCopy<Index>& row_of_copy) {
  return assemble_cotangents(surface, cut_mesh.copy_count(),
                             [&](Index corner) { return row_of_copy[cut_mesh.copy_of_corner[corner]]; });
}

Eigen::VectorXd apply_laplacian(const MetricMesh& surface, const Eigen::VectorXd& values) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const double flow = geometry.half_cotangent[h] * (values[mesh.origin(h)] - values[mesh.target(h)]);
    out[mesh.origin(h)] += flow;
    out[mesh.target(h)] -= flow;
  }
  return out;
}

}  // namespace lsgp

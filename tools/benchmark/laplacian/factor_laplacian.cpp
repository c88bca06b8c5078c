// SPDX-License-Identifier: GPL-3.0-or-later
// What no method that solves one Poisson problem can do without: the real cotangent Laplacian of a mesh, its last
// vertex held, analyzed, factored and solved with, by Eigen's SimplicialLDLT or by CHOLMOD, each with its own AMD
// ordering.
//
//     factor_laplacian MESH eigen|cholmod
//
// MESH: int32 vertex and triangle count, float64 positions, int32 triangles.  For every line "run" on the standard
// input it writes "RESULT {"seconds": S}", CPU seconds without the assembly of the matrix.

#include <Eigen/Dense>
#include <Eigen/Sparse>
#ifdef WITH_CHOLMOD
#include <cholmod.h>
#endif
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Laplacian = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

struct Mesh {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> positions;
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor> triangles;
};

Mesh read_mesh(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const auto read = [&](auto* to, Eigen::Index count) {
    file.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count * sizeof(*to)));
  };
  std::int32_t counts[2]{};
  read(counts, 2);
  Mesh mesh;
  mesh.positions.resize(counts[0], 3);
  mesh.triangles.resize(counts[1], 3);
  read(mesh.positions.data(), mesh.positions.size());
  read(mesh.triangles.data(), mesh.triangles.size());
  if (!file) throw std::runtime_error("the mesh cannot be read");
  return mesh;
}

// The lower triangle.
Laplacian build_laplacian(const Mesh& mesh) {
  const int held = static_cast<int>(mesh.positions.rows()) - 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = mesh.triangles(f, (corner + 1) % 3), b = mesh.triangles(f, (corner + 2) % 3);
      const Eigen::Vector3d apex = mesh.positions.row(mesh.triangles(f, corner));
      const Eigen::Vector3d to_a = mesh.positions.row(a).transpose() - apex,
                            to_b = mesh.positions.row(b).transpose() - apex;
      const double weight = to_a.dot(to_b) / to_a.cross(to_b).norm() / 2;
      if (a != held) entries.emplace_back(a, a, weight);
      if (b != held) entries.emplace_back(b, b, weight);
      if (a != held && b != held) entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
    }
  }
  Laplacian out(held, held);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

void solve_with_eigen(const Laplacian& laplacian, const Eigen::VectorXd& right) {
  const Eigen::SimplicialLDLT<Laplacian, Eigen::Lower> factor(laplacian);
  const Eigen::VectorXd solution = factor.solve(right);
  if (!solution.allFinite()) throw std::runtime_error("Eigen's solution is not finite");
}

#ifdef WITH_CHOLMOD
void solve_with_cholmod(const Laplacian& laplacian, const Eigen::VectorXd& right) {
  cholmod_common common;
  cholmod_start(&common);
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_AMD;
  common.postorder = 1;
  common.supernodal = CHOLMOD_AUTO;
  const std::size_t n = laplacian.rows();
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = n;
  matrix.nzmax = laplacian.nonZeros();
  matrix.p = const_cast<int*>(laplacian.outerIndexPtr());
  matrix.i = const_cast<int*>(laplacian.innerIndexPtr());
  matrix.x = const_cast<double*>(laplacian.valuePtr());
  matrix.stype = -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  cholmod_dense b{};
  b.nrow = b.nzmax = b.d = n;
  b.ncol = 1;
  b.x = const_cast<double*>(right.data());
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_factor* factor = cholmod_analyze(&matrix, &common);
  cholmod_factorize(&matrix, factor, &common);
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, &b, &common);
  const bool is_solved = common.status == CHOLMOD_OK;
  cholmod_free_dense(&solution, &common);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  if (!is_solved) throw std::runtime_error("CHOLMOD failed");
}
#endif

using Solve = void (*)(const Laplacian&, const Eigen::VectorXd&);

Solve solver(const std::string& name) {
  if (name == "eigen") return solve_with_eigen;
#ifdef WITH_CHOLMOD
  if (name == "cholmod") return solve_with_cholmod;
#endif
  throw std::runtime_error("built without " + name);
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count != 3) throw std::runtime_error("usage: factor_laplacian MESH eigen|cholmod");
    const Solve solve = solver(arguments[2]);
    const Laplacian laplacian = build_laplacian(read_mesh(arguments[1]));
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(laplacian.rows(), -1, 1);
    for (std::string line; std::getline(std::cin, line);) {
      const double begin = cpu_seconds();
      solve(laplacian, right);
      std::printf("RESULT {\"seconds\": %.9f}\n", cpu_seconds() - begin);
      std::fflush(stdout);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "factor_laplacian: %s\n", error.what());
    return 1;
  }
}

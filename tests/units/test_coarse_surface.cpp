// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/coarse_surface.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/border.hpp"
#include "prescription/log_scale.hpp"

namespace {

using namespace lsgp;

// A grid of squares with one diagonal each, over angles or a plane; the points of the last row and column may be those
// of the first.
Triangles grid_triangles(Index width, Index height, bool closed) {
  const Index across = closed ? width : width - 1, along = closed ? height : height - 1;
  Triangles out(2 * across * along, 3);
  Index f = 0;
  for (Index i = 0; i < across; ++i) {
    for (Index j = 0; j < along; ++j) {
      const Index a = i * height + j, b = (i + 1) % width * height + j;
      const Index c = (i + 1) % width * height + (j + 1) % height, d = i * height + (j + 1) % height;
      out.row(f++) << a, b, c;
      out.row(f++) << a, c, d;
    }
  }
  return out;
}

// Deterministic, -0.5 to 0.5.
double noise(Index i) { return std::fmod(std::abs(std::sin(12.9898 * i) * 43758.5453), 1.0) - 0.5; }

Surface bent_plane(Index side) {
  Surface out;
  out.triangles = grid_triangles(side, side, false);
  out.positions.resize(side * side, 3);
  for (Index i = 0; i < side; ++i) {
    for (Index j = 0; j < side; ++j) {
      const bool inside = i > 0 && j > 0 && i < side - 1 && j < side - 1;
      const Index v = i * side + j;
      out.positions.row(v) << i + 0.6 * inside * noise(v), j + 0.6 * inside * noise(-v), 0;
    }
  }
  return out;
}

Surface torus(Index around, Index along) {
  Surface out;
  out.triangles = grid_triangles(around, along, true);
  out.positions.resize(around * along, 3);
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < along; ++j) {
      const double a = 2 * M_PI * i / around, b = 2 * M_PI * j / along, radius = 3 + std::cos(b);
      out.positions.row(i * along + j) << radius * std::cos(a), radius * std::sin(a), std::sin(b);
    }
  }
  return out;
}

struct Built {
  explicit Built(const Surface& surface) {
    std::vector<Finding> findings;
    mesh = std::move(build_topology(surface, {}, findings).components.front().mesh);
    geometry = build_geometry(mesh);
  }
  HalfedgeMesh mesh;
  Geometry geometry;
};

}  // namespace

TEST_CASE("a coarse triangulation of a plane interpolates linear functions exactly") {
  const Built plane(bent_plane(40));
  const MetricMesh surface{plane.mesh, plane.geometry};
  PerVertex<char> kept(plane.mesh.vertex_count(), 0);
  const Index inner = 817;
  kept[inner] = 1;
  const CoarseSurface coarse(surface, kept, 300);
  CHECK(coarse.node_count() <= 300);
  CHECK(coarse.node(inner) != none);
  const Eigen::VectorXd x = plane.mesh.positions * Eigen::Vector3d(2, -1, 0);
  Eigen::VectorXd at_nodes(coarse.node_count());
  for (Index v = 0; v < plane.mesh.vertex_count(); ++v) {
    if (plane.mesh.loop_of_vertex[v] != none) CHECK(coarse.node(v) != none);
    if (coarse.node(v) != none) at_nodes[coarse.node(v)] = x[v];
  }
  CHECK((coarse.at_vertices(at_nodes) - x).cwiseAbs().maxCoeff() < 1e-9);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(x.size());
  CHECK(coarse.at_nodes(ones).sum() == doctest::Approx(static_cast<double>(x.size())));
  // Both are transposes of each other.
  CHECK(coarse.at_nodes(plane.geometry.vertex_area).dot(at_nodes) ==
        doctest::Approx(plane.geometry.vertex_area.dot(coarse.at_vertices(at_nodes))));
}

TEST_CASE("a coarse triangulation solves for the log scale of a surface") {
  const Built built(torus(120, 60));
  const MetricMesh surface{built.mesh, built.geometry};
  const Index n = built.mesh.vertex_count();
  const Index cones[2] = {1234, 5000};
  PerVertex<char> kept(n, 0);
  for (const Index v : cones) kept[v] = 1;
  const CoarseSurface coarse(surface, kept, 1500);
  CHECK(coarse.node_count() <= 1500);
  Eigen::VectorXd dipole = Eigen::VectorXd::Zero(n);
  dipole[cones[0]] = 1;
  dipole[cones[1]] = -1;
  const BorderConditions border = free_border(built.mesh, {});
  const LogScale exact(surface, border), model(coarse.surface(), coarse.at_nodes(border));
  const auto centerd = [&](Eigen::VectorXd y) -> Eigen::VectorXd {
    return y.array() - built.geometry.vertex_area.dot(y) / built.geometry.total_area;
  };
  const Eigen::VectorXd fine = centerd(exact.solve(dipole));
  const Eigen::VectorXd rough = centerd(coarse.at_vertices(model.solve(coarse.at_nodes(dipole))));
  const auto variance = [&](const Eigen::VectorXd& y) { return built.geometry.vertex_area.dot(y.cwiseAbs2()); };
  CHECK(variance(rough - fine) < 0.02 * 0.02 * variance(fine));
}

TEST_CASE("a coarse triangulation has the curvatures of a surface") {
  const Built built(torus(120, 60));
  const MetricMesh surface{built.mesh, built.geometry};
  const Array<Index> cones{1234, 5000, 3030, 6001};
  PerVertex<char> kept(built.mesh.vertex_count(), 0);
  for (const Index v : cones) kept[v] = 1;
  const CoarseSurface coarse(surface, kept, 1500);
  Array<Index> nodes;
  for (const Index v : cones) nodes.push_back(coarse.node(v));
  const BorderConditions border = free_border(built.mesh, {});
  const LogScale exact(surface, border, cones);
  LogScale model(coarse.surface(), coarse.at_nodes(border));
  model.set_cones(nodes);
  CHECK(model.required_sum() == doctest::Approx(exact.required_sum()));
  const Eigen::VectorXd kappa = model.harmonic_curvature();
  CHECK(std::abs(kappa.sum() - exact.required_sum()) < 1e-9);
  const Eigen::VectorXd at_nodes = model.evaluate(kappa);
  for (const Index node : nodes) CHECK(std::abs(at_nodes[node] - at_nodes[nodes.front()]) < 1e-9);
  const Eigen::VectorXd fine = exact.evaluate(kappa), rough = coarse.at_vertices(at_nodes);
  const auto variance = [&](const Eigen::VectorXd& y) { return built.geometry.vertex_area.dot(y.cwiseAbs2()); };
  CHECK(variance(rough - fine) < 0.02 * 0.02 * variance(fine));
}

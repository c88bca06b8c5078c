// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/angle_flow.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/checkpoint.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/surface.hpp"
#include "random_matrices.hpp"

namespace {

using namespace lsgp;

// A ball: an octahedron with its edges divided into so many parts. Its first six vertices have four triangles, all
// others six.
HalfedgeMesh ball(Index parts) {
  std::vector<Eigen::Vector3d> positions;
  const auto vertex_at = [&](const Eigen::Vector3d& place) {
    for (std::size_t v = 0; v < positions.size(); ++v) {
      if ((positions[v] - place).norm() < 1e-9) return static_cast<Index>(v);
    }
    positions.push_back(place);
    return static_cast<Index>(positions.size()) - 1;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) vertex_at(sign * Eigen::Vector3d::Unit(axis));
  }
  std::vector<Eigen::Vector3i> triangles;
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3d sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    const bool is_mirrored = sign.prod() < 0;
    const auto at = [&](Index i, Index j) {
      return vertex_at(sign.cwiseProduct(Eigen::Vector3d(parts - i - j, i, j) / parts));
    };
    const auto add = [&](Index a, Index b, Index c) {
      triangles.emplace_back(a, is_mirrored ? c : b, is_mirrored ? b : c);
    };
    for (Index i = 0; i < parts; ++i) {
      for (Index j = 0; i + j < parts; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < parts) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
    }
  }
  Surface out;
  out.positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  out.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t v = 0; v < positions.size(); ++v) out.positions.row(static_cast<Eigen::Index>(v)) = positions[v];
  for (std::size_t f = 0; f < triangles.size(); ++f) out.triangles.row(static_cast<Eigen::Index>(f)) = triangles[f];
  std::vector<Finding> findings;
  return std::move(build_topology(out, {}, findings).components.front().mesh);
}

// What it says, empty if the angles are possible, and how much work it was.
struct Answer {
  std::string told;
  std::vector<Index> at;
  int visits = 0;
};

// The first cones have these angles, the next ones any, all other vertices a whole turn.
Answer ask(const HalfedgeMesh& mesh, const std::vector<double>& angles, Index free, const Eigen::VectorXd& guess) {
  Eigen::VectorXd angle = Eigen::VectorXd::Constant(mesh.vertex_count(), 2 * M_PI);
  PerVertex<char> is_free(mesh.vertex_count(), 0);
  Array<Index> named;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    named.push_back(static_cast<Index>(i));
    angle[named.back()] = angles[i];
  }
  for (Index i = 0; i < free; ++i) is_free[static_cast<Index>(angles.size()) + i] = 1;
  Answer out;
  const CheckpointVisitor visitor([&] { ++out.visits; });
  try {
    require_possible_angles(mesh, angle, is_free, guess, named);
  } catch (const Error& error) {
    out.told = error.what();
    const auto& elements = error.elements().indices;
    out.at.assign(elements.begin(), elements.end());
  }
  return out;
}

}  // namespace

TEST_CASE("the guess does not matter to the answer") {
  Random random(1);
  const HalfedgeMesh mesh = ball(4);
  const double right = M_PI * 4 / 3;  // of the cones, where all triangles are equilateral
  const std::vector<std::vector<double>> asked{
      {},                                                            // possible
      {M_PI, M_PI},                                                  // possible
      {right, right, right, right, right, right},                    // possible, no vertex is free
      {4.5 * M_PI},                                                  // too much for four triangles
      {3 * M_PI, M_PI, M_PI, M_PI, M_PI, M_PI},                      // possible
      {6 * M_PI, M_PI / 2, M_PI / 2, M_PI / 4, M_PI / 4, M_PI / 2},  // too much at one
  };
  int refused = 0;
  for (const std::vector<double>& angles : asked) {
    const Index free = 6 - static_cast<Index>(angles.size());
    const Answer expected = ask(mesh, angles, free, Eigen::VectorXd::Zero(mesh.halfedge_count()));
    refused += !expected.told.empty();
    for (int round = 0; round < 20; ++round) {
      Eigen::VectorXd guess(mesh.halfedge_count());
      for (double& corner : guess) corner = below(random, 4000) / 1000.0 - 1;
      const Answer found = ask(mesh, angles, free, guess);
      CHECK(found.told == expected.told);
      CHECK(found.at == expected.at);
    }
  }
  CHECK(refused == 2);
}

TEST_CASE("angles that are right but for rounding need no search") {
  const HalfedgeMesh mesh = ball(40);
  const Eigen::VectorXd guess = Eigen::VectorXd::Constant(mesh.halfedge_count(), M_PI / 3);
  const Answer good = ask(mesh, {}, 6, guess), none_given = ask(mesh, {}, 6, 0 * guess);
  CHECK(good.told.empty());
  CHECK(none_given.told.empty());
  CHECK(good.visits == 0);
  CHECK(none_given.visits > 0);
}

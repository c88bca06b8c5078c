// SPDX-License-Identifier: GPL-3.0-or-later
#include "balls.hpp"

#include <cmath>
#include <vector>

namespace lsgp {

Surface uneven_ball(Index triangles) {
  const auto rows = static_cast<Index>(std::sqrt(triangles / 4.0)), around = 2 * rows;
  Surface out;
  out.positions.resize(around * (rows - 1) + 2, 3);
  const auto place = [&](Index v, double latitude, double longitude) {
    const double z = std::sin(latitude), x = std::cos(latitude) * std::cos(longitude),
                 y = std::cos(latitude) * std::sin(longitude);
    const double radius = 1 + 0.2 * std::sin(2.3 * x + 1) * std::cos(1.7 * y) + 0.1 * std::sin(3.1 * z + y);
    out.positions.row(v) << radius * x, radius * y, radius * z;
  };
  for (Index i = 0; i < rows - 1; ++i) {
    for (Index j = 0; j < around; ++j) {
      place(around * i + j, M_PI * (i + 1) / rows - M_PI / 2, 2 * M_PI * j / around);
    }
  }
  const Index south = around * (rows - 1), north = south + 1;
  place(south, -M_PI / 2, 0);
  place(north, M_PI / 2, 0);
  std::vector<Index> corners;
  for (Index j = 0; j < around; ++j) {
    const Index next = (j + 1) % around, last = around * (rows - 2);
    corners.insert(corners.end(), {south, next, j, north, last + j, last + next});
    for (Index i = 0; i + 2 < rows; ++i) {
      const Index a = around * i + j, b = around * i + next, c = b + around, d = a + around;
      corners.insert(corners.end(), {a, b, c, a, c, d});
    }
  }
  out.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Index>(corners.size()) / 3, 3);
  return out;
}

Surface merged(const Surface& one, const Surface& other) {
  Surface out;
  out.positions.resize(one.positions.rows() + other.positions.rows(), 3);
  out.positions << one.positions, other.positions;
  out.triangles.resize(one.triangles.rows() + other.triangles.rows(), 3);
  out.triangles << one.triangles, other.triangles.array() + static_cast<Index>(one.positions.rows());
  return out;
}

}  // namespace lsgp

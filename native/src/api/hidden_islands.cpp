// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/errors.hpp"
#include "lsgp/packing.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "plane/aabb_tree.hpp"

namespace lsgp {

namespace {

// About 25 degrees apart. Islands that are seen only between two of them are taken for hidden.
constexpr int direction_count = 64;

// Uniform on the sphere (Fibonacci's spiral); one after the other they go far apart.
Eigen::Vector3d direction(int number) {
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  constexpr int stride = 27;  // without a divisor in common with their number
  const int i = stride * number % direction_count;
  const double height = 1 - (2 * i + 1) / static_cast<double>(direction_count), radius = std::sqrt(1 - height * height);
  return {radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i), height};
}

// The surface along one direction: whether its triangles hide points from a viewer at infinity there.
class View {
 public:
  View(const Positions& positions, const Triangles& triangles, const Eigen::Vector3d& toward)
      : triangles_(triangles), axes_(axes_along(toward)), seen_(positions * axes_), tree_(boxes_of(triangles, seen_)) {}

  bool is_hidden(const Eigen::RowVector3d& point) const {
    const Eigen::RowVector3d at = point * axes_;
    return tree_.any_meeting({at[0], at[0], at[1], at[1]}, [&](Index f) { return hides(f, at); });
  }

 private:
  static Eigen::Matrix3d axes_along(const Eigen::Vector3d& toward) {
    Eigen::Matrix3d out;
    const Eigen::Vector3d right = toward.unitOrthogonal();
    out << right, toward.cross(right), toward;
    return out;
  }

  static Array<Box> boxes_of(const Triangles& triangles, const Positions& seen) {
    Array<Box> out;
    for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
      const auto at = [&](Index k) { return seen.row(triangles(f, k)); };
      const Eigen::RowVector3d low = at(0).cwiseMin(at(1)).cwiseMin(at(2)),
                               high = at(0).cwiseMax(at(1)).cwiseMax(at(2));
      out.push_back({low[0], high[0], low[1], high[1]});
    }
    return out;
  }

  bool hides(Index f, const Eigen::RowVector3d& at) const {
    constexpr double rounding = 1e-9;  // of its sides, so that no ray leaves between two triangles
    constexpr double nearer = 1e-6;    // of the extent, so that no triangle hides itself and its doubles
    const Eigen::RowVector3d a = seen_.row(triangles_(f, 0)), ab = seen_.row(triangles_(f, 1)) - a,
                             ac = seen_.row(triangles_(f, 2)) - a;
    const double doubled_area = ab[0] * ac[1] - ab[1] * ac[0];
    if (doubled_area == 0) return false;
    const double x = at[0] - a[0], y = at[1] - a[1];
    const double s = (x * ac[1] - y * ac[0]) / doubled_area, t = (ab[0] * y - ab[1] * x) / doubled_area;
    return s >= -rounding && t >= -rounding && s + t <= 1 + rounding && a[2] + s * ab[2] + t * ac[2] > at[2] + nearer;
  }

  const Triangles& triangles_;
  const Eigen::Matrix3d axes_;
  const Positions seen_;
  const AabbTree tree_;
};

// Positions with the triangles in a box around the origin whose diameter is 1.
Positions of_unit_size(const Surface& surface) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(infinity), high = -low;
  for (const Index v : surface.triangles.reshaped()) {
    low = low.cwiseMin(surface.positions.row(v));
    high = high.cwiseMax(surface.positions.row(v));
  }
  const double diameter = (high - low).norm();
  return (surface.positions.rowwise() - (low + high) / 2) / (diameter > 0 ? diameter : 1);
}

// Middles of the equal parts of each triangle: one, or more of those that are a larger part of the surface.
struct Samples {
  Samples(const Positions& positions, const Triangles& triangles, const std::vector<Index>& island, Index island_count)
      : of_island(island_count) {
    // On the whole surface, besides the one of each triangle: about as close as a texture of 64 texels.
    constexpr double wanted = 4000;
    constexpr double most_rows = 16;  // of a triangle, so that few large ones do not take all
    Array<double> areas;
    double all = 0;
    for (Index f = 0; f < triangles.rows(); ++f) {
      areas.push_back(area_normal(positions, triangles, f).norm());
      all += areas.back();
    }
    for (Index f = 0; f < triangles.rows(); ++f) {
      if (element(island, f) < 0) continue;
      const double share = all > 0 ? areas[f] / all : 0;
      const int rows = static_cast<int>(std::clamp(std::ceil(std::sqrt(wanted * share)), 1.0, most_rows));
      const auto point = [&](double s, double t) {
        const Eigen::RowVector3d at = (1 - s - t) * positions.row(triangles(f, 0)) +
                                      s * positions.row(triangles(f, 1)) + t * positions.row(triangles(f, 2));
        of_island[element(island, f)].push_back(at);
      };
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < rows - i; ++j) {
          point((i + 1 / 3.0) / rows, (j + 1 / 3.0) / rows);
          if (i + j + 1 < rows) point((i + 2 / 3.0) / rows, (j + 2 / 3.0) / rows);
        }
      }
    }
  }

  Array<Array<Eigen::RowVector3d>> of_island;
};

Index number_of_islands(const Surface& surface, const std::vector<Index>& island) {
  const Eigen::Index count = surface.triangles.rows();
  if (ssize(island) != count) {
    throw Error(Code::wrong_parameter, concat("There are ", island.size(),
                                              " numbers of islands; pass one for each of the ", count, " triangles."));
  }
  require_numbers(island, "an island");
  return island.empty() ? 0 : *std::max_element(island.begin(), island.end()) + 1;
}

}  // namespace

std::vector<Index> hidden_islands(const Surface& surface, const std::vector<Index>& island,
                                  const Progress& progress) try {
  constexpr double operations_a_point = 200;  // the way down a tree, and some triangles
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface);
  const Index count = number_of_islands(surface, island);
  if (count == 0) return {};
  const Positions positions = of_unit_size(surface);
  const Samples samples(positions, surface.triangles, island, count);
  std::vector<Index> out;
  for (Index i = 0; i < count; ++i) {
    if (!samples.of_island[i].empty()) out.push_back(i);
  }
  for (int number = 0; number < direction_count; ++number) {
    const View view(positions, surface.triangles, direction(number));
    const auto is_seen = [&](Index i) {
      return std::any_of(samples.of_island[i].begin(), samples.of_island[i].end(), [&](const auto& point) {
        checkpoint(operations_a_point);
        return !view.is_hidden(point);
      });
    };
    out.erase(std::remove_if(out.begin(), out.end(), is_seen), out.end());
    if (out.empty()) break;
    monitor.advance((number + 1.0) / direction_count);
  }
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest points in space.
#pragma once

#include <Eigen/Core>

#include "base/array.hpp"
#include "base/borrowed.hpp"
#include "lsgp/surface.hpp"

namespace lsgp {

// A k-d tree over points, halved by count.
class PointTree {
 public:
  // points: (n, 3), finite.
  explicit PointTree(Borrowed<const Positions> points);

  // The nearest point, of several the one with the least index, and its distance; -1 where there is none or `at` is not
  // finite.
  struct Nearest {
    Index point = -1;
    double distance = 0;
  };
  Nearest nearest(const Eigen::RowVector3d& at) const;
  // The same, sooner if this point is near.
  Nearest nearest(const Eigen::RowVector3d& at, Index guess) const;

 private:
  static constexpr Index leaf = 8;  // points

  // The axis along which the points order_[begin, end) are halved.
  int widest_axis(Index begin, Index end) const;
  void build(Index begin, Index end);
  // best: with the square of its distance.
  void search(const Eigen::RowVector3d& at, Index begin, Index end, Nearest& best) const;

  const Positions& points_;
  Array<Index> order_;
  Positions in_order_;
  Array<unsigned char> axis_;  // by the middle of a range
};

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace lsgp {

PointTree::PointTree(Borrowed<const Positions> points)
    : points_(points), order_(points_.rows()), axis_(points_.rows(), static_cast<unsigned char>(0)) {
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<Index>(order_.size()));
  in_order_.resize(points_.rows(), 3);
  for (std::size_t i = 0; i < order_.size(); ++i) in_order_.row(static_cast<Eigen::Index>(i)) = points_.row(order_[i]);
}

int PointTree::widest_axis(Index begin, Index end) const {
  Eigen::RowVector3d low = points_.row(order_[begin]), high = low;
  for (Index i = begin; i < end; ++i) {
    low = low.cwiseMin(points_.row(order_[i]));
    high = high.cwiseMax(points_.row(order_[i]));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

void PointTree::build(Index begin, Index end) {
  if (end - begin <= leaf) return;
  const int axis = widest_axis(begin, end);
  const Index middle = begin + (end - begin) / 2;
  const auto by_axis = [&](Index a, Index b) {
    return std::pair(points_(a, axis), a) < std::pair(points_(b, axis), b);
  };
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, by_axis);
  axis_[middle] = static_cast<unsigned char>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

void PointTree::search(const Eigen::RowVector3d& at, Index begin, Index end, Nearest& best) const {
  const auto visit = [&](Index i) {
    const double distance = (in_order_.row(i) - at).squaredNorm();
    if (distance < best.distance || (distance == best.distance && order_[i] < best.point)) best = {order_[i], distance};
  };
  if (end - begin <= leaf) {
    for (Index i = begin; i < end; ++i) visit(i);
    return;
  }
  const Index middle = begin + (end - begin) / 2;
  const int axis = axis_[middle];
  const double past = at[axis] - in_order_(middle, axis);
  visit(middle);
  if (past < 0) {
    search(at, begin, middle, best);
    if (past * past <= best.distance) search(at, middle + 1, end, best);
  } else {
    search(at, middle + 1, end, best);
    if (past * past <= best.distance) search(at, begin, middle, best);
  }
}

PointTree::Nearest PointTree::nearest(const Eigen::RowVector3d& at, Index guess) const {
  if (order_.empty() || !at.allFinite()) return {};
  Nearest best{guess, (points_.row(guess) - at).squaredNorm()};
  search(at, 0, static_cast<Index>(order_.size()), best);
  best.distance = std::sqrt(best.distance);
  return best;
}

PointTree::Nearest PointTree::nearest(const Eigen::RowVector3d& at) const {
  return order_.empty() ? Nearest{} : nearest(at, order_[order_.size() / 2]);
}

}  // namespace lsgp

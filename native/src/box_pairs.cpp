// SPDX-License-Identifier: GPL-3.0-or-later
#include "box_pairs.hpp"

namespace lsgp {

namespace {

constexpr Index leaf_size = 4;

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) {
  const Index count = static_cast<Index>(boxes.size());
  if (count == 0) return;
  std::vector<Center> centers(count);
  for (Index i = 0; i < count; ++i) {
    centers[i] = {(boxes[i].left + boxes[i].right) / 2, (boxes[i].bottom + boxes[i].top) / 2, i};
  }
  item_.resize(count);
  box_.resize(count);
  nodes_.reserve(2 * static_cast<std::size_t>(count) / (leaf_size / 2));
  build(centers.data(), 0, count, boxes);
}

Index BoxTree::build(Center* centers, Index begin, Index end, const std::vector<Box>& boxes) {
  const Index node = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, begin, end, -1});
  if (end - begin <= leaf_size) {
    Box box = boxes[centers[begin].item];
    for (Index i = begin; i < end; ++i) {
      item_[i] = centers[i].item;
      box_[i] = boxes[item_[i]];
      box = around(box, box_[i]);
    }
    nodes_[node].box = box;
    return node;
  }
  Box span{centers[begin].x, centers[begin].x, centers[begin].y, centers[begin].y};
  for (Index i = begin + 1; i < end; ++i) {
    span = around(span, {centers[i].x, centers[i].x, centers[i].y, centers[i].y});
  }
  const bool wide = span.right - span.left >= span.top - span.bottom;
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(centers + begin, centers + middle, centers + end, [wide](const Center& a, const Center& b) {
    const double p = wide ? a.x : a.y, q = wide ? b.x : b.y;
    return p != q ? p < q : a.item < b.item;
  });
  build(centers, begin, middle, boxes);
  const Index right = build(centers, middle, end, boxes);
  nodes_[node].right = right;
  nodes_[node].box = around(nodes_[node + 1].box, nodes_[right].box);
  return node;
}

}  // namespace lsgp

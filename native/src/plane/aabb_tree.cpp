// SPDX-License-Identifier: GPL-3.0-or-later
#include "plane/aabb_tree.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace lsgp {

namespace {

constexpr Index leaf_size = 8;

struct Place {
  std::uint64_t along;  // the curve
  Index item;
};

// The bits of a number, with a gap after each.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 16) & 0x0000ffff0000ffff;
  bits = (bits | bits << 8) & 0x00ff00ff00ff00ff;
  bits = (bits | bits << 4) & 0x0f0f0f0f0f0f0f0f;
  bits = (bits | bits << 2) & 0x3333333333333333;
  return (bits | bits << 1) & 0x5555555555555555;
}

// Stable, byte by byte.
void sort_along(Array<Place>& places) {
  Array<Place> sorted(places.size());
  for (int shift = 0; shift < 64; shift += 8) {
    std::array<Index, 257> begin{};
    for (const Place& place : places) ++begin[(place.along >> shift & 0xff) + 1];
    for (std::size_t byte = 0; byte < 256; ++byte) begin[byte + 1] += begin[byte];
    for (const Place& place : places) sorted[begin[place.along >> shift & 0xff]++] = place;
    places.swap(sorted);
  }
}

}  // namespace

AabbTree::AabbTree(const Array<Box>& boxes) {
  if (boxes.empty()) return;
  Box all = boxes.front();
  for (const Box& box : boxes) all = around(all, box);
  const auto steps = [](double value, double low, double high) {
    constexpr double most = 4294967295.0;
    const double span = high / 2 - low / 2;             // which is finite, whatever they are
    const double share = (value / 2 - low / 2) / span;  // no number for boxes around nothing
    return span > 0 && share > 0 ? static_cast<std::uint64_t>(std::min(share, 1.0) * most) : 0;
  };
  Array<Place> places(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box& box = boxes[i];
    const std::uint64_t column = steps(box.left / 2 + box.right / 2, all.left, all.right),
                        row = steps(box.bottom / 2 + box.top / 2, all.bottom, all.top);
    places[i] = {spread(column) | spread(row) << 1, static_cast<Index>(i)};
  }
  sort_along(places);
  for (const Place& place : places) {
    item_.push_back(place.item);
    box_.push_back(boxes[place.item]);
  }
  nodes_.reserve(2 * boxes.size() / (leaf_size / 2));
  build(0, static_cast<Index>(boxes.size()));
}

Index AabbTree::build(Index begin, Index end) {
  const Index node = static_cast<Index>(nodes_.size());
  nodes_.push_back({box_[begin], begin, end, -1});
  if (end - begin <= leaf_size) {
    for (Index i = begin + 1; i < end; ++i) nodes_[node].box = around(nodes_[node].box, box_[i]);
    return node;
  }
  const Index middle = begin + (end - begin) / 2;
  build(begin, middle);
  const Index right = build(middle, end);
  nodes_[node].right = right;
  nodes_[node].box = around(nodes_[node + 1].box, nodes_[right].box);
  return node;
}

}  // namespace lsgp

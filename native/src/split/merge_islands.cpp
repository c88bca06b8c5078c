// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/merge_islands.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "plane/overlaps.hpp"
#include "split/part_borders.hpp"

namespace lsgp {

namespace {

constexpr double operations_a_triangle = 200;  // of the overlap test
constexpr double narrowest_joint = 0.25;       // of the square root of the smaller part's area

class IslandMerger {
 public:
  IslandMerger(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts);

  void merge() {
    while (merge_next()) continue;  // each step merges two groups
  }

 private:
  struct Border : PartBorder {
    Array<Index> tried;  // the two groups and their states when they could not be merged
  };

  bool merge_next();
  bool try_to_merge(const Border& border);
  // Two groups that could not be merged cannot be merged before one of them has grown.
  Array<Index> state_of(const Border& border) const {
    const Index left = group_[border.left], right = group_[border.right];
    return {left, merges_[left], right, merges_[right]};
  }
  Motion to_meet(const Border& border) const {
    return motion_[border.right] * border.across * motion_[border.left].inverse();
  }
  bool overlaps(Index left, Index right, const Motion& motion, const Array<Index>& closed);

  const HalfedgeMesh& mesh_;
  const PerTriangle<Index>& part_;
  PerHalfedge<char>& open_;
  Eigen::VectorXcd corners_;
  double size_;
  Array<Border> borders_;
  PerPart<Motion>& motion_;
  PerPart<Index> group_;             // merged ones share one
  PerPart<Array<Index>> triangles_;  // of groups
  PerPart<double> area_;             // of groups
  PerPart<Index> merges_;            // number of groups merged into each

  // Scratch memory with these values between calls.
  PerHalfedge<char> is_closed_;  // 0
  PerTriangle<Index> place_;     // none
};

IslandMerger::IslandMerger(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept,
                           MapParts& parts)
    : mesh_(surface.mesh),
      part_(parts.part),
      open_(parts.open),
      corners_(at_corners(map.cut_mesh, map.position)),
      motion_(parts.motion),
      is_closed_(surface.mesh.halfedge_count(), 0),
      place_(surface.mesh.triangle_count(), none) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const PerTriangle<Index>& part = parts.part;
  const Index part_count = 1 + *std::max_element(part.begin(), part.end());
  motion_.assign(part_count, {});
  group_.resize(part_count);
  std::iota(group_.begin(), group_.end(), 0);
  triangles_.resize(part_count);
  area_.assign(part_count, 0);
  merges_.assign(part_count, 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    triangles_[part[f]].push_back(f);
    area_[part[f]] += geometry.area[f];
  }
  size_ = size_of(corners_);
  for (PartBorder& border : find_part_borders(surface, map, kept, parts)) {
    borders_.push_back({std::move(border), {}});
  }
}

bool IslandMerger::merge_next() {
  for (Border& border : borders_) {
    if (group_[border.left] == group_[border.right]) continue;
    Array<Index> state = state_of(border);
    if (border.tried == state) continue;
    if (try_to_merge(border)) return true;
    border.tried = std::move(state);
  }
  return false;
}

bool IslandMerger::try_to_merge(const Border& border) {
  const Index left = group_[border.left], right = group_[border.right];
  const Motion motion = to_meet(border);
  // Other edges that then coincide are closed as well.
  Array<Index> closed;
  double length = 0;
  for (const Border& other : borders_) {
    const bool runs_along = group_[other.left] == left && group_[other.right] == right;
    if (!runs_along && !(group_[other.left] == right && group_[other.right] == left)) continue;
    const Motion rest = runs_along ? motion.inverse() * to_meet(other) : motion * to_meet(other);
    if (!is_rest(rest, size_)) continue;
    for (const Index h : other.halfedges) closed.insert(closed.end(), {h, mesh_.twin[h]});
    length += other.length;
  }
  if (length < narrowest_joint * std::sqrt(std::min(area_[left], area_[right]))) return false;
  if (overlaps(left, right, motion, closed)) return false;
  for (const Index h : closed) open_[h] = 0;
  for (std::size_t p = 0; p < group_.size(); ++p) {
    if (group_[p] != left) continue;
    group_[p] = right;
    motion_[p] = motion * motion_[p];
  }
  triangles_[right].insert(triangles_[right].end(), triangles_[left].begin(), triangles_[left].end());
  triangles_[left].clear();
  area_[right] += area_[left];
  ++merges_[right];
  return true;
}

// closed: halfedges that are open now.
bool IslandMerger::overlaps(Index left, Index right, const Motion& motion, const Array<Index>& closed) {
  Array<Index> triangles = triangles_[right];
  triangles.insert(triangles.end(), triangles_[left].begin(), triangles_[left].end());
  for (std::size_t i = 0; i < triangles.size(); ++i) place_[triangles[i]] = static_cast<Index>(i);
  for (const Index h : closed) is_closed_[h] = 1;
  Eigen::VectorXcd position(3 * ssize(triangles));
  PerHalfedge<Index> twin(3 * triangles.size(), none);
  Index part = none;
  Motion moved;
  Complex turn = 1;
  for (Index i = 0; i < ssize(triangles); ++i) {
    const Index f = triangles[i];
    if (part_[f] != part) {
      part = part_[f];
      moved = group_[part] == left ? motion * motion_[part] : motion_[part];
      turn = std::polar(1.0, moved.angle);
    }
    for (Index c = 0; c < 3; ++c) {
      const Index h = 3 * f + c, other = mesh_.twin[h];
      position[3 * i + c] = turn * corners_[h] + moved.shift;
      if (other == none || place_[other / 3] == none || (open_[h] && !is_closed_[h])) continue;
      twin[3 * i + c] = 3 * place_[other / 3] + other % 3;
    }
  }
  for (const Index f : triangles) place_[f] = none;
  for (const Index h : closed) is_closed_[h] = 0;
  checkpoint(operations_a_triangle * static_cast<double>(triangles.size()));
  return has_overlap(position, twin);
}

}  // namespace

void merge_islands(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts) {
  IslandMerger(surface, map, kept, parts).merge();
}

}  // namespace lsgp

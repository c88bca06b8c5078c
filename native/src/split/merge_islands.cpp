// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/merge_islands.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "division/part_borders.hpp"
#include "plane/boundary_polygon.hpp"

namespace lsgp {

namespace {

constexpr double operations_an_end = 400;  // of the overlap test
constexpr double narrowest_joint = 0.25;   // of the square root of the smaller part's area
// Halfedges in all overlap tests, relative to those at which parts end: each takes a fifth of a microsecond. Islands
// that fit many others are tested with each of them.
constexpr double most_tested = 256;

class IslandMerger {
 public:
  IslandMerger(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts);

  void merge() {
    while (left_ > 0 && merge_next()) continue;  // each step merges two groups
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
  PerPart<Index> group_;        // merged ones share one
  PerPart<Array<Index>> ends_;  // halfedges at which the parts of groups end
  PerPart<double> area_;        // of groups
  PerPart<Index> merges_;       // number of groups merged into each
  double left_ = 0;             // halfedges that may still be tested

  // Scratch memory with these values between calls.
  PerHalfedge<char> is_closed_;  // 0
  PerHalfedge<char> is_traced_;  // 0
};

IslandMerger::IslandMerger(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept,
                           MapParts& parts)
    : mesh_(surface.mesh),
      part_(parts.part),
      open_(parts.open),
      corners_(at_corners(map.cut_mesh, map.position)),
      motion_(parts.motion),
      is_closed_(surface.mesh.halfedge_count(), 0),
      is_traced_(surface.mesh.halfedge_count(), 0) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  const PerTriangle<Index>& part = parts.part;
  const Index part_count = 1 + *std::max_element(part.begin(), part.end());
  motion_.assign(part_count, {});
  group_.resize(part_count);
  std::iota(group_.begin(), group_.end(), 0);
  ends_.resize(part_count);
  area_.assign(part_count, 0);
  merges_.assign(part_count, 0);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    area_[part[f]] += geometry.area[f];
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (open_[h] || mesh.twin[h] == none) ends_[part[h / 3]].push_back(h);
  }
  for (const Array<Index>& ends : ends_) left_ += most_tested * static_cast<double>(ends.size());
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
    if (left_ <= 0) return false;
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
  const auto is_end = [&](Index h) { return mesh_.twin[h] == none || open_[h]; };
  std::copy_if(ends_[left].begin(), ends_[left].end(), std::back_inserter(ends_[right]), is_end);
  ends_[left].clear();
  area_[right] += area_[left];
  ++merges_[right];
  return true;
}

// Of two groups, one of them moved.  closed: halfedges that are open now.
bool IslandMerger::overlaps(Index left, Index right, const Motion& motion, const Array<Index>& closed) {
  Array<Index> ends = ends_[right];
  ends.insert(ends.end(), ends_[left].begin(), ends_[left].end());
  for (const Index h : closed) is_closed_[h] = 1;
  const auto ends_at = [&](Index h) { return mesh_.twin[h] == none || (open_[h] && !is_closed_[h]); };
  // Those of one part follow each other.
  Index part = none;
  Motion moved;
  Complex turn = 1;
  const auto position_of = [&](Index h) {
    if (part_[h / 3] != part) {
      part = part_[h / 3];
      moved = group_[part] == left ? motion * motion_[part] : motion_[part];
      turn = std::polar(1.0, moved.angle);
    }
    return turn * corners_[h] + moved.shift;
  };
  const BoundaryPolygon boundary(mesh_, ends, ends_at, position_of, is_traced_);
  for (const Index h : closed) is_closed_[h] = 0;
  left_ -= static_cast<double>(ends.size());
  checkpoint(operations_an_end * static_cast<double>(ends.size()));
  return boundary.has_overlap();
}

}  // namespace

void merge_islands(const MetricMesh& surface, const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts) {
  IslandMerger(surface, map, kept, parts).merge();
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/canonical_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_set>

namespace lsgp {

namespace {

constexpr double same_place = 1e-9;  // of the largest distance or its square
// Of all walks that tell whether halfedges are alike, a few milliseconds; more for large meshes.
constexpr std::size_t most_steps = 1 << 16;

class ShapeOrder {
 public:
  explicit ShapeOrder(const HalfedgeMesh& mesh);

  Array<Index> outermost() const;

 private:
  // A breadth-first walk from a halfedge over triangles, each of which is reached across the halfedge in the list.
  struct Walk {
    Array<Index> reached;
    std::unordered_set<Index> triangles;

    explicit Walk(Index first) : reached{first}, triangles{first / 3} {}
  };

  double distance(Index vertex) const { return (mesh_.positions.row(vertex) - middle_).squaredNorm(); }
  std::array<double, 3> beyond(Walk& walk, std::size_t step) const;
  void keep_alike(Array<Index>& halfedges) const;

  const HalfedgeMesh& mesh_;
  Eigen::RowVector3d middle_;
  double farthest_ = 0;  // squared
};

ShapeOrder::ShapeOrder(const HalfedgeMesh& mesh) : mesh_(mesh), middle_(Eigen::RowVector3d::Zero()) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) middle_ += mesh.positions.row(mesh.origin(h));
  middle_ /= mesh.halfedge_count();
  for (Index v = 0; v < mesh.vertex_count(); ++v) farthest_ = std::max(farthest_, distance(v));
}

// What lies across the sides of the triangle that a walk reaches at some step: how far out the vertices opposite are,
// and other values at the surface's end and where the walk has been.
std::array<double, 3> ShapeOrder::beyond(Walk& walk, std::size_t step) const {
  std::array<double, 3> out{};
  Index h = walk.reached[step];
  for (double& found : out) {
    const Index across = mesh_.twin[h];
    h = next(h);
    if (across == none) {
      found = -farthest_;
    } else if (!walk.triangles.insert(across / 3).second) {
      found = -2 * farthest_;
    } else {
      walk.reached.push_back(across);
      found = distance(mesh_.origin(prev(across)));
    }
  }
  return out;
}

// Of halfedges that are alike, those from which a walk meets what is farther out first. That of a mirror image goes
// around the other way.
void ShapeOrder::keep_alike(Array<Index>& halfedges) const {
  struct Walker {
    Walk walk;
    std::array<double, 3> beyond;
  };
  Array<Walker> left;
  for (const Index first : halfedges) left.push_back({Walk(first), {}});
  const std::size_t all_steps = std::max(most_steps, 4 * static_cast<std::size_t>(mesh_.triangle_count()));
  const std::size_t steps = all_steps / halfedges.size() + 1;
  for (std::size_t step = 0; step < steps && left.size() > 1 && step < left.front().walk.reached.size(); ++step) {
    for (Walker& walker : left) walker.beyond = beyond(walker.walk, step);
    for (std::size_t side = 0; side < 3; ++side) {
      keep_largest(left, same_place * farthest_, [&](const Walker& walker) { return walker.beyond[side]; });
    }
  }
  halfedges.clear();
  for (const Walker& walker : left) halfedges.push_back(walker.walk.reached.front());
}

Array<Index> ShapeOrder::outermost() const {
  Array<Index> left(mesh_.halfedge_count());
  std::iota(left.begin(), left.end(), Index{0});
  const double within = same_place * farthest_;
  keep_largest(left, within, [&](Index h) { return distance(mesh_.origin(h)); });
  keep_largest(left, within, [&](Index h) {
    return (mesh_.positions.row(mesh_.target(h)) - mesh_.positions.row(mesh_.origin(h))).squaredNorm();
  });
  if (left.size() > 1) keep_alike(left);
  return left;
}

}  // namespace

Array<Index> outermost_halfedges(const HalfedgeMesh& mesh) { return ShapeOrder(mesh).outermost(); }

Array<Index> triangles_from(const HalfedgeMesh& mesh, Index first) {
  Array<Index> out;
  PerTriangle<char> is_reached(mesh.triangle_count(), 0);
  out.push_back(first);
  is_reached[first / 3] = 1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    Index h = out[i];
    for (int side = 0; side < 3; ++side, h = next(h)) {
      const Index across = mesh.twin[h];
      if (across == none || is_reached[across / 3]) continue;
      is_reached[across / 3] = 1;
      out.push_back(across);
    }
  }
  return out;
}

}  // namespace lsgp

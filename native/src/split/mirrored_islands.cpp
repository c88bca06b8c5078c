// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/mirrored_islands.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/least_first.hpp"
#include "cut/cut_cost.hpp"

namespace lsgp {

namespace {

constexpr double image_corridor = 3;  // mean edge lengths to either side of a path's image
constexpr double image_straying = 5;  // the cost of the squared distance from it, in these lengths
constexpr double operations_an_image_search = 500;

// The cheapest path near the mirror image of another.
class ImagePath {
 public:
  // points: of the image.  edge: the mean length.
  ImagePath(const MetricMesh& surface, const Positions& points, double edge)
      : mesh_(surface.mesh), geometry_(surface.geometry), points_(points), edge_(edge) {}

  // Between two vertices; empty where there is none.
  Array<Index> find(Index from, Index to);

 private:
  struct Reached {
    double distance = std::numeric_limits<double>::infinity();
    Index by = none;
    double apart = 0;  // from the image, in mean edges
  };

  Reached& at(Index v) {
    const auto [found, is_new] = reached_.try_emplace(v);
    if (is_new) {
      checkpoint(operations_an_image_search);
      found->second.apart = points_.nearest(mesh_.positions.row(v)).distance / edge_;
    }
    return found->second;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const PointTree points_;
  const double edge_;
  std::map<Index, Reached> reached_;
};

Array<Index> ImagePath::find(Index from, Index to) {
  using Entry = std::pair<double, Index>;
  LeastFirst<Entry> queue;
  at(from).distance = 0;
  queue.emplace(0, from);
  while (!queue.empty() && queue.top().second != to) {
    const auto [distance, v] = queue.top();
    queue.pop();
    const Reached here = at(v);
    if (distance > here.distance) continue;
    mesh_.for_each_outgoing(v, [&](Index h) {
      if (!may_cut(mesh_, h)) return;
      Reached& there = at(mesh_.target(h));
      if (there.apart > image_corridor && mesh_.target(h) != to) return;
      const double squares = here.apart * here.apart + there.apart * there.apart;
      const double through = here.distance + geometry_.length[h] * (1 + image_straying * squares);
      if (!(through < there.distance)) return;
      there.distance = through;
      there.by = h;
      queue.emplace(through, mesh_.target(h));
    });
  }
  Array<Index> path;
  for (Index h = at(to).by; h != none; h = at(mesh_.origin(h)).by) path.push_back(h);
  return path;
}

}  // namespace

MirroredIslands::MirroredIslands(const MetricMesh& surface, Borrowed<const Mirroring> mirroring)
    : surface_(surface),
      mirroring_(mirroring),
      side_(find_mirror_sides(surface.mesh, mirroring_)),
      vertices_(surface.mesh.positions),
      edge_(surface.geometry.length.mean()) {}

bool MirroredIslands::is_in_plane(Index h) const {
  return side_[surface_.mesh.origin(h)] == MirrorSide::plane && side_[surface_.mesh.target(h)] == MirrorSide::plane;
}

bool MirroredIslands::is_on(Index h, MirrorSide side) const {
  const MirrorSide tail = side_[surface_.mesh.origin(h)], head = side_[surface_.mesh.target(h)];
  return (tail == side || tail == MirrorSide::plane) && (head == side || head == MirrorSide::plane);
}

// A halfedge for each half of an edge.
Array<Index> MirroredIslands::one_sided_halves(const PerHalfedge<char>& open) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  Array<Index> edges;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (open[h] && mesh.twin[h] > h) edges.push_back(h);
  }
  Positions points(2 * ssize(edges), 3);
  for (Index i = 0; i < ssize(edges); ++i) {
    const auto tail = mesh.positions.row(mesh.origin(edges[i])), head = mesh.positions.row(mesh.target(edges[i]));
    points.row(2 * i) = (3 * tail + head) / 4;
    points.row(2 * i + 1) = (tail + 3 * head) / 4;
  }
  const PointTree tree(points);
  const auto is_near = [&](const Eigen::RowVector3d& at) { return tree.nearest(at).distance <= edge_; };
  Array<Index> out;
  for (Index i = 0; i < points.rows(); ++i) {
    checkpoint(operations_an_image_search);
    const Index h = edges[i / 2];
    if (is_in_plane(h)) continue;
    const Eigen::RowVector3d image = reflected(mirroring_.plane, points.row(i));
    if (is_near(image)) continue;
    const PointTree::Nearest vertex = vertices_.nearest(image);
    // Where the surface mirrors itself only roughly, the image lies off it.
    const bool is_off = vertex.distance > edge_ / 2;
    if (!is_off || !is_near(mesh.positions.row(vertex.point))) out.push_back(h);
  }
  return out;
}

double MirroredIslands::one_sided_length(const PerHalfedge<char>& open) const {
  double out = 0;
  for (const Index h : one_sided_halves(open)) out += surface_.geometry.length[h] / 2;
  return out;
}

Array<Index> MirroredIslands::one_sided_edges(const PerHalfedge<char>& open) const {
  Array<Index> out = one_sided_halves(open);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Index MirroredIslands::image_near(Index v) const {
  if (side_[v] == MirrorSide::plane) return v;
  const Index image = mirroring_.image[v];
  if (image != none) return image;
  return vertices_.nearest(reflected(mirroring_.plane, surface_.mesh.positions.row(v))).point;
}

// The edges at the mirror image of a path, or the cheapest path near it.
Array<Index> MirroredIslands::image_of(const Array<Index>& path) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  Array<Index> out;
  for (const Index h : path) {
    const Index image = mirrored_halfedge(mesh, mirroring_, h);
    if (image == none || !may_cut(mesh, image)) break;
    out.push_back(image);
  }
  if (out.size() == path.size()) return out;
  Positions points(2 * ssize(path) + 1, 3);
  for (Index i = 0; i < ssize(path); ++i) {
    const auto tail = mesh.positions.row(mesh.origin(path[i])), head = mesh.positions.row(mesh.target(path[i]));
    points.row(2 * i) = reflected(mirroring_.plane, tail);
    points.row(2 * i + 1) = reflected(mirroring_.plane, (tail + head) / 2);
    points.row(2 * i + 2) = reflected(mirroring_.plane, head);
  }
  const Index from = image_near(mesh.origin(path.front())), to = image_near(mesh.target(path.back()));
  return ImagePath(surface_, points, edge_).find(from, to);
}

PerHalfedge<char> MirroredIslands::with_images(const PerHalfedge<char>& open, const Array<Index>& cones,
                                               MirrorSide side) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  PerHalfedge<char> out(mesh.halfedge_count(), 0), one_side(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    out[h] = mesh.twin[h] != none && open[h] && is_on(h, side);
    one_side[h] = out[h] && !is_in_plane(h);
  }
  for (const Cut& path : paths_of(std::move(one_side), cones)) {
    for (const Index h : image_of(path.halfedges)) out[h] = out[mesh.twin[h]] = 1;
  }
  return out;
}

// Those between cones, junctions and the plane.
Array<Cut> MirroredIslands::paths_of(PerHalfedge<char> edges, const Array<Index>& cones) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  PerVertex<char> is_node(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) is_node[v] = side_[v] == MirrorSide::plane;
  for (const Index v : cones) is_node[v] = 1;
  return trace_cuts(mesh, is_node, std::move(edges)).cuts;
}

// The cheapest path near the projection of another onto the plane.
Array<Index> MirroredIslands::in_plane(const Cut& path) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  Positions points(2 * ssize(path.halfedges), 3);
  for (Index i = 0; i < ssize(path.halfedges); ++i) {
    const auto tail = mesh.positions.row(mesh.origin(path.halfedges[i]));
    const auto head = mesh.positions.row(mesh.target(path.halfedges[i]));
    points.row(2 * i) = (tail + reflected(mirroring_.plane, tail)) / 2;
    points.row(2 * i + 1) = (head + reflected(mirroring_.plane, head)) / 2;
  }
  return ImagePath(surface_, points, edge_).find(path.tail, path.head);
}

// Merges all parts that can be merged, except across some edges, and closes the edges that then fit.
void MirroredIslands::join(const ComponentMap& map, const PerHalfedge<char>& kept, MapParts& parts) const {
  const double size = size_of(at_corners(map.cut_mesh, map.position));
  const Array<PartBorder> borders = find_part_borders(surface_, map, kept, parts);
  const auto cost_of = [&](const PartBorder& border) {
    double out = 0;
    for (const Index h : border.halfedges) out += cut_cost(surface_, h);
    return out;
  };
  Array<std::pair<double, Index>> order;
  for (Index i = 0; i < ssize(borders); ++i) order.emplace_back(-cost_of(borders[i]), i);
  std::sort(order.begin(), order.end());
  PerPart<Index> group(parts.motion.size());
  PerPart<Array<Index>> members(parts.motion.size());
  std::iota(group.begin(), group.end(), 0);
  for (std::size_t p = 0; p < group.size(); ++p) members[p].push_back(static_cast<Index>(p));
  for (const auto& [_, i] : order) {
    const PartBorder& border = borders[i];
    const Motion to_meet = parts.motion[border.right] * border.across * parts.motion[border.left].inverse();
    const Index left = group[border.left], right = group[border.right];
    if (left == right && !is_rest(to_meet, size)) continue;
    for (const Index h : border.halfedges) parts.open[h] = parts.open[surface_.mesh.twin[h]] = 0;
    if (left == right) continue;
    for (const Index p : members[left]) {
      group[p] = right;
      parts.motion[p] = to_meet * parts.motion[p];
    }
    members[right].insert(members[right].end(), members[left].begin(), members[left].end());
    members[left].clear();
  }
}

MapParts MirroredIslands::along(const ComponentMap& map, const PerHalfedge<char>& wanted) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  MapParts parts{wanted, {}, {}};
  for (Index h = 0; h < mesh.halfedge_count(); ++h) parts.open[h] = wanted[h] || map.cut_graph.is_cut[h];
  parts.motion.resize(label_parts(mesh, parts.open, parts.part));
  join(map, wanted, parts);
  CutGraph all;
  all.is_cut = std::move(parts.open);
  parts.open = keep_cones(mesh, all, map.cones).is_cut;  // without dead ends
  return parts;
}

MapParts MirroredIslands::along_side(const ComponentMap& map, const PerHalfedge<char>& open, MirrorSide side) const {
  return along(map, with_images(open, map.cones, side));
}

MapParts MirroredIslands::along_both(const ComponentMap& map, const PerHalfedge<char>& open) const {
  PerHalfedge<char> wanted = with_images(open, map.cones, MirrorSide::own);
  const PerHalfedge<char> other = with_images(open, map.cones, MirrorSide::other);
  for (std::size_t h = 0; h < wanted.size(); ++h) wanted[h] = wanted[h] || other[h];
  return along(map, wanted);
}

std::optional<MapParts> MirroredIslands::along_plane(const ComponentMap& map, const PerHalfedge<char>& open) const {
  const HalfedgeMesh& mesh = surface_.mesh;
  PerHalfedge<char> led = open, beside(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) beside[h] = open[h] && mesh.twin[h] != none && !is_in_plane(h);
  const auto has_image = [&](Index h) {
    const Index image = mirrored_halfedge(mesh, mirroring_, h);
    return image != none && open[image];
  };
  bool is_other = false;
  for (const Cut& path : paths_of(std::move(beside), map.cones)) {
    if (side_[path.tail] != MirrorSide::plane || side_[path.head] != MirrorSide::plane) continue;
    if (std::all_of(path.halfedges.begin(), path.halfedges.end(), has_image)) continue;
    const Array<Index> flat = in_plane(path);
    if (flat.empty()) continue;
    for (const Index h : path.halfedges) led[h] = led[mesh.twin[h]] = 0;
    for (const Index h : flat) led[h] = led[mesh.twin[h]] = 1;
    is_other = true;
  }
  if (!is_other) return std::nullopt;
  return along_both(map, led);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/mirrored_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/borrowed.hpp"
#include "base/checkpoint.hpp"
#include "cut/shortest_paths.hpp"
#include "mesh/point_tree.hpp"

namespace lsgp {

namespace {

constexpr double longest = 0.5;                           // by how much of the length of cuts without symmetry
constexpr double unmatched = 1.5;                         // factor of edges whose mirror image is no edge
constexpr double of_designed = 1e-7, of_corridor = 1e-4;  // factors of edges where mirrored cuts are wanted
constexpr double corridor = 1.5;                          // mean edge lengths to either side of a cut's image
constexpr double straying = 30;  // what the square of the distance from it costs in the corridor, in these lengths

constexpr Index most_single = 6;  // places tried for a trunk that is a point
constexpr double operations_a_search = 500;

using Side = MirrorSide;

class MirroredCuts {
 public:
  MirroredCuts(const CutTask& task, Borrowed<const Mirroring> mirroring);

  // Cuts of one side and the trunk; none if the trunk cannot be connected.
  CutGraph free_half() const { return connect_cones({half_, task_.geometry}, own_cones_, beyond_); }
  std::optional<CutGraph> half_with_trunk(const CutGraph& free_half) const;

  // All cuts, along a half and its image.
  CutGraph complete(const CutGraph& half) const;

 private:
  double factor(Index h) const { return task_.mesh.cut_factor.empty() ? 1 : task_.mesh.cut_factor[h]; }
  Side side(Index v) const { return side_[v]; }
  bool is_in_plane(Index h) const {
    return side(task_.mesh.origin(h)) == Side::plane && side(task_.mesh.target(h)) == Side::plane;
  }
  bool is_own(Index h) const {
    return side(task_.mesh.origin(h)) != Side::other && side(task_.mesh.target(h)) != Side::other;
  }
  Index image_of(Index h) const;
  void classify_loops();
  void price_half();
  Index nearest_in_plane(const CutGraph& cuts) const;
  Array<Array<Index>> possible_contacts(const CutGraph& free_half) const;
  CutGraph half_through(const Array<Index>& contacts) const;
  CutGraph trunk_through(const Array<Index>& contacts) const;
  PerHalfedge<char> mark_designed(const CutGraph& half, bool& is_exact) const;
  CutGraph along(const CutGraph& half) const;
  void attract_beside(const CutGraph& half, HalfedgeMesh& steered) const;

  const CutTask task_;
  const Mirroring& mirroring_;
  const PerVertex<Side> side_;
  Array<Index> own_cones_;  // not beyond the plane
  PerLoop<char> beyond_;    // no cuts of this side have to reach them
  PerLoop<char> crosses_;   // boundaries through the plane that have to be reached
  HalfedgeMesh half_;       // with edges of this side and the plane as the only cuttable ones, priced with their images
};

MirroredCuts::MirroredCuts(const CutTask& task, Borrowed<const Mirroring> mirroring)
    : task_(task), mirroring_(mirroring), side_(find_mirror_sides(task.mesh, mirroring)), half_(task.mesh) {
  classify_loops();
  price_half();
  for (const Index v : task.interior_cones) {
    if (side(v) != Side::other) own_cones_.push_back(v);
  }
}

void MirroredCuts::classify_loops() {
  const auto& loops = task_.mesh.boundary_loops;
  beyond_.assign(loops.size(), 0);
  crosses_.assign(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const auto beyond =
        std::count_if(loops[i].begin(), loops[i].end(), [&](Index v) { return side(v) == Side::other; });
    const bool is_uncut = !task_.uncut.empty() && task_.uncut[i];
    beyond_[i] = is_uncut || beyond == static_cast<std::ptrdiff_t>(loops[i].size());
    crosses_[i] = !beyond_[i] && beyond > 0;
  }
}

// The edge at an edge's mirror image, none if there is none that may be cut.
Index MirroredCuts::image_of(Index h) const {
  const Index image = mirrored_halfedge(task_.mesh, mirroring_, h);
  return image != none && may_cut(task_.mesh, image) ? image : none;
}

void MirroredCuts::price_half() {
  half_.genus = 0;  // handles are opened last
  half_.cut_factor.assign(half_.halfedge_count(), 0.0);
  for (Index h = 0; h < half_.halfedge_count(); ++h) {
    half_.cuttable[h] = half_.cuttable[h] && is_own(h);
    if (!may_cut(half_, h)) continue;
    if (is_in_plane(h)) {
      half_.cut_factor[h] = factor(h) / 2;  // once, the others twice
    } else {
      const Index image = image_of(h);
      half_.cut_factor[h] = image == none ? unmatched * factor(h) : (factor(h) + factor(image)) / 2;
    }
  }
}

// The vertex in the plane that cuts reach most cheaply from cuts of one side or its cones; none if there is no way.
Index MirroredCuts::nearest_in_plane(const CutGraph& cuts) const {
  PerVertex<char> is_start = on_cuts(half_, cuts);
  for (const Index v : own_cones_) is_start[v] = 1;
  PerVertex<Reached> reached(half_.vertex_count());
  PathStarts starts;
  for (Index v = 0; v < half_.vertex_count(); ++v) {
    if (!is_start[v]) continue;
    reached[v] = {0, none, v};
    starts.emplace_back(0.0, v);
  }
  const CutEdges edges({half_, task_.geometry});
  grow_paths(edges, {std::move(starts)}, [&](Index v) { return half_.loop_of_vertex[v] == none; }, reached);
  Index best = none;
  for (Index v = 0; v < half_.vertex_count(); ++v) {
    const bool is_met = side(v) == Side::plane && half_.loop_of_vertex[v] == none && reached[v].source != none;
    if (is_met && (best == none || reached[v].distance < reached[best].distance)) best = v;
  }
  return best;
}

// The shortest way in the plane that joins these vertices and the boundaries through it.
CutGraph MirroredCuts::trunk_through(const Array<Index>& contacts) const {
  HalfedgeMesh plane = half_;
  for (Index h = 0; h < plane.halfedge_count(); ++h) plane.cuttable[h] = plane.cuttable[h] && is_in_plane(h);
  PerLoop<char> uncut(crosses_.size());
  for (std::size_t i = 0; i < uncut.size(); ++i) uncut[i] = !crosses_[i];
  return connect_cones({plane, task_.geometry}, contacts, uncut);
}

// Places in the plane, each a choice of what the trunk has to join: cones with all vertices at which cuts of this side
// meet the plane, or with one of them.
Array<Array<Index>> MirroredCuts::possible_contacts(const CutGraph& free_half) const {
  const auto is_inside = [&](Index v) { return side(v) == Side::plane && half_.loop_of_vertex[v] == none; };
  Array<Index> cones, met;
  for (const Index v : own_cones_) {
    if (is_inside(v)) cones.push_back(v);
  }
  const PerVertex<char> is_met = on_cuts(half_, free_half);
  for (Index v = 0; v < half_.vertex_count(); ++v) {
    if (is_met[v] && is_inside(v)) met.push_back(v);
  }
  Array<Array<Index>> out;
  if (!met.empty()) out.push_back(met);
  const bool has_crossing = std::find(crosses_.begin(), crosses_.end(), 1) != crosses_.end();
  if (!cones.empty() || has_crossing) {
    out.push_back(cones);
  } else if (met.empty()) {
    if (const Index nearest = nearest_in_plane(free_half); nearest != none) out.push_back({nearest});
  } else {
    const Index count = std::min(static_cast<Index>(ssize(met)), most_single);
    for (Index i = 0; i < count; ++i) out.push_back({met[i * ssize(met) / count]});
  }
  for (auto& contacts : out) contacts.insert(contacts.end(), cones.begin(), cones.end());
  for (auto& contacts : out) sort_unique(contacts);
  return out;
}

CutGraph MirroredCuts::half_through(const Array<Index>& contacts) const {
  const CutGraph trunk = trunk_through(contacts);
  PerVertex<char> is_met = on_cuts(half_, trunk);
  for (const Index v : contacts) is_met[v] = 1;
  HalfedgeMesh mesh = half_;
  const auto may_meet = [&](Index v) { return side(v) == Side::own || is_met[v] || mesh.loop_of_vertex[v] != none; };
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const bool is_allowed = is_in_plane(h) ? trunk.is_cut[h] : may_meet(mesh.origin(h)) && may_meet(mesh.target(h));
    mesh.cuttable[h] = mesh.cuttable[h] && is_allowed;
    if (trunk.is_cut[h]) mesh.seam[h] = 1;  // costs nothing, and is joined as a whole
  }
  Array<Index> cones = own_cones_;
  if (!contacts.empty()) cones.push_back(contacts.front());
  sort_unique(cones);
  return connect_cones({mesh, task_.geometry}, cones, beyond_);
}

std::optional<CutGraph> MirroredCuts::half_with_trunk(const CutGraph& free_half) const {
  std::optional<CutGraph> best;
  double least = 0;
  for (const Array<Index>& contacts : possible_contacts(free_half)) {
    try {
      CutGraph half = half_through(contacts);
      const double cost = cost_of({half_, task_.geometry}, half);
      if (best && !(cost < least)) continue;
      best = std::move(half);
      least = cost;
    } catch (const Error& error) {
      if (error.code() != Code::cuts_blocked) throw;  // the plane meets the surface in several curves
    }
  }
  return best;
}

// The cuts of a half and their images.  is_exact: whether all of them have one.
PerHalfedge<char> MirroredCuts::mark_designed(const CutGraph& half, bool& is_exact) const {
  const HalfedgeMesh& mesh = task_.mesh;
  PerHalfedge<char> out(mesh.halfedge_count(), 0);
  is_exact = true;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!half.is_cut[h] || !is_own(h)) continue;
    out[h] = 1;
    if (is_in_plane(h)) continue;
    const Index image = image_of(h);
    is_exact = is_exact && image != none;
    if (image != none) out[image] = out[mesh.twin[image]] = 1;
  }
  return out;
}

// Makes edges cheap that run beside the image of a half's cuts.
void MirroredCuts::attract_beside(const CutGraph& half, HalfedgeMesh& steered) const {
  const double edge = task_.geometry.length.mean();
  const PointTree vertices(steered.positions);
  const auto image_near = [&](Index v) {
    const Index image = mirroring_.image[v];
    return image == none ? vertices.nearest(reflected(mirroring_.plane, steered.positions.row(v))).point : image;
  };
  Array<Eigen::RowVector3d> path;  // near the images, halves of edges apart
  for (Index h = 0; h < steered.halfedge_count(); ++h) {
    if (!half.is_cut[h] || !is_own(h)) continue;
    checkpoint(operations_a_search);
    const Index tail = image_near(steered.origin(h)), head = image_near(steered.target(h));
    path.push_back(steered.positions.row(tail));
    if (h < steered.twin[h]) path.push_back((steered.positions.row(tail) + steered.positions.row(head)) / 2);
  }
  Positions points(ssize(path), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = path[i];
  const PointTree tree(points);
  PerVertex<double> distance(steered.vertex_count(), 2 * corridor);
  for (Index v = 0; v < steered.vertex_count(); ++v) {
    if (side(v) == Side::own) continue;
    checkpoint(operations_a_search);
    distance[v] = tree.nearest(steered.positions.row(v)).distance / edge;
  }
  for (Index h = 0; h < steered.halfedge_count(); ++h) {
    const double a = distance[steered.origin(h)], b = distance[steered.target(h)];
    if (std::max(a, b) > corridor) continue;
    steered.cut_factor[h] *= of_corridor * (1 + straying * (a * a + b * b));
  }
}

// All cuts, along those on this side and their images where that is possible.
CutGraph MirroredCuts::along(const CutGraph& half) const {
  HalfedgeMesh steered = task_.mesh;
  if (steered.cut_factor.empty()) steered.cut_factor.assign(steered.halfedge_count(), 1.0);
  bool is_exact = true;
  const PerHalfedge<char> designed = mark_designed(half, is_exact);
  if (!is_exact) attract_beside(half, steered);
  for (Index h = 0; h < steered.halfedge_count(); ++h) {
    if (designed[h]) steered.cut_factor[h] = of_designed * factor(h);
  }
  return connect_cones({steered, task_.geometry}, task_.interior_cones, task_.uncut);
}

// Loops around handles are found for all of the surface, and then those of one side for both.
CutGraph MirroredCuts::complete(const CutGraph& half) const {
  const CutGraph cuts = along(half);
  return task_.mesh.genus > 0 ? along(cuts) : cuts;
}

// Of cuts, and of them with those that cost more than others as many times longer.
struct CutLengths {
  double plain = 0, seen = 0;
};

CutLengths lengths_of(const MetricMesh& surface, const CutGraph& cuts) {
  CutLengths out;
  for (const Cut& cut : cuts.cuts) {
    for (const Index h : cut.halfedges) {
      const double length = surface.geometry.length[h];
      out.plain += length;
      out.seen += std::max(length, cut_cost(surface, h));
    }
  }
  return out;
}

}  // namespace

CutGraph connect_symmetrically(const CutTask& task, const Mirroring& mirroring) {
  CutGraph usual = connect_cones(task, task.interior_cones, task.uncut);
  if (usual.cuts.empty() || !are_mirrored(mirroring, task.interior_cones)) return usual;
  const auto [length, seen] = lengths_of(task, usual);
  const double most = seen + longest * length;
  try {
    const MirroredCuts mirrored(task, mirroring);
    const CutGraph free_half = mirrored.free_half();
    if (const auto half = mirrored.half_with_trunk(free_half)) {
      CutGraph cuts = mirrored.complete(*half);
      if (lengths_of(task, cuts).seen <= most) return cuts;
    }
    CutGraph cuts = mirrored.complete(free_half);
    if (lengths_of(task, cuts).seen <= most) return cuts;
  } catch (const Error& error) {
    if (error.code() != Code::cuts_blocked) throw;
  }
  return usual;
}

}  // namespace lsgp

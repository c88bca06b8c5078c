// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/straightness.hpp"

#include <cmath>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/text.hpp"
#include "plane/predicates.hpp"
#include "systems/poisson_system.hpp"
#include "unfold/frames.hpp"
#include "unfold/jacobians.hpp"
#include "unfold/spectral.hpp"

namespace lsgp {

namespace {

// Gauss-Bonnet of the angles read off a simple polygon holds to rounding; a crossing breaks it by whole turns.
constexpr double turn_tolerance = 1e-6;
constexpr double operations_a_pair = 10;  // of segments

// One side of a cut, straight between two node copies.
struct Segment {
  Index from, to;  // copies
};

bool share_end(const Segment& a, const Segment& b) {
  return a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to;
}

// The straightened boundary as a polygon over the node copies' positions.
class StraightBoundary {
 public:
  StraightBoundary(Array<Segment> segments, Eigen::VectorXcd positions)
      : segments_(std::move(segments)), positions_(std::move(positions)) {}

  const Eigen::VectorXcd& positions() const { return positions_; }

  int count_crossings() const {
    int total = 0;
    for (const int crossings : crossings_by_segment()) total += crossings;
    return total / 2;
  }

  // Takes the segment with most crossings, and among those crossing it the one with most, and swaps one end of each
  // so that fewest crossings remain. False where no swap helps.
  bool swap_worst() {
    const Array<int> crossings = crossings_by_segment();
    const auto most = [&](const auto& eligible) {
      int best = -1;
      for (int i = 0; i < static_cast<int>(segments_.size()); ++i) {
        if (crossings[i] > 0 && eligible(i) && (best < 0 || crossings[i] > crossings[best])) best = i;
      }
      return best;
    };
    const int first = most([](int) { return true; });
    if (first < 0) return false;
    const int second = most([&](int i) { return i != first && cross(segments_[first], segments_[i]); });
    const Segment a = segments_[first], b = segments_[second];
    int fewest = count_crossings();
    std::pair<Index, Index> chosen{none, none};
    for (const auto& [x, y] : {std::pair{a.from, b.from}, {a.from, b.to}, {a.to, b.from}, {a.to, b.to}}) {
      std::swap(positions_[x], positions_[y]);
      const int remaining = count_crossings();
      if (remaining < fewest) {
        fewest = remaining;
        chosen = {x, y};
      }
      std::swap(positions_[x], positions_[y]);
    }
    if (chosen.first == none) return false;
    std::swap(positions_[chosen.first], positions_[chosen.second]);
    return true;
  }

 private:
  bool cross(const Segment& a, const Segment& b) const {
    if (share_end(a, b)) return false;
    const Complex p = positions_[a.from], q = positions_[a.to], r = positions_[b.from], s = positions_[b.to];
    return doubled_area(p, q, r) * doubled_area(p, q, s) < 0 && doubled_area(r, s, p) * doubled_area(r, s, q) < 0;
  }

  Array<int> crossings_by_segment() const {
    Array<int> crossings(segments_.size(), 0);
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      for (std::size_t j = i + 1; j < segments_.size(); ++j) {
        if (!cross(segments_[i], segments_[j])) continue;
        ++crossings[i];
        ++crossings[j];
      }
    }
    checkpoint(operations_a_pair * static_cast<double>(segments_.size() * segments_.size()));
    return crossings;
  }

  Array<Segment> segments_;
  Eigen::VectorXcd positions_;  // (copies) those off the nodes stay where they were
};

// Copies inside a cut lie at their share of its length between the two node copies of their side.
struct StraightSides {
  Reduction reduction;
  Array<Segment> segments;  // left and right side of every cut
};

StraightSides straighten_sides(const MetricMesh& surface, const CutGraph& cut_graph, const CutMesh& cut_mesh) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Geometry& geometry = surface.geometry;
  struct Place {
    Index from = none, to = none;
    double share = 0;
  };
  PerCopy<Place> place(cut_mesh.copy_count());
  StraightSides out;
  for (const Cut& cut : cut_graph.cuts) {
    const Sisters tail = origin_sisters(mesh, cut_mesh, cut.halfedges.front());
    const Sisters head = target_sisters(mesh, cut_mesh, cut.halfedges.back());
    out.segments.push_back({tail.left, head.left});
    out.segments.push_back({tail.right, head.right});
    double length = 0, walked = 0;
    for (const Index h : cut.halfedges) length += geometry.length[h];
    for (std::size_t i = 0; i + 1 < cut.halfedges.size(); ++i) {
      walked += geometry.length[cut.halfedges[i]];
      const Sisters here = target_sisters(mesh, cut_mesh, cut.halfedges[i]);
      place[here.left] = {tail.left, head.left, walked / length};
      place[here.right] = {tail.right, head.right, walked / length};
    }
  }
  PerCopy<Index> unknown(cut_mesh.copy_count(), none);
  const Index origin = out.segments.front().from;
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
    if (place[copy].from == none && copy != origin) unknown[copy] = out.reduction.unknown_count++;
  }
  out.reduction.begin.assign(1, 0);
  for (Index copy = 0; copy < cut_mesh.copy_count(); ++copy) {
    const auto push = [&](Index of, double share) {
      if (unknown[of] != none && share != 0) out.reduction.terms.push_back({unknown[of], share});
    };
    const Place& at = place[copy];
    if (at.from == none) {
      push(copy, 1);
    } else if (at.from == at.to) {
      push(at.from, 1);
    } else {
      push(at.from, 1 - at.share);
      push(at.to, at.share);
    }
    out.reduction.begin.push_back(static_cast<Index>(out.reduction.terms.size()));
  }
  return out;
}

// The angle of a node's sector between the two straight cuts that bound it, in (-pi, pi].
double read_angle(const CutSurface& surface, const Eigen::VectorXcd& position, const Sector& sector, Index closed_by) {
  const HalfedgeMesh& mesh = surface.mesh;
  const CutGraph& cut_graph = surface.cut_graph;
  const CutMesh& cut_mesh = surface.cut_mesh;
  const auto far_end = [&, &mesh = mesh, &cut_graph = cut_graph, &cut_mesh = cut_mesh](Index h, bool on_left) {
    const Cut& cut = cut_graph.cuts[cut_graph.cut_of[h]];
    const bool forward = cut_graph.runs_forward[h];
    const Sisters end = forward ? target_sisters(mesh, cut_mesh, cut.halfedges.back())
                                : origin_sisters(mesh, cut_mesh, cut.halfedges.front());
    return position[forward == on_left ? end.left : end.right];
  };
  const Complex tip = position[sector.copy];
  const Complex right = far_end(sector.opened_by, true) - tip, left = far_end(closed_by, false) - tip;
  return std::arg(left * std::conj(right));
}

// The curvature of all nodes inside the surface.  branch: (v, sector, angle up to whole turns), returns the angle.
template <typename Branch>
Eigen::VectorXd read_curvature(const CutSurface& surface, const Eigen::VectorXcd& position, const Branch& branch) {
  const HalfedgeMesh& mesh = surface.mesh;
  const CutGraph& cut_graph = surface.cut_graph;
  const CutMesh& cut_mesh = surface.cut_mesh;
  Eigen::VectorXd curvature = Eigen::VectorXd::Zero(mesh.vertex_count());
  PerVertex<char> read(mesh.vertex_count(), 0);
  for (const Cut& cut : cut_graph.cuts) {
    for (const Index v : {cut.tail, cut.head}) {
      if (read[v] || mesh.loop_of_vertex[v] != none) continue;
      read[v] = 1;
      const auto all = sectors(mesh, cut_graph, cut_mesh, v);
      curvature[v] = 2 * M_PI;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Index closed_by = all[(i + 1) % all.size()].opened_by;
        curvature[v] -= branch(v, all[i], read_angle(surface, position, all[i], closed_by));
      }
    }
  }
  return curvature;
}

double required_curvature(const HalfedgeMesh& mesh) { return 2 * M_PI * mesh.euler; }

// Whether angles obey Gauss-Bonnet. A boundary takes up what the others leave.
bool are_possible(const HalfedgeMesh& mesh, const Eigen::VectorXd& curvature) {
  return !mesh.closed() || std::abs(curvature.sum() - required_curvature(mesh)) <= turn_tolerance;
}

// Swaps until no swap leaves fewer crossings, and reads the angles.
StraightenedLayout untangle_and_read(const CutSurface& surface, StraightBoundary boundary) {
  const HalfedgeMesh& mesh = surface.mesh;
  StraightenedLayout layout;
  // Each swap lowers the number of crossings.
  while (boundary.count_crossings() > 0 && boundary.swap_worst()) {
  }
  layout.crossings = boundary.count_crossings();
  const auto within_turn = [](Index, const Sector&, double angle) { return angle > 0 ? angle : angle + 2 * M_PI; };
  layout.curvature = read_curvature(surface, boundary.positions(), within_turn);
  if (layout.crossings > 0) {
    layout.failure = concat(count(layout.crossings, "pair of them crosses", "pairs of them cross"), " in the plane");
  } else if (!are_possible(mesh, layout.curvature)) {
    layout.failure =
        concat("the angles between the straight cuts leave a curvature of ", degrees(layout.curvature.sum()),
               " where the surface requires ", degrees(required_curvature(mesh)));
  }
  return layout;
}

// The curvature of the nodes where the layout may lie over itself: of the angles up to whole turns, the nearest to what
// sectors have in a flat metric, their shares of a node's angle being those on the surface.  curvature: of the metric.
Eigen::VectorXd read_beside(const CutSurface& surface, const Eigen::VectorXcd& position,
                            const Eigen::VectorXd& curvature) {
  return read_curvature(surface, position, [&](Index v, const Sector& sector, double angle) {
    double own = 0, whole = 0;
    surface.mesh.for_each_outgoing(v, [&](Index h) {
      whole += surface.geometry.angle[h];
      if (surface.cut_mesh.copy_of_corner[h] == sector.copy) own += surface.geometry.angle[h];
    });
    const double expected = own / whole * (2 * M_PI - curvature[v]);
    const double nearest = angle + 2 * M_PI * std::round((expected - angle) / (2 * M_PI));
    return nearest > 0 ? nearest : nearest + 2 * M_PI;
  });
}

}  // namespace

Array<StraightenedLayout> straighten(const CutSurface& surface) {
  StraightSides sides = straighten_sides(surface, surface.cut_graph, surface.cut_mesh);
  Eigen::VectorXcd position = unfold_spectral(surface, sides.reduction);
  return {untangle_and_read(surface, {std::move(sides.segments), std::move(position)})};
}

Array<StraightenedLayout> straighten_beside(const CutSurface& surface, const Eigen::VectorXd& curvature,
                                            const Eigen::VectorXd& log_scale) {
  StraightSides sides = straighten_sides(surface, surface.cut_graph, surface.cut_mesh);
  const Eigen::VectorXd frames = FrameTree(surface, surface.cut_graph).integrate(log_scale);
  const RelativeFit fit(surface, prescribed_jacobians(surface.mesh, log_scale, frames));
  Eigen::VectorXcd position = PoissonSystem(fit.surface(), sides.reduction).fit(fit.jacobians());
  StraightenedLayout overlapping;
  overlapping.curvature = read_beside(surface, position, curvature);
  Array<StraightenedLayout> out{untangle_and_read(surface, {std::move(sides.segments), std::move(position)})};
  if (are_possible(surface.mesh, overlapping.curvature)) out.push_back(std::move(overlapping));
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/straight_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/checkpoint.hpp"
#include "base/least_first.hpp"

namespace lsgp {

namespace {

constexpr double cost_of_turning = 0.25;   // times the squared turn and the mean length of the two edges
constexpr double operations_a_step = 200;  // of a search for a path
constexpr int band_width = 8;              // faces on either side in which a cut may move
constexpr double infinity = std::numeric_limits<double>::infinity();

using Path = Array<Index>;  // halfedges

class Straightener {
 public:
  Straightener(const OpenedSurface& surface, const FaceGraph& graph, const IsHeld& is_held, PerFace<Index>& part)
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        graph_(graph),
        open_(surface.open),
        is_held_(is_held),
        part_(part),
        length_(mesh_.halfedge_count(), 0),
        on_path_(mesh_.halfedge_count(), 0),
        is_end_(mesh_.halfedge_count(), 0),
        distance_(mesh_.halfedge_count(), infinity),
        before_(mesh_.halfedge_count(), none),
        in_band_(graph.face_count(), 0) {
    for (const FaceGraph::Link& link : graph.links) {
      length_[link.halfedge] = length_[mesh_.twin[link.halfedge]] = static_cast<double>(link.cost);
    }
  }

  void straighten() {
    constexpr int most_rounds = 4;
    PerPart<char> has_moved(graph_.face_count());
    bool goes_on = true;
    for (int round = 0; goes_on && round < most_rounds; ++round) {
      goes_on = false;
      std::fill(has_moved.begin(), has_moved.end(), 0);
      for (const Path& path : trace()) {
        const Index a = part(path.front()), b = part(mesh_.twin[path.front()]);
        if (has_moved[a] || has_moved[b] || !straighten(path)) continue;  // the ends of others may have moved
        has_moved[a] = has_moved[b] = 1;
        goes_on = true;
      }
    }
  }

 private:
  Index part(Index h) const { return part_[graph_.face_of[h / 3]]; }
  bool parts_differ(Index h) const { return part(h) != part(mesh_.twin[h]); }

  // For the current path: whether a halfedge bounds the union of the two parts on either side of it.
  bool is_border(Index h) const {
    if (mesh_.twin[h] == none || open_[h]) return true;
    return parts_differ(h) && !on_path_[h];
  }
  bool may_follow(Index h) const {
    return length_[h] > 0 && !is_border(h) &&
           (in_band_[graph_.face_of[h / 3]] || in_band_[graph_.face_of[mesh_.twin[h] / 3]]);
  }

  Array<Path> trace() const;
  bool straighten(const Path& path);
  void mark_band(const Path& path, Array<Index>& band);
  Index border_after(Index h) const;
  Array<Index> slide(Index border) const;
  Path find_path(const Array<Index>& starts);
  double cost(const Path& path) const;
  bool move(const Path& before, const Path& after);
  template <typename Visit>
  void for_each_way_on(Index h, Visit visit) const;

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const FaceGraph& graph_;
  const PerHalfedge<char>& open_;
  const IsHeld& is_held_;
  PerFace<Index>& part_;
  PerHalfedge<double> length_;  // cost of an edge, 0 if it may not be cut
  PerHalfedge<char> on_path_, is_end_;
  PerHalfedge<double> distance_;
  PerHalfedge<Index> before_;
  PerFace<char> in_band_;
};

// The cuts between any two parts, from boundary to boundary or between junctions; the lower part is on the left.
Array<Path> Straightener::trace() const {
  PerHalfedge<Index> next_on(mesh_.halfedge_count(), none);
  PerHalfedge<char> has_before(mesh_.halfedge_count(), 0);
  const auto is_cut = [&](Index h) { return mesh_.twin[h] != none && !open_[h] && part(h) < part(mesh_.twin[h]); };
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (!is_cut(h)) continue;
    Index g = next(h);
    while (mesh_.twin[g] != none && !open_[g] && !parts_differ(g)) g = next(mesh_.twin[g]);
    if (mesh_.twin[g] == none || open_[g] || part(mesh_.twin[g]) != part(mesh_.twin[h])) continue;
    next_on[h] = g;
    has_before[g] = 1;
  }
  Array<Path> paths;
  for (Index first = 0; first < mesh_.halfedge_count(); ++first) {
    if (!is_cut(first) || has_before[first]) continue;
    paths.emplace_back();
    for (Index h = first; h != none; h = next_on[h]) paths.back().push_back(h);
  }
  return paths;
}

// Calls visit(g, turn) for the halfedges that leave the target of h; none if that is on a boundary.
template <typename Visit>
void Straightener::for_each_way_on(Index h, Visit visit) const {
  double all = 0;
  Index g = next(h);
  for (;; g = next(mesh_.twin[g])) {
    all += geometry_.angle[g];
    if (is_border(g)) return;
    if (mesh_.twin[g] == h) break;
  }
  double left = 0;
  for (g = next(h); mesh_.twin[g] != h; g = next(mesh_.twin[g])) {
    left += geometry_.angle[g];
    visit(g, M_PI - 2 * M_PI * left / all);
  }
}

// The boundary halfedge that leaves the target of h; none in the interior.
Index Straightener::border_after(Index h) const {
  for (Index g = next(h);; g = next(mesh_.twin[g])) {
    if (is_border(g)) return g;
    if (mesh_.twin[g] == h) return none;
  }
}

// Boundary halfedges that leave a boundary vertex and those next to it, within the band.
Array<Index> Straightener::slide(Index border) const {
  Array<Index> out{border};
  Index g = border;
  for (int i = 0; i < band_width && in_band_[graph_.face_of[g / 3]]; ++i) {
    g = border_after(g);
    if (g == border) return out;
    out.push_back(g);
  }
  g = border;
  for (int i = 0; i < band_width; ++i) {
    while (!is_border(prev(g))) g = mesh_.twin[prev(g)];
    g = prev(g);
    if (!in_band_[graph_.face_of[g / 3]] || g == border) break;
    out.push_back(g);
  }
  return out;
}

void Straightener::mark_band(const Path& path, Array<Index>& band) {
  const Index a = part(path.front()), b = part(mesh_.twin[path.front()]);
  const auto add = [&](Index face) {
    const bool inside = part_[face] == a || part_[face] == b;
    if (!inside || in_band_[face] || is_held_(face, part_[face] == a ? b : a)) return;
    in_band_[face] = 1;
    band.push_back(face);
  };
  for (const Index h : path) {
    add(graph_.face_of[h / 3]);
    add(graph_.face_of[mesh_.twin[h] / 3]);
  }
  std::size_t begin = 0;
  for (int ring = 1; ring < band_width; ++ring) {
    for (const std::size_t end = band.size(); begin < end; ++begin) {
      graph_.for_each_link(band[begin], [&](Index other, const FaceGraph::Link&) { add(other); });
    }
  }
}

// Returns whether the cut moved.
bool Straightener::straighten(const Path& path) {
  bool moves = false;
  for (const Index h : path) on_path_[h] = on_path_[mesh_.twin[h]] = 1;
  Array<Index> band;
  mark_band(path, band);
  // Boundary halfedges that leave the path's start and end.
  const Index tail = border_after(mesh_.twin[path.front()]), head = border_after(path.back());
  if (tail != none && head != none && tail != head) {
    Array<Index> starts = slide(tail), ends = slide(head);
    const auto in_both = [&](Index g) { return std::find(ends.begin(), ends.end(), g) != ends.end(); };
    if (std::any_of(starts.begin(), starts.end(), in_both)) {
      starts = {tail};
      ends = {head};
    }
    for (const Index g : ends) is_end_[g] = 1;
    const Path straight = find_path(starts);
    for (const Index g : ends) is_end_[g] = 0;
    constexpr double better = 1 - 1e-6;
    moves = !straight.empty() && cost(straight) < better * cost(path) && move(path, straight);
  }
  for (const Index face : band) in_band_[face] = 0;
  for (const Index h : path) on_path_[h] = on_path_[mesh_.twin[h]] = 0;
  return moves;
}

Path Straightener::find_path(const Array<Index>& starts) {
  using Entry = std::pair<double, Index>;
  LeastFirst<Entry> queue;
  Array<Index> reached;
  const auto reach = [&](Index h, double through, Index from) {
    if (!may_follow(h) || through >= distance_[h]) return;
    if (distance_[h] == infinity) reached.push_back(h);
    distance_[h] = through;
    before_[h] = from;
    queue.emplace(through, h);
  };
  for (const Index border : starts) {
    for (Index g = border; !is_border(prev(g));) {
      g = mesh_.twin[prev(g)];
      reach(g, length_[g], none);
    }
  }
  Path path;
  while (!queue.empty()) {
    const auto [d, h] = queue.top();
    queue.pop();
    if (d > distance_[h]) continue;
    const Index border = border_after(h);
    if (border != none && is_end_[border]) {
      for (Index g = h; g != none; g = before_[g]) path.push_back(g);
      std::reverse(path.begin(), path.end());
      break;
    }
    for_each_way_on(h, [&, d = d, h = h](Index g, double turn) {
      reach(g, d + length_[g] + cost_of_turning * turn * turn * (length_[h] + length_[g]) / 2, h);
    });
  }
  checkpoint(operations_a_step * static_cast<double>(reached.size()));
  for (const Index h : reached) {
    distance_[h] = infinity;
    before_[h] = none;
  }
  return path;
}

double Straightener::cost(const Path& path) const {
  double sum = length_[path.front()];
  for (std::size_t i = 1; i < path.size(); ++i) {
    for_each_way_on(path[i - 1], [&](Index g, double turn) {
      if (g != path[i]) return;
      sum += length_[g] + cost_of_turning * turn * turn * (length_[path[i - 1]] + length_[g]) / 2;
    });
  }
  return sum;
}

// Divides the two parts along another path. Leaves them unchanged if that does not separate overlapping faces.
bool Straightener::move(const Path& before, const Path& after) {
  const Index a = part(before.front()), b = part(mesh_.twin[before.front()]);
  PerHalfedge<char> is_open(mesh_.halfedge_count(), 0);
  for (const Index h : after) is_open[h] = is_open[mesh_.twin[h]] = 1;
  PerFace<Index> side(graph_.face_count(), none);
  Array<Index> front;
  const auto flood = [&](Index seed, Index number) {
    side[seed] = number;
    front.assign(1, seed);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      graph_.for_each_link(face, [&](Index other, const FaceGraph::Link& link) {
        if (side[other] != none || is_open[link.halfedge] || is_border(link.halfedge)) return;
        side[other] = number;
        front.push_back(other);
      });
    }
  };
  const Index left = graph_.face_of[after.front() / 3], right = graph_.face_of[mesh_.twin[after.front()] / 3];
  flood(left, a);
  if (side[right] != none) return false;
  flood(right, b);
  for (Index face = 0; face < graph_.face_count(); ++face) {
    if (part_[face] != a && part_[face] != b) continue;
    if (side[face] == none) return false;
    if (side[face] != part_[face] && is_held_(face, part_[face] == a ? b : a)) return false;
  }
  for (Index face = 0; face < graph_.face_count(); ++face) {
    if (side[face] != none) part_[face] = side[face];
  }
  return true;
}

}  // namespace

void straighten_cuts(const OpenedSurface& surface, const FaceGraph& graph, const IsHeld& is_held,
                     PerFace<Index>& part) {
  Straightener(surface, graph, is_held, part).straighten();
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/sheets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/union_find.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

using Vector3 = Eigen::Vector3d;

// What a pair costs, in radians of bending. A sheet that turns inside out, or that folds back, does not continue; one
// that leaves a slit in its part, or whose parts both end all round, bends as a corner does.
constexpr double inside_out = M_PI, slit_of_part = M_PI / 2, all_ends = M_PI / 2;

// Half way to a corner: what bends more is a corner itself, what bends less goes on smoothly. Of corners one is clearly
// better than other pairs if these cost more by as much.
constexpr double corner_bend = M_PI / 4;

// At an edge of more triangles none continues another one more than the next would.
constexpr Index most_at_edge = 32;

// Pairs of triangles at an edge are chosen again once it is known which parts end at the others.
constexpr int rounds = 2;

// Disjoint sets whose members are turned over or not, relative to each other.
class TurnedUnion {
 public:
  explicit TurnedUnion(Index size) : parent_(size), turned_(size, 0) {
    for (Index i = 0; i < size; ++i) parent_[i] = i;
  }
  // Whether the members are, or now can be, so: turned over relative to each other or not.
  bool unite(Index a, Index b, bool turned) {
    const auto [root_a, turned_a] = find(a);
    const auto [root_b, turned_b] = find(b);
    const bool wanted = turned != (turned_a != turned_b);
    if (root_a == root_b) return !wanted;
    parent_[root_b] = root_a;
    turned_[root_b] = wanted;
    return true;
  }

 private:
  std::pair<Index, bool> find(Index i) {
    Index root = i;
    bool turned = false;
    for (; parent_[root] != root; root = parent_[root]) turned ^= turned_[root] != 0;
    for (bool rest = turned; parent_[i] != root && parent_[i] != i;) {
      const Index above = parent_[i];
      const bool own = turned_[i] != 0;
      parent_[i] = root;
      turned_[i] = rest;
      rest ^= own;
      i = above;
    }
    return {root, turned};
  }

  Array<Index> parent_;
  Array<char> turned_;
};

// One triangle at a crowded edge.
struct SheetSide {
  Index halfedge, opposite;  // the vertex
  Vector3 away;              // from the edge into the triangle, of unit length; 0: no area
  bool with_edge;            // runs from the lower vertex to the higher one, in its part's orientation
};

struct CrowdedEdge {
  Index edge;
  double length;
  Vector3 along;           // from the lower vertex to the higher one, of unit length
  Array<SheetSide> sides;  // by opposite vertices
};

using SheetPair = std::pair<Index, Index>;  // of sides

// Crowded edges in a row at which the same sheets meet. Its sheets have the order of the sides of its first edge.
struct SheetJunction {
  Array<Index> crowded;
  Array<Array<Index>> side_of_sheet;  // at each of these edges
  Array<SheetPair> pairs;             // of sheets
};

class SheetMatching {
 public:
  SheetMatching(const Surface& surface, const EdgeTable& edges, const PerEdge<char>& crowded, const JoinedParts& joined,
                PerHalfedge<Index>& twin)
      : surface_(surface), edges_(edges), joined_(joined), twin_(twin), crowded_of_edge_(edges.count(), none) {
    for (Index edge = 0; edge < edges.count(); ++edge) {
      if (crowded[edge] && edges.halfedge_count(edge) <= most_at_edge) add(edge);
    }
    find_junctions();
    measure_parts();
  }

  // The clearest junctions first: what they join is one part for the others.
  void choose() {
    merged_ = UnionFind(static_cast<Index>(joined_.orientable.size()));
    Array<std::pair<double, Index>> order;
    for (Index i = 0; i < ssize(junctions_); ++i) order.emplace_back(candidates(junctions_[i]).front().cost, i);
    std::sort(order.begin(), order.end());
    for (const auto& [cost, i] : order) {
      SheetJunction& junction = junctions_[i];
      junction.pairs = best_pairs(junction);
      for (const auto& [a, b] : junction.pairs) {
        for (std::size_t e = 0; e < junction.crowded.size(); ++e) {
          merged_.unite(part_of(side(junction, e, a)), part_of(side(junction, e, b)));
        }
      }
    }
  }

  void note_ends() {
    ended_.assign(joined_.orientable.size(), 0);
    for (const SheetJunction& junction : junctions_) {
      Array<char> paired(junction.side_of_sheet.front().size(), 0);
      for (const auto& [a, b] : junction.pairs) paired[a] = paired[b] = 1;
      for (std::size_t e = 0; e < junction.crowded.size(); ++e) {
        const CrowdedEdge& at = crowded_[junction.crowded[e]];
        for (std::size_t sheet = 0; sheet < paired.size(); ++sheet) {
          if (!paired[sheet]) ended_[part_of(at.sides[junction.side_of_sheet[e][sheet]])] += at.length;
        }
      }
    }
  }

  // Joins the chosen pairs, those first that turn nothing inside out.
  void join() {
    TurnedUnion parts(static_cast<Index>(joined_.orientable.size()));
    for (const bool turned : {false, true}) {
      for (const SheetJunction& junction : junctions_) {
        for (const SheetPair& pair : junction.pairs) {
          if (turns(junction, pair) == turned) join(junction, pair, parts);
        }
      }
    }
  }

 private:
  const Index* corners() const { return surface_.triangles.data(); }
  Index part_of(const SheetSide& side) const { return joined_.part[side.halfedge / 3]; }

  void add(Index edge) {
    const Index any = edges_.halfedge(edge, 0);
    const auto [low, high] = std::minmax(corners()[any], corners()[next(any)]);
    const Vector3 origin = surface_.positions.row(low), vector = surface_.positions.row(high).transpose() - origin;
    CrowdedEdge out{edge, vector.norm(), vector.normalized(), {}};
    for (Index i = 0; i < edges_.halfedge_count(edge); ++i) {
      const Index h = edges_.halfedge(edge, i), opposite = corners()[prev(h)], f = h / 3;
      const Vector3 to = surface_.positions.row(opposite).transpose() - origin;
      const Vector3 away = to - out.along * out.along.dot(to);
      const double size = away.norm();
      const bool runs_up = corners()[h] == low;
      out.sides.push_back(
          {h, opposite, size > 0 ? Vector3(away / size) : Vector3::Zero(), runs_up != (joined_.reversed[f] != 0)});
    }
    std::sort(out.sides.begin(), out.sides.end(),
              [](const SheetSide& a, const SheetSide& b) { return a.opposite < b.opposite; });
    crowded_of_edge_[edge] = static_cast<Index>(crowded_.size());
    first_side_.push_back(side_count_);
    side_count_ += static_cast<Index>(out.sides.size());
    crowded_.push_back(std::move(out));
  }

  // The halfedge at another crowded edge to which triangles lead that follow each other about a vertex, from one at a
  // crowded edge; none if the surface ends before.
  Index about_vertex(Index h, Index vertex) const {
    while (true) {
      const Index beside = corners()[h] == vertex ? prev(h) : next(h);
      if (crowded_of_edge_[edges_.edge_of(beside)] != none) return beside;
      h = twin_[beside];
      if (h == none) return none;
    }
  }

  Index side_at(Index crowded, Index halfedge) const {
    const Array<SheetSide>& sides = crowded_[crowded].sides;
    const Index opposite = corners()[prev(halfedge)];
    const auto at = std::lower_bound(sides.begin(), sides.end(), opposite,
                                     [](const SheetSide& side, Index vertex) { return side.opposite < vertex; });
    return static_cast<Index>(at - sides.begin());
  }

  // Unites the sides of an edge with those of the next one beyond a vertex if all lead to the same.
  void link(Index crowded, Index vertex, UnionFind& junctions, UnionFind& sheets) const {
    const CrowdedEdge& from = crowded_[crowded];
    Array<SheetPair> reached;
    Index other = none;
    for (const SheetSide& side : from.sides) {
      const Index at = about_vertex(side.halfedge, vertex);
      if (at == none) return;
      const Index leads_to = crowded_of_edge_[edges_.edge_of(at)];
      if (leads_to == crowded || (other != none && leads_to != other)) return;
      other = leads_to;
      reached.emplace_back(static_cast<Index>(reached.size()), side_at(other, at));
    }
    if (crowded_[other].sides.size() != from.sides.size()) return;
    junctions.unite(crowded, other);
    for (const auto& [a, b] : reached) sheets.unite(first_side_[crowded] + a, first_side_[other] + b);
  }

  void find_junctions() {
    UnionFind junctions(static_cast<Index>(crowded_.size())), sheets(side_count_);
    for (Index i = 0; i < ssize(crowded_); ++i) {
      const Index h = edges_.halfedge(crowded_[i].edge, 0);
      for (const Index vertex : {corners()[h], corners()[next(h)]}) link(i, vertex, junctions, sheets);
    }
    Array<Array<Index>> members(crowded_.size());
    for (Index i = 0; i < ssize(crowded_); ++i) members[junctions.find(i)].push_back(i);
    for (const Array<Index>& row : members) {
      if (row.empty()) continue;
      SheetJunction whole{row, {}, {}};
      if (order_sheets(whole, sheets)) {
        junctions_.push_back(std::move(whole));
        continue;
      }
      for (const Index i : row) {
        SheetJunction single{{i}, {Array<Index>(crowded_[i].sides.size())}, {}};
        for (std::size_t k = 0; k < crowded_[i].sides.size(); ++k) single.side_of_sheet[0][k] = static_cast<Index>(k);
        junctions_.push_back(std::move(single));
      }
    }
  }

  // False if a sheet comes back to an edge as another one.
  bool order_sheets(SheetJunction& junction, UnionFind& sheets) const {
    const Index first = junction.crowded.front(), count = static_cast<Index>(crowded_[first].sides.size());
    Array<SheetPair> order;
    for (Index k = 0; k < count; ++k) order.emplace_back(sheets.find(first_side_[first] + k), k);
    std::sort(order.begin(), order.end());
    for (Index k = 1; k < count; ++k) {
      if (order[k].first == order[k - 1].first) return false;
    }
    for (const Index i : junction.crowded) {
      Array<Index> sides(count, none);
      for (Index k = 0; k < count; ++k) {
        const Index root = sheets.find(first_side_[i] + k);
        const auto at = std::lower_bound(order.begin(), order.end(), SheetPair(root, none));
        sides[at->second] = k;
      }
      junction.side_of_sheet.push_back(std::move(sides));
    }
    return true;
  }

  void measure_parts() {
    const std::size_t count = joined_.orientable.size();
    free_.assign(count, 0);
    shared_.assign(count, 0);
    ended_.assign(count, 0);
    for (Index edge = 0; edge < edges_.count(); ++edge) {
      const Index h = edges_.halfedge(edge, 0);
      if (crowded_of_edge_[edge] != none || twin_[h] != none) continue;
      const auto [low, high] = std::minmax(corners()[h], corners()[next(h)]);
      const double length = (surface_.positions.row(high) - surface_.positions.row(low)).norm();
      for (Index i = 0; i < edges_.halfedge_count(edge); ++i) {
        free_[joined_.part[edges_.halfedge(edge, i) / 3]] += length;
      }
    }
    for (const CrowdedEdge& at : crowded_) {
      for (const SheetSide& side : at.sides) shared_[part_of(side)] += at.length;
    }
    // A part whose triangles are oriented either way says less about which of its sides is outside.
    Array<Index> triangles(count, 0), reversed(count, 0);
    for (std::size_t f = 0; f < joined_.part.size(); ++f) {
      if (joined_.part[f] == none) continue;
      ++triangles[joined_.part[f]];
      reversed[joined_.part[f]] += joined_.reversed[f] != 0;
    }
    certainty_.assign(count, 1);
    for (std::size_t p = 0; p < count; ++p) certainty_[p] = 1 - 2.0 * reversed[p] / triangles[p];
  }

  double ends(Index part) const {
    const double all = free_[part] + shared_[part];
    return all > 0 ? (free_[part] + ended_[part]) / all : 0;
  }

  static double bend(const SheetSide& a, const SheetSide& b) {
    if (a.away.isZero(0) || b.away.isZero(0)) return M_PI / 2;
    return std::atan2(a.away.cross(b.away).norm(), -a.away.dot(b.away));
  }

  double cost(const SheetSide& a, const SheetSide& b) {
    const Index part_a = part_of(a), part_b = part_of(b);
    double sum = bend(a, b);
    if (a.with_edge == b.with_edge) {
      sum += inside_out * (part_a == part_b ? 1 : std::min(certainty_[part_a], certainty_[part_b]));
    }
    if (merged_.find(part_a) != merged_.find(part_b)) sum += slit_of_part + all_ends * (ends(part_a) + ends(part_b));
    return sum;
  }

  struct PairOfSheets {
    double cost;
    Index a, b;
    double bend;
    bool operator<(const PairOfSheets& other) const {
      return std::tie(cost, a, b) < std::tie(other.cost, other.a, other.b);
    }
  };

  // Of all pairs of sheets the mean over the edges by their length, the cheapest first.
  Array<PairOfSheets> candidates(const SheetJunction& junction) {
    const Index count = static_cast<Index>(junction.side_of_sheet.front().size());
    double length = 0;
    for (const Index i : junction.crowded) length += crowded_[i].length;
    Array<PairOfSheets> out;
    for (Index a = 0; a < count; ++a) {
      for (Index b = a + 1; b < count; ++b) {
        PairOfSheets pair{0, a, b, 0};
        for (std::size_t e = 0; e < junction.crowded.size(); ++e) {
          const CrowdedEdge& at = crowded_[junction.crowded[e]];
          const SheetSide &one = side(junction, e, a), &other = side(junction, e, b);
          const double share = length > 0 ? at.length / length : 1;
          pair.cost += share * cost(one, other);
          pair.bend += share * bend(one, other);
        }
        out.push_back(pair);
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  Array<SheetPair> best_pairs(const SheetJunction& junction) {
    Array<SheetPair> pairs;
    Array<char> taken(junction.side_of_sheet.front().size(), 0);
    const Array<PairOfSheets> all = candidates(junction);
    const bool is_corner = all[0].bend >= corner_bend;
    if (is_corner && all[1].cost < all[0].cost + corner_bend) return {};
    for (const PairOfSheets& pair : all) {
      if (taken[pair.a] || taken[pair.b] || (!pairs.empty() && pair.bend >= corner_bend)) continue;
      taken[pair.a] = taken[pair.b] = 1;
      pairs.emplace_back(pair.a, pair.b);
    }
    return pairs;
  }

  const SheetSide& side(const SheetJunction& junction, std::size_t e, Index sheet) const {
    return crowded_[junction.crowded[e]].sides[junction.side_of_sheet[e][sheet]];
  }

  bool turns(const SheetJunction& junction, const SheetPair& pair) const {
    return side(junction, 0, pair.first).with_edge == side(junction, 0, pair.second).with_edge;
  }

  void join(const SheetJunction& junction, const SheetPair& pair, TurnedUnion& parts) {
    for (std::size_t e = 0; e < junction.crowded.size(); ++e) {
      const SheetSide &a = side(junction, e, pair.first), &b = side(junction, e, pair.second);
      const Index part_a = part_of(a), part_b = part_of(b);
      if (!joined_.orientable[part_a] || !joined_.orientable[part_b]) continue;
      if (!parts.unite(part_a, part_b, a.with_edge == b.with_edge)) continue;
      twin_[a.halfedge] = b.halfedge;
      twin_[b.halfedge] = a.halfedge;
    }
  }

  const Surface& surface_;
  const EdgeTable& edges_;
  const JoinedParts& joined_;
  PerHalfedge<Index>& twin_;
  Array<CrowdedEdge> crowded_;
  PerEdge<Index> crowded_of_edge_;
  Array<Index> first_side_;  // number of the first side of each crowded edge, of all sides
  Index side_count_ = 0;
  Array<SheetJunction> junctions_;
  UnionFind merged_{0};  // parts that are joined at junctions so far
  // Lengths of where parts end anyway, of their crowded edges, and of those at which they end as chosen.
  PerPart<double> free_, shared_, ended_;
  PerPart<double> certainty_;  // of parts' orientation
};

}  // namespace

void continue_sheets(const Surface& surface, const EdgeTable& edges, const PerEdge<char>& crowded,
                     const JoinedParts& joined, PerHalfedge<Index>& twin) {
  SheetMatching matching(surface, edges, crowded, joined, twin);
  for (int round = 0; round < rounds; ++round) {
    matching.choose();
    matching.note_ends();
  }
  matching.join();
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pieces/regroup.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "division/cut_apart.hpp"
#include "pieces/candidate_cuts.hpp"
#include "pieces/division_price.hpp"
#include "pieces/piece_graph.hpp"
#include "plane/boundary_polygon.hpp"
#include "plane/coverage_raster.hpp"

namespace lsgp {

namespace {

constexpr double raster_cells = 32768;  // in the layout's area
constexpr double explained_cells = 3;   // of the raster that two pieces may share beside each other
// Of the sum of the squares of the islands' shares of the area: pieces move to larger islands, until the smaller ones
// are used up.
constexpr double worth_of_large = 4;
constexpr double least_saving = 1e-3;    // of the score
constexpr double longest_detour = 0.3;   // cost of the cuts that make room, in square roots of the area
constexpr int most_tries = 6;            // of the best steps, which are tested exactly
constexpr double most_operations = 5e8;  // roughly
constexpr double operations_on_raster = 30, operations_of_test = 400;  // of boundaries: on the raster, and exactly

// Sides of pieces that have moved.
class MovedSides {
 public:
  void add(const Array<PieceGraph::Side>& boundary, const Motion& motion) {
    const Complex turn = std::polar(1.0, motion.angle);
    for (const PieceGraph::Side& side : boundary)
      sides_.push_back({turn * side.tail + motion.shift, turn * side.head + motion.shift});
  }
  CoverageRaster raster(double cell) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box frame{infinity, -infinity, infinity, -infinity};
    for (const auto& [z, _] : sides_) frame = around(frame, {z.real(), z.real(), z.imag(), z.imag()});
    CoverageRaster out(frame, cell);
    for (const auto& [tail, head] : sides_) out.add(tail, head);
    out.sum_up();
    return out;
  }
  std::size_t count() const { return sides_.size(); }

 private:
  Array<PieceGraph::Side> sides_;
};

// The pieces of a map assembled to islands, none of which overlaps itself.
class Regrouper {
 public:
  // corners: of the map, which covers so much area.
  Regrouper(const MetricMesh& surface, PieceGraph graph, const Eigen::VectorXcd& corners, double map_area);

  // Returns whether anything has changed.
  bool improve(Regrouping steps);

  PerHalfedge<char> cuts() const { return cuts_along(graph_, mesh_, now_.open); }  // on both sides
  Array<Index> required_cuts() const;                                              // one halfedge of each edge
  const PerPart<Motion>& motion() const { return now_.motion; }
  const PerTriangle<Index>& piece_of() const { return graph_.piece_of; }

 private:
  using Path = PieceGraph::Path;

  struct State {
    Array<char> in_tree, open;  // (paths)
    PerPart<Motion> motion;     // of pieces
    PerPart<Index> island;      // of pieces
    Index islands = 0;
    double score = 0;
  };

  // Connected pieces of an island join another one across a path, and the rest of their own stays behind.
  struct Join {
    Index path;
    Motion motion;
    Array<Index> pieces;
    double score;
  };

  void span(State& state) const;
  double cost_of(const Array<char>& open) const;
  double score_of(const State& state) const;
  Motion to_meet(const Path& path) const {
    return now_.motion[path.right] * path.across * now_.motion[path.left].inverse();
  }
  CoverageRaster raster_of(const PerPart<char>& is_in);
  double shared(const CoverageRaster& raster, Index piece, const Motion& motion);
  bool overlaps(const State& state, Index island);
  State after(const Join& join) const;
  Array<Index> fitting_pieces(Index seed, const CoverageRaster& rest, const Motion& motion);
  Array<Join> find_joins();
  bool join_once();
  bool join();
  PerPart<char> pieces_behind(Index opened) const;
  template <typename Visit>
  bool visit_exchanges(Index opened, double most_cost, Visit visit);
  bool exchange();
  bool settle();
  bool make_detours();
  bool is_spent() const { return operations_ >= most_operations; }
  void spend(double operations) {
    operations_ += operations;
    checkpoint(operations);
  }

  const HalfedgeMesh& mesh_;
  const PieceGraph graph_;
  const Eigen::VectorXcd& corners_;
  const double cell_, root_area_;
  const PerPart<Array<Index>> paths_of_;  // that lead to other pieces
  PerPart<Array<Index>> ends_;            // halfedges at which pieces end
  PerPart<double> area_;                  // shares of the whole
  PerHalfedge<Index> path_of_;            // none elsewhere
  State now_;
  double operations_ = 0;

  // Scratch memory with these values between calls.
  PerHalfedge<char> is_traced_;  // 0
  PerPart<char> is_reached_;     // 0
};

Regrouper::Regrouper(const MetricMesh& surface, PieceGraph graph, const Eigen::VectorXcd& corners, double map_area)
    : mesh_(surface.mesh),
      graph_(std::move(graph)),
      corners_(corners),
      cell_(std::sqrt(map_area / raster_cells)),
      root_area_(std::sqrt(surface.geometry.total_area)),
      paths_of_(paths_of_pieces(graph_)),
      ends_(graph_.piece_count()),
      area_(graph_.piece_count(), 0),
      path_of_(surface.mesh.halfedge_count(), none),
      is_traced_(surface.mesh.halfedge_count(), 0),
      is_reached_(graph_.piece_count(), 0) {
  for (Index p = 0; p < ssize(graph_.paths); ++p) {
    for (const Index h : graph_.paths[p].halfedges) path_of_[h] = path_of_[mesh_.twin[h]] = p;
    now_.open.push_back(graph_.paths[p].is_cut);
  }
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (mesh_.twin[h] == none || path_of_[h] != none) ends_[graph_.piece_of[h / 3]].push_back(h);
  }
  for (Index f = 0; f < mesh_.triangle_count(); ++f) {
    area_[graph_.piece_of[f]] += surface.geometry.area[f] / surface.geometry.total_area;
  }
  now_.motion.resize(graph_.piece_count());
  span(now_);
}

// Connects the pieces of each island along paths that are not open.
void Regrouper::span(State& state) const {
  state.in_tree.assign(graph_.paths.size(), 0);
  state.island.assign(graph_.piece_count(), none);
  state.islands = 0;
  Array<Index> front;
  for (Index seed = 0; seed < graph_.piece_count(); ++seed) {
    if (state.island[seed] != none) continue;
    state.island[seed] = state.islands;
    front.assign(1, seed);
    for (std::size_t i = 0; i < front.size(); ++i) {
      for (const Index p : paths_of_[front[i]]) {
        const Index other = graph_.paths[p].across_from(front[i]);
        if (state.open[p] || state.island[other] != none) continue;
        state.island[other] = state.islands;
        state.in_tree[p] = 1;
        front.push_back(other);
      }
    }
    ++state.islands;
  }
  state.open = open_paths(graph_, state.in_tree);
  state.score = score_of(state);
}

// Relative to the square root of the area.
double Regrouper::cost_of(const Array<char>& open) const { return cost_of_cuts(graph_, open) / root_area_; }

double Regrouper::score_of(const State& state) const {
  PerPart<double> area(state.islands, 0);
  for (Index piece = 0; piece < graph_.piece_count(); ++piece) area[state.island[piece]] += area_[piece];
  double out = cost_of(state.open);
  for (const double own : area) {
    out += cuts_for_island + (own < sliver ? cost_of_sliver : 0) - worth_of_large * own * own;
  }
  return out;
}

CoverageRaster Regrouper::raster_of(const PerPart<char>& is_in) {
  MovedSides sides;
  for (Index piece = 0; piece < graph_.piece_count(); ++piece) {
    if (is_in[piece]) sides.add(graph_.boundary[piece], now_.motion[piece]);
  }
  spend(operations_on_raster * static_cast<double>(sides.count()));
  return sides.raster(cell_);
}

// In cells.
double Regrouper::shared(const CoverageRaster& raster, Index piece, const Motion& motion) {
  const Motion whole = motion * now_.motion[piece];
  const Complex turn = std::polar(1.0, whole.angle);
  double out = 0;
  for (const PieceGraph::Side& side : graph_.boundary[piece]) {
    out += raster.shared(turn * side.tail + whole.shift, turn * side.head + whole.shift);
  }
  spend(operations_on_raster * static_cast<double>(graph_.boundary[piece].size()));
  return out / (cell_ * cell_);
}

// Exactly, from the boundary.
bool Regrouper::overlaps(const State& state, Index island) {
  Array<Index> ends;
  for (Index piece = 0; piece < graph_.piece_count(); ++piece) {
    if (state.island[piece] == island) ends.insert(ends.end(), ends_[piece].begin(), ends_[piece].end());
  }
  const auto ends_at = [&](Index h) {
    return mesh_.twin[h] == none || (path_of_[h] != none && state.open[path_of_[h]]);
  };
  // Halfedges of one piece follow each other.
  Index piece = none;
  Motion moved;
  Complex turn = 1;
  const auto position_of = [&](Index h) {
    if (graph_.piece_of[h / 3] != piece) {
      piece = graph_.piece_of[h / 3];
      moved = state.motion[piece];
      turn = std::polar(1.0, moved.angle);
    }
    return turn * corners_[h] + moved.shift;
  };
  const BoundaryPolygon boundary(mesh_, ends, ends_at, position_of, is_traced_);
  spend(operations_of_test * static_cast<double>(ends.size()));
  return boundary.has_overlap();
}

Regrouper::State Regrouper::after(const Join& join) const {
  State out = now_;
  PerPart<char> moves(graph_.piece_count(), 0);
  for (const Index piece : join.pieces) {
    moves[piece] = 1;
    out.motion[piece] = join.motion * now_.motion[piece];
  }
  for (Index p = 0; p < ssize(graph_.paths); ++p) {
    const Path& path = graph_.paths[p];
    out.open[p] = p != join.path && (out.open[p] || moves[path.left] != moves[path.right]);
  }
  span(out);
  return out;
}

// The connected pieces around one that, moved, do not lie on the rest.
Array<Index> Regrouper::fitting_pieces(Index seed, const CoverageRaster& rest, const Motion& motion) {
  Array<Index> fitting, reached{seed};
  is_reached_[seed] = 1;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Index piece = reached[i];
    if (shared(rest, piece, motion) > explained_cells) continue;
    fitting.push_back(piece);
    for (const Index p : paths_of_[piece]) {
      const Index other = graph_.paths[p].across_from(piece);
      if (now_.open[p] || is_reached_[other]) continue;
      is_reached_[other] = 1;
      reached.push_back(other);
    }
  }
  for (const Index piece : reached) is_reached_[piece] = 0;
  return fitting;
}

// Those that improve the score, the best first.
Array<Regrouper::Join> Regrouper::find_joins() {
  Array<CoverageRaster> rasters;
  PerPart<char> is_in(graph_.piece_count());
  for (Index island = 0; island < now_.islands; ++island) {
    for (Index piece = 0; piece < graph_.piece_count(); ++piece) is_in[piece] = now_.island[piece] == island;
    rasters.push_back(raster_of(is_in));
  }
  Array<Join> joins;
  for (Index p = 0; p < ssize(graph_.paths); ++p) {
    const Path& path = graph_.paths[p];
    const Index islands[] = {now_.island[path.left], now_.island[path.right]};
    if (islands[0] == islands[1]) continue;
    const Motion motion = to_meet(path);
    for (const bool moves_left : {false, true}) {
      Join join{p, moves_left ? motion : motion.inverse(), {}, 0};
      const Index seed = moves_left ? path.left : path.right;
      join.pieces = fitting_pieces(seed, rasters[islands[moves_left]], join.motion);
      if (join.pieces.empty()) continue;
      join.score = after(join).score;
      if (join.score < now_.score - least_saving) joins.push_back(std::move(join));
    }
  }
  std::stable_sort(joins.begin(), joins.end(), [](const Join& a, const Join& b) { return a.score < b.score; });
  return joins;
}

bool Regrouper::join_once() {
  if (now_.islands < 2 || is_spent()) return false;
  int tries = 0;
  for (const Join& join : find_joins()) {
    if (++tries > most_tries) break;
    State next = after(join);
    if (overlaps(next, next.island[join.pieces.front()])) continue;
    now_ = std::move(next);
    return true;
  }
  return false;
}

bool Regrouper::join() {
  bool has_joined = false;
  while (join_once()) has_joined = true;  // each lowers the score
  return has_joined;
}

// Those left of a path of the tree when it opens.
PerPart<char> Regrouper::pieces_behind(Index opened) const {
  PerPart<char> is_in(graph_.piece_count(), 0);
  Array<Index> front{graph_.paths[opened].left};
  is_in[front[0]] = 1;
  for (std::size_t i = 0; i < front.size(); ++i) {
    for (const Index p : paths_of_[front[i]]) {
      const Index other = graph_.paths[p].across_from(front[i]);
      if (p == opened || !now_.in_tree[p] || is_in[other]) continue;
      is_in[other] = 1;
      front.push_back(other);
    }
  }
  return is_in;
}

// Calls visit(state) for states without overlap in which a path of the tree opens and another one closes, the cheapest
// first, until it returns true; then so does this.  most_cost: of all cuts.
template <typename Visit>
bool Regrouper::visit_exchanges(Index opened, double most_cost, Visit visit) {
  const PerPart<char> moves = pieces_behind(opened);
  const Index island = now_.island[graph_.paths[opened].left];
  Array<char> in_tree = now_.in_tree;
  in_tree[opened] = 0;
  Array<std::pair<double, Index>> closing;
  for (Index p = 0; p < ssize(graph_.paths); ++p) {
    const Path& path = graph_.paths[p];
    if (!now_.open[p] || now_.island[path.left] != island || now_.island[path.right] != island) continue;
    if (moves[path.left] == moves[path.right]) continue;
    in_tree[p] = 1;
    const double cost = cost_of(open_paths(graph_, in_tree));
    in_tree[p] = 0;
    if (cost <= most_cost) closing.emplace_back(cost, p);
  }
  if (closing.empty()) return false;
  std::sort(closing.begin(), closing.end());
  PerPart<char> rests(graph_.piece_count());
  for (Index piece = 0; piece < graph_.piece_count(); ++piece) {
    rests[piece] = now_.island[piece] == island && !moves[piece];
  }
  const CoverageRaster rest = raster_of(rests);
  for (const auto& [_, p] : closing) {
    const Path& path = graph_.paths[p];
    const Motion motion = moves[path.left] ? to_meet(path) : to_meet(path).inverse();
    State next = now_;
    double on_rest = 0;
    for (Index piece = 0; piece < graph_.piece_count() && on_rest <= explained_cells; ++piece) {
      if (!moves[piece]) continue;
      on_rest += shared(rest, piece, motion);
      next.motion[piece] = motion * now_.motion[piece];
    }
    if (on_rest > explained_cells) continue;
    next.in_tree = in_tree;
    next.in_tree[p] = 1;
    next.open = open_paths(graph_, next.in_tree);
    if (overlaps(next, island)) continue;
    next.score = score_of(next);
    if (visit(std::move(next))) return true;
  }
  return false;
}

// Cheaper cuts for the same islands.
bool Regrouper::exchange() {
  bool has_changed = false;
  const Index count = static_cast<Index>(graph_.paths.size());
  for (Index p = 0, unchanged = 0; unchanged < count && !is_spent(); p = (p + 1) % count, ++unchanged) {
    if (!now_.in_tree[p]) continue;
    const auto take = [&](State next) {
      now_ = std::move(next);
      return true;
    };
    if (!visit_exchanges(p, cost_of(now_.open) - least_saving, take)) continue;
    has_changed = true;
    unchanged = 0;
  }
  return has_changed;
}

bool Regrouper::settle() {
  bool has_changed = join();
  while (exchange()) {  // each round lowers the score
    has_changed = true;
    if (!join()) break;
  }
  return has_changed;
}

// Exchanges at some cost after which pieces can join other islands.
bool Regrouper::make_detours() {
  bool has_changed = false;
  const Index count = static_cast<Index>(graph_.paths.size());
  for (Index p = 0, unchanged = 0; unchanged < count; p = (p + 1) % count, ++unchanged) {
    if (now_.islands < 2 || is_spent()) break;
    if (!now_.in_tree[p]) continue;
    const auto try_to_join = [&](State next) {
      std::swap(now_, next);
      if (join() && now_.score < next.score - least_saving) return true;
      std::swap(now_, next);
      return false;
    };
    if (!visit_exchanges(p, cost_of(now_.open) + longest_detour, try_to_join)) continue;
    exchange();
    has_changed = true;
    unchanged = 0;
  }
  return has_changed;
}

bool Regrouper::improve(Regrouping steps) {
  bool has_changed = settle();
  if (steps == Regrouping::detours && make_detours()) has_changed = true;
  return has_changed;
}

// What is left if islands are connected, whether they then overlap or not, along the paths that cost most.
Array<Index> Regrouper::required_cuts() const {
  Array<std::pair<double, Index>> order;
  for (Index p = 0; p < ssize(graph_.paths); ++p) order.emplace_back(-graph_.paths[p].cost, p);
  std::sort(order.begin(), order.end());
  UnionFind islands(now_.islands);
  Array<char> in_tree = now_.in_tree;
  for (const auto& [_, p] : order) {
    const Index a = islands.find(now_.island[graph_.paths[p].left]);
    const Index b = islands.find(now_.island[graph_.paths[p].right]);
    if (a == b) continue;
    islands.unite(a, b);
    in_tree[p] = 1;
  }
  const PerHalfedge<char> is_cut = cuts_along(graph_, mesh_, open_paths(graph_, in_tree));
  Array<Index> out;
  for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
    if (is_cut[h] && h < mesh_.twin[h]) out.push_back(h);
  }
  return out;
}

}  // namespace

std::optional<ComponentMap> regroup(const MetricMesh& surface, const PerHalfedge<double>& factor, Regrouping steps,
                                    const ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  double area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) area += doubled_area(corners, f) / 2;
  if (!(area > 0)) return std::nullopt;
  const double resolution = std::sqrt(area / raster_cells) / 2;
  PieceGraph graph = build_piece_graph(surface, map, find_candidate_cuts(surface, map.cut_graph), resolution);
  for (PieceGraph::Path& path : graph.paths) {
    path.cost = 0;
    for (const Index h : path.halfedges) path.cost += surface.geometry.length[h] * (factor.empty() ? 1 : factor[h]);
  }
  Regrouper regrouper(surface, std::move(graph), corners, area);
  if (!regrouper.improve(steps)) return std::nullopt;
  ComponentMap out = map;
  cut_apart(mesh, regrouper.cuts(), regrouper.piece_of(), regrouper.motion(), out);
  out.required_cuts = regrouper.required_cuts();
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pieces/recut.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "base/checkpoint.hpp"
#include "division/cut_apart.hpp"
#include "pieces/candidate_cuts.hpp"
#include "pieces/piece_graph.hpp"
#include "plane/coverage_raster.hpp"

namespace lsgp {

namespace {

constexpr double cells_of_layout = 32768;  // of the raster, in the layout's area
// Weights of the cuts' relative cost in the score, one descent each. Descents with cheap cuts separate pieces that
// would otherwise remain entangled.
constexpr double weights[] = {1.5, 0.3, 0.7};
// Added to the score for any overlap, since even a small one requires another island; at this small share of the
// layout, half of that is added.
constexpr double any_overlap = 0.2, small_overlap = 1e-4;
constexpr double largest_cost = 1.25;      // of the given cuts
constexpr double least_score_gain = 1e-4;  // of the score
constexpr double most_work = 1e7;          // sides of boundary polygons visited
constexpr double operations_a_side = 30;   // of a boundary polygon on the raster
constexpr double sides_a_path = 0.7;       // that take as long as a path when open ones are looked for
constexpr double least_shared = 1e-6;      // of a cell, that is more than rounding

struct Circle {
  Complex center;
  double radius;
};

Circle circle_around(const Array<PieceGraph::Side>& boundary) {
  Circle out{0, 0};
  for (const PieceGraph::Side& side : boundary) out.center += side.tail / static_cast<double>(boundary.size());
  for (const PieceGraph::Side& side : boundary) out.radius = std::max(out.radius, std::abs(side.tail - out.center));
  return out;
}

Box box_around(Complex center, double radius) {
  return {center.real() - radius, center.real() + radius, center.imag() - radius, center.imag() + radius};
}

// The pieces of a layout assembled along a spanning tree, and trees with less overlap.
class Recutter {
 public:
  // area: of the layout.
  Recutter(PieceGraph graph, double area);

  // A layout and its quality.
  struct State {
    Array<char> in_tree;     // (paths) closed; one tree per island
    PerPart<Motion> motion;  // of pieces
    double overlap = 0, cost = 0;
  };

  // Layouts other than the given one, the best first.
  Array<State> search();

  // Whether a halfedge is cut, on both sides of an edge.
  PerHalfedge<char> cuts_of(const HalfedgeMesh& mesh, const State& state) const;
  const PerTriangle<Index>& piece_of() const { return graph_.piece_of; }

 private:
  using Path = PieceGraph::Path;
  enum class Side : char { elsewhere, moving, resting };

  // One path of the tree opens and another closes.
  struct Exchange {
    Index closed = none;
    Motion motion;
    double overlap = 0, cost = 0;
  };

  double score(double overlap, double cost, double weight) const {
    const double share = std::max(overlap, 0.0) / area_;
    return std::sqrt(share) + any_overlap * share / (share + small_overlap) + weight * (cost / first_cost_ - 1);
  }
  void span();
  double cost_of(const Array<char>& in_tree);
  double measure_overlap();
  void find_shared_with_others(const Array<Index>& island);
  void descend(double weight);
  Exchange best_exchange(Index opened, double weight, Array<Index>& moving);
  Array<Index> pieces_behind(Index opened, Index seed) const;
  std::size_t count_sides(const Array<Index>& pieces) const;
  template <typename Visit>
  void for_each_side(Index piece, const Motion& motion, Visit visit);
  Box frame_around(const Array<Index>& pieces) const;
  CoverageRaster raster_of(const Array<Index>& pieces) { return raster_of(pieces, frame_around(pieces), cell_); }
  CoverageRaster raster_of(const Array<Index>& pieces, const Box& frame, double cell);
  // What moved pieces share with those of a raster.  goes_on: whether more than this is of interest.
  template <typename GoesOn>
  double shared(const CoverageRaster& raster, const Array<Index>& pieces, const Motion& motion, GoesOn goes_on);

  const PieceGraph graph_;
  const double area_, cell_;
  PerPart<Array<Index>> paths_of_;  // that lead to other pieces
  PerPart<Circle> circles_;         // around the pieces where they were at first
  State now_;
  Array<char> is_open_;                 // (paths) in the current state
  PerPart<double> shared_with_others_;  // the area of each piece that others of its island cover in the current state
  double first_cost_ = 0;
  double work_ = 0;  // so far, in sides of boundary polygons
};

Recutter::Recutter(PieceGraph graph, double area)
    : graph_(std::move(graph)),
      area_(area),
      cell_(std::sqrt(area / cells_of_layout)),
      paths_of_(paths_of_pieces(graph_)),
      shared_with_others_(graph_.piece_count(), 0) {
  for (const auto& boundary : graph_.boundary) circles_.push_back(circle_around(boundary));
  now_.motion.resize(graph_.piece_count());
  span();
  first_cost_ = cost_of(now_.in_tree);
}

// Connects the pieces of each island along paths that are not cut.
void Recutter::span() {
  now_.in_tree.assign(graph_.paths.size(), 0);
  PerPart<char> is_reached(graph_.piece_count(), 0);
  Array<Index> front;
  for (Index seed = 0; seed < graph_.piece_count(); ++seed) {
    if (is_reached[seed]) continue;
    is_reached[seed] = 1;
    front.assign(1, seed);
    for (std::size_t i = 0; i < front.size(); ++i) {
      for (const Index p : paths_of_[front[i]]) {
        const Index other = graph_.paths[p].across_from(front[i]);
        if (graph_.paths[p].is_cut || is_reached[other]) continue;
        is_reached[other] = now_.in_tree[p] = 1;
        front.push_back(other);
      }
    }
  }
}

double Recutter::cost_of(const Array<char>& in_tree) {
  work_ += sides_a_path * static_cast<double>(in_tree.size());
  return cost_of_cuts(graph_, open_paths(graph_, in_tree));
}

// The pieces connected to a seed, which is the first, when a path of the tree is opened; if that is `none`, the whole
// island.
Array<Index> Recutter::pieces_behind(Index opened, Index seed) const {
  PerPart<char> is_reached(graph_.piece_count(), 0);
  is_reached[seed] = 1;
  Array<Index> out{seed};
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (const Index p : paths_of_[out[i]]) {
      const Index other = graph_.paths[p].across_from(out[i]);
      if (!now_.in_tree[p] || p == opened || is_reached[other]) continue;
      is_reached[other] = 1;
      out.push_back(other);
    }
  }
  return out;
}

std::size_t Recutter::count_sides(const Array<Index>& pieces) const {
  std::size_t count = 0;
  for (const Index piece : pieces) count += graph_.boundary[piece].size();
  return count;
}

// Calls visit(tail, head) for the sides of a piece in the current state, moved.
template <typename Visit>
void Recutter::for_each_side(Index piece, const Motion& motion, Visit visit) {
  const Motion whole = motion * now_.motion[piece];
  const Complex turn = std::polar(1.0, whole.angle);
  for (const PieceGraph::Side& side : graph_.boundary[piece]) {
    visit(turn * side.tail + whole.shift, turn * side.head + whole.shift);
  }
  const double sides = static_cast<double>(graph_.boundary[piece].size());
  work_ += sides;
  checkpoint(operations_a_side * sides);
}

Box Recutter::frame_around(const Array<Index>& pieces) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box frame{infinity, -infinity, infinity, -infinity};
  for (const Index piece : pieces) {
    const Complex z = now_.motion[piece](circles_[piece].center);
    frame = around(frame, box_around(z, circles_[piece].radius));
  }
  return frame;
}

CoverageRaster Recutter::raster_of(const Array<Index>& pieces, const Box& frame, double cell) {
  CoverageRaster raster(frame, cell);
  for (const Index piece : pieces) {
    for_each_side(piece, {}, [&](Complex tail, Complex head) { raster.add(tail, head); });
  }
  raster.sum_up();
  return raster;
}

template <typename GoesOn>
double Recutter::shared(const CoverageRaster& raster, const Array<Index>& pieces, const Motion& motion,
                        GoesOn goes_on) {
  double out = 0;
  for (const Index piece : pieces) {
    const Complex center = motion(now_.motion[piece](circles_[piece].center));
    if (!meet(raster.frame(), box_around(center, circles_[piece].radius))) continue;
    for_each_side(piece, motion, [&](Complex tail, Complex head) { out += raster.shared(tail, head); });
    if (!goes_on(out)) break;
  }
  return out;
}

// The overlap of every island with itself.
double Recutter::measure_overlap() {
  PerPart<char> is_measured(graph_.piece_count(), 0);
  double out = 0;
  for (Index seed = 0; seed < graph_.piece_count(); ++seed) {
    if (is_measured[seed]) continue;
    const Array<Index> island = pieces_behind(none, seed);
    for (const Index piece : island) is_measured[piece] = 1;
    out += raster_of(island).doubly_covered();
    find_shared_with_others(island);
  }
  return out;
}

// On rasters with the same cells, so that the difference is what the others cover of each piece, and 0 of one that no
// other lies on.
void Recutter::find_shared_with_others(const Array<Index>& island) {
  constexpr double most_cells_across = 512;  // fewer than a raster may have
  const auto always = [](double) { return true; };
  Box frame = frame_around(island);
  const double across = std::max(frame.right - frame.left, frame.top - frame.bottom);
  const double cell = std::max(cell_, across / most_cells_across);
  const auto on_cells = [cell](Box box) {
    box.left = cell * std::floor(box.left / cell);
    box.bottom = cell * std::floor(box.bottom / cell);
    return box;
  };
  const CoverageRaster whole = raster_of(island, on_cells(frame), cell);
  for (const Index piece : island) {
    const CoverageRaster alone = raster_of({piece}, on_cells(frame_around({piece})), cell);
    const double by_others = shared(whole, {piece}, {}, always) - shared(alone, {piece}, {}, always);
    shared_with_others_[piece] = by_others > least_shared * cell * cell ? by_others : 0;
  }
}

// The smaller side moves; overlaps within each side do not change.
Recutter::Exchange Recutter::best_exchange(Index opened, double weight, Array<Index>& moving) {
  moving = pieces_behind(opened, graph_.paths[opened].left);
  Array<Index> resting = pieces_behind(opened, graph_.paths[opened].right);
  if (count_sides(moving) > count_sides(resting)) std::swap(moving, resting);
  PerPart<Side> side(graph_.piece_count(), Side::elsewhere);
  for (const Index piece : moving) side[piece] = Side::moving;
  for (const Index piece : resting) side[piece] = Side::resting;
  // What others cover of these pieces and, if they cover any of them, what rasters with other cells differ by.
  double most_removed = 0;
  for (const Index piece : moving) most_removed += shared_with_others_[piece];
  if (most_removed > 0) most_removed += small_overlap * area_;
  Exchange best;
  double least = score(now_.overlap, now_.cost, weight) - least_score_gain;
  const auto gains = [&](double overlap, double cost) { return score(overlap, cost, weight) < least; };
  Array<Exchange> hopeful;
  Array<char> in_tree = now_.in_tree;
  in_tree[opened] = 0;
  for (Index p = 0; p < ssize(graph_.paths); ++p) {
    const Path& path = graph_.paths[p];
    const bool moves_left = side[path.left] == Side::moving;
    if (!is_open_[p] || side[moves_left ? path.right : path.left] != Side::resting) continue;
    if (!moves_left && side[path.right] != Side::moving) continue;
    in_tree[p] = 1;
    const double cost = cost_of(in_tree);
    in_tree[p] = 0;
    if (cost > largest_cost * first_cost_ || !gains(now_.overlap - most_removed, cost)) continue;
    const Motion to_meet = now_.motion[path.right] * path.across * now_.motion[path.left].inverse();
    hopeful.push_back({p, moves_left ? to_meet : to_meet.inverse(), 0, cost});
  }
  if (hopeful.empty()) return best;
  const CoverageRaster rest = raster_of(resting);
  const double without = now_.overlap - shared(rest, moving, {}, [](double) { return true; });
  for (Exchange& exchange : hopeful) {
    if (!gains(without, exchange.cost)) continue;
    const auto may_gain = [&](double so_far) { return gains(without + so_far, exchange.cost); };
    exchange.overlap = without + shared(rest, moving, exchange.motion, may_gain);
    if (!gains(exchange.overlap, exchange.cost)) continue;
    least = score(exchange.overlap, exchange.cost, weight);
    best = exchange;
  }
  return best;
}

// Makes the best exchange for each path of the tree in turn, until none improves the score.
void Recutter::descend(double weight) {
  now_.overlap = measure_overlap();
  now_.cost = cost_of(now_.in_tree);
  is_open_ = open_paths(graph_, now_.in_tree);
  Array<Index> moving;
  const Index count = static_cast<Index>(graph_.paths.size());
  for (Index p = 0, tried = 0; tried < count && work_ < most_work; p = (p + 1) % count, ++tried) {
    if (!now_.in_tree[p]) continue;
    const Exchange exchange = best_exchange(p, weight, moving);
    if (exchange.closed == none) continue;
    now_.in_tree[p] = 0;
    now_.in_tree[exchange.closed] = 1;
    for (const Index piece : moving) now_.motion[piece] = exchange.motion * now_.motion[piece];
    now_.overlap = exchange.overlap;
    now_.cost = exchange.cost;
    is_open_ = open_paths(graph_, now_.in_tree);
    find_shared_with_others(pieces_behind(none, moving.front()));
    tried = 0;
  }
}

Array<Recutter::State> Recutter::search() {
  const State first = now_;
  Array<State> found;
  for (const double weight : weights) {
    descend(weight);
    const auto is_same = [&](const State& state) { return state.in_tree == now_.in_tree; };
    if (is_same(first) || std::any_of(found.begin(), found.end(), is_same)) continue;
    found.push_back(now_);
  }
  const auto own_score = [&](const State& state) { return score(state.overlap, state.cost, weights[0]); };
  std::stable_sort(found.begin(), found.end(),
                   [&](const State& a, const State& b) { return own_score(a) < own_score(b); });
  return found;
}

PerHalfedge<char> Recutter::cuts_of(const HalfedgeMesh& mesh, const State& state) const {
  return cuts_along(graph_, mesh, open_paths(graph_, state.in_tree));
}

}  // namespace

Array<ComponentMap> recut(const MetricMesh& surface, const Array<MetricMesh>& costs, const ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  double area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) area += doubled_area(corners, f) / 2;
  if (!(area > 0)) return {};
  const double resolution = std::sqrt(area / cells_of_layout) / 2;
  PieceGraph graph = build_piece_graph(surface, map, find_candidate_cuts(surface, map.cut_graph), resolution);
  Array<ComponentMap> out;
  for (const MetricMesh& own : costs) {
    price_paths(own, graph);
    Recutter recutter(graph, area);
    for (const Recutter::State& state : recutter.search()) {
      out.push_back(map);
      cut_apart(mesh, recutter.cuts_of(mesh, state), recutter.piece_of(), state.motion, out.back());
      out.back().required_cuts = halfedges_of(out.back().cut_graph);
    }
  }
  return out;
}

}  // namespace lsgp

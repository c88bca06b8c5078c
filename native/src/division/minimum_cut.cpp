// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/minimum_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/least_first.hpp"
#include "base/radix_order.hpp"

namespace lsgp {

namespace {

using Units = FaceGraph::Units;

constexpr double enough_area = 0.02;  // of the surface, from which on parts need not be larger
constexpr double least_area = 1e-16;  // of the surface: smaller areas are lost in the sum
constexpr Index most_cells = 10000;   // among which a cut is searched before its neighborhood is
constexpr double cell_detour = 1.5;   // by which a cut between cells may be longer than the shortest one

constexpr Index first_cell = 0, second_cell = 1;  // the cells to be separated

using Edge = SmallestCut::Edge;

}  // namespace

// Cells of faces. The first two are to be separated.
struct MinimumCutter::Cells {
  Array<double> area;
  Array<Edge> edges;  // one between any two neighbors, sorted

  Index count() const { return static_cast<Index>(area.size()); }

  // all: between different cells.
  void collect(Array<Edge>& all) {
    Array<Index> begin(count() + 1, 0);
    for (Edge& edge : all) {
      if (edge.nodes[0] > edge.nodes[1]) std::swap(edge.nodes[0], edge.nodes[1]);
      ++begin[edge.nodes[0] + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    Array<Index> cursor(begin.begin(), begin.end() - 1);
    Array<Edge> sorted(all.size());
    for (const Edge& edge : all) sorted[cursor[edge.nodes[0]]++] = edge;
    for (Index cell = 0; cell < count(); ++cell) {
      std::sort(sorted.begin() + begin[cell], sorted.begin() + begin[cell + 1],
                [](const Edge& a, const Edge& b) { return a.nodes[1] < b.nodes[1]; });
    }
    edges.clear();
    for (const Edge& edge : sorted) {
      if (!edges.empty() && edges.back().nodes[0] == edge.nodes[0] && edges.back().nodes[1] == edge.nodes[1])
        edges.back().capacity += edge.capacity;
      else
        edges.push_back(edge);
    }
  }

  // The edges of every cell: offsets into the list, and the list.
  std::pair<Array<Index>, Array<Index>> by_cell() const {
    Array<Index> begin(count() + 1, 0), list(2 * edges.size());
    for (const Edge& edge : edges) {
      for (const Index cell : edge.nodes) ++begin[cell + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    Array<Index> cursor(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (const Index cell : edges[i].nodes) list[cursor[cell]++] = static_cast<Index>(i);
    }
    return {std::move(begin), std::move(list)};
  }

  // Merges pairs of neighbors, preferring those with the longest common boundary for their size. Returns the new cell
  // of every cell.
  Array<Index> coarsen() {
    const auto [begin, list] = by_cell();
    Array<Index> merged(count(), none);
    merged[first_cell] = first_cell;
    merged[second_cell] = second_cell;
    Index merged_count = 2;
    for (const Index cell : radix_order(area)) {
      if (merged[cell] != none) continue;
      Index best = none;
      double longest = 0;
      for (Index i = begin[cell]; i < begin[cell + 1]; ++i) {
        const Edge& edge = edges[list[i]];
        const Index other = edge.nodes[edge.nodes[0] == cell];
        if (merged[other] != none) continue;
        const double length = static_cast<double>(edge.capacity) / std::sqrt(area[other]);
        if (best != none && length <= longest) continue;
        best = other;
        longest = length;
      }
      merged[cell] = merged_count++;
      if (best != none) merged[best] = merged[cell];
    }
    Array<double> areas(merged_count, 0);
    for (Index cell = 0; cell < count(); ++cell) areas[merged[cell]] += area[cell];
    area = std::move(areas);
    Array<Edge> all;
    for (const auto& [cells, length] : edges) {
      if (merged[cells[0]] != merged[cells[1]]) all.push_back({{merged[cells[0]], merged[cells[1]]}, length});
    }
    collect(all);
    return merged;
  }

  // The cells nearer to each of the first two, the nearest first.
  std::array<Array<Index>, 2> by_distance() const {
    struct Reached {
      double distance;
      Index cell, side;
      bool operator>(const Reached& other) const {
        return distance != other.distance ? distance > other.distance : cell > other.cell;
      }
    };
    const auto [begin, list] = by_cell();
    Array<double> distance(count(), std::numeric_limits<double>::infinity());
    Array<char> is_done(count(), 0);
    LeastFirst<Reached> queue;
    for (const Index side : {first_cell, second_cell}) {
      distance[side] = 0;
      queue.push({0, side, side});
    }
    std::array<Array<Index>, 2> out;
    while (!queue.empty()) {
      const Reached nearest = queue.top();
      queue.pop();
      const Index cell = nearest.cell;
      if (is_done[cell]) continue;
      is_done[cell] = 1;
      if (cell > second_cell) element(out, nearest.side).push_back(cell);
      const double own = cell > second_cell ? std::sqrt(area[cell]) : 0;
      for (Index i = begin[cell]; i < begin[cell + 1]; ++i) {
        const Edge& edge = edges[list[i]];
        const Index other = edge.nodes[edge.nodes[0] == cell];
        const double through = nearest.distance + own + std::sqrt(area[other]);
        if (other <= second_cell || through >= distance[other]) continue;
        distance[other] = through;
        queue.push({through, other, nearest.side});
      }
    }
    return out;
  }
};

double MinimumCutter::enough() const { return enough_area * graph_.total_area; }

double MinimumCutter::cost(Units length, double smaller_area) const {
  const double area = std::clamp(smaller_area, least_area * graph_.total_area, enough());
  switch (rule_) {
    case CutCost::no_slivers: return static_cast<double>(length) / std::sqrt(area);
    case CutCost::no_small_parts: return static_cast<double>(length) / area;
    default: return static_cast<double>(length);
  }
}

MinimumCutter::Cells MinimumCutter::cells_of(const Array<Index>& scope, const Array<Index>& cell_of_place,
                                             Index count) const {
  Cells cells;
  cells.area.assign(count, 0);
  Array<Edge> edges;
  for (std::size_t i = 0; i < scope.size(); ++i) {
    cells.area[cell_of_place[i]] += graph_.area[scope[i]];
    graph_.for_each_link(scope[i], [&](Index other, const FaceGraph::Link& link) {
      if (place_[other] == none || link.faces[0] != scope[i]) return;
      const Index own = cell_of_place[i], beside = cell_of_place[place_[other]];
      if (own != beside) edges.push_back({{own, beside}, link.cost});
    });
  }
  cells.collect(edges);
  return cells;
}

// A length at which a cut costs at least so much, however large the parts are.
Units MinimumCutter::useless_length(double least_cost) const {
  constexpr double longest = 1e18, rounding = 1e-12;
  const double length = 1 + (1 + rounding) * least_cost / cost(1, enough());
  return length < longest ? static_cast<Units>(length) : std::numeric_limits<Units>::max();
}

// Those that cost less than `best`, and at most `slack` times what the cheapest does.
Array<MinimumCutter::CellCut> MinimumCutter::cut_cells(const Cells& cells, double slack, double best) const {
  SmallestCut network(cells.count(), cells.edges);
  network.add_to_first(first_cell);
  network.add_to_second(second_cell);
  const double total = std::accumulate(cells.area.begin(), cells.area.end(), 0.0);
  Array<CellCut> out;
  const auto is_useless = [&](Units length) { return cost(length, enough()) >= slack * best; };
  const auto judge = [&](const SmallestCut& solved, Units length, const Array<char>& is_held) {
    CellCut cut{solved.first_side(), is_held, 0};
    double area = 0;
    for (Index cell = 0; cell < cells.count(); ++cell) area += cut.is_first[cell] ? cells.area[cell] : 0;
    cut.cost = cost(length, std::min(area, total - area));
    if (cut.cost < slack * best) {
      best = std::min(best, cut.cost);
      out.push_back(std::move(cut));
    }
    return std::array<double, 2>{area, total - area};
  };
  Array<char> is_held(cells.count(), 0);
  is_held[first_cell] = is_held[second_cell] = 1;
  const Units least = network.find_smallest(useless_length(slack * best));
  if (is_useless(least)) return out;
  const std::array<double, 2> least_areas = judge(network, least, is_held);
  if (rule_ == CutCost::shortest) return out;
  // Cuts further away from the sets to be separated, on one side or on both, which leave larger parts.
  const std::array<Array<Index>, 2> nearest = cells.by_distance();
  for (const std::array<bool, 2> grows : {std::array{true, false}, std::array{false, true}, std::array{true, true}}) {
    SmallestCut grown = network;
    Units length = least;
    Array<char> held = is_held;
    std::array<double, 2> areas = least_areas, taken{cells.area[first_cell], cells.area[second_cell]};
    std::array<std::size_t, 2> next{0, 0};
    for (;;) {
      bool has_grown = false;
      for (const std::size_t side : {0u, 1u}) {
        const double target = std::min(2 * areas[side], enough());
        if (!grows[side] || areas[side] >= enough()) continue;
        for (; next[side] < nearest[side].size() && taken[side] < target; ++next[side]) {
          const Index cell = nearest[side][next[side]];
          taken[side] += cells.area[cell];
          held[cell] = 1;
          side == 0 ? grown.add_to_first(cell) : grown.add_to_second(cell);
          has_grown = true;
        }
      }
      if (!has_grown || is_useless(length)) break;
      length = grown.find_smallest(useless_length(slack * best));
      if (is_useless(length)) break;
      areas = judge(grown, length, held);
    }
  }
  out.erase(std::remove_if(out.begin(), out.end(), [&](const CellCut& cut) { return cut.cost > slack * best; }),
            out.end());
  return out;
}

MinimumCut MinimumCutter::cut(const Array<Index>& scope, const Array<Index>& first, const Array<Index>& second,
                              double cost_to_beat) {
  for (std::size_t i = 0; i < scope.size(); ++i) place_[scope[i]] = static_cast<Index>(i);
  Array<Index> cell(scope.size(), none);
  for (const Index face : first) cell[place_[face]] = first_cell;
  for (const Index face : second) cell[place_[face]] = second_cell;
  Index count = 2;
  for (Index& c : cell) {
    if (c == none) c = count++;
  }
  Cells cells = cells_of(scope, cell, count);
  int halvings = 0;
  while (cells.count() > most_cells) {
    const Index before = cells.count();
    const Array<Index> merged = cells.coarsen();
    for (Index& c : cell) c = merged[c];
    ++halvings;
    if (cells.count() > 0.9 * before) break;
  }
  const int rings = 2 + static_cast<int>(2 * std::exp2(halvings / 2.0));  // cells are about so wide, twice
  MinimumCut best{Array<char>(scope.size(), 0)};
  constexpr double any = std::numeric_limits<double>::infinity();
  const bool is_fine = halvings == 0;  // cuts between cells are those between faces
  for (const CellCut& coarse : cut_cells(cells, is_fine ? 1.0 : cell_detour, is_fine ? cost_to_beat : any)) {
    MinimumCut cut{Array<char>(scope.size()), coarse.cost};
    Array<char> is_held(scope.size());
    for (std::size_t i = 0; i < scope.size(); ++i) {
      cut.is_first[i] = coarse.is_first[cell[i]];
      is_held[i] = coarse.is_held[cell[i]];
    }
    if (!is_fine) cut = refine(scope, is_held, cut, rings, best.cost);
    if (cut.cost < best.cost) best = std::move(cut);
  }
  for (const Index face : scope) place_[face] = none;
  return best;
}

// The shortest cut within a given number of faces of a coarse one.
MinimumCut MinimumCutter::refine(const Array<Index>& scope, const Array<char>& is_held, const MinimumCut& coarse,
                                 int rings, double cost_to_beat) const {
  Array<Index> cell(scope.size()), band;
  for (std::size_t i = 0; i < scope.size(); ++i) cell[i] = coarse.is_first[i] ? first_cell : second_cell;
  Array<char> in_band(scope.size(), 0);
  const auto add = [&](Index face) {
    const Index place = place_[face];
    if (place == none || in_band[place] || is_held[place]) return;
    in_band[place] = 1;
    band.push_back(face);
  };
  for (std::size_t i = 0; i < scope.size(); ++i) {
    graph_.for_each_link(scope[i], [&](Index other, const FaceGraph::Link&) {
      if (place_[other] != none && coarse.is_first[place_[other]] != coarse.is_first[i]) add(scope[i]);
    });
  }
  for (std::size_t begin = 0; rings > 0 && begin < band.size(); --rings) {
    const std::size_t end = band.size();
    for (; begin < end; ++begin) {
      graph_.for_each_link(band[begin], [&](Index other, const FaceGraph::Link&) { add(other); });
    }
  }
  Index count = 2;
  for (const Index face : band) cell[place_[face]] = count++;
  const Cells cells = cells_of(scope, cell, count);
  SmallestCut network(count, cells.edges);
  network.add_to_first(first_cell);
  network.add_to_second(second_cell);
  const Units length = network.find_smallest(useless_length(cost_to_beat));
  MinimumCut fine;
  if (cost(length, enough()) >= cost_to_beat) return fine;
  const Array<char> reached = network.first_side();
  double area = 0, total = 0;
  for (std::size_t i = 0; i < scope.size(); ++i) {
    fine.is_first.push_back(reached[cell[i]]);
    total += graph_.area[scope[i]];
    area += fine.is_first[i] ? graph_.area[scope[i]] : 0;
  }
  fine.cost = cost(length, std::min(area, total - area));
  const bool is_useless = fine.cost >= cost_to_beat;
  return is_useless || leaves_two(scope, fine.is_first) || !leaves_two(scope, coarse.is_first) ? fine : coarse;
}

// Whether either side of a cut is connected.
bool MinimumCutter::leaves_two(const Array<Index>& scope, const Array<char>& is_first) const {
  Array<char> reached(scope.size(), 0);
  Array<Index> front;
  int parts = 0;
  for (std::size_t seed = 0; seed < scope.size(); ++seed) {
    if (reached[seed]) continue;
    if (++parts > 2) return false;
    reached[seed] = 1;
    front.assign(1, scope[seed]);
    while (!front.empty()) {
      const Index face = front.back();
      front.pop_back();
      graph_.for_each_link(face, [&](Index other, const FaceGraph::Link&) {
        const Index place = place_[other];
        if (place == none || reached[place] || is_first[place] != is_first[place_[face]]) return;
        reached[place] = 1;
        front.push_back(other);
      });
    }
  }
  return true;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/key_path_exchange.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cut/cut_regions.hpp"
#include "cut/star_exchange.hpp"
#include "cut/strip_search.hpp"

namespace lsgp {

namespace {

// Marks the smaller of the two subtrees of the cuts after closing a path.
class SmallerSubtree {
 public:
  explicit SmallerSubtree(const CutNetwork& network) : network_(network), mark_of_(network.mesh.vertex_count(), 0) {}

  // Searches from both ends at once, so that the cost is that of the smaller subtree. Returns the mark, none if there
  // is only one.
  std::optional<Index> mark(Index head, Index tail) {
    if (head == tail) return std::nullopt;
    Front fronts[] = {{++marks_, {head}}, {++marks_, {tail}}};
    mark_of_[head] = fronts[0].mark;
    mark_of_[tail] = fronts[1].mark;
    while (true) {
      for (Front& front : fronts) {
        if (front.done == front.vertices.size()) return front.mark;
        const Index other = front.mark == marks_ ? marks_ - 1 : marks_;
        if (!advance(front, other)) return std::nullopt;
      }
    }
  }
  const PerVertex<Index>& mark_of() const { return mark_of_; }

 private:
  struct Front {
    Index mark;
    Array<Index> vertices;
    std::size_t done = 0;
  };

  // Expands one vertex. Returns whether the other front was not met.
  bool advance(Front& front, Index other) {
    const Index v = front.vertices[front.done++];
    bool is_apart = true;
    const auto visit = [&](Index w) {
      if (mark_of_[w] == front.mark) return;
      is_apart &= mark_of_[w] != other;
      mark_of_[w] = front.mark;
      front.vertices.push_back(w);
    };
    network_.for_each_joined(v, visit);
    return is_apart;
  }

  const CutNetwork& network_;
  PerVertex<Index> mark_of_;
  Index marks_ = 0;
};

class KeyPathExchange {
 public:
  explicit KeyPathExchange(CutNetwork& network)
      : network_(network),
        smaller_(network),
        regions_(network),
        strips_(network),
        traced_(network.mesh.halfedge_count(), 0) {}

  // Tries every path once. Returns the relative reduction of cost.
  double try_all();

 private:
  CutPath trace(Index h);
  CutPath find_cheaper(const CutPath& path);

  CutNetwork& network_;
  SmallerSubtree smaller_;
  CutRegions regions_;
  StripSearch strips_;
  PerHalfedge<Index> traced_;  // the last round that saw the path of a halfedge
  Index rounds_ = 0;
};

CutPath KeyPathExchange::trace(Index h) {
  CutPath path = network_.trace(h);
  for (const Index g : path) traced_[g] = traced_[network_.mesh.twin[g]] = rounds_;
  return path;
}

// Closes a path. Returns a cheaper one, or an empty one.
CutPath KeyPathExchange::find_cheaper(const CutPath& path) {
  constexpr double least_gain = 1e-9;  // of the path's cost: rounding is no gain
  const HalfedgeMesh& mesh = network_.mesh;
  const double below = (1 - least_gain) * network_.cost(path);
  const StripSearch::Ends ends = strips_.ends_of(path);
  network_.close(path);
  if (const auto mark = smaller_.mark(mesh.target(path.back()), mesh.origin(path.front()))) {
    return regions_.find(path, smaller_.mark_of(), *mark, below);
  }
  // A closed path may be the whole boundary of a piece.
  const bool is_whole = ends.after_head == path.front() || ends.after_tail == mesh.twin[path.back()];
  return is_whole ? CutPath() : strips_.find(path, ends, below);
}

double KeyPathExchange::try_all() {
  const HalfedgeMesh& mesh = network_.mesh;
  ++rounds_;
  Array<std::pair<double, Index>> order;  // most expensive paths first: largest potential gain
  double before = 0, gained = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!network_.is_cut[h] || traced_[h] == rounds_) continue;
    const double cost = network_.cost(trace(h));
    before += cost;
    if (cost > 0) order.emplace_back(-cost, h);
  }
  std::sort(order.begin(), order.end());
  if (order.empty()) return 0;
  ++rounds_;
  regions_.update(-order.front().first);
  for (const auto& [_, h] : order) {
    if (!network_.is_cut[h] || traced_[h] == rounds_) continue;
    const CutPath path = trace(h), cheaper = find_cheaper(path);
    network_.open(cheaper.empty() ? path : cheaper);
    if (!cheaper.empty()) gained += network_.cost(path) - network_.cost(cheaper);
  }
  return gained / before;
}

}  // namespace

void shorten_cuts(CutNetwork& network) {
  constexpr int most_rounds = 6;
  constexpr double worth_another = 1e-3;  // of the cuts' cost
  constexpr double nearly_all = 2e-2;     // of the cuts' cost: then key paths alone gain little more
  KeyPathExchange paths(network);
  StarExchange stars(network);
  for (int round = 0; round < most_rounds; ++round) {
    double gain = paths.try_all();
    if (gain < nearly_all && network.mesh.genus == 0) gain += stars.try_all();  // handles hold most stars together
    if (gain <= worth_another) break;
  }
}

}  // namespace lsgp

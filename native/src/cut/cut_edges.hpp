// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/array.hpp"
#include "cut/cut_cost.hpp"

namespace lsgp {

// The edges that cuts may follow with their costs, those of a vertex side by side: searches read nothing else of the
// surface.
class CutEdges {
 public:
  struct Edge {
    double cost;
    Index halfedge;  // leaves the vertex
    Index target;
  };
  struct Range {
    const Edge *first, *last;
    const Edge* begin() const { return first; }
    const Edge* end() const { return last; }
  };

  explicit CutEdges(const MetricMesh& surface);

  Index vertex_count() const { return static_cast<Index>(first_.size()) - 1; }
  // Counter-clockwise from outgoing[v].
  Range from(Index v) const { return {edges_.get() + first_[v], edges_.get() + first_[v + 1]}; }
  // Starts to read the edges from v into the caches.
  void prefetch(Index v) const { Eigen::internal::prefetch(&from(v).first->cost); }
  double usual_cost() const { return usual_cost_; }  // the mean

 private:
  Array<Index> first_;             // (n + 1)
  std::unique_ptr<Edge[]> edges_;  // not an Array, which would be cleared first: by one thread alone
  double usual_cost_ = 0;
};

}  // namespace lsgp

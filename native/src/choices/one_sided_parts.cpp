// SPDX-License-Identifier: GPL-3.0-or-later
#include "choices/one_sided_parts.hpp"

#include <optional>
#include <utility>

#include "mesh/edge_set.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

void end_at(const VertexPairs& ends, const EdgeTable& edges, PerHalfedge<Index>& other_side) {
  for (Eigen::Index e = 0; e < ends.rows(); ++e) {
    const Index edge = edges.find(ends(e, 0), ends(e, 1));
    for (Index i = 0; edge != none && i < edges.halfedge_count(edge); ++i) other_side[edges.halfedge(edge, i)] = none;
  }
}

// Turns triangles one after another like those from which they are reached. Triangles joined by edges that may not be
// cut are turned together.
class Turning {
 public:
  Turning(const Surface& surface, const EdgeTable& edges, const PerHalfedge<Index>& other_side)
      : surface_(surface),
        edges_(edges),
        other_side_(other_side),
        cuttable_(surface.edges ? *surface.edges : VertexPairs()),
        turn_(surface.triangles.rows(), unknown) {
    for (Index seed = 0; seed < static_cast<Index>(turn_.size()); ++seed) turn_from(seed);
  }

  // Edges whose triangles are turned in two ways, and which may be cut.
  VertexPairs contradictions() const {
    Array<std::pair<Index, Index>> found;
    for (Index edge = 0; edge < edges_.count(); ++edge) {
      const Index h = edges_.halfedge(edge, 0), other = other_side_[h];
      if (other != none && turn_[other / 3] != turn_beyond(h) && may_be_cut(h)) found.emplace_back(tail(h), head(h));
    }
    return to_rows(found);
  }

 private:
  static constexpr char unknown = 2;

  Index tail(Index h) const { return surface_.triangles.data()[h]; }
  Index head(Index h) const { return surface_.triangles(h / 3, (h % 3 + 1) % 3); }
  bool may_be_cut(Index h) const { return !surface_.edges || cuttable_.has(tail(h), head(h)); }

  // How the triangle on the other side of a halfedge is to be turned.
  char turn_beyond(Index h) const {
    return static_cast<char>((turn_[h / 3] != 0) != (tail(h) == tail(other_side_[h])));
  }

  void turn_from(Index seed) {
    if (turn_[seed] != unknown) return;
    Array<Index> queue;
    turn(seed, 0, queue);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
        const Index other = other_side_[h];
        if (other != none && turn_[other / 3] == unknown) turn(other / 3, turn_beyond(h), queue);
      }
    }
  }

  // A triangle, and those that may not be cut off it.
  void turn(Index triangle, char turned, Array<Index>& queue) {
    turn_[triangle] = turned;
    const std::size_t first = queue.size();
    queue.push_back(triangle);
    for (std::size_t i = first; i < queue.size(); ++i) {
      for (Index h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
        const Index other = other_side_[h];
        if (other == none || turn_[other / 3] != unknown || may_be_cut(h)) continue;
        turn_[other / 3] = turn_beyond(h);
        queue.push_back(other / 3);
      }
    }
  }

  const Surface& surface_;
  const EdgeTable& edges_;
  const PerHalfedge<Index>& other_side_;
  const EdgeSet cuttable_;
  PerTriangle<char> turn_;
};

}  // namespace

OpenedParts ends_of_one_sided_parts(const Surface& surface) {
  OpenedParts out;
  const auto halfedge_count = static_cast<Index>(3 * surface.triangles.rows());
  const EdgeTable edges(surface, PerTriangle<char>(surface.triangles.rows(), 0));
  PerHalfedge<Index> other_side = other_sides(edges, halfedge_count);
  end_at(surface.borders, edges, other_side);
  // Nearly all surfaces end here, sooner than by their topology.
  if (Turning(surface, edges, other_side).contradictions().rows() == 0) return out;
  std::vector<Finding> unsaid;
  PerTriangle<char> is_one_sided(surface.triangles.rows(), 0);
  for (const Component& component : build_topology(surface, {}, unsaid).components) {
    if (component.orientable) continue;
    for (const Index f : component.source_triangle) is_one_sided[f] = 1;
  }
  for (Index h = 0; h < halfedge_count; ++h) {
    if (!is_one_sided[h / 3]) other_side[h] = none;
  }
  end_at(surface.seams, edges, other_side);
  out.ends = Turning(surface, edges, other_side).contradictions();
  for (std::size_t f = 0; out.ends.rows() > 0 && f < is_one_sided.size(); ++f) {
    if (is_one_sided[f]) out.triangles.push_back(static_cast<Index>(f));
  }
  return out;
}

void tell_opened(const OpenedParts& opened, Result& result) {
  if (opened.triangles.empty()) return;
  result.warnings.push_back({Code::seams_opened,
                             "A one-sided component, like a Moebius strip, was cut open so that it has two sides. "
                             "Its texture cannot continue across all of these cuts: mark seams to choose them.",
                             {ElementKind::triangles, opened.triangles}});
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/angle_flow.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/text.hpp"
#include "lsgp/errors.hpp"
#include "solvers/max_flow.hpp"

namespace lsgp {

namespace {

using Units = FlowNetwork::Units;

constexpr double unit = M_PI / (Units(1) << 40);

// Radians. Sums of given angles may be off by a millionth and are mended then. All others are whole multiples of the
// unit, so that nothing possible is refused.
struct Precision {
  double smallest_corner, tolerance;
};
constexpr Precision of_given{1e-5, 2e-6}, of_chosen{1e-9, 0};

// Radians. A guess is off by less where it is only rounded.
constexpr double largest_rounding = 1e-5;

Units to_units(double angle) { return static_cast<Units>(std::llround(angle / unit)); }

// Angle left over when every corner has its smallest one.
struct Transport {
  Units of_triangle;
  PerVertex<Units> of_vertex;  // -1 where free
};

Transport left_over(const HalfedgeMesh& mesh, const Eigen::VectorXd& angle, const PerVertex<char>& is_free,
                    double smallest_corner) {
  const Units corner = to_units(smallest_corner);
  Transport out{to_units(M_PI) - 3 * corner, PerVertex<Units>(mesh.vertex_count())};
  for (Index v = 0; v < mesh.vertex_count(); ++v) out.of_vertex[v] = is_free[v] ? -1 : to_units(angle[v]);
  for (Index c = 0; c < mesh.halfedge_count(); ++c) {
    Units& left = out.of_vertex[mesh.origin(c)];
    if (left >= 0) left = std::max<Units>(0, left - corner);
  }
  return out;
}

// A feasible flow close to a guess: what the corners get of their vertices and triangles, which are nodes 0 to n - 1
// and n to n + m - 1. Where the guess is exact but for rounding and has no negative angles, the flow is a maximum.
class FirstFlow {
 public:
  FirstFlow(const HalfedgeMesh& mesh, const Transport& transport, const Eigen::VectorXd& guess, Units smallest_corner)
      : mesh_(mesh),
        vertices_(mesh.vertex_count()),
        left_(vertices_ + mesh.triangle_count(), transport.of_triangle),
        at_corner_(mesh.halfedge_count()) {
    std::copy(transport.of_vertex.begin(), transport.of_vertex.end(), left_.begin());
    for (Index c = 0; c < mesh.halfedge_count(); ++c) add(c, std::max<Units>(0, to_units(guess[c]) - smallest_corner));
    round_along_trees(transport);
    limit(transport);
  }

  const PerHalfedge<Units>& at_corner() const { return at_corner_; }

 private:
  Index triangle_of(Index corner) const { return vertices_ + corner / 3; }

  void add(Index corner, Units units) {
    at_corner_[corner] += units;
    left_[mesh_.origin(corner)] -= units;
    left_[triangle_of(corner)] -= units;
  }

  // Passes on rounding errors, which would otherwise have to find their way to a free vertex one by one.
  void round_along_trees(const Transport& transport) {
    Array<Index> order, corner_above(left_.size(), none);
    Array<char> is_reached(left_.size(), 0);
    const auto reach = [&](Index node, Index corner) {
      if (is_reached[node]) return;
      is_reached[node] = 1;
      corner_above[node] = corner;
      order.push_back(node);
    };
    order.reserve(left_.size());
    for (Index v = 0; v < vertices_; ++v) {
      if (transport.of_vertex[v] < 0) reach(v, none);
    }
    if (order.empty()) reach(0, none);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Index node = order[i];
      if (node < vertices_) {
        mesh_.for_each_outgoing(node, [&](Index h) { reach(triangle_of(h), h); });
      } else {
        for (Index c = 3 * (node - vertices_), end = c + 3; c < end; ++c) reach(mesh_.origin(c), c);
      }
    }
    const Units most = to_units(largest_rounding);
    for (std::size_t i = order.size(); i-- > 0;) {
      const Index corner = corner_above[order[i]];
      if (corner == none) continue;
      const Units units = left_[order[i]];
      if (std::abs(units) <= most && at_corner_[corner] + units >= 0) add(corner, units);
    }
  }

  // Nothing gets more than it has room for.
  void limit(const Transport& transport) {
    const auto take = [&](Index node, Index corner) {
      if (left_[node] < 0) add(corner, -std::min(-left_[node], at_corner_[corner]));
    };
    for (Index c = 0; c < mesh_.halfedge_count(); ++c) {
      if (transport.of_vertex[mesh_.origin(c)] >= 0) take(mesh_.origin(c), c);
      take(triangle_of(c), c);
    }
  }

  const HalfedgeMesh& mesh_;
  const Index vertices_;
  Array<Units> left_;  // (nodes) room
  PerHalfedge<Units> at_corner_;
};

enum class From { vertices, triangles };

// The side of a minimum cut on which what `from` has to give finds too little room: which vertices and how many
// triangles belong to it. None where everything finds its place.
struct Bottleneck {
  Array<Index> vertices;
  Index triangles = 0;
};
// first: what the flow along the corners is at first.
std::optional<Bottleneck> find_bottleneck(const HalfedgeMesh& mesh, const Transport& transport,
                                          const PerHalfedge<Units>& first, From from, double tolerance) {
  const int n = mesh.vertex_count(), m = mesh.triangle_count(), source = n + m, sink = source + 1;
  FlowNetwork network(sink + 1);
  constexpr Units unlimited = Units(1) << 60;
  const bool from_vertices = from == From::vertices;
  // Free vertices have nothing to give.
  const auto gives = [&](Index v) { return !from_vertices || transport.of_vertex[v] >= 0; };
  PerVertex<Units> of_vertex(n, 0);
  PerTriangle<Units> of_triangle(m, 0);
  Units flows = 0, wanted = 0;
  for (Index c = 0; c < 3 * m; ++c) {
    const Index v = mesh.origin(c), f = c / 3;
    if (!gives(v)) continue;
    of_vertex[v] += first[c];
    of_triangle[f] += first[c];
    flows += first[c];
    network.send(from_vertices ? network.add_arc(v, n + f, unlimited) : network.add_arc(n + f, v, unlimited), first[c]);
  }
  for (int v = 0; v < n; ++v) {
    if (!gives(v)) continue;
    const Units left = transport.of_vertex[v];
    network.send(
        from_vertices ? network.add_arc(source, v, left) : network.add_arc(v, sink, left < 0 ? unlimited : left),
        of_vertex[v]);
    if (from_vertices) wanted += left;
  }
  for (int f = 0; f < m; ++f) {
    network.send(from_vertices ? network.add_arc(n + f, sink, transport.of_triangle)
                               : network.add_arc(source, n + f, transport.of_triangle),
                 of_triangle[f]);
    if (!from_vertices) wanted += transport.of_triangle;
  }
  if (flows + network.maximize(source, sink) + to_units(tolerance) >= wanted) return std::nullopt;
  const Array<char> side = network.reachable(source);
  Bottleneck out;
  for (int v = 0; v < n; ++v) {
    if (side[v]) out.vertices.push_back(v);
  }
  for (int f = 0; f < m; ++f) out.triangles += side[n + f];
  return out;
}

Array<Index> cones_at(const Bottleneck& at, const Array<Index>& named) {
  Array<Index> out;
  for (const Index v : named) {
    if (std::binary_search(at.vertices.begin(), at.vertices.end(), v)) out.push_back(v);
  }
  return out;
}

[[noreturn]] void refuse(const Bottleneck& at, From from, const Eigen::VectorXd& angle, Array<Index> cones) {
  double sum = 0;
  for (const Index v : at.vertices) sum += angle[v];
  const bool is_short = from == From::vertices;
  const auto triangles = count(at.triangles, "triangle", "triangles");
  const std::string carried = degrees(M_PI * at.triangles), wanted = degrees(sum);
  // None of these vertices is a cone whose angle is chosen, since such a one takes whatever is left.
  if (cones.empty()) {
    const auto vertices = count(at.vertices.size(), "vertex that is no cone", "vertices that are no cones");
    throw Error(Code::angles_impossible,
                concat("No angles of these cones give a map: ",
                       is_short ? concat("the ", triangles, " around ", vertices, " can carry less than ", carried,
                                         ", but the angles there have to add up to ", wanted)
                                : concat(triangles, " with ", vertices, " carry ", carried,
                                         ", but the angles there add up to ", wanted, " at most"),
                       ". Mark a cone among these vertices, or subdivide the mesh there."),
                {ElementKind::vertices, at.vertices});
  }
  const std::string around = concat("The ", triangles, " around ", count(cones.size(), "cone", "cones"));
  throw Error(Code::angles_impossible,
              is_short ? concat(around, " can carry less than ", carried, ", but the angles there add up to ", wanted,
                                ". Lower them or subdivide the mesh there.")
                       : concat(around, " carry more than ", carried, ", but the angles there add up to only ", wanted,
                                ". Raise them or subdivide the mesh there."),
              {ElementKind::vertices, std::move(cones)});
}

}  // namespace

void require_possible_angles(const HalfedgeMesh& mesh, const Eigen::VectorXd& angle, const PerVertex<char>& is_free,
                             const Eigen::VectorXd& guess, const Array<Index>& named) {
  const Precision precision = named.empty() ? of_chosen : of_given;
  const Transport transport = left_over(mesh, angle, is_free, precision.smallest_corner);
  const PerHalfedge<Units> first = FirstFlow(mesh, transport, guess, to_units(precision.smallest_corner)).at_corner();
  // Without free vertices both sums are the same, so what finds its place from one side fills the other.
  const bool any_free = std::find(is_free.begin(), is_free.end(), 1) != is_free.end();
  const auto at_vertices = find_bottleneck(mesh, transport, first, From::vertices, precision.tolerance);
  if (!at_vertices && !any_free) return;
  const auto at_triangles = find_bottleneck(mesh, transport, first, From::triangles, precision.tolerance);
  if (!at_vertices && !at_triangles) return;
  // Too much at some cones is too little at the others: the fewer are the cause.
  const Array<Index> high = at_vertices ? cones_at(*at_vertices, named) : Array<Index>{};
  const Array<Index> low = at_triangles ? cones_at(*at_triangles, named) : Array<Index>{};
  if (!at_triangles || (at_vertices && high.size() <= low.size())) {
    refuse(*at_vertices, From::vertices, angle, high);
  }
  refuse(*at_triangles, From::triangles, angle, low);
}

}  // namespace lsgp

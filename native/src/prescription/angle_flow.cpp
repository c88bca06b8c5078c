// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/angle_flow.hpp"

#include <algorithm>
#include <cmath>
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

enum class From { vertices, triangles };

// The side of a minimum cut on which what `from` has to give finds too little room: which vertices and how many
// triangles belong to it. None where everything finds its place.
struct Bottleneck {
  Array<Index> vertices;
  Index triangles = 0;
};
std::optional<Bottleneck> find_bottleneck(const HalfedgeMesh& mesh, const Transport& transport, From from,
                                          double tolerance) {
  const int n = mesh.vertex_count(), m = mesh.triangle_count(), source = n + m, sink = source + 1;
  FlowNetwork network(sink + 1);
  constexpr Units unlimited = Units(1) << 60;
  const bool from_vertices = from == From::vertices;
  Units wanted = 0;
  for (int v = 0; v < n; ++v) {
    const Units left = transport.of_vertex[v];
    if (from_vertices) {
      if (left < 0) continue;
      network.add_arc(source, v, left);
      wanted += left;
    } else {
      network.add_arc(v, sink, left < 0 ? unlimited : left);
    }
  }
  for (int f = 0; f < m; ++f) {
    for (int c = 0; c < 3; ++c) {
      const int v = mesh.triangles(f, c);
      if (from_vertices)
        network.add_arc(v, n + f, unlimited);
      else
        network.add_arc(n + f, v, unlimited);
    }
    if (from_vertices) {
      network.add_arc(n + f, sink, transport.of_triangle);
    } else {
      network.add_arc(source, n + f, transport.of_triangle);
      wanted += transport.of_triangle;
    }
  }
  if (network.maximize(source, sink) + to_units(tolerance) >= wanted) return std::nullopt;
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
                             const Array<Index>& named) {
  const Precision precision = named.empty() ? of_chosen : of_given;
  const Transport transport = left_over(mesh, angle, is_free, precision.smallest_corner);
  // Without free vertices both sums are the same, so what finds its place from one side fills the other.
  const bool any_free = std::find(is_free.begin(), is_free.end(), 1) != is_free.end();
  const auto at_vertices = find_bottleneck(mesh, transport, From::vertices, precision.tolerance);
  if (!at_vertices && !any_free) return;
  const auto at_triangles = find_bottleneck(mesh, transport, From::triangles, precision.tolerance);
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

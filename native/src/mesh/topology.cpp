// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/topology.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "base/memory.hpp"
#include "base/text.hpp"
#include "base/union_find.hpp"
#include "mesh/edge_table.hpp"
#include "mesh/sheets.hpp"

namespace lsgp {

namespace {

using EdgeSet = std::set<std::pair<Index, Index>>;  // the lower vertex first

// The edges of collapsed triangles.
EdgeSet edges_of(const Surface& surface, const Array<Index>& collapsed) {
  EdgeSet edges;
  for (const Index f : collapsed) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      edges.insert(std::minmax(surface.triangles.data()[h], surface.triangles.data()[next(h)]));
    }
  }
  return edges;
}

// What a message says of vertex pairs, and of those among them that are no edges.
struct PairWording {
  Code code;
  const char *what, *remedy;
};

// lost: edges that pairs may name although no triangle of the table has them.
PerEdge<char> mark_edges(const EdgeTable& edges, const EdgeSet& lost, const VertexPairs& pairs,
                         const PairWording& wording) {
  const auto& [code, what, remedy] = wording;
  PerEdge<char> marked(edges.count(), 0);
  Array<Index> missing;
  for (Index row = 0; row < pairs.rows(); ++row) {
    const Index a = pairs(row, 0), b = pairs(row, 1), edge = a == b ? none : edges.find(a, b);
    if (edge != none)
      marked[edge] = 1;
    else if (lost.count(std::minmax(a, b)) == 0)
      missing.insert(missing.end(), {a, b});
  }
  if (!missing.empty()) {
    const std::size_t pairs_missing = missing.size() / 2;
    throw Error(code,
                concat(count(pairs_missing, "vertex pair", "vertex pairs"), " among the ", what,
                       pairs_missing == 1 ? " is" : " are", " not joined by an edge. ", remedy),
                {ElementKind::edges, missing});
  }
  return marked;
}

// The cut cost factor of each edge, empty if none were given; 1 where no cut may run.
PerEdge<double> cut_factors(const EdgeTable& edges, const Surface& surface) {
  if (surface.cut_costs.size() == 0) return {};
  PerEdge<double> out(edges.count(), 1);
  for (Index row = 0; row < surface.edges->rows(); ++row) {
    const Index edge = edges.find((*surface.edges)(row, 0), (*surface.edges)(row, 1));
    if (edge != none) out[edge] = surface.cut_costs[row];
  }
  return out;
}

// Pairs of a triangle and the first one with the same vertices.
Array<std::pair<Index, Index>> find_duplicates(const Surface& surface, const EdgeTable& edges) {
  const Index* corner_vertex = surface.triangles.data();
  Array<std::pair<Index, Index>> duplicates;
  // Most surfaces have no edge of more than two triangles and none of two with the same third vertex.
  bool is_plain = true;
  for (Index edge = 0; edge < edges.count() && is_plain; ++edge) {
    const Index count = edges.halfedge_count(edge);
    is_plain = count == 1 || (count == 2 && corner_vertex[prev(edges.halfedge(edge, 0))] !=
                                                corner_vertex[prev(edges.halfedge(edge, 1))]);
  }
  if (is_plain) return duplicates;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (is_collapsed(surface.triangles, f)) continue;
    // Search the edge with the fewest triangles; the others may be shared by many.
    Index own = 3 * f;
    for (Index h = 3 * f + 1; h < 3 * f + 3; ++h) {
      if (edges.halfedge_count(edges.edge_of(h)) < edges.halfedge_count(edges.edge_of(own))) own = h;
    }
    const Index edge = edges.edge_of(own);
    for (Index i = 0; i < edges.halfedge_count(edge); ++i) {
      const Index h = edges.halfedge(edge, i);
      if (h / 3 >= f) break;  // an edge lists its halfedges in order
      if (corner_vertex[prev(h)] != corner_vertex[prev(own)]) continue;
      duplicates.emplace_back(f, h / 3);
      break;
    }
  }
  return duplicates;
}

// What the caller says of edges.
struct EdgeMarks {
  PerEdge<char> cuttable, seam, border, feature;
  PerEdge<double> factor;  // empty: 1
};

struct Orientation {
  PerTriangle<Index> component;  // none for triangles left out
  PerTriangle<char> reversed;
  PerPart<char> orientable;
};

// Whether the surface ends at an edge that is a border, or a seam of triangles with open seams.
bool is_open(const EdgeTable& edges, Index edge, const EdgeMarks& marks, const OpenSeams& open_seams) {
  if (marks.border[edge]) return true;
  if (!marks.seam[edge] || open_seams.empty()) return false;
  for (Index i = 0; i < edges.halfedge_count(edge); ++i) {
    if (open_seams[edges.halfedge(edge, i) / 3]) return true;
  }
  return false;
}

// Labels components by breadth-first search over joined halfedges and orients every triangle like its component's
// majority.
Orientation orient(const Surface& surface, const PerTriangle<char>& skip, const PerHalfedge<Index>& twin) {
  const Index triangle_count = static_cast<Index>(surface.triangles.rows());
  const Index* corner_vertex = surface.triangles.data();
  Orientation out{PerTriangle<Index>(triangle_count, none), PerTriangle<char>(triangle_count, 0), {}};
  Array<Index> queue;
  for (Index seed = 0; seed < triangle_count; ++seed) {
    if (out.component[seed] != none || skip[seed]) continue;
    const Index label = static_cast<Index>(out.orientable.size());
    out.orientable.push_back(1);
    out.component[seed] = label;
    queue.assign(1, seed);
    std::size_t turned = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Index f = queue[i];
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        const Index other = twin[h], g = other / 3;
        if (other == none) continue;
        const bool wanted = out.reversed[f] != (corner_vertex[h] == corner_vertex[other]);
        if (out.component[g] == none) {
          out.component[g] = label;
          out.reversed[g] = wanted;
          turned += wanted;
          queue.push_back(g);
        } else if (out.reversed[g] != wanted) {
          out.orientable[label] = 0;
        }
      }
    }
    if (2 * turned > queue.size()) {
      for (const Index f : queue) out.reversed[f] ^= 1;
    }
  }
  return out;
}

// The twin of every halfedge across which the surface continues, none at others: at edges of two triangles that
// are not open, and at those of more triangles that are not as sheets run on.
PerHalfedge<Index> join_sheets(const Surface& surface, const EdgeTable& edges, const EdgeMarks& marks,
                               const OpenSeams& open_seams, const PerTriangle<char>& skip) {
  PerHalfedge<Index> twin(3 * surface.triangles.rows(), none);
  PerEdge<char> crowded;
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (edges.halfedge_count(edge) < 2 || is_open(edges, edge, marks, open_seams)) continue;
    if (edges.halfedge_count(edge) == 2) {
      const Index a = edges.halfedge(edge, 0), b = edges.halfedge(edge, 1);
      twin[a] = b;
      twin[b] = a;
      continue;
    }
    if (crowded.empty()) crowded.assign(edges.count(), 0);
    crowded[edge] = 1;
  }
  if (!crowded.empty()) {
    const Orientation parts = orient(surface, skip, twin);
    continue_sheets(surface, edges, crowded, {parts.component, parts.reversed, parts.orientable}, twin);
  }
  return twin;
}

// Joins triangles of one-sided parts at edges of three or more triangles: as they are once seams are open.
void join_one_sided(const EdgeTable& edges, const Orientation& parts, const PerHalfedge<Index>& opened,
                    PerHalfedge<Index>& twin) {
  const auto is_one_sided = [&](Index h) {
    return parts.component[h / 3] != none && !parts.orientable[parts.component[h / 3]];
  };
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (edges.halfedge_count(edge) < 3) continue;
    for (Index i = 0; i < edges.halfedge_count(edge); ++i) {
      const Index h = edges.halfedge(edge, i), other = opened[h];
      if (other != none && is_one_sided(h) && is_one_sided(other)) twin[h] = other;
    }
  }
}

// As sheets run on where nothing is open, so that a part hangs on no seam of another, without what is open.
PerHalfedge<Index> join_halfedges(const Surface& surface, const EdgeTable& edges, const EdgeMarks& marks,
                                  const OpenSeams& open_seams, const PerTriangle<char>& skip) {
  PerHalfedge<Index> twin = join_sheets(surface, edges, marks, {}, skip);
  if (open_seams.empty()) return twin;
  bool any_crowded = false;
  for (Index edge = 0; edge < edges.count() && !any_crowded; ++edge) any_crowded = edges.halfedge_count(edge) > 2;
  if (any_crowded) {
    const Orientation parts = orient(surface, skip, twin);
    const bool all_orientable =
        std::all_of(parts.orientable.begin(), parts.orientable.end(), [](char is) { return is != 0; });
    if (!all_orientable) join_one_sided(edges, parts, join_sheets(surface, edges, marks, open_seams, skip), twin);
  }
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (!marks.seam[edge]) continue;
    for (Index i = 0; i < edges.halfedge_count(edge); ++i) {
      const Index h = edges.halfedge(edge, i), other = twin[h];
      if (other == none || !(open_seams[h / 3] || open_seams[other / 3])) continue;
      twin[h] = none;
      twin[other] = none;
    }
  }
  return twin;
}

void find_boundary_loops(HalfedgeMesh& mesh) {
  mesh.loop_of_vertex.assign(mesh.vertex_count(), none);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] != none || mesh.twin[mesh.outgoing[v]] != none) continue;
    const Index loop = static_cast<Index>(mesh.boundary_loops.size());
    mesh.boundary_loops.emplace_back();
    for (Index at = v; mesh.loop_of_vertex[at] == none; at = mesh.target(mesh.outgoing[at])) {
      mesh.loop_of_vertex[at] = loop;
      mesh.boundary_loops.back().push_back(at);
    }
  }
}

// Numbers vertices by fans: corners connected by rotation about their vertex share it.
void number_vertices(const Surface& surface, Component& component) {
  HalfedgeMesh& mesh = component.mesh;
  const Index halfedge_count = mesh.halfedge_count();
  PerHalfedge<Index> vertex(halfedge_count, none);
  for (Index corner = 0; corner < halfedge_count; ++corner) {
    if (vertex[corner] != none) continue;
    const Index v = static_cast<Index>(mesh.outgoing.size());
    Index first = corner, h = corner;
    do {
      vertex[h] = v;
      h = mesh.rotate(h);
    } while (h != none && h != corner);
    while (h == none && mesh.twin[first] != none) {  // a boundary: back to where the fan begins
      first = next(mesh.twin[first]);
      vertex[first] = v;
    }
    mesh.outgoing.push_back(first);
    const Index source = component.source_corner(corner);
    component.source_vertex.push_back(surface.triangles(source / 3, source % 3));
  }
  std::copy(vertex.begin(), vertex.end(), mesh.triangles.data());
  mesh.positions.resize(mesh.vertex_count(), 3);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    mesh.positions.row(v) = surface.positions.row(component.source_vertex[v]);
  if (surface.scale.size() == 0) return;
  mesh.scale.resize(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.scale[v] = surface.scale[component.source_vertex[v]];
}

void mark_feature(Index h, HalfedgeMesh& mesh) {
  if (mesh.feature.empty()) mesh.feature.assign(mesh.halfedge_count(), 0);
  mesh.feature[h] = 1;
}

void measure_topology(HalfedgeMesh& mesh) {
  find_boundary_loops(mesh);
  Index paired = 0;
  for (const Index twin : mesh.twin) paired += twin != none;
  const Index edge_count = mesh.halfedge_count() - paired / 2;
  mesh.euler = mesh.vertex_count() - edge_count + mesh.triangle_count();
  mesh.genus = (2 - static_cast<int>(mesh.boundary_loops.size()) - mesh.euler) / 2;
}

void report_crowded_edges(const Surface& surface, const EdgeTable& edges, std::vector<Finding>& findings) {
  Array<Index> crowded;
  for (Index edge = 0; edge < edges.count(); ++edge) {
    if (edges.halfedge_count(edge) <= 2) continue;
    const Index h = edges.halfedge(edge, 0);
    crowded.insert(crowded.end(), {surface.triangles.data()[h], surface.triangles.data()[next(h)]});
  }
  if (crowded.empty()) return;
  findings.push_back(
      {Code::non_manifold_edge,
       concat(count(crowded.size() / 2, "edge is", "edges are"),
              " shared by more than two triangles. The two that continue each other best stay joined, the others end "
              "there; delete the surplus faces to avoid this note."),
       {ElementKind::edges, crowded}});
}

// The vertices at which fans are separate because the surface was opened there.
PerVertex<char> mark_opened(const Surface& surface, const EdgeTable& edges, const PerHalfedge<Index>& twin,
                            const Orientation& orientation) {
  PerVertex<char> open(surface.positions.rows(), 0);
  for (Index edge = 0; edge < edges.count(); ++edge) {
    const Index h = edges.halfedge(edge, 0), sides = edges.halfedge_count(edge);
    if (sides < 2 || (sides == 2 && twin[h] != none)) continue;
    open[surface.triangles.data()[h]] = open[surface.triangles.data()[next(h)]] = 1;
  }
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (orientation.component[f] != none && orientation.orientable[orientation.component[f]]) continue;
    for (int c = 0; c < 3; ++c) open[surface.triangles(f, c)] = 1;
  }
  return open;
}

// Vertices of several fans and of none.  opened: as from mark_opened.
void report_fans(const PerComponent<Component>& components, const PerVertex<char>& opened,
                 std::vector<Finding>& findings) {
  PerVertex<Index> fans(opened.size(), 0);
  Array<Index> split, isolated;
  for (const Component& component : components) {
    for (const Index v : component.source_vertex) ++fans[v];
  }
  for (std::size_t v = 0; v < fans.size(); ++v) {
    if (opened[v]) continue;
    if (fans[v] == 0) isolated.push_back(static_cast<Index>(v));
    if (fans[v] > 1) split.push_back(static_cast<Index>(v));
  }
  if (!split.empty()) {
    findings.push_back({Code::split_vertex,
                        concat("At ", count(split.size(), "vertex", "vertices"),
                               " separate pieces of the surface touch. They were unwrapped as separate vertices; split "
                               "the vertices to avoid this note."),
                        {ElementKind::vertices, split}});
  }
  if (!isolated.empty()) {
    findings.push_back(
        {Code::isolated_vertices,
         concat(count(isolated.size(), "vertex belongs", "vertices belong"), " to no face and got no coordinates."),
         {ElementKind::vertices, isolated}});
  }
}

void report_turned(const Orientation& orientation, std::vector<Finding>& findings) {
  Array<Index> turned;
  for (std::size_t f = 0; f < orientation.reversed.size(); ++f) {
    if (orientation.reversed[f]) turned.push_back(static_cast<Index>(f));
  }
  if (turned.empty()) return;
  findings.push_back(
      {Code::reoriented,
       concat(count(turned.size(), "triangle has", "triangles have"), " the opposite orientation to the rest of ",
              "the surface. Unwrapped as if flipped; recalculate normals to repair it."),
       {ElementKind::triangles, turned}});
}

// Takes triangles that coincide with an earlier one out of `edges` and marks them in `skip`.
Array<std::pair<Index, Index>> leave_out_duplicates(const Surface& surface, PerTriangle<char>& skip, EdgeTable& edges,
                                                    std::vector<Finding>& findings) {
  Array<std::pair<Index, Index>> duplicates = find_duplicates(surface, edges);
  if (duplicates.empty()) return duplicates;
  Array<Index> doubled;
  for (const auto& [f, original] : duplicates) {
    skip[f] = 1;
    doubled.push_back(f);
  }
  edges = EdgeTable(surface, skip);
  findings.push_back({Code::duplicate_face,
                      concat(count(doubled.size(), "triangle coincides", "triangles coincide"),
                             " with another one and got its coordinates. Delete duplicate faces to avoid this note."),
                      {ElementKind::triangles, doubled}});
  return duplicates;
}

EdgeMarks marks_of(const Surface& surface, const EdgeTable& edges, const Array<Index>& collapsed) {
  const EdgeSet lost = edges_of(surface, collapsed);
  const auto marked = [&](const VertexPairs& pairs, const char* what) {
    return mark_edges(edges, lost, pairs, {Code::edge_not_in_mesh, what, "Pass edges of this mesh."});
  };
  return {surface.edges ? marked(*surface.edges, "cuttable edges") : PerEdge<char>(edges.count(), 1),
          mark_edges(edges, lost, surface.seams, {Code::seam_not_an_edge, "seams", "Mark edges of this mesh."}),
          marked(surface.borders, "borders"), marked(surface.features, "features"), cut_factors(edges, surface)};
}

// Marks collapsed triangles in `skip` and returns them.
Array<Index> leave_out_collapsed(const Surface& surface, PerTriangle<char>& skip) {
  Array<Index> collapsed;
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (!is_collapsed(surface.triangles, f)) continue;
    skip[f] = 1;
    collapsed.push_back(f);
  }
  return collapsed;
}

// Collapsed triangles, and for each one with the same edge or, where all of its corners are one vertex, with that.
// Those without such a triangle are left out.
Array<std::pair<Index, Index>> find_neighbors(const Surface& surface, const EdgeTable& edges,
                                              const Array<Index>& collapsed) {
  Array<std::pair<Index, Index>> neighbors;
  if (collapsed.empty()) return neighbors;
  PerVertex<Index> triangle_at(surface.positions.rows(), none);
  for (Index h = 0; h < 3 * surface.triangles.rows(); ++h) {
    if (edges.edge_of(h) != none) triangle_at[surface.triangles.data()[h]] = h / 3;
  }
  for (const Index f : collapsed) {
    const auto [low, high] = std::minmax({surface.triangles(f, 0), surface.triangles(f, 1), surface.triangles(f, 2)});
    const Index edge = low == high ? none : edges.find(low, high);
    const Index neighbor = low == high ? triangle_at[low] : edge == none ? none : edges.halfedge(edge, 0) / 3;
    if (neighbor != none) neighbors.emplace_back(f, neighbor);
  }
  return neighbors;
}

// A surface's edges, how its triangles are joined across them, and which of these are turned over.
struct JoinedTriangles {
  const EdgeTable& edges;
  const EdgeMarks& marks;
  const PerHalfedge<Index>& twin;
  const Orientation& orientation;
};

// Vertices at which three or more marked edges meet.
PerVertex<char> feature_junctions(const Surface& surface, const JoinedTriangles& joined) {
  PerVertex<int> count(surface.positions.rows(), 0);
  for (Index edge = 0; edge < ssize(joined.marks.feature); ++edge) {
    if (!joined.marks.feature[edge]) continue;
    const Index h = joined.edges.halfedge(edge, 0);
    for (const Index corner : {h, next(h)}) ++count[surface.triangles.data()[corner]];
  }
  PerVertex<char> out(surface.positions.rows(), 0);
  for (Index v = 0; v < ssize(count); ++v) out[v] = count[v] > 2;
  return out;
}

// Components with their halfedge meshes, those that are not orientable without.
PerComponent<Component> build_components(const Surface& surface, const JoinedTriangles& joined) {
  const Orientation& orientation = joined.orientation;
  const EdgeMarks& marks = joined.marks;
  PerComponent<Component> components;
  components.resize(orientation.orientable.size());
  PerTriangle<Index> local_triangle(surface.triangles.rows());
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    if (orientation.component[f] == none) continue;
    Component& component = components[orientation.component[f]];
    local_triangle[f] = static_cast<Index>(component.source_triangle.size());
    component.source_triangle.push_back(f);
    component.reversed.push_back(orientation.reversed[f]);
  }
  // The halfedge of a reversed triangle runs the other way: corners (0, 2, 1), halfedges (2, 1, 0).
  const auto local_halfedge = [&](Index h) {
    const Index f = h / 3, c = h % 3;
    return 3 * local_triangle[f] + (orientation.reversed[f] ? 2 - c : c);
  };
  const PerVertex<char> is_junction = feature_junctions(surface, joined);
  for (std::size_t i = 0; i < components.size(); ++i) {
    Component& component = components[i];
    component.orientable = orientation.orientable[i];
    if (!component.orientable) continue;
    HalfedgeMesh& mesh = component.mesh;
    mesh.triangles.resize(ssize(component.source_triangle), 3);
    mesh.twin.resize(mesh.halfedge_count());
    mesh.cuttable.resize(mesh.halfedge_count());
    mesh.seam.resize(mesh.halfedge_count());
    if (!marks.factor.empty()) mesh.cut_factor.resize(mesh.halfedge_count());
    for (const Index f : component.source_triangle) {
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        const Index edge = joined.edges.edge_of(h), local = local_halfedge(h);
        mesh.cuttable[local] = marks.cuttable[edge];
        mesh.seam[local] = marks.seam[edge];
        if (marks.feature[edge]) mark_feature(local, mesh);
        if (!marks.factor.empty()) mesh.cut_factor[local] = marks.factor[edge];
        mesh.twin[local] = joined.twin[h] == none ? none : local_halfedge(joined.twin[h]);
      }
    }
    number_vertices(surface, component);
    if (mesh.has_features()) {
      for (const Index v : component.source_vertex) mesh.is_feature_junction.push_back(is_junction[v]);
    }
    measure_topology(mesh);
  }
  return components;
}

}  // namespace

Index label_parts(const HalfedgeMesh& mesh, const PerHalfedge<char>& open, PerTriangle<Index>& part) {
  UnionFind parts(mesh.triangle_count());
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!open[h] && h < mesh.twin[h]) parts.unite(h / 3, mesh.twin[h] / 3);
  }
  part.resize(mesh.triangle_count());
  Index count = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const Index lowest = parts.find(f);
    part[f] = lowest == f ? count++ : part[lowest];
  }
  return count;
}

Topology build_topology(const Surface& surface, const OpenSeams& open_seams, std::vector<Finding>& findings) {
  // Halfedges, edges while they are sorted, and the geometry that follows.
  constexpr double bytes_a_triangle = 250;
  require_memory(bytes_a_triangle * static_cast<double>(surface.triangles.rows()));
  Topology topology;
  PerTriangle<char> skip(surface.triangles.rows(), 0);
  topology.collapsed = leave_out_collapsed(surface, skip);
  EdgeTable edges(surface, skip);
  topology.duplicates = leave_out_duplicates(surface, skip, edges, findings);
  for (const auto& pair : find_neighbors(surface, edges, topology.collapsed)) topology.duplicates.push_back(pair);
  const EdgeMarks marks = marks_of(surface, edges, topology.collapsed);
  const PerHalfedge<Index> twin = join_halfedges(surface, edges, marks, open_seams, skip);
  const Orientation orientation = orient(surface, skip, twin);
  topology.components = build_components(surface, {edges, marks, twin, orientation});
  report_crowded_edges(surface, edges, findings);
  report_fans(topology.components, mark_opened(surface, edges, twin, orientation), findings);
  report_turned(orientation, findings);
  return topology;
}

}  // namespace lsgp

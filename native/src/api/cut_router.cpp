// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/cut_router.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/array.hpp"
#include "base/text.hpp"
#include "cut/cut_reroute.hpp"
#include "mesh/edge_table.hpp"
#include "pipeline/validation.hpp"
#include "plane/overlaps.hpp"

namespace lsgp {

namespace {

// One of the caller's triangles in its component.
struct LocalTriangle {
  Index component = none, triangle = none;
};

Surface without_seams(Surface surface) {
  require_valid(surface);
  surface.seams.resize(0, 2);
  surface.borders.resize(0, 2);
  return surface;
}

}  // namespace

struct CutRouter::Kept {
  explicit Kept(Surface given);
  Index edge_between(Index a, Index b) const;
  // The halfedge of a component on one side of an edge, and the component; none for triangles in no component.
  std::pair<Index, Index> local_halfedge(Index source) const;
  // Halfedges of one component along the caller's path, and the component.
  std::pair<Array<Index>, Index> along(const std::vector<Index>& path) const;

  const Surface surface;
  const EdgeTable edges;
  PerComponent<Component> components;
  PerComponent<Geometry> geometry;
  PerTriangle<LocalTriangle> place;
};

CutRouter::Kept::Kept(Surface given)
    : surface(without_seams(std::move(given))), edges(surface, PerTriangle<char>(surface.triangles.rows(), 0)) {
  std::vector<Finding> ignored;
  components = std::move(build_topology(surface, {}, ignored).components);
  place.resize(surface.triangles.rows());
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Component& component = components[i];
    geometry.push_back(component.orientable ? build_geometry(component.mesh) : Geometry{});
    if (!component.orientable) continue;
    for (std::size_t f = 0; f < component.source_triangle.size(); ++f) {
      place[component.source_triangle[f]] = {static_cast<Index>(i), static_cast<Index>(f)};
    }
  }
}

Index CutRouter::Kept::edge_between(Index a, Index b) const {
  const auto count = static_cast<Index>(surface.positions.rows());
  if (a < 0 || b < 0 || a >= count || b >= count) {
    throw Error(Code::index_out_of_range, "A cut refers to vertices that do not exist. Pass vertices of this mesh.");
  }
  const Index edge = a == b ? none : edges.find(a, b);
  if (edge == none) {
    throw Error(Code::edge_not_in_mesh, "A cut does not follow the edges of this mesh. Pass edges of triangles.",
                {ElementKind::edges, {a, b}});
  }
  return edge;
}

std::pair<Index, Index> CutRouter::Kept::local_halfedge(Index source) const {
  const LocalTriangle& at = place[source / 3];
  if (at.component == none) return {none, none};
  const bool reversed = components[at.component].reversed[at.triangle];
  return {3 * at.triangle + (reversed ? 2 - source % 3 : source % 3), at.component};
}

std::pair<Array<Index>, Index> CutRouter::Kept::along(const std::vector<Index>& path) const {
  Array<Index> halfedges;
  Index component = none;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Index edge = edge_between(path[i], path[i + 1]);
    // At an edge of several sheets it is the cut of the component that it has run through, or of the first one.
    Index h = none, owner = none;
    for (Index side = 0; side < edges.halfedge_count(edge) && h == none; ++side) {
      const auto [at, on] = local_halfedge(edges.halfedge(edge, side));
      const bool is_inside = at != none && components[on].mesh.twin[at] != none;
      if (is_inside && (component == none || on == component)) std::tie(h, owner) = std::pair(at, on);
    }
    if (h == none) {
      throw Error(Code::cut_not_movable, "The cut runs along a boundary of the mesh, which stays where it is.",
                  {ElementKind::edges, {path[i], path[i + 1]}});
    }
    component = owner;
    const Component& on = components[component];
    if (on.source_vertex[on.mesh.origin(h)] != path[i]) h = on.mesh.twin[h];
    halfedges.push_back(h);
  }
  return {std::move(halfedges), component};
}

struct GrabbedCut::Kept {
  Kept(std::shared_ptr<const CutRouter::Kept> router, Index component, MovedCut cut)
      : router(std::move(router)),
        component(this->router->components[component]),
        reroute({this->component.mesh, this->router->geometry[component]}, std::move(cut)) {
    for (const Index h : reroute.path()) {
      const auto pairs = sides(h);
      left.insert(left.end(), {pairs[0], pairs[2]});
      right.insert(right.end(), {pairs[1], pairs[3]});
    }
  }

  // The caller's corners on the left and on the right at a halfedge's origin and at its target.
  std::array<Index, 4> sides(Index h) const {
    const Index twin = component.mesh.twin[h];
    return {component.source_corner(h), component.source_corner(next(twin)), component.source_corner(next(h)),
            component.source_corner(twin)};
  }

  Index local_vertex(Index vertex) const {
    const auto& source = component.source_vertex;
    const auto found = std::find(source.begin(), source.end(), vertex);
    if (found == source.end()) {
      throw Error(Code::cut_not_movable, "A cut cannot leave its connected component.");
    }
    return static_cast<Index>(found - source.begin());
  }

  const std::shared_ptr<const CutRouter::Kept> router;
  const Component& component;
  const CutReroute reroute;
  std::vector<Index> left, right;
};

CutRouter::CutRouter(Surface surface) : kept_(std::make_shared<const Kept>(std::move(surface))) {}
CutRouter::~CutRouter() = default;
CutRouter::CutRouter(CutRouter&&) noexcept = default;

GrabbedCut CutRouter::grab(const VertexPairs& cuts, const std::vector<Index>& path,
                           const std::vector<Index>& nodes) const {
  if (path.size() < 2) throw Error(Code::wrong_parameter, "A cut has at least two vertices. Pass more.");
  auto [halfedges, owner] = kept_->along(path);
  const Component& component = kept_->components[owner];
  const HalfedgeMesh& mesh = component.mesh;
  MovedCut cut{halfedges, PerHalfedge<char>(mesh.halfedge_count(), 0), PerVertex<char>(mesh.vertex_count(), 0)};
  for (Index row = 0; row < cuts.rows(); ++row) {
    const Index edge = kept_->edge_between(cuts(row, 0), cuts(row, 1));
    for (Index i = 0; i < kept_->edges.halfedge_count(edge); ++i) {
      const auto [h, in] = kept_->local_halfedge(kept_->edges.halfedge(edge, i));
      if (h != none && in == owner) cut.is_other[h] = 1;
    }
  }
  for (const Index h : halfedges) cut.is_other[h] = cut.is_other[mesh.twin[h]] = 0;
  PerVertex<char> is_node(kept_->surface.positions.rows(), 0);
  for (const Index v : nodes) {
    if (v < 0 || v >= ssize(is_node)) {
      throw Error(Code::index_out_of_range, concat("There is no vertex ", v, ". Pass vertices of this mesh as nodes."));
    }
    is_node[v] = 1;
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) cut.is_node[v] = is_node[component.source_vertex[v]];
  return GrabbedCut(std::make_unique<GrabbedCut::Kept>(kept_, owner, std::move(cut)));
}

GrabbedCut::GrabbedCut(std::unique_ptr<Kept> kept) : kept_(std::move(kept)) {}
GrabbedCut::~GrabbedCut() = default;
GrabbedCut::GrabbedCut(GrabbedCut&&) noexcept = default;

const std::vector<Index>& GrabbedCut::left() const { return kept_->left; }
const std::vector<Index>& GrabbedCut::right() const { return kept_->right; }

ReroutedCut GrabbedCut::through(Index vertex) const {
  const Component& component = kept_->component;
  const HalfedgeMesh& mesh = component.mesh;
  const Array<Index> way = kept_->reroute.way_through(kept_->local_vertex(vertex));
  const Array<int> powers = kept_->reroute.powers(way);
  ReroutedCut out;
  out.path.push_back(component.source_vertex[mesh.origin(way.front())]);
  for (const Index h : way) out.path.push_back(component.source_vertex[mesh.target(h)]);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    if (powers[f] == 0) continue;
    // Ascending as the caller's are.
    out.triangles.push_back(component.source_triangle[f]);
    out.powers.push_back(powers[f]);
  }
  for (const Index h : kept_->reroute.path()) {
    if (powers[h / 3] - powers[mesh.twin[h] / 3] != 1) continue;
    const auto pairs = kept_->sides(h);
    out.joins.insert(out.joins.end(), pairs.begin(), pairs.end());
  }
  return out;
}

std::vector<Index> overlapping_triangles(const CornerUv& corner_uv) {
  require_countable(corner_uv.rows() / 3, "triangles");
  if (corner_uv.rows() % 3 != 0) {
    throw Error(Code::wrong_parameter,
                concat("There are ", corner_uv.rows(), " texture coordinates. Give three for each triangle."));
  }
  double largest = 0;
  for (const double coordinate : corner_uv.reshaped()) {
    if (std::isfinite(coordinate)) largest = std::max(largest, std::abs(coordinate));
  }
  // Areas of any size are numbers then.
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  Eigen::VectorXcd position(corner_uv.rows());
  for (Eigen::Index corner = 0; corner < position.size(); ++corner) {
    position[corner] = {std::scalbn(corner_uv(corner, 0), -exponent), std::scalbn(corner_uv(corner, 1), -exponent)};
  }
  std::vector<Index> out;
  for (const Overlap& pair : find_overlaps(position)) out.insert(out.end(), {pair.first, pair.second});
  sort_unique(out);
  return out;
}

}  // namespace lsgp

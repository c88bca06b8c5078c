// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "lsgp/lsgp.hpp"
#include "lsgp/shaping.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"
#include "pipeline/components.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "shaping/map_copies.hpp"
#include "shaping/quad_grid.hpp"
#include "shaping/rectangle.hpp"

namespace lsgp {

namespace {

// Of a patch's size: how far pins may be from where the shape has them, as coordinates have single precision.
constexpr double pin_tolerance = 1e-5;

// The map, changed patch by patch and island by island.
class Shaping {
 public:
  Shaping(const Surface& surface, const CornerUv& corner_uv, const ShapeRequest& request)
      : copies_(copies_of_map(surface, corner_uv)),
        is_chosen_(surface.triangles.rows(), 0),
        is_corner_(surface.positions.rows(), 0),
        is_pinned_(3 * surface.triangles.rows(), 0),
        patch_of_(surface.triangles.rows(), none),
        before_(corner_uv) {
    out_.corner_uv = corner_uv;
    for (const Index f : request.triangles) is_chosen_[f] = 1;
    for (const Index v : request.corners) is_corner_[v] = 1;
    for (const Index corner : request.pinned) is_pinned_[corner] = 1;
  }

  ShapedMap shaped(PatchShape shape, ProgressMonitor& monitor) {
    shape_all(shape, monitor);
    follow_all(monitor);
    Array<Index> patches;
    for (Index f = 0; f < ssize(patch_of_); ++f) {
      if (patch_of_[f] != none) patches.push_back(patch_of_[f]);
      const auto now = out_.corner_uv.middleRows(3 * f, 3);
      if (now.allFinite() && now != before_.middleRows(3 * f, 3)) out_.moved.push_back(f);
    }
    sort_unique(patches);
    out_.patches = static_cast<Index>(patches.size());
    if (patches.empty() && failure_) throw Error(*failure_);
    return std::move(out_);
  }

 private:
  bool is_shaped(Index triangle) const { return patch_of_[triangle] != none; }
  Complex uv(Index corner) const { return {out_.corner_uv(corner, 0), out_.corner_uv(corner, 1)}; }

  // The corner of the caller's of one of a component's.
  static Index corner_of(const MapCopies& part, const Component& component, Index corner) {
    const Index at = component.source_corner(corner);
    return 3 * part.source_triangle[at / 3] + at % 3;
  }

  void shape_all(PatchShape shape, ProgressMonitor& monitor) {
    Array<Index> chosen;
    for (Index i = 0; i < ssize(copies_.source_triangle); ++i) {
      if (is_chosen_[copies_.source_triangle[i]]) chosen.push_back(i);
    }
    const MapCopies part = part_of(copies_, chosen);
    std::vector<Finding> unsaid;
    const Topology topology = build_topology(part.surface, {}, unsaid);
    for (Index i = 0; i < ssize(topology.components); ++i) {
      const Component& component = topology.components[static_cast<std::size_t>(i)];
      monitor.tick();
      try {
        shape_one(part, component, shape);
        for (const Index f : component.source_triangle) patch_of_[part.source_triangle[f]] = i;
      } catch (const Error& error) {
        leave(part, component, error);
      }
    }
  }

  // Notes why triangles stay as they are, and has them do so.
  void leave(const MapCopies& part, const Component& component, const Error& error) {
    if (error.code() == Code::cancelled || error.code() == Code::out_of_memory) throw Error(error);
    Elements elements{ElementKind::triangles, {}};
    for (const Index f : component.source_triangle) {
      const Index source = part.source_triangle[f];
      elements.indices.push_back(source);
      patch_of_[source] = none;
      out_.corner_uv.middleRows(3 * source, 3) = before_.middleRows(3 * source, 3);
    }
    std::sort(elements.indices.begin(), elements.indices.end());
    const Error said(Code::shape_impossible, in_words(error).what(), elements);
    if (!failure_) failure_ = said;
    out_.warnings.push_back({said.code(), said.what(), said.elements()});
  }

  void shape_one(const MapCopies& part, const Component& component, PatchShape shape) {
    if (!component.orientable) {
      throw Error(Code::shape_impossible, "The faces have one side only, as a Moebius strip. Cut them.");
    }
    const HalfedgeMesh& mesh = component.mesh;
    const Geometry geometry = build_geometry(mesh);
    const MetricMesh surface{mesh, geometry};
    Eigen::VectorXcd place =
        shape == PatchShape::rectangle
            ? rectangle_of(component, surface)
            : lay_on_grid(surface, shape == PatchShape::even_grid ? GridSpacing::even : GridSpacing::mesh,
                          shape == PatchShape::strip ? 1 : mesh.triangle_count());
    put_in_place(part, component, place);
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      const Index source = corner_of(part, component, corner);
      out_.corner_uv.row(source) << place[mesh.origin(corner)].real(), place[mesh.origin(corner)].imag();
    }
  }

  // Between its boundaries, the map of least stretch.
  Eigen::VectorXcd rectangle_of(const Component& component, const MetricMesh& surface) const {
    const HalfedgeMesh& mesh = component.mesh;
    PerVertex<char> is_corner(mesh.vertex_count(), 0);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      is_corner[v] = is_corner_[copies_.source_vertex[component.source_vertex[v]]];
    }
    const RectangularBoundary boundary = lay_on_rectangle(surface, is_corner);
    Eigen::VectorXcd out = Eigen::VectorXcd::Zero(mesh.vertex_count());
    PerVertex<char> is_fixed(mesh.vertex_count(), 0);
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i) {
      out[boundary.vertices[i]] = boundary.positions[i];
      is_fixed[boundary.vertices[i]] = 1;
    }
    Surface inside;
    inside.positions = mesh.positions;
    inside.triangles = mesh.triangles;
    inside.scale = mesh.scale;
    Pins pins;
    Array<Complex> positions;
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      if (!is_fixed[mesh.origin(corner)]) continue;
      pins.corners.push_back(corner);
      positions.push_back(out[mesh.origin(corner)]);
    }
    const CornerUv solved = with_pins(inside, std::move(pins), positions);
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      out[mesh.origin(corner)] = {solved(corner, 0), solved(corner, 1)};
    }
    return out;
  }

  // The map of least stretch with these pins and no cuts. Throws what `parameterize` throws, SHAPE_IMPOSSIBLE.
  CornerUv with_pins(const Surface& surface, Pins pins, const Array<Complex>& positions) const {
    pins.positions.resize(ssize(positions), 2);
    for (Index i = 0; i < ssize(positions); ++i) pins.positions.row(i) << positions[i].real(), positions[i].imag();
    Options options;
    options.mode = Mode::low_stretch;
    const Result result = map_with(surface, options, pins);
    if (result.cut_edges.rows() > 0 || !result.corner_uv.allFinite()) {
      throw Error(
          Code::shape_impossible,
          "The other faces of the island have a hole or a handle, and cannot follow. Choose all of its faces, or "
          "cut it.");
    }
    return result.corner_uv;
  }

  static Result map_with(const Surface& surface, const Options& options, const Pins& pins) {
    try {
      return parameterize(surface, {}, options, pins);
    } catch (const Error& error) {
      if (error.code() != Code::pins_conflict) throw;
      throw Error(
          Code::shape_impossible,
          "The chosen faces touch at a vertex, which would have to be in two places. Choose faces that are joined "
          "along edges, or all of the island.");
    }
  }

  // Turned by quarters, scaled and moved to where the patch is in the map. Throws SHAPE_IMPOSSIBLE.
  void put_in_place(const MapCopies& part, const Component& component, Eigen::VectorXcd& place) const {
    const HalfedgeMesh& mesh = component.mesh;
    const auto area_and_middle = [&](const auto& at) {
      double area = 0;
      Complex middle = 0;
      for (Index f = 0; f < mesh.triangle_count(); ++f) {
        const Complex a = at(3 * f), b = at(3 * f + 1), c = at(3 * f + 2);
        const double doubled = std::imag(std::conj(b - a) * (c - a));
        area += doubled / 2;
        middle += doubled / 6 * (a + b + c);
      }
      return std::make_pair(area, middle / area);
    };
    const auto now = [&](Index corner) { return uv(corner_of(part, component, corner)); };
    const auto [area, middle] = area_and_middle(now);
    if (area < 0) place = place.conjugate().eval();  // it is mirrored in the map
    const auto then = [&](Index corner) { return place[mesh.origin(corner)]; };
    const auto [new_area, new_middle] = area_and_middle(then);
    if (!(std::isfinite(std::abs(middle)) && std::isfinite(std::abs(new_middle)))) {
      throw Error(Code::shape_impossible, "The faces have no area in the map. Unwrap them first.");
    }
    Complex along = 0;
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      along += std::conj(then(corner) - new_middle) * (now(corner) - middle);
    }
    const double quarters = std::round(std::arg(along) / (M_PI / 2));
    // Exactly, so that the sides are along the axes.
    const std::array<Complex, 4> turns{Complex{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const Complex turn = element(turns, (static_cast<int>(quarters) + 4) % 4) * std::sqrt(std::abs(area / new_area));
    for (Complex& z : place) z = middle + turn * (z - new_middle);
    move_onto_pins(part, component, place);
  }

  // By a translation. Throws SHAPE_IMPOSSIBLE.
  void move_onto_pins(const MapCopies& part, const Component& component, Eigen::VectorXcd& place) const {
    const HalfedgeMesh& mesh = component.mesh;
    Complex away = 0;
    Array<std::pair<Index, Complex>> pins;
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      const Index source = corner_of(part, component, corner);
      if (!is_pinned_[source]) continue;
      pins.emplace_back(mesh.origin(corner), uv(source));
      away += uv(source) - place[mesh.origin(corner)];
    }
    if (pins.empty()) return;
    place.array() += away / static_cast<double>(pins.size());
    const double size = (place.array() - place[0]).abs().maxCoeff();
    for (const auto& [v, position] : pins) {
      if (std::abs(place[v] - position) > pin_tolerance * size) {
        throw Error(Code::shape_impossible, "The pins of the faces are not where the shape has them. Unpin them.");
      }
      place[v] = position;
    }
  }

  void follow_all(ProgressMonitor& monitor) {
    std::vector<Finding> unsaid;
    const Topology topology = build_topology(copies_.surface, {}, unsaid);
    for (const Component& island : topology.components) {
      monitor.tick();
      Index shaped = 0;
      for (const Index f : island.source_triangle) shaped += is_shaped(copies_.source_triangle[f]);
      if (shaped == 0 || shaped == ssize(island.source_triangle)) continue;
      try {
        follow(island);
      } catch (const Error& error) {
        leave(copies_, island, error);
      }
    }
  }

  // The other triangles of an island, whose shaped ones stay.
  void follow(const Component& island) {
    const MapCopies part = part_of(copies_, island.source_triangle);
    Pins pins;
    Array<Complex> positions;
    double area = 0;
    for (Index f = 0; f < ssize(part.source_triangle); ++f) {
      const Index source = part.source_triangle[f];
      area += std::imag(std::conj(uv(3 * source + 1) - uv(3 * source)) * (uv(3 * source + 2) - uv(3 * source)));
    }
    const bool is_mirrored = area < 0;
    for (Index corner = 0; corner < part.surface.triangles.size(); ++corner) {
      const Index source = 3 * part.source_triangle[corner / 3] + corner % 3;
      if (!is_shaped(source / 3) && !is_pinned_[source]) continue;
      pins.corners.push_back(corner);
      positions.push_back(is_mirrored ? std::conj(uv(source)) : uv(source));
    }
    const CornerUv solved = with_pins(part.surface, std::move(pins), positions);
    Array<Index> flipped;
    for (Index f = 0; f < ssize(part.source_triangle); ++f) {
      const Index source = part.source_triangle[f];
      if (is_shaped(source)) continue;
      for (const Index c : {0, 1, 2}) {
        out_.corner_uv.row(3 * source + c) << solved(3 * f + c, 0), (is_mirrored ? -1 : 1) * solved(3 * f + c, 1);
      }
      const Complex a = uv(3 * source);
      const double doubled = std::imag(std::conj(uv(3 * source + 1) - a) * (uv(3 * source + 2) - a));
      if (!((is_mirrored ? -1 : 1) * doubled > 0)) flipped.push_back(source);
    }
    if (!flipped.empty()) {
      out_.warnings.push_back({Code::flipped_triangles,
                               concat(count(flipped.size(), "triangle is", "triangles are"),
                                      " flipped beside the faces that got the shape. Choose more faces, or undo."),
                               {ElementKind::triangles, flipped}});
    }
  }

  const MapCopies copies_;
  PerTriangle<char> is_chosen_;
  PerVertex<char> is_corner_;
  Array<char> is_pinned_;
  PerTriangle<Index> patch_of_;  // none: it does not have the shape
  const CornerUv before_;
  ShapedMap out_;
  std::optional<Error> failure_;  // the first one
};

void require_indices(const char* what, const std::vector<Index>& indices, Eigen::Index count) {
  for (const Index i : indices) {
    if (i >= 0 && i < count) continue;
    throw Error(Code::index_out_of_range, concat("There is no ", what, " ", i, ". Name some of the surface."));
  }
}

}  // namespace

ShapedMap shape_patches(const Surface& surface, const CornerUv& corner_uv, const ShapeRequest& request,
                        const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface);
  require_one_each(surface, corner_uv);
  require_indices("triangle", request.triangles, surface.triangles.rows());
  require_indices("vertex", request.corners, surface.positions.rows());
  require_indices("corner", request.pinned, surface.triangles.size());
  ShapedMap out = Shaping(surface, corner_uv, request).shaped(request.shape, monitor);
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/compact_islands.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "base/checkpoint.hpp"
#include "division/cut_apart.hpp"
#include "division/face_graph.hpp"
#include "division/island_division.hpp"
#include "division/minimum_cut.hpp"
#include "division/straight_cuts.hpp"
#include "mesh/point_tree.hpp"
#include "plane/convex_hull.hpp"

namespace lsgp {

namespace {

constexpr int cells_across = 40;
constexpr double rounding = 1e-9;  // of what divisions are worth
// Radians: beyond what edges of coarse round shapes bend by; those of rings with five sides bend by 1.2 to 1.31.
constexpr double is_sharp = 1.4;
// An island is its own mirror image if this share of its area has an image in it, at most this far from there,
// relative to the square root of its area.
constexpr double least_reflected = 0.6, most_apart = 0.05;
constexpr double outlying = 0.5;      // distances that do not count in a first fit
constexpr double beside_axis = 0.35;  // how far a cut may be from the axis, in square roots of the mean face's area
constexpr double operations_a_face = 500;

// The face nearest to the mirror image of each.
PerFace<Index> mirror_faces(const MetricMesh& surface, const FaceGraph& graph, const MirrorPlane& plane) {
  const HalfedgeMesh& mesh = surface.mesh;
  Positions center = Positions::Zero(graph.face_count(), 3);
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      center.row(graph.face_of[f]) += surface.geometry.area[f] / 3 * mesh.positions.row(mesh.triangles(f, c));
    }
  }
  for (Index face = 0; face < graph.face_count(); ++face) center.row(face) /= graph.area[face];
  const PointTree tree(center);
  PerFace<Index> image;
  for (Index face = 0; face < graph.face_count(); ++face) {
    checkpoint(operations_a_face);
    image.push_back(tree.nearest(reflected(plane, center.row(face))).point);
  }
  return image;
}

// The same lines, seen from their other sides.
Array<Line> reversed(Array<Line> lines) {
  for (Line& line : lines) line = line.reversed();
  return lines;
}

// A reflection of the plane, which moves z to turn conj(z) + shift.
struct Reflection {
  Complex turn = 1, shift = 0;
  Complex operator()(Complex z) const { return turn * std::conj(z) + shift; }
  Line axis() const {
    const Complex normal = Complex(0, 1) * std::sqrt(turn);
    return {normal, std::real(std::conj(normal) * shift) / 2};
  }
};

class Compactor {
 public:
  // graph: of the surface.  position: at the corners, on the scale of the surface.
  // image: of each face beyond a mirror plane; empty if the islands need not be symmetric.
  Compactor(const OpenedSurface& surface, const FaceGraph& graph, PerFace<Index> image,
            const Eigen::VectorXcd& position, const SharedSquare& square)
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        graph_(graph),
        image_(std::move(image)),
        position_(position),
        search_(square),
        cutter_(graph, CutCost::shortest),
        center_(graph.face_count(), 0),
        map_area_(graph.face_count(), 0),
        place_(graph.face_count(), none),
        is_near_cut_(graph.face_count(), 0) {
    const HalfedgeMesh& mesh = surface.mesh;
    Array<Index> triangles(graph.face_count() + 1, 0);
    for (const Index face : graph.face_of) ++triangles[face + 1];
    std::partial_sum(triangles.begin(), triangles.end(), triangles.begin());
    triangle_begin_ = triangles;
    triangles_.resize(mesh.triangle_count());
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      const Index face = graph.face_of[f];
      triangles_[triangles[face]++] = f;
      map_area_[face] += doubled_area(position, f) / 2;
      center_[face] +=
          position.segment<3>(3 * f).mean() / static_cast<double>(triangle_begin_[face + 1] - triangle_begin_[face]);
    }
  }

  // Returns the part of every face.
  PerFace<Index> divide_all() {
    PerFace<Index> part(graph_.face_count(), 0);
    Array<Index> all(graph_.face_count());
    std::iota(all.begin(), all.end(), 0);
    Array<Array<Index>> pending = pieces_of(all, part);
    Index count = 0;
    while (!pending.empty()) {
      const Array<Index> island = std::move(pending.back());
      pending.pop_back();
      Array<Array<Index>> pieces = divide(island);
      if (pieces.size() < 2) {
        for (const Index face : island) part[face] = count;
        ++count;
      } else {
        std::move(pieces.begin(), pieces.end(), std::back_inserter(pending));
      }
    }
    return part;
  }

  bool is_near_cut(Index face) const { return is_near_cut_[face]; }

 private:
  Array<Complex> hull_of(const Array<Index>& faces) const;
  // The connected faces of one class each.  faces: those that are divided.  class_of: by their place among them.
  Array<Array<Index>> pieces_of(const Array<Index>& faces, const Array<Index>& class_of);
  // The faces of the pieces of the best division of an island; fewer than two if it is best left whole.
  Array<Array<Index>> divide(const Array<Index>& faces);
  WholeIsland describe(const Array<Index>& faces, const Array<Complex>& hull) const;
  IslandCells cells_of(const Array<Index>& island, Complex along);
  std::optional<Line> axis_of(const Array<Index>& island);
  // Between equal pieces of an island that is a long strip, none of others.
  Array<Line> lines_across_strip(const Array<Complex>& hull, const WholeIsland& island) const;
  bool has_sharp_edges(const Array<Index>& faces);
  // What is left of an island between some lines, and what that is worth.
  struct Division {
    Array<Array<Index>> pieces;
    double worth = 0, length = 0;  // of the cuts
  };
  Division divided_at(const Array<Line>& lines, double band, const Array<Index>& faces, const WholeIsland& island);
  // A long strip into equal pieces, if that gains anything.
  Division divided_evenly(const Array<Index>& faces, const Array<Complex>& hull, const WholeIsland& island);
  Reflection fit_reflection(const Array<Index>& faces) const;
  Array<Index> cut_along(const Array<Line>& lines, const Array<Index>& island, double band);
  Array<Index> without_slivers(const Array<Index>& faces, const WholeIsland& island, const Array<Index>& class_of);
  double length_between(const Array<Index>& faces, const Array<Index>& class_of);
  // The length with which an edge counts in the price of a division: expensive edges, which cuts avoid as far as they
  // can, are no reason to leave an island undivided.
  double priced_length(const FaceGraph::Link& link) const {
    return std::min(graph_.unit * static_cast<double>(link.cost), geometry_.length[link.halfedge]);
  }
  bool is_smooth(const FaceGraph::Link& link) const { return bend_at(mesh_, link.halfedge) < is_sharp; }
  void set_places(const Array<Index>& faces) {
    for (std::size_t i = 0; i < faces.size(); ++i) place_[faces[i]] = static_cast<Index>(i);
  }
  void clear_places(const Array<Index>& faces) {
    for (const Index face : faces) place_[face] = none;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const FaceGraph& graph_;
  const PerFace<Index> image_;
  const Eigen::VectorXcd& position_;
  const DivisionSearch search_;
  MinimumCutter cutter_;
  Array<Index> triangle_begin_, triangles_;  // of every face
  PerFace<Complex> center_;
  PerFace<double> map_area_;
  PerFace<Index> place_;       // index in the current island, none elsewhere
  PerFace<char> is_near_cut_;  // may change sides
};

Array<Complex> Compactor::hull_of(const Array<Index>& faces) const {
  Index count = 0;
  for (const Index face : faces) count += triangle_begin_[face + 1] - triangle_begin_[face];
  Eigen::VectorXcd points(3 * count);
  Index next = 0;
  for (const Index face : faces) {
    for (Index i = triangle_begin_[face]; i < triangle_begin_[face + 1]; ++i, next += 3) {
      points.segment<3>(next) = position_.segment<3>(3 * triangles_[i]);
    }
  }
  return convex_hull(points);
}

Array<Array<Index>> Compactor::pieces_of(const Array<Index>& faces, const Array<Index>& class_of) {
  set_places(faces);
  Array<char> is_listed(faces.size(), 0);
  Array<Array<Index>> pieces;
  for (std::size_t seed = 0; seed < faces.size(); ++seed) {
    if (is_listed[seed]) continue;
    is_listed[seed] = 1;
    Array<Index> piece{faces[seed]};
    for (std::size_t i = 0; i < piece.size(); ++i) {
      graph_.for_each_link(piece[i], [&](Index other, const FaceGraph::Link&) {
        const Index at = place_[other];
        if (at == none || is_listed[at] || class_of[at] != class_of[seed]) return;
        is_listed[at] = 1;
        piece.push_back(other);
      });
    }
    pieces.push_back(std::move(piece));
  }
  clear_places(faces);
  return pieces;
}

// Faces of one square of a grid that are connected there.
IslandCells Compactor::cells_of(const Array<Index>& island, Complex along) {
  Array<Complex> centers;
  for (const Index face : island) centers.push_back(center_[face]);
  const Extent extent = extent_along(centers, along);
  const double size = std::max(extent.width(), extent.height()) / cells_across;
  Array<Index> square_of;
  for (const Complex z : centers) {
    const Complex at = size > 0 ? (z * std::conj(along) - extent.low) / size : 0;
    square_of.push_back(static_cast<Index>(at.real()) + (cells_across + 1) * static_cast<Index>(at.imag()));
  }
  IslandCells cells;
  const Array<Array<Index>> pieces = pieces_of(island, square_of);
  for (std::size_t cell = 0; cell < pieces.size(); ++cell) {
    double area = 0, map_area = 0;
    Complex center = 0;
    for (const Index face : pieces[cell]) {
      place_[face] = static_cast<Index>(cell);
      area += graph_.area[face];
      map_area += map_area_[face];
      center += graph_.area[face] * center_[face];
    }
    cells.area.push_back(area);
    cells.map_area.push_back(map_area);
    cells.faces.push_back(static_cast<Index>(pieces[cell].size()));
    cells.center.push_back(area > 0 ? center / area : center_[pieces[cell].front()]);
    cells.support.emplace_back(hull_of(pieces[cell]));
  }
  for (const Index face : island) {
    graph_.for_each_link(face, [&](Index other, const FaceGraph::Link& link) {
      if (place_[other] == none || place_[other] <= place_[face]) return;
      cells.links.push_back({{place_[face], place_[other]}, priced_length(link), is_smooth(link)});
    });
  }
  clear_places(island);
  return cells;
}

// The line at which the plane mirrors an island of the layout, if it does.
std::optional<Line> Compactor::axis_of(const Array<Index>& island) {
  if (image_.empty()) return std::nullopt;
  set_places(island);
  Array<Index> fitted;
  double whole = 0;
  for (const Index face : island) {
    whole += graph_.area[face];
    if (image_[face] != none && place_[image_[face]] != none) fitted.push_back(face);
  }
  clear_places(island);
  // Faces across the plane are near their own images, but may lie elsewhere on the island.
  for (const double most : {outlying, most_apart}) {
    const Reflection reflection = fit_reflection(fitted);
    const auto is_apart = [&](Index face) {
      return std::abs(reflection(center_[face]) - center_[image_[face]]) > most * std::sqrt(whole);
    };
    fitted.erase(std::remove_if(fitted.begin(), fitted.end(), is_apart), fitted.end());
  }
  double reflected = 0;
  for (const Index face : fitted) reflected += graph_.area[face];
  if (reflected < least_reflected * whole) return std::nullopt;
  return fit_reflection(fitted).axis();
}

// The reflection in the plane nearest to that which moves faces to their images.
Reflection Compactor::fit_reflection(const Array<Index>& faces) const {
  double area = 0;
  Complex from = 0, to = 0, turn = 0;
  for (const Index face : faces) {
    area += graph_.area[face];
    from += graph_.area[face] * center_[face];
    to += graph_.area[face] * center_[image_[face]];
  }
  if (!(area > 0)) return {};
  from /= area;
  to /= area;
  for (const Index face : faces) turn += graph_.area[face] * (center_[image_[face]] - to) * (center_[face] - from);
  turn = std::polar(1.0, std::arg(turn));
  return {turn, to - turn * std::conj(from)};
}

// The side of every face, by its index in the island, after a cut near each of the lines, short and preferably along
// sharp edges.
Array<Index> Compactor::cut_along(const Array<Line>& lines, const Array<Index>& island, double band) {
  Array<Index> class_of(island.size(), 0);
  Index classes = 1;
  for (const Line& line : lines) {
    for (Index divided = 0; divided < classes; ++divided) {
      Array<Index> scope, places, first, second;
      for (std::size_t i = 0; i < island.size(); ++i) {
        if (class_of[i] != divided) continue;
        scope.push_back(island[i]);
        places.push_back(static_cast<Index>(i));
        const double distance = line.distance(center_[island[i]]);
        if (std::abs(distance) > band)
          (distance > 0 ? first : second).push_back(island[i]);
        else
          is_near_cut_[island[i]] = 1;
      }
      if (first.empty() || second.empty()) {
        for (std::size_t i = 0; i < scope.size(); ++i) {
          if (line.distance(center_[scope[i]]) > 0) class_of[places[i]] = classes + divided;
        }
        continue;
      }
      const MinimumCut cut = cutter_.cut(scope, first, second);
      for (std::size_t i = 0; i < scope.size(); ++i) {
        if (cut.is_first[i]) class_of[places[i]] = classes + divided;
      }
    }
    classes *= 2;
  }
  return class_of;
}

// Pieces too small to be islands join the neighbor with the longest common boundary.
Array<Index> Compactor::without_slivers(const Array<Index>& faces, const WholeIsland& island,
                                        const Array<Index>& class_of) {
  const Array<Array<Index>> pieces = pieces_of(faces, class_of);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const Index face : pieces[i]) place_[face] = static_cast<Index>(i);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Piece piece;
    piece.faces = static_cast<Index>(pieces[i].size());
    Array<double> border(pieces.size(), 0);
    for (const Index face : pieces[i]) {
      piece.area += graph_.area[face];
      piece.map_area += map_area_[face];
      graph_.for_each_link(face, [&](Index other, const FaceGraph::Link& link) {
        const Index beside = place_[other];
        if (beside == none || beside == place_[face]) return;
        border[beside] += static_cast<double>(link.cost);
        piece.ends_smoothly = piece.ends_smoothly || is_smooth(link);
      });
    }
    if (pieces.size() < 2 || search_.may_be_cut_off(piece, island)) continue;
    const auto longest = std::max_element(border.begin(), border.end());
    for (const Index face : pieces[i]) place_[face] = static_cast<Index>(longest - border.begin());
  }
  Array<Index> out;
  for (const Index face : faces) out.push_back(place_[face]);
  clear_places(faces);
  return out;
}

double Compactor::length_between(const Array<Index>& faces, const Array<Index>& class_of) {
  set_places(faces);
  double length = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    graph_.for_each_link(faces[i], [&](Index other, const FaceGraph::Link& link) {
      const Index at = place_[other];
      if (at != none && class_of[at] < class_of[i]) length += priced_length(link);
    });
  }
  clear_places(faces);
  return length;
}

WholeIsland Compactor::describe(const Array<Index>& faces, const Array<Complex>& hull) const {
  double area = 0, squares = 0;
  for (const Index face : faces) {
    area += graph_.area[face];
    squares += graph_.area[face] * std::norm(std::log(map_area_[face] / graph_.area[face]));
  }
  WholeIsland out = search_.describe(area, Support(hull));
  out.unevenness = std::sqrt(squares / area);
  return out;
}

Array<Line> Compactor::lines_across_strip(const Array<Complex>& hull, const WholeIsland& island) const {
  constexpr double least_filled = 0.9;  // of its box
  const Complex along = longer_side(hull);
  const Extent extent = extent_along(hull, along);
  if (!island.is_long || island.area < least_filled * extent.width() * extent.height()) return {};
  const Index count = search_.pieces_of_strip(extent.width());
  Array<Line> out;
  for (Index i = 1; i < count; ++i)
    out.push_back(Line{along, extent.low.real() + extent.width() * i / count}.reversed());
  return out;
}

bool Compactor::has_sharp_edges(const Array<Index>& faces) {
  bool out = false;
  set_places(faces);
  for (const Index face : faces) {
    graph_.for_each_link(face, [&](Index other, const FaceGraph::Link& link) {
      out = out || (place_[other] != none && !is_smooth(link));
    });
  }
  clear_places(faces);
  return out;
}

Compactor::Division Compactor::divided_at(const Array<Line>& lines, double band, const Array<Index>& faces,
                                          const WholeIsland& island) {
  const Array<Index> class_of = without_slivers(faces, island, cut_along(lines, faces, band));
  Division out{pieces_of(faces, class_of)};
  double after = 0;
  for (const Array<Index>& piece : out.pieces) after += search_.demand(Support(hull_of(piece)));
  out.length = length_between(faces, class_of);
  out.worth = search_.worth(island.demand - after, out.length, out.pieces.size());
  return out;
}

Compactor::Division Compactor::divided_evenly(const Array<Index>& faces, const Array<Complex>& hull,
                                              const WholeIsland& island) {
  const Array<Line> lines = lines_across_strip(hull, island);
  if (lines.empty() || has_sharp_edges(faces)) return {};
  // Cuts in a wide band hug one end of it, but follow rows of faces that are bent in the map.
  constexpr double narrow = 0.02, wide = 0.1;  // of a piece
  constexpr double clearly_shorter = 0.98;
  const double length = extent_along(hull, lines.front().normal).width() / static_cast<double>(lines.size() + 1);
  const double row = beside_axis * std::sqrt(island.area / static_cast<double>(faces.size()));
  Division out;
  for (const double share : {narrow, wide}) {
    Division made = divided_at(lines, std::max(share * length, row), faces, island);
    const bool is_better =
        made.pieces.size() == out.pieces.size() ? made.length < clearly_shorter * out.length : made.worth > out.worth;
    if (made.worth > 0 && (out.pieces.empty() || is_better)) out = std::move(made);
  }
  return out;
}

Array<Array<Index>> Compactor::divide(const Array<Index>& faces) {
  if (faces.size() < 2) return {};
  const Array<Complex> hull = hull_of(faces);
  const WholeIsland island = describe(faces, hull);
  if (island.demand - island.area < search_.least_gain()) return {};
  Division best = divided_evenly(faces, hull, island);
  // Others are mostly into two pieces, which are divided again: what one of them is worth says nothing about all.
  if (best.pieces.size() > 2) return std::move(best.pieces);
  const std::optional<Line> axis = axis_of(faces);
  const Complex along = axis ? axis->normal : longer_side(hull);
  const IslandDivision division = search_.find_division(cells_of(faces, along), island, hull, along, axis);
  if (division.lines.empty()) return std::move(best.pieces);
  // A single line is the axis or at right angles to it.
  const bool is_axis = axis && division.lines.size() == 1 &&
                       std::abs(std::real(std::conj(axis->normal) * division.lines.front().normal)) > 0.5;
  const double band = is_axis ? beside_axis * std::sqrt(island.area / static_cast<double>(faces.size()))
                              : extent_along(hull, along).width() / division_positions;
  bool is_found = false;
  // Where the shortest cut of a band leaves too small a piece, a cut nearer to the line may not.
  for (const double width : {band, band / 4}) {
    // Of equally short cuts, one hugs one end of the band and one the other.
    for (const Array<Line>& lines : {division.lines, reversed(division.lines)}) {
      Division made = divided_at(lines, width, faces, island);  // the cells only gave an estimate of the gain
      is_found = is_found || made.worth > 0;
      if (made.worth > best.worth * (1 + rounding)) best = std::move(made);
    }
    if (is_found) break;
  }
  return std::move(best.pieces);
}

}  // namespace

bool compact_islands(const OpenedSurface& surface, const Mirroring& mirroring, const SharedSquare& square,
                     ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerHalfedge<char> ends = surface.open, is_cut = map.cut_graph.is_cut;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) ends[h] = ends[h] || is_cut[h];
  const OpenedSurface islands{surface, ends};
  const FaceGraph graph = build_face_graph(islands);
  const Eigen::VectorXcd position = square.scale * at_corners(map.cut_mesh, map.position);
  PerFace<Index> image;
  if (are_mirrored(mirroring, map.cones)) image = mirror_faces(surface, graph, mirroring.plane);
  Compactor compactor(islands, graph, std::move(image), position, square);
  PerFace<Index> part = compactor.divide_all();
  straighten_cuts(islands, graph, [&](Index face, Index) { return !compactor.is_near_cut(face); }, part);
  bool has_opened = false;
  for (const FaceGraph::Link& link : graph.links) {
    if (part[link.faces[0]] == part[link.faces[1]]) continue;
    for (const Index h : {link.halfedge, mesh.twin[link.halfedge]}) ends[h] = is_cut[h] = 1;
    has_opened = true;
  }
  if (!has_opened) return false;
  PerTriangle<Index> part_of_triangle;
  const PerPart<Motion> motions(label_parts(mesh, ends, part_of_triangle));
  cut_apart(mesh, std::move(is_cut), part_of_triangle, motions, map);
  return true;
}

}  // namespace lsgp

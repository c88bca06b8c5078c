// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/compact_islands.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "base/checkpoint.hpp"
#include "base/union_find.hpp"
#include "plane/convex_hull.hpp"
#include "split/cut_apart.hpp"
#include "split/face_graph.hpp"
#include "split/minimum_cut.hpp"
#include "split/straight_cuts.hpp"

namespace lsgp {

namespace {

// Parts of the area of all islands that have to be saved: by a cut as long as the square root of that area, and by each
// further island.
constexpr double cost_of_cut = 0.15, cost_of_island = 0.01;
// Times as much for those who would rather have few cuts.
constexpr double sparing_factor = 8;
// An island takes what is halfway between its convex hull and its smallest box. Where the smallest square around it is
// larger than a part of the square that all share, it keeps others out of that square as well.
constexpr double fill = 0.62, large = 0.7, cost_of_large = 0.5;
// Of the area of all islands: what is smaller than the first is not cut, and nothing is cut off that is smaller than
// the second.
constexpr double least_island = 0.02, least_piece = 0.01;
constexpr Index most_pieces = 8;  // of one division
constexpr int directions = 12, positions = 12, cells_across = 40;
constexpr double operations_a_point = 60;  // of finding hulls

struct Line {
  Complex normal;  // of length 1
  double offset;
  // Above 0 on the side that the normal points to.
  double distance(Complex z) const { return std::real(std::conj(normal) * z) - offset; }
};

// A way to divide an island: by a line, or by two that cross.
struct Division {
  Array<Line> lines;
  double worth = 0;
};

class Compactor {
 public:
  // position: at the corners, on the scale of the surface.
  Compactor(const HalfedgeMesh& mesh, const FaceGraph& graph, const Eigen::VectorXcd& position,
            const SharedSquare& square)
      : graph_(graph),
        position_(position),
        area_(square.area),
        price_factor_(square.filling == Compactness::sparing ? sparing_factor : 1),
        cutter_(graph, CutCost::shortest),
        center_(graph.face_count(), 0),
        place_(graph.face_count(), none),
        is_near_cut_(graph.face_count(), 0) {
    Array<Index> triangles(graph.face_count() + 1, 0);
    for (const Index face : graph.face_of) ++triangles[face + 1];
    std::partial_sum(triangles.begin(), triangles.end(), triangles.begin());
    triangle_begin_ = triangles;
    triangles_.resize(mesh.triangle_count());
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      const Index face = graph.face_of[f];
      triangles_[triangles[face]++] = f;
      center_[face] +=
          position.segment<3>(3 * f).mean() / static_cast<double>(triangle_begin_[face + 1] - triangle_begin_[face]);
    }
  }

  // Returns the part of every face.
  Array<Index> divide_all() {
    Array<Index> part(graph_.face_count(), 0);
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
  // Faces taken together, to try divisions quickly.
  struct Cells {
    struct Link {
      Index cells[2];
      double length;
    };
    Array<Complex> center;
    Array<double> area;
    Array<Array<Complex>> hull;
    Array<Link> links;
    Index count() const { return static_cast<Index>(area.size()); }
  };

  // What islands of that hull take of the square.
  double demand(const Array<Complex>& hull) const;
  Array<Complex> hull_of(const Array<Index>& faces) const;
  // The connected faces of one class each.  faces: those that are divided.  class_of: by their place among them.
  Array<Array<Index>> pieces_of(const Array<Index>& faces, const Array<Index>& class_of);
  // The faces of the pieces into which an island is best cut; fewer than two pieces where it is best left whole.
  Array<Array<Index>> divide(const Array<Index>& island);
  Cells cells_of(const Array<Index>& island, Complex along);
  double worth(const Cells& cells, const Array<Index>& class_of, double demand_before) const;
  double worth(double gain, double length, std::size_t pieces) const;
  Division find_division(const Cells& cells, const Array<Complex>& hull, Complex along) const;
  Array<Index> cut_along(const Array<Line>& lines, const Array<Index>& island, double band);
  Array<Index> without_scraps(const Array<Index>& island, const Array<Index>& class_of);
  double length_between(const Array<Index>& faces, const Array<Index>& class_of);
  void set_places(const Array<Index>& faces) {
    for (std::size_t i = 0; i < faces.size(); ++i) place_[faces[i]] = static_cast<Index>(i);
  }
  void clear_places(const Array<Index>& faces) {
    for (const Index face : faces) place_[face] = none;
  }

  const FaceGraph& graph_;
  const Eigen::VectorXcd& position_;
  const double area_, price_factor_;
  MinimumCutter cutter_;
  Array<Index> triangle_begin_, triangles_;  // of every face
  Array<Complex> center_;                    // (faces)
  Array<Index> place_;                       // (faces) among those in hand, none elsewhere
  Array<char> is_near_cut_;                  // (faces) may change sides
};

double Compactor::demand(const Array<Complex>& hull) const {
  constexpr int turns = 45;  // of a quarter
  double box = std::numeric_limits<double>::infinity(), square = box;
  for (int i = 0; i < turns; ++i) {
    const Extent extent = extent_along(hull, std::polar(1.0, M_PI / 2 * i / turns));
    box = std::min(box, extent.width() * extent.height());
    square = std::min(square, std::max(extent.width(), extent.height()));
  }
  const double too_large = std::max(0.0, square * square - large * area_ / fill);
  return (area_of_hull(hull) + box) / 2 + cost_of_large * too_large;
}

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
Compactor::Cells Compactor::cells_of(const Array<Index>& island, Complex along) {
  Array<Complex> centers;
  for (const Index face : island) centers.push_back(center_[face]);
  const Extent extent = extent_along(centers, along);
  const double size = std::max(extent.width(), extent.height()) / cells_across;
  Array<Index> square_of;
  for (const Complex z : centers) {
    const Complex at = size > 0 ? (z * std::conj(along) - extent.low) / size : 0;
    square_of.push_back(static_cast<Index>(at.real()) + (cells_across + 1) * static_cast<Index>(at.imag()));
  }
  Cells cells;
  const Array<Array<Index>> pieces = pieces_of(island, square_of);
  for (std::size_t cell = 0; cell < pieces.size(); ++cell) {
    double area = 0;
    Complex center = 0;
    for (const Index face : pieces[cell]) {
      place_[face] = static_cast<Index>(cell);
      area += graph_.area[face];
      center += graph_.area[face] * center_[face];
    }
    cells.area.push_back(area);
    cells.center.push_back(area > 0 ? center / area : center_[pieces[cell].front()]);
    cells.hull.push_back(hull_of(pieces[cell]));
  }
  for (const Index face : island) {
    graph_.for_each_link(face, [&](Index other, const FaceGraph::Link& link) {
      if (place_[other] == none || place_[other] <= place_[face]) return;
      cells.links.push_back({{place_[face], place_[other]}, graph_.unit * static_cast<double>(link.cost)});
    });
  }
  clear_places(island);
  return cells;
}

// Of a division into so many pieces; 0 where it does not gain its price.
double Compactor::worth(double gain, double length, std::size_t pieces) const {
  const double price = price_factor_ * (area_ * cost_of_island * static_cast<double>(pieces - 1) +
                                        std::sqrt(area_) * cost_of_cut * length);
  // Between what gains most and what gains most for its price.
  return gain > price ? gain / std::sqrt(price) : 0;
}

double Compactor::worth(const Cells& cells, const Array<Index>& class_of, double demand_before) const {
  UnionFind sets(cells.count());
  double length = 0;
  for (const Cells::Link& link : cells.links) {
    if (class_of[link.cells[0]] == class_of[link.cells[1]])
      sets.unite(link.cells[0], link.cells[1]);
    else
      length += link.length;
  }
  Array<Index> roots, number(cells.count(), none);
  Array<double> area;
  Array<Index> points;
  for (Index cell = 0; cell < cells.count(); ++cell) {
    const Index root = sets.find(cell);
    if (root == cell) {
      number[cell] = static_cast<Index>(roots.size());
      roots.push_back(root);
      area.push_back(0);
      points.push_back(0);
    }
    number[cell] = number[root];
    area[number[cell]] += cells.area[cell];
    points[number[cell]] += static_cast<Index>(cells.hull[cell].size());
  }
  if (roots.size() < 2 || static_cast<Index>(roots.size()) > most_pieces ||
      *std::min_element(area.begin(), area.end()) < least_piece * area_)
    return 0;
  double after = 0;
  for (std::size_t piece = 0; piece < roots.size(); ++piece) {
    Eigen::VectorXcd outline(points[piece]);
    Eigen::Index next = 0;
    for (Index cell = 0; cell < cells.count(); ++cell) {
      if (number[cell] != static_cast<Index>(piece)) continue;
      for (const Complex z : cells.hull[cell]) outline[next++] = z;
    }
    after += demand(convex_hull(outline));
  }
  return worth(demand_before - after, length, roots.size());
}

// along: a side of the smallest box.
Division Compactor::find_division(const Cells& cells, const Array<Complex>& hull, Complex along) const {
  const double before = demand(hull);
  std::size_t points = 0;
  for (const Array<Complex>& own : cells.hull) points += own.size();
  Division best;
  Array<Index> class_of(cells.count());
  const auto consider = [&](Array<Line> lines) {
    for (Index cell = 0; cell < cells.count(); ++cell) {
      class_of[cell] = 0;
      for (const Line& line : lines) class_of[cell] = 2 * class_of[cell] + (line.distance(cells.center[cell]) > 0);
    }
    const double gain = worth(cells, class_of, before);
    if (gain > best.worth) best = {std::move(lines), gain};
    checkpoint(operations_a_point * static_cast<double>(points));
  };
  const double total = std::accumulate(cells.area.begin(), cells.area.end(), 0.0);
  Complex center = 0;
  for (Index cell = 0; cell < cells.count(); ++cell) center += cells.area[cell] / total * cells.center[cell];
  for (int i = 0; i < directions; ++i) {
    const Complex normal = along * std::polar(1.0, M_PI * i / directions);
    const Extent extent = extent_along(hull, normal);
    for (int k = 1; k < positions; ++k) consider({{normal, extent.low.real() + extent.width() * k / positions}});
    if (2 * i >= directions) continue;
    const Complex across = normal * Complex(0, 1);
    consider({{normal, Line{normal, 0}.distance(center)}, {across, Line{across, 0}.distance(center)}});
  }
  return best;
}

// The side of every face, by its place in the island, after a cut near each of the lines, short and rather along sharp
// edges.
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

// Pieces too small to be islands join the neighbour that they share the longest border with.
Array<Index> Compactor::without_scraps(const Array<Index>& island, const Array<Index>& class_of) {
  const Array<Array<Index>> pieces = pieces_of(island, class_of);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const Index face : pieces[i]) place_[face] = static_cast<Index>(i);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    double area = 0;
    Array<double> border(pieces.size(), 0);
    for (const Index face : pieces[i]) {
      area += graph_.area[face];
      graph_.for_each_link(face, [&](Index other, const FaceGraph::Link& link) {
        const Index beside = place_[other];
        if (beside != none && beside != place_[face]) border[beside] += static_cast<double>(link.cost);
      });
    }
    if (pieces.size() < 2 || area >= least_piece * area_) continue;
    const auto longest = std::max_element(border.begin(), border.end());
    for (const Index face : pieces[i]) place_[face] = static_cast<Index>(longest - border.begin());
  }
  Array<Index> out;
  for (const Index face : island) out.push_back(place_[face]);
  clear_places(island);
  return out;
}

double Compactor::length_between(const Array<Index>& faces, const Array<Index>& class_of) {
  set_places(faces);
  double length = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    graph_.for_each_link(faces[i], [&](Index other, const FaceGraph::Link& link) {
      const Index at = place_[other];
      if (at != none && class_of[at] < class_of[i]) length += graph_.unit * static_cast<double>(link.cost);
    });
  }
  clear_places(faces);
  return length;
}

Array<Array<Index>> Compactor::divide(const Array<Index>& island) {
  double area = 0;
  for (const Index face : island) area += graph_.area[face];
  if (island.size() < 2 || area < least_island * area_) return {};
  const Array<Complex> hull = hull_of(island);
  const double before = demand(hull);
  if (before - area < price_factor_ * cost_of_island * area_) return {};
  const Complex along = longer_side(hull);
  const Division division = find_division(cells_of(island, along), hull, along);
  if (division.lines.empty()) return {};
  const double band = extent_along(hull, along).width() / positions;
  const Array<Index> class_of = without_scraps(island, cut_along(division.lines, island, band));
  Array<Array<Index>> pieces = pieces_of(island, class_of);
  double after = 0;
  for (const Array<Index>& piece : pieces) after += demand(hull_of(piece));
  // The cells have shown it roughly.
  const bool is_worth_it = worth(before - after, length_between(island, class_of), pieces.size()) > 0;
  return is_worth_it ? pieces : Array<Array<Index>>{};
}

}  // namespace

void compact_islands(const OpenedSurface& surface, const SharedSquare& square, ComponentMap& map) {
  const HalfedgeMesh& mesh = surface.mesh;
  Array<char> ends = surface.open, is_cut = map.cut_graph.is_cut;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) ends[h] = ends[h] || is_cut[h];
  const OpenedSurface islands{mesh, surface.geometry, ends};
  const FaceGraph graph = build_face_graph(islands);
  const Eigen::VectorXcd position = square.scale * at_corners(map.cut_mesh, map.position);
  Compactor compactor(mesh, graph, position, square);
  Array<Index> part = compactor.divide_all();
  straighten_cuts(
      islands, graph, [&](Index face, Index) { return !compactor.is_near_cut(face); }, part);
  bool has_opened = false;
  for (const FaceGraph::Link& link : graph.links) {
    if (part[link.faces[0]] == part[link.faces[1]]) continue;
    for (const Index h : {link.halfedge, mesh.twin[link.halfedge]}) ends[h] = is_cut[h] = 1;
    has_opened = true;
  }
  if (!has_opened) return;
  Array<Index> part_of_triangle;
  const Array<Motion> motions(label_parts(mesh, ends, part_of_triangle));
  cut_apart(mesh, std::move(is_cut), part_of_triangle, motions, map);
}

}  // namespace lsgp

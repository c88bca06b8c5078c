// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"
#include "base/thread_team.hpp"
#include "mesh/geometry.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

namespace {

// Squared areas and their sums must neither overflow nor vanish in double precision.
constexpr double largest_extent = 1e60;
constexpr double smallest_extent = 1e-60;
// Outliers this far away leave no significant digits for the rest, in lengths or angles.
constexpr double farthest = 1e20;
constexpr double smallest_cone_angle = 1e-6;  // radians; less is lost beside the angles of triangles
constexpr double largest_cost = 1e6;          // of a cut per length
constexpr double smallest_scale = 1e-6, largest_scale = 1e6;
constexpr double rounding_of_sides = 1e-9;  // of the longest one

PerVertex<char> used_vertices(const Surface& surface) {
  PerVertex<char> used(surface.positions.rows(), 0);
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    for (int c = 0; c < 3; ++c) used[surface.triangles(f, c)] = 1;
  }
  return used;
}

void require_extent(const Positions& positions, const PerVertex<char>& used) {
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Index v = 0; v < positions.rows(); ++v) {
    if (!used[v]) continue;
    low = low.cwiseMin(positions.row(v));
    high = high.cwiseMax(positions.row(v));
  }
  const double extent = (high - low).maxCoeff();
  if (extent > largest_extent || (extent > 0 && extent < smallest_extent)) {
    throw Error(Code::scale_range, concat("The surface is ", extent, " units large; sizes from ", smallest_extent,
                                          " to ", largest_extent, " can be computed with. Scale it."));
  }
  if (!(extent > 0)) {
    throw Error(Code::degenerate_mesh, "All vertices of the surface coincide, so it has no area. Restore its shape.");
  }
}

void require_importance(const Eigen::VectorXd& importance, Index vertex_count) {
  if (importance.size() == 0) return;
  if (importance.size() != vertex_count) {
    throw Error(Code::wrong_parameter, concat("There are ", importance.size(), " weights of importance for ",
                                              vertex_count, " vertices. Give one for each."));
  }
  Array<Index> bad;
  for (Index v = 0; v < vertex_count; ++v) {
    if (!(importance[v] >= 0 && std::isfinite(importance[v]))) bad.push_back(v);
  }
  if (!bad.empty()) {
    throw Error(Code::wrong_parameter,
                concat("The importance of ", count(bad.size(), "vertex", "vertices"),
                       " is negative or no finite number. Give weights of 0 or more."),
                {ElementKind::vertices, bad});
  }
}

void require_scale(const Surface& surface, const PerVertex<char>& used) {
  const Eigen::VectorXd& scale = surface.scale;
  const Index n = static_cast<Index>(surface.positions.rows());
  if (scale.size() == 0) return;
  if (scale.size() != n) {
    throw Error(Code::wrong_parameter,
                concat("There are ", scale.size(), " factors of lengths for ", n, " vertices. Give one for each."));
  }
  Array<Index> bad;
  for (Index v = 0; v < n; ++v) {
    if (used[v] && !(scale[v] >= smallest_scale && scale[v] <= largest_scale)) bad.push_back(v);
  }
  if (!bad.empty()) {
    throw Error(Code::wrong_parameter,
                concat("The factor of lengths at ", count(bad.size(), "vertex", "vertices"), " does not lie between ",
                       smallest_scale, " and ", largest_scale, ". Give positive numbers around 1."),
                {ElementKind::vertices, bad});
  }
  for (Index f = 0; f < surface.triangles.rows(); ++f) {
    double length[3];
    for (int c = 0; c < 3; ++c) {
      const Index a = surface.triangles(f, c), b = surface.triangles(f, (c + 1) % 3);
      length[c] = edge_scale(scale, a, b) * (surface.positions.row(b) - surface.positions.row(a)).norm();
    }
    const double longest = std::max({length[0], length[1], length[2]});
    if (2 * longest - (length[0] + length[1] + length[2]) > rounding_of_sides * longest) bad.push_back(f);
  }
  if (bad.empty()) return;
  throw Error(Code::wrong_parameter,
              concat("With their factors of lengths ", count(bad.size(), "triangle has", "triangles have"),
                     " a side longer than the two others together. Give factors that vary less, or smaller triangles."),
              {ElementKind::triangles, bad});
}

void require_directions(const Surface& surface) {
  const Positions& directions = surface.directions;
  if (directions.rows() == 0) return;
  if (directions.rows() != surface.triangles.rows()) {
    throw Error(Code::wrong_parameter, concat("There are ", directions.rows(), " directions for ",
                                              surface.triangles.rows(), " triangles. Give one for each."));
  }
  Array<Index> bad;
  for (Index f = 0; f < directions.rows(); ++f) {
    if (!directions.row(f).allFinite()) bad.push_back(f);
  }
  if (!bad.empty()) {
    throw Error(Code::wrong_parameter,
                concat("The direction at ", count(bad.size(), "triangle", "triangles"),
                       " is not a finite vector. Give 0 0 0 for no direction."),
                {ElementKind::triangles, bad});
  }
}

void require_cut_costs(const Surface& surface) {
  const Eigen::VectorXd& costs = surface.cut_costs;
  if (costs.size() == 0) return;
  const Eigen::Index edges = surface.edges ? surface.edges->rows() : 0;
  if (costs.size() != edges) {
    throw Error(Code::wrong_parameter,
                concat("There are ", costs.size(), " costs of cuts for ", edges,
                       " edges that a cut may follow. Name those edges, and give one cost for each."));
  }
  Array<Index> bad;
  for (Eigen::Index row = 0; row < edges; ++row) {
    if (costs[row] >= 0 && costs[row] <= largest_cost) continue;
    bad.insert(bad.end(), {(*surface.edges)(row, 0), (*surface.edges)(row, 1)});
  }
  if (bad.empty()) return;
  throw Error(Code::wrong_parameter,
              concat("The cost of a cut along ", count(bad.size() / 2, "edge", "edges"), " does not lie between 0 and ",
                     largest_cost, ". Costs are factors of lengths; scale them down."),
              {ElementKind::edges, bad});
}

void require_threads(int threads) {
  if (threads >= 0 && threads <= most_threads) return;
  throw Error(Code::wrong_parameter, concat("The number of threads is ", threads, ". Give one from 1 to ", most_threads,
                                            ", or 0 for the default."));
}

}  // namespace

void require_valid(const Options& options) {
  require_threads(options.threads);
  if (!(options.stretch >= 0 && options.stretch <= 1)) {
    throw Error(Code::wrong_parameter,
                concat("The share of stretch to take away is ", options.stretch, ". Choose one from 0 to 1."));
  }
  constexpr double most_squares = 100;  // UDIM tiles
  if (!(options.square_share > 0 && options.square_share <= most_squares)) {
    throw Error(Code::wrong_parameter, concat("The islands' share of the square is ", options.square_share,
                                              ". Choose one above 0, up to the number of UDIM tiles, at most 100."));
  }
  if (options.compact != Compactness::off && options.seamless) {
    throw Error(
        Code::wrong_parameter,
        "A seamless layout does not fill a square, so its islands cannot be compacted. Turn off compact islands or the "
        "seamless layout.");
  }
  if (options.method != Method::lscm) return;
  // It solves a least squares problem of its own, without transitions.
  const auto refuse = [](const char* what, const char* instead) {
    throw Error(Code::wrong_parameter, concat("The method lscm ", what, ". Choose the method lsgp, or ", instead, "."));
  };
  if (options.unfold == UnfoldMethod::spectral) refuse("excludes spectral unfolding", "the unfolding poisson");
  if (options.mode == Mode::low_stretch) refuse("supports no low stretch", "the mode conformal");
  if (options.border == BorderMode::straight) refuse("supports no straight boundaries", "leave boundaries free");
  if (!options.loop_turning.empty()) refuse("supports no prescribed turning of boundaries", "leave it free");
}

void require_valid(const Options& options, const Pins& pins) {
  require_valid(options);
  if (options.method != Method::lscm || pins.corners.empty()) return;
  throw Error(Code::pins_conflict,
              "The method lscm has two pins of its own, so pinned texture coordinates cannot be kept. Choose the "
              "method lsgp, or unpin them.");
}

void require_countable(std::ptrdiff_t count, const char* what) {
  constexpr std::ptrdiff_t most = std::numeric_limits<Index>::max() / 3;
  if (count <= most) return;
  throw Error(Code::wrong_parameter, concat("There are ", count, " ", what, "; up to ", most,
                                            " can be computed with. Unwrap fewer faces at once."));
}

void require_one_each(const Surface& surface, const CornerUv& corner_uv) {
  if (corner_uv.rows() != surface.triangles.size()) {
    throw Error(Code::wrong_parameter, concat("There are ", corner_uv.rows(), " texture coordinates for ",
                                              surface.triangles.size(), " corners of triangles. Give one for each."));
  }
}

void require_vertices(const Surface& surface, const VertexPairs& pairs, const char* what) {
  const Index vertex_count = static_cast<Index>(surface.positions.rows());
  require_countable(pairs.rows(), what);
  Array<Index> bad;
  for (Index row = 0; row < pairs.rows(); ++row) {
    for (const Index v : {pairs(row, 0), pairs(row, 1)}) {
      if (v < 0 || v >= vertex_count) bad.push_back(v);
    }
  }
  if (!bad.empty()) {
    throw Error(Code::index_out_of_range,
                concat("The ", what, " name ", count(bad.size(), "vertex", "vertices"), " outside 0 to ",
                       vertex_count - 1, " (", list(bad), "). Pass vertex pairs of this mesh."));
  }
}

void require_connectivity(const Surface& surface) {
  require_countable(surface.positions.rows(), "vertices");
  require_countable(surface.triangles.rows(), "triangles");
  const Index n = static_cast<Index>(surface.positions.rows());
  const Triangles& triangles = surface.triangles;
  if (triangles.rows() == 0) throw Error(Code::empty_mesh, "The mesh has no faces. Add faces to unwrap.");

  Array<Index> outside, collapsed;
  for (Index f = 0; f < triangles.rows(); ++f) {
    const Index a = triangles(f, 0), b = triangles(f, 1), c = triangles(f, 2);
    if (a < 0 || b < 0 || c < 0 || a >= n || b >= n || c >= n) {
      outside.push_back(f);
    } else if (is_collapsed(triangles, f)) {
      collapsed.push_back(f);
    }
  }
  if (!outside.empty()) {
    throw Error(Code::index_out_of_range,
                concat(count(outside.size(), "triangle names", "triangles name"), " vertices outside 0 to ", n - 1,
                       ". Repair the face indices."),
                {ElementKind::triangles, outside});
  }
  if (!surface.may_collapse && !collapsed.empty()) {
    throw Error(Code::bad_face,
                concat(count(collapsed.size(), "triangle repeats", "triangles repeat"),
                       " a vertex. Merge by distance or delete them."),
                {ElementKind::triangles, collapsed});
  }
  if (ssize(collapsed) == triangles.rows()) {
    throw Error(Code::degenerate_mesh, "All triangles have an edge without length. Restore the surface's shape.",
                {ElementKind::triangles, collapsed});
  }
  if (surface.edges) require_vertices(surface, *surface.edges, "edges");
  require_cut_costs(surface);
  require_vertices(surface, surface.seams, "seams");
  require_vertices(surface, surface.borders, "borders");
  require_vertices(surface, surface.features, "features");
}

void require_valid(const Surface& surface) {
  require_connectivity(surface);
  const Index n = static_cast<Index>(surface.positions.rows());
  const PerVertex<char> used = used_vertices(surface);
  Array<Index> bad;
  for (Index v = 0; v < n; ++v) {
    if (used[v] && !surface.positions.row(v).allFinite()) bad.push_back(v);
  }
  if (!bad.empty()) {
    throw Error(Code::non_finite_position,
                concat(count(bad.size(), "vertex has", "vertices have"),
                       " a coordinate that is not a finite number. Move or delete ", bad.size() == 1 ? "it." : "them."),
                {ElementKind::vertices, bad});
  }
  require_extent(surface.positions, used);
  require_importance(surface.importance, n);
  require_scale(surface, used);
  require_directions(surface);
}

void require_comparable(const Positions& positions) {
  const Index n = static_cast<Index>(positions.rows());
  Eigen::RowVector3d middle;
  Array<double> sorted(n);
  for (int axis = 0; axis < 3; ++axis) {
    for (Index v = 0; v < n; ++v) sorted[v] = positions(v, axis);
    std::nth_element(sorted.begin(), sorted.begin() + n / 2, sorted.end());
    middle[axis] = sorted[n / 2];
  }
  const Eigen::VectorXd distance = (positions.rowwise() - middle).cwiseAbs().rowwise().maxCoeff();
  for (Index v = 0; v < n; ++v) sorted[v] = distance[v];
  std::sort(sorted.begin(), sorted.end());
  // If more than a few are distant, it is the surface's shape.
  for (Index reached = n - n / 4; reached < n; ++reached) {
    const double reach = sorted[reached - 1];
    if (!(reach > 0 && sorted[reached] > farthest * reach)) continue;
    Array<Index> far;
    for (Index v = 0; v < n; ++v) {
      if (distance[v] > reach) far.push_back(v);
    }
    throw Error(Code::scale_range,
                concat(count(far.size(), "vertex lies", "vertices lie"), " more than ", farthest,
                       " times as far out as the others, whose shape is lost beside that. Move or delete ",
                       far.size() == 1 ? "it." : "them."),
                {ElementKind::vertices, far});
  }
}

void require_vertices(const Surface& surface, const Cones& cones) {
  const Index n = static_cast<Index>(surface.positions.rows());
  if (cones.angles.size() != cones.vertices.size()) {
    throw Error(Code::angle_count, concat(cones.vertices.size(), " cones but ", cones.angles.size(),
                                          " angles were given. Pass one angle per cone, none for automatic."));
  }
  Array<Index> outside;
  for (const Index v : cones.vertices) {
    if (v < 0 || v >= n) outside.push_back(v);
  }
  if (!outside.empty()) {
    throw Error(Code::cone_index, concat(count(outside.size(), "cone lies", "cones lie"), " outside the vertices 0 to ",
                                         n - 1, " (", list(outside), "). Mark vertices of this mesh."));
  }
}

void require_valid(const Surface& surface, const Cones& cones) {
  require_vertices(surface, cones);
  const Index n = static_cast<Index>(surface.positions.rows());
  const PerVertex<char> used = used_vertices(surface);
  PerVertex<char> seen(n, 0);
  Array<Index> duplicate, loose, non_finite, impossible;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Index v = cones.vertices[i];
    if (seen[v]++) duplicate.push_back(v);
    if (!used[v]) loose.push_back(v);
    if (!cones.angles[i]) continue;
    if (!std::isfinite(*cones.angles[i]))
      non_finite.push_back(v);
    else if (*cones.angles[i] < smallest_cone_angle)
      impossible.push_back(v);
  }
  const auto refuse = [](Code code, const Array<Index>& bad, const char* one, const char* many, const char* remedy) {
    if (!bad.empty()) {
      throw Error(code, concat(count(bad.size(), one, many), ". ", remedy), {ElementKind::vertices, bad});
    }
  };
  refuse(Code::cone_duplicate, duplicate, "cone is listed twice", "cones are listed twice", "List every cone once.");
  refuse(Code::cone_not_on_surface, loose, "cone belongs to no face", "cones belong to no face",
         "Mark vertices of the surface only.");
  refuse(Code::cone_angle_non_finite, non_finite, "cone angle is not a finite number",
         "cone angles are not finite numbers", "Give an angle above 0, or none for automatic.");
  refuse(Code::cone_angle_range, impossible, "cone angle is not above zero", "cone angles are not above zero",
         "Give an angle above 0 degrees.");
}

void require_room_for_cones(SeamMode seams) {
  if (seams != SeamMode::exact) return;
  throw Error(Code::wrong_parameter,
              "Nothing but the marked seams may be cut, so no cones can be placed. Allow automatic cuts besides the "
              "seams.");
}

void require_valid(const PlacementOptions& options) {
  require_threads(options.threads);
  require_room_for_cones(options.seams);
  if (options.count && *options.count < 0) {
    throw Error(Code::wrong_parameter, concat("The number of cones is ", *options.count, ". Give 0 or more."));
  }
  if (options.most && *options.most < 0) {
    throw Error(Code::wrong_parameter, concat("The most cones are ", *options.most, ". Give 0 or more."));
  }
  if (!(options.target > 1) || !std::isfinite(options.target)) {
    throw Error(Code::wrong_parameter,
                concat("The L2 stretch to reach is ", options.target, ". Give a number above 1, which is none."));
  }
  if (!options.mirror) return;
  if (!options.symmetric) {
    throw Error(Code::wrong_parameter,
                "A mirror plane is given for cones that need not be symmetric. Ask for symmetric ones, or leave it "
                "out.");
  }
  const bool finite = options.mirror->point.allFinite() && options.mirror->normal.allFinite();
  if (!finite || !(options.mirror->normal.cwiseAbs().maxCoeff() > 0)) {
    throw Error(Code::wrong_parameter,
                "The mirror plane has no usable point and normal. Give finite numbers, and a "
                "normal that is not zero.");
  }
}

void require_valid(const Surface& surface, const Pins& pins) {
  const Index corner_count = static_cast<Index>(3 * surface.triangles.rows());
  if (pins.positions.rows() != static_cast<Eigen::Index>(pins.corners.size())) {
    throw Error(Code::pin_index, concat(pins.corners.size(), " corners are pinned but ", pins.positions.rows(),
                                        " positions were given. Pass one position per pinned corner."));
  }
  Array<Index> outside, non_finite;
  for (std::size_t i = 0; i < pins.corners.size(); ++i) {
    const Index corner = pins.corners[i];
    if (corner < 0 || corner >= corner_count)
      outside.push_back(corner);
    else if (!(pins.positions.row(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff() <= largest_extent))
      non_finite.push_back(corner / 3);
  }
  if (!outside.empty()) {
    throw Error(Code::pin_index, concat("The pins name ", count(outside.size(), "corner", "corners"), " outside 0 to ",
                                        corner_count - 1, " (", list(outside), "). Pass corners of this mesh."));
  }
  if (!non_finite.empty()) {
    throw Error(Code::pin_non_finite,
                concat(count(non_finite.size(), "pin is", "pins are"), " not at a finite place within ", largest_extent,
                       " of the origin. Unpin or move them."),
                {ElementKind::triangles, non_finite});
  }
}

void require_numbers(const std::vector<Index>& numbers, const char* what) {
  const Index most = static_cast<Index>(numbers.size());
  Elements wrong{ElementKind::triangles, {}};
  for (Index f = 0; f < most; ++f) {
    if (element(numbers, f) < -1 || element(numbers, f) >= most) wrong.indices.push_back(f);
  }
  if (wrong.indices.empty()) return;
  throw Error(Code::index_out_of_range,
              concat("There is ", what, " ", element(numbers, wrong.indices[0]), "; number them from 0 to at most ",
                     most - 1, ", or -1 for none."),
              wrong);
}

}  // namespace lsgp

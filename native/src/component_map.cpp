// SPDX-License-Identifier: GPL-3.0-or-later
#include "component_map.hpp"

#include <algorithm>
#include <cmath>

#include "border.hpp"
#include "connection.hpp"
#include "energies/quadratic_forms.hpp"
#include "text.hpp"
#include "unfold.hpp"
#include "untangle.hpp"

namespace lsgp {

void check_seams(const HalfedgeMesh& mesh, const Eigen::VectorXcd& corners, ComponentMap& map) {
  map.seams = measure_seams(mesh, map.cut_graph, corners, map.rotation ? &*map.rotation : nullptr,
                            map.rotation ? &map.inexact_seams : nullptr);
}

void check_triangles(const HalfedgeMesh& mesh, const Eigen::VectorXcd& corners, ComponentMap& map) {
  map.validity = check_map(mesh, corners, map.curvature.at_vertex, map.curvature.is_free);
  if (map.rotation) return;
  map.validity.wrong_angle_sums.clear();  // without transitions all angles are free
  map.validity.inexact_angles.clear();
}

std::vector<Index> inside_only(const HalfedgeMesh& mesh, const std::vector<Index>& vertices) {
  std::vector<Index> out;
  for (const Index v : vertices) {
    if (mesh.loop_of_vertex[v] == none) out.push_back(v);
  }
  return out;
}

namespace {

using Kind = DistortionEnergy::Kind;

constexpr double tangled_share = 0.002;  // of the triangles flipped, for which another fit is tried

// A surface with boundary has conformal maps without number, so the spectral step would return an arbitrary one; only
// without cones does the smallest eigenvector still mean something (Mullen et al. 2008).
UnfoldMethod usable_unfold(const HalfedgeMesh& mesh, const ComponentCones& cones, UnfoldMethod asked,
                           std::vector<Finding>& findings) {
  const bool plain_disk =
      mesh.boundary_loops.size() == 1 && mesh.genus == 0 && cones.vertices.empty() && cones.border == BorderMode::free;
  if (asked == UnfoldMethod::poisson || mesh.closed() || plain_disk) return asked;
  findings.push_back(
      {Code::spectral_needs_closed,
       "The spectral unfolding is ill-posed on a surface with boundary and cones; the Poisson unfolding was "
       "used instead.",
       {}});
  return UnfoldMethod::poisson;
}

// What decides about a repair; what is returned is checked in the layout.
void check(const HalfedgeMesh& mesh, ComponentMap& map) {
  if (!map.position.allFinite()) {
    throw Error(Code::solver_failed,
                "The unfolding returned values that are not finite. Clean the mesh (merge by distance, "
                "dissolve degenerate faces) and try again.");
  }
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  map.uv_area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) map.uv_area += doubled_area(corners, f) / 2;
  check_triangles(mesh, corners, map);
}

// Vertices a repair has to leave where they are.
std::vector<char> fixed_vertices(const HalfedgeMesh& mesh, const ComponentMap& map, const std::vector<Index>& aligned) {
  std::vector<char> fixed(mesh.vertex_count(), 0);
  for (const Pin& pin : map.pins) fixed[map.cut_mesh.source[pin.copy]] = 1;
  for (const Index h : aligned) fixed[mesh.origin(h)] = fixed[mesh.target(h)] = 1;
  return fixed;
}

// A border without corners is one straight line along its own translation, but the discrete metric knows the angle
// between two such borders only to the mesh's resolution.  Its direction is therefore taken from the map without
// straight borders, whose translations are consistent.
void turn_cornerless_borders(const HalfedgeMesh& mesh, const CutMesh& cut_mesh, const std::vector<Index>& corners,
                             const Eigen::VectorXcd& natural, const std::vector<Index>& edges,
                             Eigen::VectorXd& directions) {
  const std::size_t loop_count = mesh.boundary_loops.size();
  std::vector<char> has_corner(loop_count, 0);
  for (const Index v : corners) {
    if (mesh.loop_of_vertex[v] != none) has_corner[mesh.loop_of_vertex[v]] = 1;
  }
  std::vector<Complex> along(loop_count, 0.0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Complex edge = natural[cut_mesh.copy_of_corner[next(edges[i])]] - natural[cut_mesh.copy_of_corner[edges[i]]];
    along[mesh.loop_of_vertex[mesh.origin(edges[i])]] +=
        std::polar(1.0, -directions[static_cast<Eigen::Index>(i)]) * edge;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Index loop = mesh.loop_of_vertex[mesh.origin(edges[i])];
    if (!has_corner[loop]) directions[static_cast<Eigen::Index>(i)] += std::arg(along[loop]);
  }
}

Eigen::VectorXcd unfold_along_borders(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map,
                                      const ComponentCones& cones, const Connection& connection,
                                      const std::vector<Index>& edges) {
  const Eigen::VectorXd& log_scale = map.curvature.log_scale;
  Eigen::VectorXd directions = metric_directions(mesh, geometry, log_scale, connection.frames, edges);
  if (cones.border == BorderMode::straight) {
    const Eigen::VectorXcd natural = PoissonSystem(mesh, geometry, map.cut_mesh, connection.reduction)
                                         .fit(prescribed_jacobians(mesh, log_scale, connection.frames));
    turn_cornerless_borders(mesh, map.cut_mesh, cones.vertices, natural, edges, directions);
  }
  return unfold_aligned(mesh, geometry, map.cut_mesh, connection.reduction, log_scale, connection.frames, edges,
                        directions);
}

// The fit to the prescribed Jacobians with every triangle's error relative to its scale: where scales differ much, the
// plain fit loses what is small to what is large.  One more factorization.
Eigen::VectorXcd unfold_relatively(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map,
                                   const Connection& connection) {
  Jacobians jacobians = prescribed_jacobians(mesh, map.curvature.log_scale, connection.frames);
  constexpr double widest_range = 1e8;  // of the weights, so that the form can be factored
  Eigen::VectorXd weight = jacobians.f_z.cwiseAbs2().cwiseInverse();
  weight = weight.cwiseMin(widest_range * weight.minCoeff());
  const Geometry weighted = with_weights(geometry, weight);
  jacobians.f_z = jacobians.f_z.cwiseProduct(weight);
  return PoissonSystem(mesh, weighted, map.cut_mesh, connection.reduction).fit(jacobians);
}

// Takes a valid map from the metric's own rotations about handles to the chosen ones, in steps over which it stays
// valid. Leaves the map as it is where that does not succeed.
void twist_gradually(const HalfedgeMesh& mesh, const Geometry& geometry, const ConnectionChoice& connections,
                     const std::vector<char>& fixed, ComponentMap& map) {
  constexpr double first_step = 0.25, shortest_step = 0.02;
  ComponentMap moved = map;
  // The map under a share of the twist, from its Jacobians under less.
  const auto move_to = [&](double share, const Jacobians& jacobians) {
    const Connection connection = connections.at(share);
    moved.rotation = connection.rotation;
    moved.position = PoissonSystem(mesh, geometry, map.cut_mesh, connection.reduction).fit(jacobians);
    check(mesh, moved);
    if (moved.validity.defects() == 0) return true;
    moved.position =
        untangle(mesh, geometry, map.cut_graph, map.cut_mesh, connection.rotation, map.curvature,
                 jacobians.f_z.array().arg(), fixed, Effort::local, Kind::framed_foldover_free, moved.position);
    check(mesh, moved);
    return moved.validity.defects() == 0;
  };
  if (!move_to(0, prescribed_jacobians(mesh, map.curvature.log_scale, connections.at(0).frames))) return;
  double reached = 0;
  for (double step = first_step; step > shortest_step && reached < 1;) {
    const double share = std::min(1.0, reached + step);
    const Eigen::VectorXcd before = moved.position;
    const Eigen::VectorXd turn = (share - reached) * connections.twist();
    Jacobians jacobians = measure_jacobians(mesh, geometry, map.cut_mesh, before);
    for (Index f = 0; f < mesh.triangle_count(); ++f) {
      jacobians.f_z[f] *= std::polar(1.0, turn[f]);
      jacobians.f_zbar[f] *= std::polar(1.0, turn[f]);
    }
    if (move_to(share, jacobians)) {
      reached = share;
      step *= 1.5;
    } else {
      moved.position = before;
      step /= 2;
    }
  }
  if (reached == 1) map = std::move(moved);
}

ComponentMap attempt_map(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                         const std::vector<std::pair<Index, Complex>>& pinned_corners, const Options& options,
                         Effort effort, std::vector<Finding>& findings, Monitor& monitor) {
  // Border edges whose direction is imposed.
  const std::vector<Index> aligned =
      cones.border == BorderMode::straight ? straight_edges(mesh, cones.vertices) : corner_edges(mesh, cones.vertices);
  ComponentMap map;
  {
    const Monitor::Stage stage(monitor, "prescribe");
    map.curvature = prescribe(mesh, geometry, cones, options.prescription, findings);
  }
  {
    const Monitor::Stage stage(monitor, "cut");
    for (const Index v : inside_only(mesh, cones.vertices)) {
      const bool flat = cones.symmetry > 0 && map.curvature.at_vertex[v] == 0;
      (flat ? map.flat_cones : map.cones).push_back(v);
    }
    if (!map.flat_cones.empty()) {
      findings.push_back({Code::flat_cones,
                          concat(count(map.flat_cones.size(), "cone", "cones"),
                                 " came out flat when angles were rounded: ordinary vertices now, which need no cut."),
                          {ElementKind::vertices, map.flat_cones}});
    }
    map.cut_graph = connect_cones(mesh, geometry, map.cones, map.curvature.needs_no_cut);
    map.cut_mesh = cut_open(mesh, map.cut_graph);
    map.pins = pins_of_copies(map.cut_mesh, pinned_corners);
  }
  const Monitor::Stage stage(monitor, "unfold");
  if (options.method == Method::lscm) {
    map.pins.clear();  // a comparison: its two pins are its own
    map.position = unfold_lscm(mesh, geometry, map.cut_mesh);
    check(mesh, map);
    return map;
  }
  const ConnectionChoice connections(mesh, geometry, map.cut_graph, map.cut_mesh, map.curvature, cones.symmetry);
  const Connection connection = connections.at(1);
  map.rotation = connection.rotation;
  const bool spectral = usable_unfold(mesh, cones, options.unfold, findings) == UnfoldMethod::spectral;
  if (spectral) {
    map.position = unfold_spectral(mesh, geometry, map.cut_mesh, connection.reduction);
  } else if (!aligned.empty()) {
    map.position = unfold_along_borders(mesh, geometry, map, cones, connection, aligned);
  } else {
    map.position = PoissonSystem(mesh, geometry, map.cut_mesh, connection.reduction)
                       .fit(prescribed_jacobians(mesh, map.curvature.log_scale, connection.frames));
  }
  Curvature target = map.curvature;
  if (map.pins.size() > 1) {
    PinnedMap pinned =
        move_onto_pins(mesh, geometry, map.cut_mesh, connection.reduction, map.pins, !aligned.empty(), map.position);
    map.position = std::move(pinned.position);
    target.log_scale.array() += std::log(pinned.scale);
  }
  check(mesh, map);
  if (static_cast<double>(map.validity.flipped.size()) > tangled_share * mesh.triangle_count() && !spectral &&
      aligned.empty() && map.pins.size() < 2) {
    ComponentMap relative = map;
    relative.position = unfold_relatively(mesh, geometry, map, connection);
    check(mesh, relative);
    if (relative.validity.defects() < map.validity.defects()) map = std::move(relative);
  }
  if (!map.validity.flipped.empty() && !spectral) {
    const std::vector<char> fixed = fixed_vertices(mesh, map, aligned);
    const auto repair = [&](Effort of_repair) {
      map.position = untangle(
          mesh, geometry, map.cut_graph, map.cut_mesh, connection.rotation, target, connection.frames, fixed, of_repair,
          connections.is_twisted() ? Kind::framed_foldover_free : Kind::foldover_free, map.position);
      check(mesh, map);
    };
    repair(connections.is_twisted() ? Effort::local : effort);
    if (map.validity.defects() > 0 && connections.is_twisted()) {
      twist_gradually(mesh, geometry, connections, fixed, map);
      if (map.validity.defects() > 0) repair(Effort::global);
    }
  }
  return map;
}

// Whether other angles may be tried where those of least distortion have no valid map.
bool has_choice(const ComponentCones& cones, const Options& options) {
  if (options.method != Method::lsgp || options.unfold != UnfoldMethod::poisson || cones.symmetry > 0) return false;
  const bool fixed =
      std::all_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
  return options.prescription == PrescriptionRule::least_distortion ||
         (options.prescription == PrescriptionRule::manual && !fixed);
}

}  // namespace

ComponentMap map_component(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                           const std::vector<std::pair<Index, Complex>>& pinned_corners, const Options& options,
                           std::vector<Finding>& findings, Monitor& monitor) {
  if (!has_choice(cones, options)) {
    return attempt_map(mesh, geometry, cones, pinned_corners, options, Effort::global, findings, monitor);
  }
  // Wide angles distort least but may leave turns with neighbouring vertices.
  std::optional<ComponentMap> best;
  ComponentCones bounded = cones, best_bounded = cones;
  std::vector<Finding> of_best;
  for (const double largest : {largest_angle, 2.5 * M_PI, 2 * M_PI}) {
    bounded.largest_angle = largest;
    std::vector<Finding> found;
    ComponentMap map = attempt_map(mesh, geometry, bounded, pinned_corners, options, Effort::local, found, monitor);
    if (best && map.validity.defects() >= best->validity.defects()) continue;
    best = std::move(map);
    best_bounded = bounded;
    of_best = std::move(found);
    if (best->validity.defects() == 0) break;
  }
  if (best->validity.defects() > 0) {
    of_best.clear();
    best = attempt_map(mesh, geometry, best_bounded, pinned_corners, options, Effort::global, of_best, monitor);
  }
  findings.insert(findings.end(), of_best.begin(), of_best.end());
  return std::move(*best);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "component_map.hpp"

#include <algorithm>
#include <cmath>

#include "border.hpp"
#include "holonomy.hpp"
#include "quantize_curvature.hpp"
#include "transitions.hpp"
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

Eigen::VectorXd curvature_of_nodes(const HalfedgeMesh& mesh, const NodeGraph& nodes, const Eigen::VectorXd& at_vertex) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(nodes.vertex.size());
  for (std::size_t node = 0; node < nodes.vertex.size(); ++node) {
    if (nodes.vertex[node] != none) {
      out[node] = at_vertex[nodes.vertex[node]];
    } else {
      for (const Index v : mesh.boundary_loops[nodes.loop[node]]) out[node] += at_vertex[v];
    }
  }
  return out;
}

namespace {

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

// The rotations of the cuts under a curvature, and the frames that go with them.
struct Connection {
  Eigen::VectorXd frames, rotation;
  Reduction reduction;
};

// The changes of all rotations, (cuts, loops), that turn each of the loops about handles by 1.
Eigen::MatrixXd loop_changes(const NodeGraph& nodes) {
  const Eigen::Index cuts = static_cast<Eigen::Index>(nodes.tail.size());
  std::vector<Eigen::VectorXd> columns;
  for (Eigen::Index p = 0; p < cuts; ++p) {
    if (nodes.in_tree[p]) continue;
    columns.push_back(
        find_rotations(nodes, Eigen::VectorXd::Zero(nodes.vertex.size()), Eigen::VectorXd::Unit(cuts, p)));
  }
  Eigen::MatrixXd out(cuts, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) out.col(static_cast<Eigen::Index>(k)) = columns[k];
  return out;
}

// Whole numbers near `exact` with small (x - exact)^T form (x - exact): the nearest ones, changed one or two at a time.
Eigen::VectorXd round_by_energy(const Eigen::MatrixXd& form, const Eigen::VectorXd& exact) {
  Eigen::VectorXd x = exact.array().round();
  const auto cost = [&](const Eigen::VectorXd& tried) { return (tried - exact).dot(form * (tried - exact)); };
  double least = cost(x);
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      for (Eigen::Index j = i; j < x.size(); ++j) {
        for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
          if ((b == 0) != (i == j)) continue;
          Eigen::VectorXd tried = x;
          tried[i] += a;
          tried[j] += b;
          const double value = cost(tried);
          if (value >= least * (1 - 1e-9)) continue;
          least = value;
          x = tried;
          lowered = true;
        }
      }
    }
  }
  return x;
}

// By how much the loops about handles, which curvature leaves free, are turned against the metric, radians: not at all,
// but for layouts that admit fewer rotations.  Those twist the frames as little as they can.
Eigen::VectorXd choose_turning(const FrameTwist& twist, const NodeGraph& nodes, const Eigen::VectorXd& natural,
                               const Eigen::MatrixXd& loops, double unit) {
  Eigen::VectorXd exact(loops.cols());
  Eigen::Index k = 0;
  for (Eigen::Index p = 0; p < natural.size(); ++p) {
    if (!nodes.in_tree[p]) exact[k++] = natural[p] / unit;
  }
  return unit * (round_by_energy(twist.energy(loops), exact) - exact);
}

Connection connect(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentMap& map, int symmetry) {
  const Curvature& curvature = map.curvature;
  Connection out;
  out.frames = integrate_frames(mesh, geometry, map.cut_graph, curvature.log_scale);
  // The better a root, the farther its curvature is from whole turns.
  const NodeGraph nodes = build_node_graph(mesh, map.cut_graph, (curvature.at_vertex / 2).array().sin().abs());
  const Eigen::VectorXd node_curvature = curvature_of_nodes(mesh, nodes, curvature.at_vertex);
  const Eigen::VectorXd natural = read_rotations(mesh, geometry, map.cut_graph, curvature.log_scale, out.frames);
  out.rotation = find_rotations(nodes, node_curvature, natural);
  // The holonomy of a flat torus without cones is trivial.
  const bool flat = mesh.closed() && node_curvature.size() > 0 && node_curvature.cwiseAbs().maxCoeff() == 0;
  const Eigen::MatrixXd loops = loop_changes(nodes);
  if (loops.cols() > 0 && (symmetry > 0 || flat)) {
    const FrameTwist twist(mesh, geometry, map.cut_graph);
    const double unit = flat ? 2 * M_PI : 2 * M_PI / symmetry;
    const Eigen::VectorXd change = loops * choose_turning(twist, nodes, natural, loops, unit);
    out.rotation += change;
    out.frames += twist.spread(change);
  }
  if (symmetry > 0) {
    for (double& rotation : out.rotation) rotation = angle_of_turns(turns_of(rotation, symmetry), symmetry);
  }
  out.reduction = impose_transitions(mesh, map.cut_graph, map.cut_mesh, nodes, node_curvature, out.rotation);
  return out;
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
    const Eigen::VectorXcd natural =
        PoissonSystem(mesh, geometry, map.cut_mesh, connection.reduction).unfold(log_scale, connection.frames);
    turn_cornerless_borders(mesh, map.cut_mesh, cones.vertices, natural, edges, directions);
  }
  return unfold_aligned(mesh, geometry, map.cut_mesh, connection.reduction, log_scale, connection.frames, edges,
                        directions);
}

}  // namespace

ComponentMap map_component(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                           const std::vector<std::pair<Index, Complex>>& pinned_corners, const Options& options,
                           std::vector<Finding>& findings, StageSeconds& seconds) {
  // Border edges whose direction is imposed.
  const std::vector<Index> aligned =
      cones.border == BorderMode::straight ? straight_edges(mesh, cones.vertices) : corner_edges(mesh, cones.vertices);
  ComponentMap map;
  {
    StageTimer timer(seconds, "prescribe");
    map.curvature = prescribe(mesh, geometry, cones, options.prescription, findings);
  }
  {
    StageTimer timer(seconds, "cut");
    map.cones = inside_only(mesh, cones.vertices);
    if (cones.symmetry > 0) {  // those that came out flat need no cut
      const auto flat = [&](Index v) { return map.curvature.at_vertex[v] == 0; };
      map.cones.erase(std::remove_if(map.cones.begin(), map.cones.end(), flat), map.cones.end());
    }
    map.cut_graph = connect_cones(mesh, geometry, map.cones, map.curvature.needs_no_cut);
    map.cut_mesh = cut_open(mesh, map.cut_graph);
    map.pins = pins_of_copies(map.cut_mesh, pinned_corners);
  }
  StageTimer timer(seconds, "unfold");
  if (options.method == Method::lscm) {
    map.pins.clear();  // a comparison: its two pins are its own
    map.position = unfold_lscm(mesh, geometry, map.cut_mesh);
    check(mesh, map);
    return map;
  }
  const Connection connection = connect(mesh, geometry, map, cones.symmetry);
  map.rotation = connection.rotation;
  const bool spectral = usable_unfold(mesh, cones, options.unfold, findings) == UnfoldMethod::spectral;
  if (spectral) {
    map.position = unfold_spectral(mesh, geometry, map.cut_mesh, connection.reduction);
  } else if (!aligned.empty()) {
    map.position = unfold_along_borders(mesh, geometry, map, cones, connection, aligned);
  } else {
    map.position = PoissonSystem(mesh, geometry, map.cut_mesh, connection.reduction)
                       .unfold(map.curvature.log_scale, connection.frames);
  }
  Curvature target = map.curvature;
  if (map.pins.size() > 1) {
    PinnedMap pinned =
        move_onto_pins(mesh, geometry, map.cut_mesh, connection.reduction, map.pins, !aligned.empty(), map.position);
    map.position = std::move(pinned.position);
    target.log_scale.array() += std::log(pinned.scale);
  }
  check(mesh, map);
  if (!map.validity.flipped.empty() && !spectral) {
    map.position = untangle(mesh, geometry, map.cut_graph, map.cut_mesh, connection.rotation, target, connection.frames,
                            fixed_vertices(mesh, map, aligned), map.position);
    check(mesh, map);
  }
  return map;
}

}  // namespace lsgp

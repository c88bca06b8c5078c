// SPDX-License-Identifier: GPL-3.0-or-later
// The pipeline (the paper's section 3.2): cut, prescribe, unfold, check.
#include <cmath>
#include <limits>

#include "components.hpp"
#include "cut_graph.hpp"
#include "cut_mesh.hpp"
#include "distortion.hpp"
#include "holonomy.hpp"
#include "layout.hpp"
#include "lsgp/lsgp.hpp"
#include "pins.hpp"
#include "text.hpp"
#include "transitions.hpp"
#include "unfold.hpp"
#include "untangle.hpp"
#include "validation.hpp"

namespace lsgp {

namespace {

// A component's map and all that was imposed on it, in its own numbering.
struct Map {
  CutGraph cut_graph;
  CutMesh cut_mesh;
  Curvature curvature;
  std::optional<Eigen::VectorXd> rotation;  // (cuts) imposed, radians; none without transitions
  Eigen::VectorXcd position;                // (copies) u + iv
  std::vector<Pin> pins;
  double uv_area = 0;  // signed
  SeamQuality seams;
  std::vector<Index> inexact_seams;  // halfedges
  Validity validity;
};

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

Connection connect(const HalfedgeMesh& mesh, const Geometry& geometry, const Map& map, const Curvature& curvature) {
  Connection out;
  out.frames = integrate_frames(mesh, geometry, map.cut_graph, curvature.log_scale);
  // The better a root, the farther its curvature is from whole turns.
  const NodeGraph nodes = build_node_graph(mesh, map.cut_graph, (curvature.at_vertex / 2).array().sin().abs());
  const Eigen::VectorXd node_curvature = curvature_of_nodes(mesh, nodes, curvature.at_vertex);
  out.rotation = find_rotations(nodes, node_curvature,
                                read_rotations(mesh, geometry, map.cut_graph, curvature.log_scale, out.frames));
  out.reduction = impose_transitions(mesh, map.cut_graph, map.cut_mesh, nodes, node_curvature, out.rotation);
  return out;
}

void check_seams(const HalfedgeMesh& mesh, const Eigen::VectorXcd& corners, Map& map) {
  map.seams = measure_seams(mesh, map.cut_graph, corners, map.rotation ? &*map.rotation : nullptr,
                            map.rotation ? &map.inexact_seams : nullptr);
}

void check_triangles(const HalfedgeMesh& mesh, const Eigen::VectorXcd& corners, Map& map) {
  map.validity = check_map(mesh, corners, map.curvature.at_vertex, map.curvature.is_free);
  if (map.rotation) return;
  map.validity.wrong_angle_sums.clear();  // without transitions all angles are free
  map.validity.inexact_angles.clear();
}

// What decides about a repair; what is returned is checked in the layout.
void check(const HalfedgeMesh& mesh, Map& map) {
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

std::vector<Index> inside_only(const HalfedgeMesh& mesh, const std::vector<Index>& vertices) {
  std::vector<Index> out;
  for (const Index v : vertices) {
    if (mesh.loop_of_vertex[v] == none) out.push_back(v);
  }
  return out;
}

// Vertices a repair has to leave where they are.
std::vector<char> fixed_vertices(const HalfedgeMesh& mesh, const Map& map, const std::vector<Index>& aligned) {
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

Eigen::VectorXcd unfold_along_borders(const HalfedgeMesh& mesh, const Geometry& geometry, const Map& map,
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

Map solve_component(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                    const std::vector<std::pair<Index, Complex>>& pinned_corners, const Options& options,
                    std::vector<Finding>& findings, StageSeconds& seconds) {
  // Border edges whose direction is imposed.
  const std::vector<Index> aligned =
      cones.border == BorderMode::straight ? straight_edges(mesh, cones.vertices) : corner_edges(mesh, cones.vertices);
  Map map;
  {
    StageTimer timer(seconds, "prescribe");
    map.curvature = prescribe(mesh, geometry, cones, options.prescription, findings);
  }
  {
    StageTimer timer(seconds, "cut");
    map.cut_graph = connect_cones(mesh, geometry, inside_only(mesh, cones.vertices), map.curvature.needs_no_cut);
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
  const Connection connection = connect(mesh, geometry, map, map.curvature);
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
    map.position = untangle(mesh, geometry, map.cut_graph, map.cut_mesh, connection.rotation, target,
                            fixed_vertices(mesh, map, aligned), map.position);
    check(mesh, map);
  }
  return map;
}

// Collects the maps of the components into one result in the caller's numbering.
class Assembly {
 public:
  Assembly(const Surface& surface, const std::vector<Component>& components, Result& result)
      : surface_(surface), components_(components), result_(result) {
    result.corner_uv = CornerUv::Constant(3 * surface.triangles.rows(), 2, std::numeric_limits<double>::quiet_NaN());
    result.island.assign(surface.triangles.rows(), none);
    result.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
    cone_angle_.assign(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  }

  void add(std::size_t component_index, const ComponentCones& cones, const Geometry& geometry, Map map) {
    const Component& component = components_[component_index];
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      result_.log_scale[component.source_vertex[v]] = map.curvature.log_scale[v];
    }
    for (const Index v : cones.vertices) {
      cone_angle_[component.source_vertex[v]] = flat_angle(component.mesh, v) - map.curvature.at_vertex[v];
    }
    const Index islands = add_islands(component, geometry, map);
    solved_.push_back({&component, std::move(map), islands});
  }

  void finish(const Cones& cones, const std::vector<std::pair<Index, Index>>& duplicates) {
    arrange(islands_);
    std::vector<Index> triangles;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      for (std::size_t k = 0; k < corners_[i].size(); ++k) {
        const Complex z = islands_[i].position[static_cast<Eigen::Index>(k)];
        result_.corner_uv.row(corners_[i][k]) << z.real(), z.imag();
      }
    }
    for (std::size_t i = 0; i < pinned_.size(); ++i) result_.corner_uv.row(pinned_[i].first) = pinned_[i].second;
    for (Index f = 0; f < surface_.triangles.rows(); ++f) {
      if (result_.island[f] != none) triangles.push_back(f);
    }
    for (Solved& solved : solved_) {
      check_in_layout(solved);
      collect_checks(*solved.component, solved.map);
    }
    for (const auto& [f, original] : duplicates) share_map(f, original);
    name_unmapped(duplicates);
    result_.distortion = measure_triangles(surface_, result_.corner_uv, triangles);
    result_.cut_edges = Eigen::Map<VertexPairs>(cut_edges_.data(), static_cast<Eigen::Index>(cut_edges_.size() / 2), 2);
    for (const Index v : cones.vertices) {
      if (std::isnan(cone_angle_[v])) continue;
      result_.cones.push_back(v);
      result_.cone_angles.push_back(cone_angle_[v]);
    }
    report_defects();
  }

 private:
  struct Solved {
    const Component* component;
    Map map;
    Index islands;
  };

  // Checks the coordinates that are returned: a component much smaller than the others has lost digits to its place.
  void check_in_layout(Solved& solved) const {
    const HalfedgeMesh& mesh = solved.component->mesh;
    Eigen::VectorXcd corners(mesh.halfedge_count());
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
      const Index source = solved.component->source_corner(corner);
      corners[corner] = {result_.corner_uv(source, 0), result_.corner_uv(source, 1)};
    }
    check_triangles(mesh, corners, solved.map);
    // Islands of one map were moved one by one; their common cuts are checked as they were before.
    check_seams(mesh, solved.islands == 1 ? corners : at_corners(solved.map.cut_mesh, solved.map.position), solved.map);
  }

  void collect_checks(const Component& component, const Map& map) {
    SeamQuality& seams = result_.seams;
    seams.sister_ratio_max = std::max(seams.sister_ratio_max, map.seams.sister_ratio_max);
    seams.rotation_residual = std::max(seams.rotation_residual, map.seams.rotation_residual);
    seams.translation_residual = std::max(seams.translation_residual, map.seams.translation_residual);
    for (const Index f : map.validity.flipped) result_.flipped.push_back(component.source_triangle[f]);
    for (const Index v : map.validity.wrong_angle_sums) {
      result_.wrong_angle_sums.push_back(component.source_vertex[v]);
    }
    result_.cone_angle_error = std::max(result_.cone_angle_error, map.validity.cone_angle_error);
    // Beside flipped triangles angles are off for that reason alone.
    std::vector<char> excused(component.mesh.vertex_count(), 0);
    for (const Index f : map.validity.flipped) {
      for (int c = 0; c < 3; ++c) excused[component.mesh.triangles(f, c)] = 1;
    }
    for (const Index v : map.validity.inexact_angles) {
      if (!excused[v]) inexact_angles_.push_back(component.source_vertex[v]);
    }
    for (const Index h : map.inexact_seams) {
      inexact_seams_.push_back(component.source_vertex[component.mesh.origin(h)]);
      inexact_seams_.push_back(component.source_vertex[component.mesh.target(h)]);
    }
  }

  // A component is one island, or several where its cuts and seams together close off parts: those keep their size and
  // are placed one by one, related across the seam by how they were moved.
  // Returns how many.
  Index add_islands(const Component& component, const Geometry& geometry, const Map& map) {
    const HalfedgeMesh& mesh = component.mesh;
    std::vector<char> open(mesh.halfedge_count());
    for (Index h = 0; h < mesh.halfedge_count(); ++h) open[h] = map.cut_graph.is_cut[h] || mesh.seam[h];
    std::vector<Index> part;
    const Index part_count = label_parts(mesh, open, part);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index twin = mesh.twin[h];
      if (twin < h || !(map.cut_graph.is_cut[h] || part[h / 3] != part[twin / 3])) continue;
      cut_edges_.push_back(component.source_vertex[mesh.origin(h)]);
      cut_edges_.push_back(component.source_vertex[mesh.target(h)]);
    }
    const Index first = island_count_;
    island_count_ += part_count;
    for (Index f = 0; f < mesh.triangle_count(); ++f) result_.island[component.source_triangle[f]] = first + part[f];
    const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
    if (map.pins.size() > 1) {  // in its place already
      for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) {
        pinned_.emplace_back(component.source_corner(corner),
                             Eigen::RowVector2d(corners[corner].real(), corners[corner].imag()));
      }
      return part_count;
    }
    const double scale = map.uv_area > 0 ? std::sqrt(geometry.total_area / map.uv_area) : 1.0;
    std::vector<std::vector<Index>> of_part(part_count);
    for (Index corner = 0; corner < mesh.halfedge_count(); ++corner) of_part[part[corner / 3]].push_back(corner);
    for (const std::vector<Index>& own : of_part) {
      Island island{Eigen::VectorXcd(own.size()), std::nullopt};
      corners_.emplace_back();
      for (std::size_t k = 0; k < own.size(); ++k) {
        island.position[static_cast<Eigen::Index>(k)] = scale * corners[own[k]];
        corners_.back().push_back(component.source_corner(own[k]));
        if (!map.pins.empty() && map.cut_mesh.copy_of_corner[own[k]] == map.pins.front().copy) {
          island.pin = {static_cast<Eigen::Index>(k), map.pins.front().position};
        }
      }
      islands_.push_back(std::move(island));
    }
    return part_count;
  }

  // Triangles that lie on one of a skipped component were skipped with it.
  void name_unmapped(const std::vector<std::pair<Index, Index>>& duplicates) {
    for (Finding& finding : result_.warnings) {
      if (finding.code != Code::component_skipped) continue;
      std::vector<Index>& skipped = finding.elements.indices;
      const std::vector<Index> originals = skipped;  // sorted, as a component lists its triangles
      for (const auto& [f, original] : duplicates) {
        if (std::binary_search(originals.begin(), originals.end(), original)) skipped.push_back(f);
      }
      std::sort(skipped.begin(), skipped.end());
    }
  }

  void share_map(Index triangle, Index original) {
    result_.island[triangle] = result_.island[original];
    for (Index corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
      for (Index other = 3 * original; other < 3 * original + 3; ++other) {
        if (surface_.triangles.data()[corner] == surface_.triangles.data()[other]) {
          result_.corner_uv.row(corner) = result_.corner_uv.row(other);
        }
      }
    }
  }

  void report_defects() {
    std::vector<Index>& flipped = result_.flipped;
    std::vector<Index>& wrong = result_.wrong_angle_sums;
    std::sort(flipped.begin(), flipped.end());
    std::sort(wrong.begin(), wrong.end());
    if (!inexact_seams_.empty()) {
      result_.warnings.push_back(
          {Code::inexact_seams,
           concat(
               "At ", count(inexact_seams_.size() / 2, "cut edge", "cut edges"),
               " the two sides agree to fewer than nine digits, because the layout shrinks too much there. Add cones "
               "nearby."),
           {ElementKind::edges, inexact_seams_}});
    }
    if (!inexact_angles_.empty()) {
      std::sort(inexact_angles_.begin(), inexact_angles_.end());
      result_.warnings.push_back({Code::inexact_angles,
                                  concat("The angles around ", count(inexact_angles_.size(), "vertex", "vertices"),
                                         " miss what was imposed by more than a millionth. Add cones nearby."),
                                  {ElementKind::vertices, inexact_angles_}});
    }
    if (!flipped.empty()) {
      result_.warnings.push_back({Code::flipped_triangles,
                                  concat(count(flipped.size(), "triangle is", "triangles are"),
                                         " flipped in the layout. Add a cone nearby or improve the mesh there."),
                                  {ElementKind::triangles, flipped}});
    }
    if (!wrong.empty()) {
      result_.warnings.push_back({Code::wrong_angle_sums,
                                  concat("At ", count(wrong.size(), "vertex", "vertices"),
                                         " the layout turns once too often or too little. Move or add cones nearby."),
                                  {ElementKind::vertices, wrong}});
    }
  }

  const Surface& surface_;
  const std::vector<Component>& components_;
  Result& result_;
  std::vector<double> cone_angle_;                // by the caller's vertex, NaN where none was imposed
  std::vector<Index> cut_edges_, inexact_seams_;  // vertex pairs
  std::vector<Index> inexact_angles_;
  std::vector<Solved> solved_;
  std::vector<Island> islands_;                               // those to be arranged
  std::vector<std::vector<Index>> corners_;                   // the caller's, of each of them
  std::vector<std::pair<Index, Eigen::RowVector2d>> pinned_;  // corners that are in their place
  Index island_count_ = 0;
};

void report_border_cones(const Component& component, const std::vector<Index>& border_cones,
                         std::vector<Finding>& findings) {
  if (border_cones.empty()) return;
  findings.push_back(
      {Code::cone_on_boundary,
       concat(count(border_cones.size(), "cone lies", "cones lie"),
              " on an open border, where angles are free anyway; nothing was prescribed there. Give it an "
              "angle to make it a corner."),
       in_source(component, {ElementKind::vertices, border_cones})});
}

std::vector<std::pair<Index, Complex>> pinned_corners(const Component& component, const std::vector<Index>& pin_at,
                                                      const Pins& pins) {
  std::vector<std::pair<Index, Complex>> out;
  if (pins.corners.empty()) return out;
  for (Index corner = 0; corner < component.mesh.halfedge_count(); ++corner) {
    const Index pin = pin_at[component.source_corner(corner)];
    if (pin != none) out.emplace_back(corner, Complex(pins.positions(pin, 0), pins.positions(pin, 1)));
  }
  return out;
}

void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to) {
  for (Finding& finding : from) {
    to.push_back({finding.code, std::move(finding.message), in_source(component, std::move(finding.elements))});
  }
}

}  // namespace

Result parameterize(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins) {
  Result result;
  require_valid(surface);
  require_valid(surface, pins);
  const Work work = [&] {
    StageTimer timer(result.stage_seconds, "topology");
    return prepare(surface, cones, options, result.warnings);
  }();
  const std::vector<Component>& components = work.topology.components;
  std::vector<Index> pin_at(pins.corners.empty() ? 0 : 3 * surface.triangles.rows(), none);
  for (std::size_t i = 0; i < pins.corners.size(); ++i) pin_at[pins.corners[i]] = static_cast<Index>(i);
  Assembly assembly(surface, components, result);
  for_each_component(components, result.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work.tasks[i];
    std::vector<Finding> findings;
    const Geometry geometry = [&] {
      StageTimer timer(result.stage_seconds, "geometry");
      return require_geometry(component, result.warnings);
    }();
    Map map = solve_component(component.mesh, geometry, task.cones, pinned_corners(component, pin_at, pins), options,
                              findings, result.stage_seconds);
    report_border_cones(component, task.border_cones, result.warnings);
    move_findings(component, findings, result.warnings);
    assembly.add(i, task.cones, geometry, std::move(map));
  });
  StageTimer timer(result.stage_seconds, "layout");
  assembly.finish(cones, work.topology.duplicates);
  return result;
}

CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones, const Options& options) {
  const Cones automatic{cones, std::vector<std::optional<double>>(cones.size())};
  std::vector<Finding> findings;
  const Work work = prepare(surface, automatic, options, findings);
  const std::vector<Component>& components = work.topology.components;
  CutPaths out;
  std::vector<Index> edges;
  for_each_component(components, findings, [&](std::size_t i) {
    const Component& component = components[i];
    const Geometry geometry = require_geometry(component, findings);
    const std::vector<Index> inside = inside_only(component.mesh, work.tasks[i].cones.vertices);
    for (const Cut& cut : connect_cones(component.mesh, geometry, inside, {}).cuts) {
      std::vector<Index> path{component.source_vertex[cut.tail]};
      for (const Index h : cut.halfedges) path.push_back(component.source_vertex[component.mesh.target(h)]);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) edges.insert(edges.end(), {path[k], path[k + 1]});
      out.paths.push_back(std::move(path));
    }
  });
  out.edges = Eigen::Map<VertexPairs>(edges.data(), static_cast<Eigen::Index>(edges.size() / 2), 2);
  return out;
}

Prescription prescribe_curvature(const Surface& surface, const Cones& cones, const Options& options) {
  Prescription out;
  const Work work = prepare(surface, cones, options, out.warnings);
  const std::vector<Component>& components = work.topology.components;
  out.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  std::vector<double> angle(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  double stretched_area = 0, total_area = 0;
  for_each_component(components, out.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work.tasks[i];
    const Geometry geometry = require_geometry(component, out.warnings);
    std::vector<Finding> findings;
    const Curvature curvature = prescribe(component.mesh, geometry, task.cones, options.prescription, findings);
    report_border_cones(component, task.border_cones, out.warnings);
    move_findings(component, findings, out.warnings);
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      out.log_scale[component.source_vertex[v]] = curvature.log_scale[v];
    }
    for (const Index v : task.cones.vertices) {
      angle[component.source_vertex[v]] = flat_angle(component.mesh, v) - curvature.at_vertex[v];
    }
    // Islands get the same area in 2D as in 3D, so their squared stretches add up by area.
    stretched_area += curvature.predicted_l2 * curvature.predicted_l2 * geometry.total_area;
    total_area += geometry.total_area;
  });
  out.predicted_l2 = std::sqrt(stretched_area / total_area);
  for (const Index v : cones.vertices) {
    if (std::isnan(angle[v])) continue;
    out.cones.push_back(v);
    out.cone_angles.push_back(angle[v]);
  }
  return out;
}

}  // namespace lsgp

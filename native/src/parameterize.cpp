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
  Eigen::VectorXcd position;  // (copies) u + iv
  double uv_area = 0;         // signed
  SeamQuality seams;
  Validity validity;
};

Eigen::VectorXd curvature_of_nodes(const HalfedgeMesh& mesh, const NodeGraph& nodes, const Eigen::VectorXd& at_vertex) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(nodes.vertex.size());
  for (std::size_t node = 0; node < nodes.vertex.size(); ++node) {
    if (nodes.vertex[node] != none) {
      out[node] = at_vertex[nodes.vertex[node]];
    } else {
      for (const Index v : mesh.boundary_loops[node]) out[node] += at_vertex[v];
    }
  }
  return out;
}

// A surface with boundary has conformal maps without number, so the spectral step would return an arbitrary one; only
// without cones does the smallest eigenvector still mean something (Mullen et al. 2008).
UnfoldMethod usable_unfold(const HalfedgeMesh& mesh, const ComponentCones& cones, UnfoldMethod asked,
                           std::vector<Finding>& findings) {
  const bool plain_disk = mesh.boundary_loops.size() == 1 && mesh.genus == 0 && cones.vertices.empty();
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

// rotation: as imposed, none where no transitions were; angles are then free, too.
void check(const HalfedgeMesh& mesh, const Eigen::VectorXd* rotation, Map& map) {
  if (!map.position.allFinite()) {
    throw Error(Code::solver_failed,
                "The unfolding returned values that are not finite. Clean the mesh (merge by distance, "
                "dissolve degenerate faces) and try again.");
  }
  const Eigen::VectorXcd corners = at_corners(map.cut_mesh, map.position);
  map.uv_area = 0;
  for (Index f = 0; f < mesh.triangle_count(); ++f) map.uv_area += doubled_area(corners, f) / 2;
  map.seams = measure_seams(mesh, map.cut_graph, corners, rotation);
  map.validity = check_map(mesh, corners, map.curvature.at_vertex);
  if (!rotation) map.validity.wrong_angle_sums.clear();
}

Map solve_component(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                    const Options& options, std::vector<Finding>& findings, StageSeconds& seconds) {
  Map map;
  {
    StageTimer timer(seconds, "cut");
    map.cut_graph = connect_cones(mesh, geometry, cones.vertices);
    map.cut_mesh = cut_open(mesh, map.cut_graph);
  }
  {
    StageTimer timer(seconds, "prescribe");
    map.curvature = prescribe(mesh, geometry, map.cut_graph, map.cut_mesh, cones, options.prescription, findings);
  }
  StageTimer timer(seconds, "unfold");
  if (options.method == Method::lscm) {
    map.position = unfold_lscm(mesh, geometry, map.cut_mesh);
    check(mesh, nullptr, map);
    return map;
  }
  const Connection connection = connect(mesh, geometry, map, map.curvature);
  if (usable_unfold(mesh, cones, options.unfold, findings) == UnfoldMethod::spectral) {
    map.position = unfold_spectral(mesh, geometry, map.cut_mesh, connection.reduction);
    check(mesh, &connection.rotation, map);
    return map;
  }
  map.position = PoissonSystem(mesh, geometry, map.cut_mesh, connection.reduction)
                     .unfold(map.curvature.log_scale, connection.frames);
  check(mesh, &connection.rotation, map);
  if (!map.validity.flipped.empty()) {
    map.position =
        untangle(mesh, geometry, map.cut_graph, map.cut_mesh, connection.rotation, map.curvature, map.position);
    check(mesh, &connection.rotation, map);
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
    for (Index h = 0; h < component.mesh.halfedge_count(); ++h) {
      if (!map.cut_graph.is_cut[h] || component.mesh.twin[h] < h) continue;
      cut_edges_.push_back(component.source_vertex[component.mesh.origin(h)]);
      cut_edges_.push_back(component.source_vertex[component.mesh.target(h)]);
    }
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      result_.log_scale[component.source_vertex[v]] = map.curvature.log_scale[v];
    }
    for (const Index v : cones.vertices)
      cone_angle_[component.source_vertex[v]] = 2 * M_PI - map.curvature.at_vertex[v];
    SeamQuality& seams = result_.seams;
    seams.sister_ratio_max = std::max(seams.sister_ratio_max, map.seams.sister_ratio_max);
    seams.rotation_residual = std::max(seams.rotation_residual, map.seams.rotation_residual);
    seams.translation_residual = std::max(seams.translation_residual, map.seams.translation_residual);
    for (const Index f : map.validity.flipped) result_.flipped.push_back(component.source_triangle[f]);
    for (const Index v : map.validity.wrong_angle_sums) result_.wrong_angle_sums.push_back(component.source_vertex[v]);
    result_.cone_angle_error = std::max(result_.cone_angle_error, map.validity.cone_angle_error);

    islands_.push_back({std::move(map.position), geometry.total_area, map.uv_area});
    solved_.emplace_back(component_index, std::move(map.cut_mesh.copy_of_corner));
  }

  void finish(const Cones& cones, const std::vector<std::pair<Index, Index>>& duplicates) {
    arrange(islands_);
    std::vector<Index> triangles;
    for (std::size_t i = 0; i < solved_.size(); ++i) {
      const Component& component = components_[solved_[i].first];
      for (std::size_t corner = 0; corner < solved_[i].second.size(); ++corner) {
        const Index source = component.source_corner(static_cast<Index>(corner));
        const Complex z = islands_[i].position[solved_[i].second[corner]];
        result_.corner_uv.row(source) << z.real(), z.imag();
      }
      for (const Index f : component.source_triangle) result_.island[f] = static_cast<Index>(i);
      triangles.insert(triangles.end(), component.source_triangle.begin(), component.source_triangle.end());
    }
    for (const auto& [f, original] : duplicates) share_map(f, original);
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
  std::vector<double> cone_angle_;  // by the caller's vertex, NaN where none was imposed
  std::vector<Index> cut_edges_;
  std::vector<Island> islands_;
  std::vector<std::pair<std::size_t, std::vector<Index>>> solved_;  // component, copy of each corner
};

void report_boundary_cones(const Component& component, const std::vector<Index>& on_boundary,
                           std::vector<Finding>& findings) {
  if (on_boundary.empty()) return;
  Elements elements = in_source(component, {ElementKind::vertices, on_boundary});
  findings.push_back({Code::cone_on_boundary,
                      concat(count(on_boundary.size(), "cone lies", "cones lie"),
                             " on an open border, where angles are free anyway; nothing was prescribed there."),
                      std::move(elements)});
}

void move_findings(const Component& component, std::vector<Finding>& from, std::vector<Finding>& to) {
  for (Finding& finding : from) {
    to.push_back({finding.code, std::move(finding.message), in_source(component, std::move(finding.elements))});
  }
}

}  // namespace

Result parameterize(const Surface& surface, const Cones& cones, const Options& options) {
  Result result;
  Topology topology;
  {
    StageTimer timer(result.stage_seconds, "topology");
    require_valid(surface);
    require_valid(surface, cones);
    topology = build_topology(surface, result.warnings);
  }
  const std::vector<Component>& components = topology.components;
  const std::vector<AssignedCones> assigned = assign_cones(surface, components, cones);
  Assembly assembly(surface, components, result);
  for_each_component(components, result.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    std::vector<Finding> findings;
    const Geometry geometry = [&] {
      StageTimer timer(result.stage_seconds, "geometry");
      return require_geometry(component, result.warnings);
    }();
    Map map = solve_component(component.mesh, geometry, assigned[i].inside, options, findings, result.stage_seconds);
    report_boundary_cones(component, assigned[i].on_boundary, result.warnings);
    move_findings(component, findings, result.warnings);
    assembly.add(i, assigned[i].inside, geometry, std::move(map));
  });
  StageTimer timer(result.stage_seconds, "layout");
  assembly.finish(cones, topology.duplicates);
  return result;
}

CutPaths find_cuts(const Surface& surface, const std::vector<Index>& cones) {
  const Cones automatic{cones, std::vector<std::optional<double>>(cones.size())};
  require_valid(surface);
  require_valid(surface, automatic);
  std::vector<Finding> findings;
  const std::vector<Component> components = build_topology(surface, findings).components;
  const std::vector<AssignedCones> assigned = assign_cones(surface, components, automatic);
  CutPaths out;
  std::vector<Index> edges;
  for_each_component(components, findings, [&](std::size_t i) {
    const Component& component = components[i];
    const Geometry geometry = require_geometry(component, findings);
    const CutGraph graph = connect_cones(component.mesh, geometry, assigned[i].inside.vertices);
    for (const Cut& cut : graph.cuts) {
      std::vector<Index> path{component.source_vertex[cut.tail]};
      for (const Index h : cut.halfedges) path.push_back(component.source_vertex[component.mesh.target(h)]);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) edges.insert(edges.end(), {path[k], path[k + 1]});
      out.paths.push_back(std::move(path));
    }
  });
  out.edges = Eigen::Map<VertexPairs>(edges.data(), static_cast<Eigen::Index>(edges.size() / 2), 2);
  return out;
}

Prescription prescribe_curvature(const Surface& surface, const Cones& cones, PrescriptionRule rule) {
  require_valid(surface);
  require_valid(surface, cones);
  Prescription out;
  const std::vector<Component> components = build_topology(surface, out.warnings).components;
  const std::vector<AssignedCones> assigned = assign_cones(surface, components, cones);
  out.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  std::vector<double> angle(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  double stretched_area = 0, total_area = 0;
  for_each_component(components, out.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const Geometry geometry = require_geometry(component, out.warnings);
    const CutGraph cut_graph = connect_cones(component.mesh, geometry, assigned[i].inside.vertices);
    const CutMesh cut_mesh = cut_open(component.mesh, cut_graph);
    std::vector<Finding> findings;
    const Curvature curvature =
        prescribe(component.mesh, geometry, cut_graph, cut_mesh, assigned[i].inside, rule, findings);
    report_boundary_cones(component, assigned[i].on_boundary, out.warnings);
    move_findings(component, findings, out.warnings);
    for (Index v = 0; v < component.mesh.vertex_count(); ++v)
      out.log_scale[component.source_vertex[v]] = curvature.log_scale[v];
    for (const Index v : assigned[i].inside.vertices)
      angle[component.source_vertex[v]] = 2 * M_PI - curvature.at_vertex[v];
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

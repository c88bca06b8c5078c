// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of cone placement; every component is worked on for itself.
#include <cmath>
#include <limits>

#include "component_placement.hpp"
#include "components.hpp"
#include "lsgp/lsgp.hpp"
#include "monitor.hpp"
#include "solvers/cholesky.hpp"
#include "text.hpp"
#include "validation.hpp"

namespace lsgp {

namespace {

// A surface split into components, each with what cones may be placed on.
class PlacementWork {
 public:
  PlacementWork(const Surface& surface, const Cones& existing, SeamMode seams, std::vector<Finding>& findings,
                const Progress& progress)
      : triangles_(surface.triangles.rows()), findings_(findings), monitor_(progress, seconds_) {
    Options options;
    options.prescription = PrescriptionRule::manual;  // given angles stay
    options.seams = seams;
    work_ = prepare(surface, existing, options, findings);
    copies_.assign(surface.positions.rows(), 0);
    for (const Component& component : work_.topology.components) {
      for (const Index v : component.source_vertex) ++copies_[v];
    }
  }

  double unit_scale() const { return work_.unit_scale; }
  const std::vector<Component>& components() const { return work_.topology.components; }
  Monitor& monitor() { return monitor_; }

  // Calls visit(component, geometry, existing cones, allowed vertices, findings) for every component.
  template <typename Visit>
  void for_each(Visit visit) {
    Index triangles_before = 0;
    for_each_component(components(), findings_, [&](std::size_t i) {
      const Component& component = components()[i];
      const double begin = static_cast<double>(triangles_before) / static_cast<double>(triangles_);
      triangles_before += component.mesh.triangle_count();
      const Monitor::Part part(monitor_, begin,
                               static_cast<double>(triangles_before) / static_cast<double>(triangles_));
      monitor_.advance(0);
      const Geometry geometry = require_geometry(component, findings_);
      // A vertex where parts meet cannot have an angle on each.
      std::vector<char> allowed;
      for (const Index v : component.source_vertex) allowed.push_back(copies_[v] == 1);
      std::vector<Finding> found;
      visit(component, geometry, work_.tasks[i].cones, allowed, found);
      report_border_cones(component, work_.tasks[i].border_cones, findings_);
      move_findings(component, found, findings_);
    });
    monitor_.advance(1);
  }

 private:
  Eigen::Index triangles_;
  std::vector<Finding>& findings_;
  StageSeconds seconds_;
  Monitor monitor_;
  Work work_;
  std::vector<Index> copies_;  // (n) components' vertices that are one of the caller's
};

std::vector<Index> mirror_images(const Component& component, const Geometry& geometry, const PlacementOptions& options,
                                 double unit_scale, std::vector<Finding>& findings) {
  if (!options.symmetric) return {};
  std::optional<MirrorPlane> plane = options.mirror;
  if (plane) plane->point *= unit_scale;
  std::vector<Index> images = find_mirror_images(component.mesh, geometry, plane);
  if (images.empty()) {
    std::vector<Index> all(component.source_triangle.size());
    for (std::size_t f = 0; f < all.size(); ++f) all[f] = static_cast<Index>(f);
    findings.push_back({Code::not_symmetric,
                        concat("A part of the surface is not its own mirror image in ",
                               options.mirror ? "the given plane" : "any plane that was tried",
                               "; its cones were placed without regard to symmetry. Symmetrize the mesh, or give its "
                               "mirror plane."),
                        {ElementKind::triangles, std::move(all)}});
  }
  return images;
}

}  // namespace

Placement place_cones(const Surface& surface, const Cones& existing, const PlacementOptions& options,
                      const Progress& progress) {
  require_valid(options);
  Placement out;
  const LinearAlgebraCounter counter;
  PlacementWork work(surface, existing, options.seams, out.warnings, progress);
  out.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  std::vector<std::optional<double>> angle(surface.positions.rows());
  std::vector<Index> placed;
  double stretched_area = 0, total_area = 0;
  work.for_each([&](const Component& component, const Geometry& geometry, const ComponentCones& cones,
                    const std::vector<char>& allowed, std::vector<Finding>& findings) {
    const std::vector<Index> mirrored = mirror_images(component, geometry, options, work.unit_scale(), findings);
    const PlacedCones found =
        place_component({component.mesh, geometry, cones, allowed, mirrored}, options, findings, work.monitor());
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      out.log_scale[component.source_vertex[v]] = found.curvature.log_scale[v];
    }
    for (std::size_t i = 0; i < found.cones.vertices.size(); ++i) {
      placed.push_back(component.source_vertex[found.cones.vertices[i]]);
      angle[placed.back()] = found.cones.angles[i];
    }
    // Islands get the same area in 2D as in 3D, so their squared stretches add up by area.
    stretched_area += found.curvature.predicted_l2 * found.curvature.predicted_l2 * geometry.total_area;
    total_area += geometry.total_area;
    out.reached &= found.reached;
  });
  out.linear_algebra = counter.counted();
  out.predicted_l2 = std::sqrt(stretched_area / total_area);
  std::vector<Index> all = existing.vertices;
  all.insert(all.end(), placed.begin(), placed.end());
  for (const Index v : all) {
    if (!angle[v]) continue;
    out.cones.push_back(v);
    out.cone_angles.push_back(*angle[v]);
    angle[v].reset();  // listed
  }
  return out;
}

ConeGains cone_gains(const Surface& surface, const Cones& existing, SeamMode seams, const Progress& progress) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  ConeGains out;
  PlacementWork work(surface, existing, seams, out.warnings, progress);
  out.predicted_l2 = Eigen::VectorXd::Constant(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  double stretched_area = 0, total_area = 0, most = 0, most_without = 0;
  work.for_each([&](const Component& component, const Geometry& geometry, const ComponentCones& cones,
                    const std::vector<char>& allowed, std::vector<Finding>&) {
    const ComponentGains gains = component_gains({component.mesh, geometry, cones, allowed, {}}, work.monitor());
    Index best = none;
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      const double with_cone = gains.predicted_l2[v];
      if (std::isnan(with_cone)) continue;
      out.predicted_l2[component.source_vertex[v]] = with_cone;
      if (best == none || with_cone < gains.predicted_l2[best]) best = v;
    }
    stretched_area += gains.present_l2 * gains.present_l2 * geometry.total_area;
    total_area += geometry.total_area;
    if (best == none) return;
    // A component that has to have a cone comes first, the largest before others.
    const bool needed = gains.present_l2 == unlimited;
    const double saved = geometry.total_area *
                         (gains.present_l2 * gains.present_l2 - gains.predicted_l2[best] * gains.predicted_l2[best]);
    const double gained = needed ? geometry.total_area : saved;
    double& record = needed ? most_without : most;
    if (!(gained > record) || (!needed && most_without > 0)) return;
    record = gained;
    out.best = component.source_vertex[best];
  });
  out.present_l2 = std::sqrt(stretched_area / total_area);
  return out;
}

}  // namespace lsgp

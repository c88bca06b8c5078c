// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of cone placement; components are independent.
#include "api/cone_placement.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "api/opened_component.hpp"
#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "base/text.hpp"
#include "base/thread_team.hpp"
#include "creases/tubes.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh/mirror.hpp"
#include "mesh/noise.hpp"
#include "pipeline/said_once.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"
#include "placement/component_placement.hpp"
#include "placement/directed_placement.hpp"
#include "placement/twin_placement.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace lsgp {

namespace {

constexpr double same_cone_angle = 1e-9;  // radians

// A surface split into components, with the vertices where cones may be placed.
class PlacementWork {
 public:
  PlacementWork(const PlacementRequest& request, KeptComponents& kept, std::vector<Finding>& findings,
                const Progress& progress)
      : triangles_(request.surface.triangles.rows()), kept_(kept), findings_(findings), monitor_(progress, seconds_) {
    kept_.update([&](Work earlier) { return prepare_placement(request, findings, std::move(earlier)); });
    inside_.assign(request.surface.positions.rows(), 0);
    for (const Component& component : components()) {
      for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
        inside_[component.source_vertex[v]] += component.mesh.loop_of_vertex[v] == none;
      }
    }
  }

  double unit_scale() const { return kept_.work().unit_scale; }
  const PerComponent<Component>& components() const { return kept_.work().topology.components; }
  ProgressMonitor& monitor() { return monitor_; }

  void keep_system(const Component& component, KeptSystem system) {
    kept_.keep_system(number(component), std::move(system));
  }
  // Null if none are kept.
  ComponentResults* results(const Component& component) {
    return kept_.keeps() ? &kept_.results(number(component)) : nullptr;
  }
  const Mirroring& mirroring_of(const Component& component) { return kept_.mirroring_of(number(component)); }

  // Calls visit(component, geometry, task, allowed vertices, findings) for every component.
  template <typename Visit>
  void for_each(Visit visit) {
    Index triangles_before = 0;
    for_each_component(components(), findings_, [&](std::size_t i) {
      const Component& component = components()[i];
      const ComponentTask& task = kept_.work().tasks[i];
      const double begin = static_cast<double>(triangles_before) / static_cast<double>(triangles_);
      triangles_before += component.mesh.triangle_count();
      const ProgressMonitor::Interval interval(monitor_, begin,
                                               static_cast<double>(triangles_before) / static_cast<double>(triangles_));
      monitor_.advance(0);
      const Geometry& geometry = kept_.geometry_of(i, findings_);
      // A vertex inside several components cannot have a different angle on each.
      PerVertex<char> allowed;
      for (const Index v : component.source_vertex) allowed.push_back(inside_[v] <= 1);
      std::vector<Finding> found;
      visit(component, geometry, task, allowed, found);
      report_border_cones(component, task.border_cones, findings_);
      move_findings(component, found, findings_);
    });
    monitor_.advance(1);
  }

 private:
  std::size_t number(const Component& component) const {
    return static_cast<std::size_t>(&component - kept_.work().topology.components.data());
  }

  Eigen::Index triangles_;
  KeptComponents& kept_;
  std::vector<Finding>& findings_;
  StageSeconds seconds_;
  ProgressMonitor monitor_;
  PerVertex<Index> inside_;  // vertices inside components that are one of the caller's
};

// The given mirror plane in the components' unit.
std::optional<MirrorPlane> mirror_plane(const PlacementOptions& options, double unit_scale) {
  std::optional<MirrorPlane> plane = options.mirror;
  if (plane) plane->point *= unit_scale;
  return plane;
}

// What the placements on all components share.
struct PlacementRules {
  const Surface& surface;
  const PlacementOptions& options;
  TwinPlacement& twins;
  ProgressMonitor& monitor;
};

PlacedCones place_alone(const PlacementTask& task, const Positions& directions, const PlacementRules& rules,
                        std::vector<Finding>& findings) {
  PlacedCones found = place_component(task, rules.options, findings, rules.monitor);
  const bool is_done = found.are_too_many || rules.options.count;
  if (directions.rows() == 0 || !rules.options.lattice || is_done) return found;
  auto beside = place_beside_directions(task, directions, rules.options, found, rules.monitor);
  return beside ? std::move(*beside) : std::move(found);
}

// A component and what there is of it.
struct OfComponent {
  const Component& component;
  const PlacementTask& task;
  ComponentResults* results;  // or null
  Positions directions = {};  // (m, 3), or empty
};

// The cones without regard to strokes.
PlacedCones place_usual(const OfComponent& of, const PlacementRules& rules, std::vector<Finding>& findings) {
  const PlacementTask& task = of.task;
  if (auto copied = rules.twins.place(of.component, task, rules.monitor)) return std::move(*copied);
  const PlacementInput input{task.existing, task.allowed, task.mirrored, of.directions, rules.options};
  PlacedCones placed;
  const PlacementResult* known = of.results == nullptr ? nullptr : of.results->find_placement(input);
  if (known != nullptr) {
    static_cast<ConePlacement&>(placed) = known->placed;
    findings.insert(findings.end(), known->found.begin(), known->found.end());
  } else {
    const auto before = static_cast<std::ptrdiff_t>(findings.size());
    placed = place_alone(task, of.directions, rules, findings);
    if (of.results != nullptr) of.results->keep_placement(input, {placed, {findings.begin() + before, findings.end()}});
  }
  rules.twins.keep(of.component, task, placed);
  return placed;
}

PlacedCones place_on(OfComponent of, const PlacementRules& rules, std::vector<Finding>& findings) {
  const bool has_directions = rules.surface.directions.rows() > 0;
  if (has_directions) of.directions = directions_on(of.component, rules.surface.directions);
  PlacedCones usual = place_usual(of, rules, findings);
  if (!has_directions || usual.are_too_many) return usual;
  auto toward = turn_toward_strokes(of.task, of.directions, rules.options, usual, rules.monitor);
  return toward ? std::move(*toward) : std::move(usual);
}

// A vertex has one angle in the result, even if different ones are best on the components that touch there.
void report_shared(Array<Index> vertices, std::vector<Finding>& findings) {
  if (vertices.empty()) return;
  sort_unique(vertices);
  findings.push_back({Code::split_vertex,
                      concat(count(vertices.size(), "cone is", "cones are"),
                             " where pieces of the surface touch, and should have a separate angle on each; only one "
                             "can be given. Split the vertices there."),
                      {ElementKind::vertices, std::move(vertices)}});
}

}  // namespace

Placement place_cones_on(const KnownSurface& known, const Cones& existing, const PlacementOptions& options,
                         const Progress& progress) {
  const Surface& surface = known.surface;
  require_valid(options);
  Placement out;
  const LinearAlgebraCounter counter;
  const ThreadCount threads(options.threads);
  const MoreCones more = options.count == 0 ? MoreCones::none : MoreCones::some;
  PlacementWork work({surface, existing, options.seams, more, options.border}, known.components, out.warnings,
                     progress);
  out.log_scale = Eigen::VectorXd::Zero(surface.positions.rows());
  PerVertex<std::optional<double>> angle(surface.positions.rows());
  Array<Index> placed, shared;
  double stretched_area = 0, stretched_in_maps = 0, total_area = 0;
  Shortfalls shortfalls(options);
  const std::optional<MirrorPlane> plane = mirror_plane(options, work.unit_scale());
  TwinPlacement twins(work.components(), options, plane);
  work.for_each([&](const Component& component, const Geometry& geometry, const ComponentTask& given,
                    const PerVertex<char>& allowed, std::vector<Finding>& findings) {
    PerVertex<Index> mirrored;
    if (options.symmetric) {
      mirrored =
          plane ? find_mirror_images({component.mesh, geometry}, plane).image : work.mirroring_of(component).image;
    }
    if (options.symmetric && mirrored.empty() && !twins.is_mirrored(component)) {
      shortfalls.add_asymmetric(component.source_triangle);
    }
    const Shape shape({component.mesh, geometry}, options.without_noise);
    const PlacementTask task{shape.surface(), given.cones, allowed, mirrored};
    PlacementOptions of_component = options;
    const TubeShape tube = given.may_be_strip ? tube_shape(task) : TubeShape::none;
    const bool is_unrolled = component.mesh.is_ring() ? tube != TubeShape::none : tube == TubeShape::even;
    if (is_unrolled) of_component.count = 0;
    PlacedCones found =
        place_on({component, task, work.results(component)}, {surface, of_component, twins, work.monitor()}, findings);
    found.reached |= is_unrolled;
    if (is_opened(component, found, options)) describe_opened(component, options, work.monitor(), found);
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      out.log_scale[component.source_vertex[v]] = found.curvature.log_scale[v];
    }
    Array<Index> own;
    for (std::size_t i = 0; i < found.cones.vertices.size(); ++i) {
      own.push_back(component.source_vertex[found.cones.vertices[i]]);
      std::optional<double>& told = angle[own.back()];
      if (told && std::abs(*told - *found.cones.angles[i]) > same_cone_angle) shared.push_back(own.back());
      told = found.cones.angles[i];
    }
    placed.insert(placed.end(), own.begin(), own.end());
    // Islands get the same area in 2D as in 3D, so their squared stretches add up by area.
    stretched_area += found.curvature.predicted_l2 * found.curvature.predicted_l2 * geometry.total_area;
    total_area += geometry.total_area;
    stretched_in_maps += found.mapped_l2 * found.mapped_l2 * geometry.total_area;
    out.maps += found.maps;
    out.reached &= found.reached;
    if (found.missing) shortfalls.add(*found.missing, component.source_triangle);
    if (!options.count && !found.reached && !found.are_too_many) {
      shortfalls.add(found.mapped_l2, own, component.source_triangle);
    }
    if (!shape.is_smoothed()) work.keep_system(component, std::move(found.system));
  });
  shortfalls.report(out.warnings);
  report_shared(std::move(shared), out.warnings);
  say_once(out.warnings);
  out.linear_algebra = counter.counted();
  out.predicted_l2 = std::sqrt(stretched_area / total_area);
  out.mapped_l2 = std::sqrt(stretched_in_maps / total_area);
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

Placement place_cones(const Surface& surface, const Cones& existing, const PlacementOptions& options,
                      const Progress& progress) try {
  KeptComponents components(false);
  return place_cones_on({surface, components}, existing, options, progress);
} catch (const Error& error) {
  throw in_words(error);
}

ConeGains cone_gains(const Surface& surface, const Cones& existing, SeamMode seams, const Progress& progress) try {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  require_room_for_cones(seams);
  ConeGains out;
  KeptComponents components(false);
  PlacementWork work({surface, existing, seams, MoreCones::some}, components, out.warnings, progress);
  out.predicted_l2 = Eigen::VectorXd::Constant(surface.positions.rows(), std::numeric_limits<double>::quiet_NaN());
  double stretched_area = 0, total_area = 0, most = 0, most_without = 0;
  work.for_each([&](const Component& component, const Geometry& geometry, const ComponentTask& given,
                    const PerVertex<char>& allowed, std::vector<Finding>&) {
    const ComponentGains gains =
        component_gains({{component.mesh, geometry}, given.cones, allowed, {}}, work.monitor());
    for (Index v = 0; v < component.mesh.vertex_count(); ++v) {
      if (!std::isnan(gains.predicted_l2[v])) out.predicted_l2[component.source_vertex[v]] = gains.predicted_l2[v];
    }
    stretched_area += gains.present_l2 * gains.present_l2 * geometry.total_area;
    total_area += geometry.total_area;
    if (gains.best == none) return;
    // Components that need a cone come first, in order of decreasing size.
    const bool needed = gains.present_l2 == unlimited;
    const double with_cone = gains.predicted_l2[gains.best];
    const double saved = geometry.total_area * (gains.present_l2 * gains.present_l2 - with_cone * with_cone);
    const double gained = needed ? geometry.total_area : saved;
    double& record = needed ? most_without : most;
    if (!(gained > record) || (!needed && most_without > 0)) return;
    record = gained;
    out.best = component.source_vertex[gains.best];
  });
  out.present_l2 = std::sqrt(stretched_area / total_area);
  say_once(out.warnings);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

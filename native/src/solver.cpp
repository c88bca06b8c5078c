// SPDX-License-Identifier: GPL-3.0-or-later
// The whole way from a surface to its map; every component is worked on for itself.
#include "lsgp/solver.hpp"

#include <utility>

#include "assembly.hpp"
#include "component_map.hpp"
#include "component_system.hpp"
#include "components.hpp"
#include "lsgp/lsgp.hpp"
#include "monitor.hpp"
#include "seamless.hpp"
#include "solvers/cholesky.hpp"

namespace lsgp {

namespace {

bool same_cones(const ComponentCones& a, const ComponentCones& b) {
  return a.vertices == b.vertices && a.border == b.border;
}

class Pipeline {
 public:
  // keeps_systems: from one run to the next, rather than until each component is done.
  explicit Pipeline(bool keeps_systems) : keeps_systems_(keeps_systems) {}
  Result run(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
             const Progress& progress);

 private:
  // What is kept of one component.
  struct Kept {
    Geometry geometry;
    std::vector<Finding> found;  // while it was built
    ComponentCones cones;        // of the system
    Factorization factorization = Factorization::automatic;
    std::optional<ComponentSystem> system;
  };

  void prepare_work(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                    std::vector<Finding>& findings);
  const Geometry& geometry_of(std::size_t i, std::vector<Finding>& findings);
  ComponentSystem& system_of(std::size_t i, const Options& options);
  void release(std::size_t i) {
    if (!keeps_systems_) kept_[i]->system->release();
  }

  const bool keeps_systems_;
  Work work_;
  std::vector<std::unique_ptr<Kept>> kept_;  // (components) systems refer to the geometry beside them
};

void Pipeline::prepare_work(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                            std::vector<Finding>& findings) {
  const Component* before = work_.topology.components.data();
  try {
    work_ = prepare(surface, cones, options, findings, pins, std::move(work_));
  } catch (...) {
    kept_.clear();
    work_ = {};
    throw;
  }
  if (work_.topology.components.data() != before) kept_.clear();
  kept_.resize(work_.topology.components.size());
}

const Geometry& Pipeline::geometry_of(std::size_t i, std::vector<Finding>& findings) {
  if (!kept_[i]) {
    auto kept = std::make_unique<Kept>();
    kept->geometry = require_geometry(work_.topology.components[i], kept->found);
    kept_[i] = std::move(kept);
  }
  findings.insert(findings.end(), kept_[i]->found.begin(), kept_[i]->found.end());
  return kept_[i]->geometry;
}

ComponentSystem& Pipeline::system_of(std::size_t i, const Options& options) {
  Kept& kept = *kept_[i];
  const ComponentCones& cones = work_.tasks[i].cones;
  if (!kept.system || !same_cones(kept.cones, cones) || kept.factorization != options.factorization) {
    Eigen::VectorXd memory = kept.system ? kept.system->take_memory() : Eigen::VectorXd();
    kept.system.emplace(work_.topology.components[i].mesh, kept.geometry, cones, options.factorization,
                        std::move(memory));
    kept.cones = cones;
    kept.factorization = options.factorization;
  }
  return *kept.system;
}

Result Pipeline::run(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                     const Progress& progress) {
  Result result;
  const LinearAlgebraCounter counter;
  Monitor monitor(progress, result.stage_seconds);
  {
    const Monitor::Stage stage(monitor, "topology");
    prepare_work(surface, cones, options, pins, result.warnings);
  }
  const std::vector<Component>& components = work_.topology.components;
  if (options.seamless) require_valid(*options.seamless, options, pins);
  constexpr double share_of_rounding = 0.5;
  const double share_of_maps = options.seamless ? 1 - share_of_rounding : 1;
  Index triangles_before = 0;
  std::vector<std::optional<ComponentMap>> maps(components.size());
  for_each_component(components, result.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work_.tasks[i];
    std::vector<Finding> findings;
    const auto share_up_to = [&](Index count) { return share_of_maps * count / surface.triangles.rows(); };
    const double begin = share_up_to(triangles_before);
    triangles_before += component.mesh.triangle_count();
    const Monitor::Part part(monitor, begin, share_up_to(triangles_before));
    monitor.advance(0);
    {
      const Monitor::Stage stage(monitor, "geometry");
      geometry_of(i, result.warnings);
    }
    maps[i] = map_component(system_of(i, options), task, options, findings, monitor);
    release(i);
    result.repair.flipped_before += maps[i]->repair.flipped_before;
    result.repair.wrong_angle_sums_before += maps[i]->repair.wrong_angle_sums_before;
    result.repair.iterations += maps[i]->repair.iterations;
    if (options.seamless) require_quantizable(component.mesh, *maps[i]);
    report_border_cones(component, task.border_cones, result.warnings);
    move_findings(component, findings, result.warnings);
  });
  std::vector<ComponentTask> tasks = work_.tasks;  // seamless layouts merge cones
  if (options.seamless) {
    const Monitor::Stage stage(monitor, "quantize");
    const Monitor::Part part(monitor, share_of_maps, 1);
    monitor.advance(0);
    std::vector<SeamlessPart> parts;
    for (std::size_t i = 0; i < components.size(); ++i) {
      if (maps[i]) parts.push_back({&components[i], &tasks[i], &*maps[i], &*kept_[i]->system});
    }
    result.seamless = make_seamless(options, work_.unit_scale, parts, result.warnings, monitor);
    for (std::size_t i = 0; i < components.size(); ++i) {
      if (maps[i]) release(i);
    }
  }
  const Monitor::Stage stage(monitor, "layout");
  Assembly assembly(surface, components, options, monitor, result);
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (maps[i]) assembly.add(i, tasks[i].cones, kept_[i]->geometry, std::move(*maps[i]));
  }
  assembly.finish(cones, work_.topology.duplicates);
  monitor.advance(1);
  result.linear_algebra = counter.counted();
  return result;
}

}  // namespace

struct Solver::Kept {
  Pipeline pipeline{true};
};

Solver::Solver(Surface surface) : surface_(std::move(surface)), kept_(std::make_unique<Kept>()) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;

Result Solver::parameterize(const Cones& cones, const Options& options, const Pins& pins, const Progress& progress) {
  return kept_->pipeline.run(surface_, cones, options, pins, progress);
}

Result parameterize(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                    const Progress& progress) {
  return Pipeline(false).run(surface, cones, options, pins, progress);
}

}  // namespace lsgp

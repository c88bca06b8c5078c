// SPDX-License-Identifier: GPL-3.0-or-later
// From a surface to its map; components are independent.
#include "lsgp/solver.hpp"
#include "base/array.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

#include "api/assembly.hpp"
#include "base/progress_monitor.hpp"
#include "base/thread_team.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/mapping.hpp"
#include "pipeline/wording.hpp"
#include "prescription/component_system.hpp"
#include "seamless/seamless.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace lsgp {

namespace {

bool same_cones(const ComponentCones& a, const ComponentCones& b) {
  return a.vertices == b.vertices && a.border == b.border && a.mirroring.image == b.mirroring.image;
}

using ComponentMaps = PerComponent<std::optional<ComponentMap>>;  // none of those that have no map

class Pipeline {
 public:
  // keeps_systems: from one run to the next, rather than until each component is done.
  explicit Pipeline(bool keeps_systems) : keeps_systems_(keeps_systems) {}
  Result run(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
             const Progress& progress);

 private:
  // Cached data of one component.
  struct Kept {
    Geometry geometry;
    std::optional<Mirroring> mirroring;  // where it was asked for
    std::vector<Finding> found;          // while it was built
    ComponentCones cones;                // of the system
    Factorization factorization = Factorization::automatic;
    std::optional<ComponentSystem> system;
  };

  void prepare_work(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                    std::vector<Finding>& findings);
  const Geometry& geometry_of(std::size_t i, std::vector<Finding>& findings);
  const Mirroring& mirroring_of(std::size_t i);
  ComponentSystem& system_of(std::size_t i, const Options& options);
  // Puts the maps onto a lattice, and takes away those of components that cannot be.
  SeamlessReport quantize(const Options& options, PerComponent<ComponentTask>& tasks, ComponentMaps& maps,
                          std::vector<Finding>& findings, ProgressMonitor& monitor);
  void release(std::size_t i) {
    if (!keeps_systems_) kept_[i]->system->release();
  }

  const bool keeps_systems_;
  Work work_;
  PerComponent<std::unique_ptr<Kept>> kept_;  // systems refer to the geometry beside them
  std::int64_t kept_of_ = 0;                  // generation of the topology it was made from
};

void Pipeline::prepare_work(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                            std::vector<Finding>& findings) {
  try {
    work_ = prepare({surface, cones, options}, findings, pins, std::move(work_));
  } catch (...) {
    kept_.clear();
    work_ = {};
    throw;
  }
  if (work_.generation != kept_of_) kept_.clear();
  kept_of_ = work_.generation;
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

const Mirroring& Pipeline::mirroring_of(std::size_t i) {
  Kept& kept = *kept_[i];
  if (!kept.mirroring) {
    kept.mirroring = find_mirror_images({work_.topology.components[i].mesh, kept.geometry}, std::nullopt);
  }
  return *kept.mirroring;
}

ComponentSystem& Pipeline::system_of(std::size_t i, const Options& options) {
  Kept& kept = *kept_[i];
  const ComponentCones& cones = work_.tasks[i].cones;
  if (!kept.system || !same_cones(kept.cones, cones) || kept.factorization != options.factorization) {
    Eigen::VectorXd memory = kept.system ? kept.system->take_memory() : Eigen::VectorXd();
    kept.system.emplace(MetricMesh{work_.topology.components[i].mesh, kept.geometry}, cones, options.factorization,
                        std::move(memory));
    kept.cones = cones;
    kept.factorization = options.factorization;
  }
  return *kept.system;
}

SeamlessReport Pipeline::quantize(const Options& options, PerComponent<ComponentTask>& tasks, ComponentMaps& maps,
                                  std::vector<Finding>& findings, ProgressMonitor& monitor) {
  const PerComponent<Component>& components = work_.topology.components;
  monitor.advance(0);
  Array<SeamlessComponent> laid_out;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (maps[i]) laid_out.push_back({&components[i], &tasks[i], &*maps[i], &*kept_[i]->system});
  }
  SeamlessReport report = make_seamless(options, work_.unit_scale, laid_out, findings, monitor);
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (!maps[i]) continue;
    release(i);
    const bool is_laid_out = std::any_of(laid_out.begin(), laid_out.end(), [&](const SeamlessComponent& component) {
      return component.source == &components[i];
    });
    if (!is_laid_out) maps[i].reset();
  }
  return report;
}

Result Pipeline::run(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                     const Progress& progress) {
  Result result;
  const LinearAlgebraCounter counter;
  const ThreadCount threads(options.threads);
  ProgressMonitor monitor(progress, result.stage_seconds);
  {
    const ProgressMonitor::Stage stage(monitor, "topology");
    prepare_work(surface, cones, options, pins, result.warnings);
  }
  const PerComponent<Component>& components = work_.topology.components;
  if (options.seamless) require_valid(*options.seamless, options, pins);
  constexpr double share_of_rounding = 0.5;
  const double share_of_maps = options.seamless ? 1 - share_of_rounding : 1;
  Index triangles_before = 0;
  ComponentMaps maps(components.size());
  PerComponent<std::vector<Finding>> found(components.size());  // about the maps
  for_each_component(components, result.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work_.tasks[i];
    const auto share_up_to = [&](Index count) {
      return share_of_maps * count / static_cast<double>(surface.triangles.rows());
    };
    const double begin = share_up_to(triangles_before);
    triangles_before += component.mesh.triangle_count();
    const ProgressMonitor::Interval interval(monitor, begin, share_up_to(triangles_before));
    monitor.advance(0);
    {
      const ProgressMonitor::Stage stage(monitor, "geometry");
      geometry_of(i, result.warnings);
      if (options.mirrored_cuts) work_.tasks[i].cones.mirroring = mirroring_of(i);
    }
    ComponentMap map = map_component(system_of(i, options), task, options, found[i], monitor);
    release(i);
    if (options.seamless) require_quantizable(component.mesh, map);
    result.repair.flipped_before += map.repair.flipped_before;
    result.repair.wrong_angle_sums_before += map.repair.wrong_angle_sums_before;
    result.repair.iterations += map.repair.iterations;
    maps[i] = std::move(map);
    report_border_cones(component, task.border_cones, result.warnings);
  });
  PerComponent<ComponentTask> tasks = work_.tasks;  // seamless layouts merge cones
  if (options.seamless) {
    const ProgressMonitor::Stage stage(monitor, "quantize");
    const ProgressMonitor::Interval interval(monitor, share_of_maps, 1);
    result.seamless = quantize(options, tasks, maps, result.warnings, monitor);
  }
  const ProgressMonitor::Stage stage(monitor, "layout");
  Assembly assembly(surface, components, options, monitor, result);
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (maps[i]) assembly.add(i, tasks[i], kept_[i]->geometry, std::move(*maps[i]), std::move(found[i]));
  }
  assembly.require_any();
  assembly.finish(cones, work_.topology.duplicates);
  monitor.advance(1);
  result.linear_algebra = counter.counted();
  return result;
}

}  // namespace

struct Solver::Kept {
  Pipeline pipeline{true};
  std::atomic<bool> is_busy{false};
};

namespace {

// Marks a solver as busy for as long as this lives.
class Turn {
 public:
  explicit Turn(std::atomic<bool>& is_busy) : is_busy_(is_busy) {
    if (!is_busy_.exchange(true)) return;
    throw Error(Code::solver_busy,
                "This solver is already running a call (from another thread, or from its own progress callback). Wait "
                "for it, or use one solver per thread.");
  }
  ~Turn() { is_busy_ = false; }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic<bool>& is_busy_;
};

}  // namespace

Solver::Solver(Surface surface) : surface_(std::move(surface)), kept_(std::make_unique<Kept>()) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;

Result Solver::parameterize(const Cones& cones, const Options& options, const Pins& pins,
                            const Progress& progress) try {
  const Turn turn(kept_->is_busy);
  return kept_->pipeline.run(surface_, cones, options, pins, progress);
} catch (const Error& error) {
  throw in_words(error);
}

Result parameterize(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                    const Progress& progress) try {
  return Pipeline(false).run(surface, cones, options, pins, progress);
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// From a surface to its map; components are independent.
#include "lsgp/solver.hpp"
#include "base/array.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "api/cone_placement.hpp"
#include "api/map_surface.hpp"
#include "assembly/assembly.hpp"
#include "base/progress_monitor.hpp"
#include "base/thread_team.hpp"
#include "creases/tubes.hpp"
#include "kept/kept_components.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/components.hpp"
#include "pipeline/directed_borders.hpp"
#include "pipeline/mapping.hpp"
#include "pipeline/said_once.hpp"
#include "pipeline/wording.hpp"
#include "seamless/seamless.hpp"
#include "solvers/linear_algebra_counter.hpp"

namespace lsgp {

namespace {

using ComponentMaps = PerComponent<std::optional<ComponentMap>>;  // none of those that have no map

struct MappedComponents {
  PerComponent<ComponentTask> tasks;  // seamless layouts merge cones
  ComponentMaps maps;
  PerComponent<MapResult*> results;  // where they are kept
};

// Puts the maps onto a lattice, and takes away those of components that cannot be.
void quantize(KeptComponents& kept, const Options& options, MappedComponents& mapped, Result& result,
              ProgressMonitor& monitor) {
  const Work& work = kept.work();
  const PerComponent<Component>& components = work.topology.components;
  monitor.advance(0);
  Array<SeamlessComponent> laid_out;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (mapped.maps[i])
      laid_out.push_back(
          {&components[i], &mapped.tasks[i], &*mapped.maps[i], kept.system(i), &mapped.results[i]->alignment});
  }
  result.seamless = make_seamless(options, work.unit_scale, laid_out, result.warnings, monitor);
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (!mapped.maps[i]) continue;
    kept.release(i);
    const bool is_laid_out = std::any_of(laid_out.begin(), laid_out.end(), [&](const SeamlessComponent& component) {
      return component.source == &components[i];
    });
    if (!is_laid_out) mapped.maps[i].reset();
  }
}

// The options without what would cut more than the seams, where nothing else may be cut.
Options allowed_by_seams(Options options) {
  if (options.seams != SeamMode::exact) return options;
  options.overlaps = Overlaps::keep;
  options.compact = Compactness::off;
  options.mirrored_cuts = false;
  return options;
}

Result map_components(const KnownSurface& known, const MapRequest& request, const Progress& progress) {
  const Surface& surface = known.surface;
  const Cones& cones = request.cones;
  const Options options = allowed_by_seams(request.options);
  const Pins& pins = request.pins;
  KeptComponents& kept = known.components;
  Result result;
  const LinearAlgebraCounter counter;
  const ThreadCount threads(options.threads);
  ProgressMonitor monitor(progress, result.stage_seconds);
  {
    const ProgressMonitor::Stage stage(monitor, "topology");
    kept.update(
        [&](Work earlier) { return prepare({surface, cones, options}, result.warnings, pins, std::move(earlier)); });
  }
  Work& work = kept.work();
  const PerComponent<Component>& components = work.topology.components;
  if (options.seamless) require_valid(*options.seamless, options, pins);
  constexpr double share_of_rounding = 0.5;
  const double share_of_maps = options.seamless ? 1 - share_of_rounding : 1;
  Index triangles_before = 0;
  MappedComponents mapped{{}, ComponentMaps(components.size()), PerComponent<MapResult*>(components.size())};
  // Of seamless layouts before they are split, which they are before their islands are put onto the lattice. Others are
  // computed fast, and copied often while a cone is dragged.
  const bool keeps_maps =
      kept.keeps() && (options.seamless || options.overlaps == Overlaps::split) && pins.corners.empty();
  PerComponent<MapResult> unkept(components.size());
  PerComponent<std::vector<Finding>> found(components.size());  // about the maps
  for_each_component(components, result.warnings, [&](std::size_t i) {
    const Component& component = components[i];
    const ComponentTask& task = work.tasks[i];
    const auto share_up_to = [&](Index count) {
      return share_of_maps * count / static_cast<double>(surface.triangles.rows());
    };
    const double begin = share_up_to(triangles_before);
    triangles_before += component.mesh.triangle_count();
    const ProgressMonitor::Interval interval(monitor, begin, share_up_to(triangles_before));
    monitor.advance(0);
    {
      const ProgressMonitor::Stage stage(monitor, "geometry");
      kept.geometry_of(i, result.warnings);
      const MetricMesh metric{component.mesh, kept.geometry(i)};
      if (task.may_be_strip && tube_shape(metric) == TubeShape::even) become_strip(work.tasks[i]);
      const bool is_closed_strip = task.is_strip && component.mesh.closed();  // cut along a row and a ring of its own
      if (options.mirrored_cuts && !is_closed_strip) work.tasks[i].cones.mirroring = kept.mirroring_of(i);
      if (work.tasks[i].has_directed_borders) {
        free_stretched_borders(metric, monitor, work.tasks[i]);
      }
    }
    ComponentSystem& system = kept.system_of(i, options.factorization);
    ComponentMap map;
    MapResult& result_of_map = keeps_maps ? kept.results(i).of_map(task, options) : unkept[i];
    mapped.results[i] = &result_of_map;
    if (const auto& known = result_of_map.map) {
      map = known->map;
      found[i] = known->findings;
    } else {
      map = map_component(system, task, options, found[i], monitor);
      if (keeps_maps && options.seamless) result_of_map.map = FoundMap{map, found[i]};
    }
    kept.release(i);
    if (options.seamless) require_quantizable(component.mesh, map);
    result.repair.flipped_before += map.repair.flipped_before;
    result.repair.wrong_angle_sums_before += map.repair.wrong_angle_sums_before;
    result.repair.iterations += map.repair.iterations;
    mapped.maps[i] = std::move(map);
    report_border_cones(component, task.border_cones, result.warnings);
  });
  mapped.tasks = work.tasks;
  if (options.seamless) {
    const ProgressMonitor::Stage stage(monitor, "quantize");
    const ProgressMonitor::Interval interval(monitor, share_of_maps, 1);
    quantize(kept, options, mapped, result, monitor);
  }
  const ProgressMonitor::Stage stage(monitor, "layout");
  Assembly assembly(surface, components, options, monitor, result);
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (!mapped.maps[i]) continue;
    FoundMap of_component{std::move(*mapped.maps[i]), std::move(found[i])};
    MapResult& known = *mapped.results[i];
    assembly.add(i, mapped.tasks[i], kept.geometry(i), std::move(of_component), {known.map, known.divided});
  }
  assembly.require_any();
  assembly.finish(cones, work.topology.duplicates, request.search);
  say_once(result.warnings);
  monitor.advance(1);
  result.linear_algebra = counter.counted();
  return result;
}

}  // namespace

struct Solver::Kept {
  std::shared_ptr<KeptComponents> components = std::make_shared<KeptComponents>(true);
  std::shared_ptr<std::atomic<bool>> is_busy = std::make_shared<std::atomic<bool>>(false);
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
Solver::Solver(Surface surface, const Solver& earlier)
    : surface_(std::move(surface)),
      kept_(std::make_unique<Kept>(
          Kept{std::make_shared<KeptComponents>(earlier.kept_->components), earlier.kept_->is_busy})) {}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;

Result Solver::parameterize(const Cones& cones, const Options& options, const Pins& pins,
                            const Progress& progress) try {
  const Turn turn(*kept_->is_busy);
  return map_components({surface_, *kept_->components}, {cones, options, pins, OverlapSearch::made}, progress);
} catch (const Error& error) {
  throw in_words(error);
}

Placement Solver::place_cones(const Cones& existing, const PlacementOptions& options, const Progress& progress) try {
  const Turn turn(*kept_->is_busy);
  return place_cones_on({surface_, *kept_->components}, existing, options, progress);
} catch (const Error& error) {
  throw in_words(error);
}

Result map_surface(const Surface& surface, const MapRequest& request, const Progress& progress) {
  KeptComponents components(false);
  return map_components({surface, components}, request, progress);
}

Result parameterize(const Surface& surface, const Cones& cones, const Options& options, const Pins& pins,
                    const Progress& progress) try {
  return map_surface(surface, {cones, options, pins, OverlapSearch::made}, progress);
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

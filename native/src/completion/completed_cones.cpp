// SPDX-License-Identifier: GPL-3.0-or-later
#include "lsgp/completed_cones.hpp"

#include <algorithm>
#include <new>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/array.hpp"
#include "base/progress_share.hpp"
#include "completion/features_wanted.hpp"
#include "completion/merged_findings.hpp"
#include "lsgp/lsgp.hpp"
#include "measures/map_comparison.hpp"
#include "mesh/part_of_surface.hpp"

namespace lsgp {

namespace {

// What cones are completed by.
struct CompletionRules {
  const CompletionOptions& completion;
  const MapOptions& options;
};

Placement place(Solver& solver, const Cones& given, const CompletionRules& rules, const Progress& progress) {
  const CompletionOptions& completion = rules.completion;
  const MapOptions& options = rules.options;
  PlacementOptions placing;
  placing.count = completion.count;
  placing.most = completion.most;
  placing.target = completion.target;
  placing.symmetric = completion.symmetric;
  if (options.of_map.seamless) placing.lattice = options.of_map.seamless->lattice;
  placing.follow_strokes = options.of_map.follow_strokes;
  placing.seams = options.of_map.seams;
  placing.border = options.of_map.border;
  placing.without_noise = true;
  placing.hard_repairs = options.of_map.hard_repairs;
  placing.threads = options.of_map.threads;
  return solver.place_cones(given, placing, progress);
}

CompletedCones completed(const Cones& given, const CompletionOptions& completion, const MapOptions& options,
                         Placement placed) {
  // Angles of placement are for free borders, and for rules that keep them.
  const bool keeps_angles = !options.prescription && options.of_map.border != BorderMode::straight;
  std::unordered_map<Index, double> placed_angle;
  for (std::size_t i = 0; keeps_angles && i < placed.cones.size(); ++i) {
    placed_angle[placed.cones[i]] = placed.cone_angles[i];
  }
  const auto angle_at = [&](Index cone, std::optional<double> otherwise) {
    const auto found = placed_angle.find(cone);
    return found == placed_angle.end() ? otherwise : found->second;
  };
  CompletedCones out;
  for (std::size_t i = 0; i < given.vertices.size(); ++i) {
    out.cones.vertices.push_back(given.vertices[i]);
    out.cones.angles.push_back(angle_at(given.vertices[i], given.angles[i]));
  }
  for (const Index cone : placed.cones) {
    if (std::find(given.vertices.begin(), given.vertices.end(), cone) != given.vertices.end()) continue;
    out.cones.vertices.push_back(cone);
    out.cones.angles.push_back(angle_at(cone, {}));
  }
  out.placement = std::move(placed);
  if (!completion.count) out.target = completion.target;
  return out;
}

// Findings on these triangles of a surface as findings on the surface, of which the others are a part as well.
std::vector<Finding> renumbered(std::vector<Finding> findings, const std::vector<Index>& triangles) {
  std::vector<Finding> out;
  for (Finding& finding : findings) {
    if (finding.code == Code::isolated_vertices) continue;
    if (finding.elements.kind == ElementKind::triangles) {
      for (Index& f : finding.elements.indices) f = element(triangles, f);
    }
    out.push_back(std::move(finding));
  }
  return out;
}

// Cones on some triangles alone.
Placement place_on(const std::vector<Index>& triangles, const Surface& surface, const Cones& given,
                   const CompletionRules& rules, const Progress& progress) {
  Solver solver(part_of(surface, triangles));
  Placement placed = place(solver, given, rules, progress);
  placed.warnings = renumbered(std::move(placed.warnings), triangles);
  return placed;
}

// Cones where none are given.
CompletedCones placed_freely(Solver& solver, const CompletionOptions& completion, const MapOptions& options,
                             const Progress& progress) {
  const std::vector<char>& without = completion.without;
  if (std::count(without.begin(), without.end(), 0) == ssize(without)) {
    return completed({}, completion, options, place(solver, {}, {completion, options}, progress));
  }
  std::vector<Index> triangles;
  for (std::size_t f = 0; f < without.size(); ++f) {
    if (!without[f]) triangles.push_back(static_cast<Index>(f));
  }
  if (triangles.empty()) return {{}, {}, completion.target, false};  // none are needed
  return completed({}, completion, options, place_on(triangles, solver.surface(), {}, {completion, options}, progress));
}

// Cones on some components alone; none where the library finds none.
std::optional<Placement> try_to_place_on(const std::vector<LedgerPart>& components, const Surface& surface,
                                         const Cones& given, const CompletionRules& rules,
                                         const Progress& progress) try {
  std::vector<Index> triangles, present;
  for (const LedgerPart& component : components) {
    triangles.insert(triangles.end(), component.triangles.begin(), component.triangles.end());
    present.insert(present.end(), component.cones.begin(), component.cones.end());
  }
  std::sort(triangles.begin(), triangles.end());
  sort_unique(present);
  Cones own;
  for (const Index i : present) {
    own.vertices.push_back(element(given.vertices, i));
    own.angles.push_back(element(given.angles, i));
  }
  CompletionOptions usual = rules.completion;
  usual.symmetric = false;
  return place_on(triangles, surface, own, {usual, rules.options}, progress);
} catch (const Error& error) {
  if (error.code() == Code::cancelled) throw;
  return {};
} catch (const std::bad_alloc&) {
  return {};
}

// A finding of placement, which leaves components out that have a map without cones. The map names what it lacks of
// these itself.
Finding true_of_map(Finding finding, const Result& result) {
  const auto is_left_out = [&](Index f) { return element(result.island, f) < 0; };
  const std::vector<Index>& triangles = finding.elements.indices;
  if (finding.code != Code::component_skipped || std::all_of(triangles.begin(), triangles.end(), is_left_out)) {
    return finding;
  }
  const std::size_t reason = finding.message.find(": ");
  finding.code = Code::placement_not_reached;
  finding.message = "A component was unwrapped without placed cones: " +
                    (reason == std::string::npos ? std::string() : finding.message.substr(reason + 2));
  return finding;
}

}  // namespace

Options MapOptions::through(const Cones& cones) const {
  const bool has_angle = std::any_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle; });
  Options out = of_map;
  out.prescription = prescription.value_or(has_angle ? PrescriptionRule::manual : PrescriptionRule::least_distortion);
  return out;
}

CompletedCones complete_cones(Solver& solver, const Cones& given, const CompletionOptions& completion,
                              const MapOptions& options, const Progress& progress) {
  if (given.vertices.empty()) return placed_freely(solver, completion, options, progress);
  std::vector<LedgerPart> lacking = build_ledger(solver.surface(), given, options.through(given), LedgerOf::placement);
  const auto remove_if = [&](auto is_complete) {
    lacking.erase(std::remove_if(lacking.begin(), lacking.end(), is_complete), lacking.end());
  };
  const auto gets_none = [&](Index f) { return !completion.without.empty() && element(completion.without, f); };
  remove_if([&](const LedgerPart& component) {
    const std::vector<Index>& triangles = component.triangles;
    return (!component.cones.empty() && closes(component)) ||
           std::all_of(triangles.begin(), triangles.end(), gets_none);
  });
  // Given cones that no map can have leave other components without: mapping reports the defect of those.
  for (const bool with_cones : {true, false}) {
    if (!with_cones) remove_if([](const LedgerPart& component) { return !component.cones.empty(); });
    if (lacking.empty()) break;
    std::optional<Placement> placed =
        try_to_place_on(lacking, solver.surface(), given, {completion, options}, progress);
    if (placed) return completed(given, completion, options, std::move(*placed));
  }
  CompletedCones out;
  out.cones = given;
  out.target = completion.target;
  return out;
}

std::optional<CompletedCones> complete_feature_cones(Solver& solver, const MapOptions& options, double target,
                                                     const Progress& progress) {
  constexpr double of_features = 0.5;  // of the time
  if (!aligns_features(solver.surface(), options)) return {};
  try {
    const bool has_creases = options.of_map.straighten && options.of_map.seamless;
    const Cones chosen = feature_cones(solver.surface(), has_creases, share_of(progress, 0, of_features));
    if (chosen.vertices.empty()) return {};
    CompletionOptions completion;
    completion.target = target;
    return complete_cones(solver, chosen, completion, options, share_of(progress, of_features, 1));
  } catch (const Error& error) {
    if (error.code() == Code::cancelled) throw;
    return {};
  } catch (const std::bad_alloc&) {
    return {};
  }
}

std::vector<Finding> findings_of(const CompletedCones& cones, const Result& result, const Options& options) {
  std::vector<Finding> of_map;
  for (const Finding& finding : result.warnings) {
    // Cuts are mirrored where that is possible; nobody has to be told where it is not.
    if (finding.code != Code::cuts_not_mirrored) of_map.push_back(finding);
  }
  if (!cones.placement) return of_map;
  const bool is_reached =
      cones.target && result.distortion.l2_stretch <= reached_up_to(*cones.target, result, options.mode);
  std::vector<Finding> of_placement;
  for (const Finding& finding : cones.placement->warnings) {
    // Which triangles are turned depends on where the surface ends, and cones may have been placed where it ended
    // elsewhere.
    if (finding.code == Code::reoriented) continue;
    Finding told = true_of_map(finding, result);
    if (!(is_reached && told.code == Code::placement_not_reached)) of_placement.push_back(std::move(told));
  }
  return merged(std::move(of_placement), of_map);
}

}  // namespace lsgp

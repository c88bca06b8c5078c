// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/component_placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/conditions.hpp"
#include "base/text.hpp"
#include "cut/cut_graph.hpp"
#include "placement/verified_placement.hpp"
#include "prescription/component_system.hpp"

namespace lsgp {

namespace {

constexpr double cheap_share = 0.5;  // of the largest gain, required of a site that cuts reach more cheaply

// Of which cones are chosen, at most: as many as a target takes are stretched no less with more sites.
int most_sites(const PlacementTask& task, const PlacementOptions& options) {
  const int required = 4 * std::abs(task.mesh.euler);  // quarter turns by Gauss-Bonnet
  return options.count || required > most_one_by_one ? sites_of_many : usual_sites;
}

// Refuses too few cones if cuts cannot reach further sites.
void require_reachable(const ConeChooser& chooser, const ConeChoice& choice) {
  if (choice.is_possible() || chooser.reaches_all()) return;
  const Index places = chooser.place_count();
  if (ssize(choice.vertices) < places) return;
  throw Error(Code::cuts_blocked,
              concat("The edges a cut may follow lead to ", count(places, "place", "places"),
                     " for cones, too few for the curvature of this surface. Allow more edges to be cut."));
}

void require_room(const ConeChoice& choice) {
  if (choice.is_possible()) return;
  throw Error(Code::too_few_cones,
              concat(count(choice.vertices.size(), "cone is", "cones are"),
                     " too few for the curvature of this surface. Place more, or as many as it takes."),
              {ElementKind::vertices, choice.vertices});
}

// The defects of a map, as text.
std::string told(const TriedMap& map) {
  if (map.failed) return "there is no map";
  const auto angles = count(map.wrong_angles, "vertex", "vertices"), seams = count(map.inexact_seams, "edge", "edges");
  if (map.inexact_seams == 0) return concat("angles are off at ", angles);
  if (map.wrong_angles == 0) return concat("the two sides do not match at ", seams, " of cuts");
  return concat("angles are off at ", angles, " and the two sides do not match at ", seams, " of cuts");
}

// What to do where cones are too few: with a corner at every tooth of a comb there are more corners than cones can be.
std::string remedy_for(const PlacementTask& task) {
  constexpr double sharp = M_PI / 4;  // where an eighth of a turn is rounded to a quarter of it, and not to none
  const HalfedgeMesh& mesh = task.mesh;
  Index corners = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] == none && std::abs(task.geometry.angle_defect[v]) > sharp) ++corners;
  }
  if (corners <= most_one_by_one) {
    return "Place more, mark cones at tips and branches, or cut the component into simpler ones along seams.";
  }
  return concat("It is curved by more than 45 degrees at ", corners,
                " vertices, and cones at all of them are too many. Smooth it, or cut it into components with fewer "
                "corners along seams.");
}

// Marked cones are kept, and the map reports its defects; other cones with defects are refused.
void require_right(const VerifiedChoice& choice, const PlacementTask& task) {
  const TriedMap& map = choice.map;
  if (!map.is_off() || !map.is_repaired || !task.existing.vertices.empty()) return;
  const std::size_t placed = choice.cones.vertices.size();
  throw Error(Code::solver_failed,
              concat("No cones were found with correct angles and seams on this component: with ",
                     count(placed, "cone", "cones"), ", ", told(map), ". ", remedy_for(task)),
              {ElementKind::vertices, choice.cones.vertices});
}

// Repairing the map of a large rough surface takes a minute, and fails.
void require_hope(const VerifiedPlacement& placement, const VerifiedChoice& choice, const PlacementTask& task) {
  if (!task.existing.vertices.empty() || !placement.is_hopeless(choice)) return;
  throw Error(
      Code::solver_failed,
      concat("This component is too rough to be flattened: with ", count(choice.cones.vertices.size(), "cone", "cones"),
             " an L2 stretch of ", rounded(choice.cones.predicted_l2), " is predicted, and ", choice.map.defects(),
             " of ", count(task.mesh.triangle_count(), "triangle", "triangles"),
             " are flipped or have wrong angles. Smooth it, unwrap a version without the details, or cut it "
             "into smaller components along seams."),
      {ElementKind::vertices, choice.cones.vertices});
}

// If the map with the requested number of cones is unusable: says how many cones are placed without a given number, and
// how good their map is. Empty if that map is unusable, too.
std::string told_of_automatic(const PlacementTask& task, PlacementOptions options, ProgressMonitor& monitor,
                              int& maps) {
  options.count.reset();
  options.most.reset();
  const ProgressMonitor::Interval interval(monitor, 1, 1);
  ConeChooser chooser(task, options, most_sites(task, options), monitor);
  VerifiedPlacement placement(chooser, monitor);
  const VerifiedChoice choice = placement.place();
  maps += placement.maps();
  if (!choice.cones.is_possible() || !(choice.map.l2 < high_l2)) return "";
  const std::size_t placed = choice.cones.vertices.size();
  return concat(" Left automatic, ", count(placed, "cone is", "cones are"),
                " placed, and the map has an L2 stretch of ", rounded(choice.map.l2), ".");
}

// A requested number of cones with which the map is unusable.
std::optional<Finding> unusable_map(const PlacementTask& task, const PlacementOptions& options,
                                    const VerifiedChoice& choice, ProgressMonitor& monitor, int& maps) {
  if (!options.count || choice.map.l2 < high_l2) return std::nullopt;
  const std::string map = choice.map.is_valid() ? concat("has an L2 stretch of ", rounded(choice.map.l2))
                                                : "has flipped triangles or wrong angles";
  const std::string automatic = told_of_automatic(task, options, monitor, maps);
  const char* otherwise = " Mark cones at thin tips, clean up spikes and thin triangles, or place more.";
  return Finding{Code::placement_not_reached,
                 concat("With ", count(choice.cones.vertices.size(), "cone", "cones"), " the map ", map, ".",
                        automatic.empty() ? otherwise : automatic),
                 {ElementKind::vertices, choice.cones.vertices}};
}

std::optional<MissingCones> missing_cones(const ConeChooser& chooser, const ConeChoice& choice) {
  const int asked = chooser.options().count.value_or(0), placed = static_cast<int>(choice.vertices.size());
  if (placed >= asked) return std::nullopt;
  const auto why = choice.left_flat > 0             ? MissingCones::Why::left_flat
                   : chooser.place_count() > placed ? MissingCones::Why::only_pairs
                                                    : MissingCones::Why::no_room;
  return MissingCones{placed, why};
}

// Among the open sites that gain nearly the most, the one with the largest gain for its price.
Index best_place(const ConeChooser& chooser, const Eigen::VectorXd& gains, const Array<char>& open) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  double largest = -unlimited, most = -unlimited;
  for (Eigen::Index i = 0; i < gains.size(); ++i) {
    if (open[static_cast<std::size_t>(i)]) largest = std::max(largest, gains[i]);
  }
  const double least = largest - (1 - cheap_share) * std::max(largest, 0.0);
  const Eigen::VectorXd priced = gains - chooser.problem().price_among(chooser.existing_count() + 1);
  Index best = none;
  for (Eigen::Index i = 0; i < gains.size(); ++i) {
    const auto site = static_cast<std::size_t>(i);
    if (!open[site] || !(gains[i] >= least) || !(priced[i] > most)) continue;
    most = priced[i];
    best = chooser.sites()[site].vertex;
  }
  return best;
}

}  // namespace

PlacedCones place_component(const PlacementTask& task, const PlacementOptions& options, std::vector<Finding>& findings,
                            ProgressMonitor& monitor) {
  ConeChooser chooser(task, options, most_sites(task, options), monitor);
  if (!options.count) {
    require_few_conditions(chooser.required_count(), "The curvature of this component takes about", "cones");
  }
  const ProgressMonitor::Interval interval(monitor, 0.3, 1);
  VerifiedPlacement placement(chooser, monitor);
  const VerifiedChoice choice = placement.place();
  PlacedCones out;
  out.cones = chooser.with_given_angles(choice.cones.vertices);
  require_reachable(chooser, choice.cones);
  out.maps = placement.maps();
  if (chooser.are_too_many(ssize(choice.cones.vertices))) {
    out.cones = chooser.with_angles(choice.cones);
    out.curvature.log_scale = Eigen::VectorXd::Zero(task.mesh.vertex_count());
    out.curvature.predicted_l2 = choice.cones.predicted_l2;
    out.mapped_l2 = std::numeric_limits<double>::infinity();
    out.reached = false;
    out.are_too_many = true;
    findings.push_back({Code::placement_not_reached,
                        concat("This component takes more than the ", *options.most,
                               " cones that are wanted at most. Allow more of them or a higher stretch."),
                        {ElementKind::vertices, choice.cones.vertices}});
    return out;
  }
  // If a requested number of cones is refused, the message adds a number that works.
  const auto refuse_with_remedy = [&](auto require) {
    try {
      require();
    } catch (const Error& error) {
      if (!options.count || (error.code() != Code::too_few_cones && error.code() != Code::solver_failed)) throw;
      throw Error(error.code(), error.what() + told_of_automatic(task, options, monitor, out.maps), error.elements());
    }
  };
  refuse_with_remedy([&] {
    require_feasible(task.mesh, out.cones, chooser.border());
    require_room(choice.cones);
  });
  out.system = placement.take_system(choice.cones);
  ComponentSystem* const of_map = out.system.get();
  const LogScale& scale = chooser.scale().is_factored() || !of_map ? chooser.scale() : of_map->log_scale();
  const Eigen::VectorXd log_scale = scale.evaluate_held(choice.cones.vertices, choice.cones.curvature);
  if (!choice.map.is_valid()) require_possible(task, out.cones, log_scale);
  if (!options.count) require_hope(placement, choice, task);
  out.missing = missing_cones(chooser, choice.cones);
  out.cones = chooser.with_angles(choice.cones);
  ComponentCones imposed = out.cones;
  if (!choice.map.failed) imposed.holes = choice.map.holes;  // left open where closing them would stretch the map
  out.curvature = impose(scale, imposed, choice.cones.curvature, log_scale, findings);
  // A map that was made has cuts to all cones.
  if (choice.map.failed) {
    connect_cones(task, inside_only(task.mesh, choice.cones.vertices), out.curvature.needs_no_cut);
  }
  refuse_with_remedy([&] { require_right(choice, task); });
  out.mapped_l2 = choice.map.l2;
  if (auto finding = unusable_map(task, options, choice, monitor, out.maps)) findings.push_back(std::move(*finding));
  out.reached = out.mapped_l2 <= options.target;
  return out;
}

ComponentGains component_gains(const PlacementTask& task, ProgressMonitor& monitor) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  constexpr int all_sites = std::numeric_limits<int>::max();
  const PlacementOptions options;
  ConeChooser chooser(task, options, all_sites, monitor);
  chooser.weigh_prices(price_weights[0]);
  const ConeSet set = chooser.existing(usual_reach);
  ComponentGains out;
  out.present_l2 = chooser.predicted_l2(set);
  out.predicted_l2 = Eigen::VectorXd::Constant(task.mesh.vertex_count(), std::numeric_limits<double>::quiet_NaN());
  const Eigen::VectorXd gains = set.gains();
  const Array<char> open = chooser.search().open_sites(set.sites());
  for (std::size_t s = 0; s < chooser.sites().size(); ++s) {
    const auto i = static_cast<Eigen::Index>(s);
    if (!open[s]) continue;
    const Index vertex = chooser.sites()[s].vertex;
    // The L2 stretch is e^{2 J} to leading order.
    const double with_cone = out.present_l2 == unlimited ? std::exp(2 * (set.variance() - gains[i]))
                                                         : out.present_l2 * std::exp(-2 * gains[i]);
    out.predicted_l2[vertex] = std::clamp(with_cone, 1.0, largest_l2);
  }
  out.best = best_place(chooser, gains, open);
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/verified_placement.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/lower_quartile.hpp"
#include "cut/cut_graph.hpp"
#include "lsgp/auto_unwrap.hpp"

namespace lsgp {

namespace {

constexpr Index small = 2000;         // triangles: all repairs of such a surface cost little
constexpr int most_hard_repairs = 2;  // of a larger one
constexpr Index very_large = 20000;   // triangles: too many for repairs without hope of low stretch
constexpr int fewer_defects = 2;      // factor, compared with a map whose repair left high stretch
constexpr double unreachable_l2 = 2;  // as predicted: lower targets are out of reach
constexpr int tangled_share = 4;      // one triangle of so many with a defect: only the final choice is repaired
constexpr double as_predicted = 1.03;
constexpr double same_angles = 1e-9;  // of all of them
// Lower targets, and by how much of the stretch above 1.
constexpr int most_maps = 8, most_lowerings = 12;
constexpr int most_shrinkings = 3;
constexpr double least_lowered = 0.4, most_lowered = 0.9, lowered_when_invalid = 0.6;
// Additions, of one cone for so many, and what one may leave of the stretch above 1 to come before lower targets.
constexpr int most_additions = 3, least_added = 2, added_share = 6;
constexpr double worthwhile = 0.7;
// Moves of cones that are tried, the triangles of all their maps, and what one may leave of the stretch above 1.
constexpr int most_moves = 400;
constexpr Index triangles_moved = 150000;
constexpr double worth_moving = 0.99;
// More cones than the stages have, if nothing else helps: so many times as many each time, as long as each time leaves
// no more than this of the stretch above 1.
constexpr double more_cones = 1.25, still_worthwhile = 0.9;
constexpr int most_enlargements = 6;
constexpr double justified_l2 = 1.01;  // of a map that justifies a cone at every rounded corner
constexpr double usual_l2 = 1.05;      // of a map that does not justify more cones than any surface may have
constexpr double far_from_target = 2;  // of the stretch above 1: other stages are tried where angles are rounded

// Whether the first choice is nearer to a usable map.
bool is_better(const TriedMap& a, const TriedMap& b) {
  const auto rank = [](const TriedMap& map) { return map.failed ? 3 : map.is_off() ? 2 : map.is_valid() ? 0 : 1; };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a.is_valid() ? a.l2 < b.l2 : a.defects() < b.defects();
}

bool is_as_predicted(const VerifiedChoice& choice) { return choice.map.l2 <= as_predicted * choice.cones.predicted_l2; }

}  // namespace

VerifiedPlacement::VerifiedPlacement(ConeChooser& chooser, ProgressMonitor& monitor)
    : chooser_(chooser), monitor_(monitor), trial_(chooser.task(), monitor) {}

VerifiedChoice VerifiedPlacement::place() {
  VerifiedChoice out = place_as_asked();
  if (has_many() || chooser_.are_too_many(ssize(out.cones.vertices))) return out;
  if (misses(out) && chooser_.has_prices()) {
    chooser_.forget_prices();
    VerifiedChoice anywhere = place_as_asked();
    if (is_better(anywhere.map, out.map)) out = std::move(anywhere);
  }
  if (misses(out) || out.cones.predicted_l2 > unreachable_l2) choose_other_angles(out);
  if (out.map.l2 > unreachable_l2 && is_worth_trying(out.cones)) {
    const auto present = static_cast<int>(out.cones.vertices.size());
    VerifiedChoice weaker = verified(chooser_.choose_within(usual_reach, present));
    choose_other_angles(weaker);
    if (is_better(weaker.map, out.map)) out = std::move(weaker);
  }
  const bool is_automatic = !chooser_.options().count;
  if (is_automatic && is_small() && out.cones.predicted_l2 <= unreachable_l2) move_cones(MovedAngles::bounded, out);
  // Unwrapping would repair it anyway.
  const bool is_left =
      chooser_.options().hard_repairs && !out.map.is_valid() && !out.map.is_repaired && out.cones.is_possible();
  if (is_left && chooser_.task().mesh.triangle_count() <= very_large) repair(out);
  if (is_automatic && chooser_.options().hard_repairs) take_other_stage(out);
  return out;
}

VerifiedChoice VerifiedPlacement::place_as_asked() {
  const std::optional<int> count = chooser_.options().count;
  if (has_many()) {
    std::optional<AutomaticCones> none_automatic;
    return verified(choose_where_cheap(none_automatic));
  }
  return count ? place_count(*count) : place_to_target();
}

bool VerifiedPlacement::misses(const VerifiedChoice& choice) const {
  return chooser_.options().count ? !is_as_predicted(choice) : choice.map.l2 > chooser_.options().target;
}

VerifiedChoice VerifiedPlacement::verified(ConeChoice cones) {
  VerifiedChoice out{std::move(cones), {}};
  if (!out.cones.is_possible()) return out;
  out.map = trial_.make(chooser_.with_angles(out.cones), MapTrial::Repairs::easy);
  if (!out.map.is_valid() && is_worth_repairing(out)) repair(out);
  return out;
}

// Repairs take long; a map with about as many defects as one that they left with high stretch will not be better, and
// one that is tangled all over, as on rough surfaces, gets high stretch at best.
bool VerifiedPlacement::is_worth_repairing(const VerifiedChoice& choice) const {
  if (!chooser_.options().hard_repairs || !is_worth_trying(choice.cones)) return false;
  if (is_small()) return true;
  if (is_tangled(choice.map)) return false;
  const bool promises_more =
      hopeless_defects_ == 0 || choice.map.failed || fewer_defects * choice.map.defects() < hopeless_defects_;
  return hard_repairs_ < most_hard_repairs && promises_more;
}

// As far as the map can be, with other angles if only these have a valid one.
void VerifiedPlacement::repair(VerifiedChoice& choice) {
  ++hard_repairs_;
  TriedMap repaired = trial_.make(chooser_.with_angles(choice.cones), MapTrial::Repairs::all);
  if (repaired.is_valid() && repaired.l2 > unreachable_l2) hopeless_defects_ = choice.map.defects();
  if (!repaired.is_valid() || repaired.curvature.isApprox(choice.cones.curvature, same_angles)) {
    choice.map = std::move(repaired);
  } else {
    choice.map.is_repaired = true;
    if (chooses_angles()) take_angles(repaired, MapTrial::Repairs::all, choice);
  }
}

// The angles of another map with the same cones, if they give a better map.
void VerifiedPlacement::take_angles(const TriedMap& other, MapTrial::Repairs repairs, VerifiedChoice& choice) {
  if (!is_better(other, choice.map)) return;
  ConeChoice cones = chooser_.choice_with(choice.cones.vertices, other.curvature);
  TriedMap map = trial_.make(chooser_.with_angles(cones), repairs);
  if (is_better(map, choice.map)) choice = {std::move(cones), std::move(map)};
}

// These cones, if there are any and the stretch of their map is at most this.
std::optional<VerifiedChoice> VerifiedPlacement::verified_within(double most_l2, std::optional<ConeChoice> cones) {
  if (!cones) return std::nullopt;
  VerifiedChoice out = verified(std::move(*cones));
  if (!(out.map.l2 <= most_l2)) return std::nullopt;
  return out;
}

std::optional<VerifiedChoice> VerifiedPlacement::placed_naturally(Corners corners) {
  return verified_within(isometric_l2, natural_cones(chooser_, corners));
}

// Rounded corners give nearly isometric maps, with few cones more than the target takes.
std::optional<VerifiedChoice> VerifiedPlacement::placed_at_corners() {
  if (std::optional<VerifiedChoice> natural = placed_naturally(Corners::sharp)) return natural;
  return verified_within(std::min(justified_l2, chooser_.options().target), rounded_corner_cones(chooser_));
}

VerifiedChoice VerifiedPlacement::place_to_target() {
  const double target = chooser_.options().target;
  std::optional<AutomaticCones> automatic;
  VerifiedChoice best{choose_where_cheap(automatic), {}};
  if (chooser_.are_too_many(ssize(best.cones.vertices))) return best;
  // No additional cone is best if that suffices; corners are next.
  const bool adds_none = static_cast<int>(best.cones.vertices.size()) <= chooser_.existing_count();
  if (adds_none) best = verified(std::move(best.cones));
  if (best.map.l2 <= target) return best;
  if (std::optional<VerifiedChoice> natural = placed_at_corners()) return std::move(*natural);
  if (!adds_none) best = verified(std::move(best.cones));
  if (!is_as_predicted(best)) add_where_stretched(best, worthwhile);
  lower_target(*automatic, best);
  add_where_stretched(best, 1);
  if (best.map.l2 <= target) return best;
  if (std::optional<VerifiedChoice> natural = placed_naturally(Corners::any)) return std::move(*natural);
  take_many(best);
  if (best.map.l2 <= target) return best;
  if (std::optional<VerifiedChoice> natural = placed_naturally(Corners::all)) return std::move(*natural);
  if (!best.map.is_valid() && !chooser_.options().lattice) {
    // Far from the target harmonic angles are better than those of the variance, which underrates large scales.
    VerifiedChoice harmonic = verified(chooser_.choose_harmonically(most_on_any));
    if (is_better(harmonic.map, best.map)) best = std::move(harmonic);
  }
  return best;
}

// Beyond the stages, where the map misses the target with all of them.
void VerifiedPlacement::take_many(VerifiedChoice& best) {
  if (chooser_.options().lattice || !best.cones.is_possible()) return;
  const int most = chooser_.task().mesh.vertex_count() / least_vertices_a_cone;
  const int present = static_cast<int>(best.cones.vertices.size());
  if (present > 2 * *std::rbegin(cone_stages)) return;
  double count = std::max(present, most_on_any);
  double predicted = best.cones.predicted_l2;
  for (int i = 0; i < most_enlargements && count * more_cones <= most; ++i) {
    count *= more_cones;
    VerifiedChoice found = verified(chooser_.choose(static_cast<int>(count)));
    const bool is_gain = is_better(found.map, best.map);
    const auto lowers = [](double before, double after) { return after - 1 < still_worthwhile * (before - 1); };
    // If the map has defects, only the prediction tells whether more cones help.
    const bool goes_on = best.map.is_valid() ? is_gain && lowers(best.map.l2, found.map.l2)
                                             : is_gain || lowers(predicted, found.cones.predicted_l2);
    predicted = found.cones.predicted_l2;
    if (is_gain) best = std::move(found);
    if (best.map.l2 <= chooser_.options().target || !goes_on) return;
    monitor_.tick();
  }
}

// The requested number of cones, or as many as the target takes.  automatic: receives the growth that led to these.
ConeChoice VerifiedPlacement::choose(std::optional<AutomaticCones>& automatic) {
  if (chooser_.options().count || has_many()) return chooser_.choose(chooser_.options().count.value_or(0));
  automatic.emplace(chooser_);
  return automatic->reach(chooser_.options().target);
}

// Among cones within the target that are placed with prices of several weights, those that cost least.
ConeChoice VerifiedPlacement::choose_where_cheap(std::optional<AutomaticCones>& automatic) {
  ConeChoice best = choose(automatic);
  if (!chooser_.has_prices() || !best.is_possible()) return best;
  const double most_l2 = std::max(chooser_.options().target, best.predicted_l2);
  double least = cost(best), weight_of_best = 0;
  for (const double weight : price_weights) {
    chooser_.weigh_prices(weight);
    std::optional<AutomaticCones> growth;
    ConeChoice cheap = choose(growth);
    if (cheap.predicted_l2 > most_l2) continue;
    const double own = cost(cheap);
    if (own >= least) continue;
    least = own;
    weight_of_best = weight;
    best = std::move(cheap);
    if (growth) automatic.emplace(std::move(*growth));
  }
  chooser_.weigh_prices(weight_of_best);
  return best;
}

// Of the cuts that join cones by what they cost, in square roots of the area, and of the cones as cuts.
double VerifiedPlacement::cost(const ConeChoice& choice) const {
  const double cone_as_cut = Weights().cones / Weights().cuts;
  const PlacementTask& task = chooser_.task();
  const PerLoop<char> none_uncut(task.mesh.boundary_loops.size(), 0);
  const CutGraph cuts = connect_cones(task, inside_only(task.mesh, choice.vertices), none_uncut);
  const double usual = std::max(1.0, lower_quartile(task.mesh.cut_factor));
  return cost_of(task, cuts) / (usual * std::sqrt(task.geometry.total_area)) +
         cone_as_cut * static_cast<double>(choice.vertices.size());
}

// Adds cones where the map itself is stretched, as long as each addition reduces the stretch to this share.
void VerifiedPlacement::add_where_stretched(VerifiedChoice& best, double share) {
  for (int i = 0; i < most_additions && is_short(best) && best.map.is_valid(); ++i) {
    // Preferably at corners of the surface rather than beside them.
    const Eigen::VectorXd wanted = best.map.stretch.cwiseProduct(chooser_.task().geometry.angle_defect.cwiseAbs());
    const auto present = static_cast<int>(best.cones.vertices.size());
    const int more = std::max(least_added, present / added_share);
    if (present > most_one_by_one) return;
    if (present + more > most_on_any && best.map.l2 <= usual_l2) return;
    VerifiedChoice found = verified(chooser_.choose_more(best.cones, wanted, more));
    const bool is_enough = found.map.l2 <= chooser_.options().target;
    if (!is_enough && !(found.map.l2 - 1 < share * (best.map.l2 - 1))) return;
    best = std::move(found);
    monitor_.tick();
  }
}

void VerifiedPlacement::lower_target(AutomaticCones& automatic, VerifiedChoice& best) {
  const double target = chooser_.options().target;
  VerifiedChoice latest = best;
  double lower = target, missed_at = target;
  int misses = 1;  // the target is lowered further each time
  for (int i = 0; i < most_lowerings && trial_.made() < most_maps && is_short(best); ++i) {
    if (automatic.is_exhausted(lower)) break;
    const double missed = std::min((target - 1) / (latest.map.l2 - 1), most_lowered);
    const double share = std::max(std::pow(missed, misses), least_lowered);
    missed_at = lower;
    lower = 1 + (lower - 1) * (latest.map.is_valid() ? share : lowered_when_invalid);
    ConeChoice next = automatic.reach(lower);
    if (next.vertices == latest.cones.vertices) continue;
    latest = verified(std::move(next));
    ++misses;
    if (is_better(latest.map, best.map)) best = latest;
    monitor_.tick();
  }
  if (misses > 1 && latest.map.l2 <= target) take_fewer(automatic, missed_at, lower, best);
}

// The target was lowered in large steps: from `missed`, with which the map misses it, to `reached`.
void VerifiedPlacement::take_fewer(const AutomaticCones& automatic, double missed, double reached,
                                   VerifiedChoice& best) {
  for (int i = 0; i < most_shrinkings; ++i) {
    const double between = 1 + std::sqrt((missed - 1) * (reached - 1));
    ConeChoice fewer = automatic.shrink_to(between);
    if (fewer.vertices.size() >= best.cones.vertices.size()) return;
    VerifiedChoice found = verified(std::move(fewer));
    const bool is_enough = found.map.l2 <= chooser_.options().target;
    (is_enough ? reached : missed) = between;
    if (is_enough) best = std::move(found);
    monitor_.tick();
  }
}

// Fewer cones are predicted to stretch more, but if angles or seams are off with many, they may be right with few. So
// may others be where angles are rounded, since what is predicted is far from the map of a coarse surface then.
void VerifiedPlacement::take_other_stage(VerifiedChoice& best) {
  const bool is_far = best.map.l2 - 1 > far_from_target * (chooser_.options().target - 1);
  const bool tries_all = is_small() && chooser_.options().lattice && is_far;
  const auto present = static_cast<int>(best.cones.vertices.size());
  for (auto stage = std::rbegin(cone_stages); stage != std::rend(cone_stages); ++stage) {
    if (tries_all ? *stage > most_on_any : !best.map.is_off() || *stage > present) continue;
    VerifiedChoice found = verified(chooser_.choose(*stage));
    if (is_better(found.map, best.map)) best = std::move(found);
    monitor_.tick();
  }
}

bool VerifiedPlacement::is_small() const { return chooser_.task().mesh.triangle_count() <= small; }

bool VerifiedPlacement::is_tangled(const TriedMap& map) const {
  return tangled_share * map.defects() > chooser_.task().mesh.triangle_count();
}

bool VerifiedPlacement::is_hopeless(const VerifiedChoice& choice) const {
  const TriedMap& map = choice.map;
  return !map.is_valid() && !map.is_repaired && is_tangled(map) && choice.cones.predicted_l2 > unreachable_l2;
}

bool VerifiedPlacement::has_many() const {
  return std::max(chooser_.options().count.value_or(0), chooser_.existing_count()) > most_one_by_one;
}

bool VerifiedPlacement::is_short(const VerifiedChoice& choice) const {
  return choice.map.l2 > chooser_.options().target && choice.cones.predicted_l2 <= unreachable_l2;
}

VerifiedChoice VerifiedPlacement::place_count(int count) {
  if (std::optional<VerifiedChoice> natural = placed_at_corners()) return std::move(*natural);
  std::optional<AutomaticCones> none_automatic;
  VerifiedChoice best = verified(choose_where_cheap(none_automatic));
  const auto is_settled = [&] {
    const bool adds_none = static_cast<int>(best.cones.vertices.size()) <= chooser_.existing_count();
    return is_as_predicted(best) || adds_none || !best.cones.is_possible();
  };
  constexpr std::size_t other_reaches = 3;  // the first ones
  const std::size_t placed = best.cones.vertices.size();
  for (std::size_t i = 0; i <= other_reaches && !is_settled(); ++i) {
    const bool harmonic = i == other_reaches;
    if (harmonic && chooser_.options().lattice) break;
    ConeChoice other = harmonic ? chooser_.choose_harmonically(count) : chooser_.choose_within(reaches[i], count);
    if (!other.is_possible() || other.vertices.size() != placed || other.vertices == best.cones.vertices) continue;
    VerifiedChoice found = verified(std::move(other));
    if (is_better(found.map, best.map)) best = std::move(found);
    monitor_.tick();
  }
  if (!is_settled()) move_cones(MovedAngles::bounded, best);
  if (!is_settled() && is_small()) move_cones(MovedAngles::least_distortion, best);
  return best;
}

// Moves one cone after another to a neighbor or to where the map is stretched most, as long as that improves it, until
// it is as predicted. What is predicted with angles beyond the bounds is no promise: that before the moves is.
void VerifiedPlacement::move_cones(MovedAngles angles, VerifiedChoice& best) {
  if (!chooses_angles() || !best.map.is_valid()) return;
  const double promised = as_predicted * best.cones.predicted_l2;
  int left = std::min(most_moves, triangles_moved / chooser_.task().mesh.triangle_count());
  const auto kept = static_cast<std::size_t>(chooser_.existing_count()), count = best.cones.vertices.size();
  for (bool is_moved = true; is_moved && left > 0;) {
    is_moved = false;
    for (std::size_t cone = kept; cone < count; ++cone) {
      if (angles == MovedAngles::bounded ? is_as_predicted(best) : best.map.l2 <= promised) return;
      is_moved |= move_cone(best, cone, angles, left);
    }
  }
}

bool VerifiedPlacement::move_cone(VerifiedChoice& best, std::size_t cone, MovedAngles angles, int& left) {
  const auto improves = [&](const TriedMap& map) { return map.l2 - 1 < worth_moving * (best.map.l2 - 1); };
  const Index from = best.cones.vertices[cone];
  for (const Index to : places_near(best, from)) {
    if (left == 0) return false;
    std::optional<ConeChoice> moved = chooser_.choose_moved(best.cones, from, to);
    if (!moved || !moved->is_possible()) continue;
    --left;
    monitor_.tick();
    VerifiedChoice found{std::move(*moved), {}};
    found.map = trial_.make(chooser_.with_angles(found.cones), MapTrial::Repairs::easy);
    if (angles == MovedAngles::least_distortion && !improves(found.map)) {
      take_least_distortion(MapTrial::Repairs::easy, found);
    }
    if (!improves(found.map)) continue;
    best = std::move(found);
    return true;
  }
  return false;
}

// Where the map is stretched most, at corners of the surface and anywhere, and the neighbors of a cone.
Array<Index> VerifiedPlacement::places_near(const VerifiedChoice& choice, Index cone) const {
  const HalfedgeMesh& mesh = chooser_.task().mesh;
  Array<Index> out(2);
  choice.map.stretch.cwiseProduct(chooser_.task().geometry.angle_defect.cwiseAbs()).maxCoeff(&out[0]);
  choice.map.stretch.maxCoeff(&out[1]);
  mesh.for_each_outgoing(cone, [&](Index h) { out.push_back(mesh.target(h)); });
  return out;
}

void VerifiedPlacement::take_least_distortion(MapTrial::Repairs repairs, VerifiedChoice& choice) {
  take_angles(trial_.make(chooser_.with_given_angles(choice.cones.vertices), repairs), repairs, choice);
}

// Angles without bounds, independent of the variance: those of least distortion. If angles or seams are off, all
// attempts of unwrapping with automatic angles.
void VerifiedPlacement::choose_other_angles(VerifiedChoice& best) {
  const std::size_t count = best.cones.vertices.size();
  if (!chooses_angles() || count == 0 || count > most_one_by_one) return;
  // A valid map takes no repairs.
  if (!best.map.is_valid() && !is_worth_trying(best.cones)) return;
  const bool is_hard = best.map.is_off() || is_small();
  const auto repairs = is_hard && chooser_.options().hard_repairs ? MapTrial::Repairs::all : MapTrial::Repairs::easy;
  take_least_distortion(repairs, best);
}

// Repairs of large surfaces with high stretch take long.
bool VerifiedPlacement::is_worth_trying(const ConeChoice& cones) const {
  if (!cones.is_possible()) return false;
  return is_small() || cones.predicted_l2 <= unreachable_l2;
}

// False with a lattice, a mirror plane, or given angles.
bool VerifiedPlacement::chooses_angles() const {
  const ComponentCones& existing = chooser_.task().existing;
  return !chooser_.options().lattice && chooser_.task().mirrored.empty() &&
         std::none_of(existing.angles.begin(), existing.angles.end(),
                      [](const auto& angle) { return angle.has_value(); });
}

}  // namespace lsgp

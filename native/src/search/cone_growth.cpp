// SPDX-License-Identifier: GPL-3.0-or-later
#include "search/cone_growth.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lsgp {

namespace {

constexpr double stage_growth = 1.25;  // beyond the stages
constexpr std::size_t usual_reaches = 2;
constexpr double poor_l2 = 1.15;  // L2 stretch above which stronger cones are tried

}  // namespace

ConeGrowth::ConeGrowth(ConeChooser& chooser, double reach)
    : chooser_(chooser), reach_(reach), set_(chooser.existing(reach)), best_(chooser.settled(set_)) {}

ConeChoice ConeGrowth::grow_to(double target) {
  while (best_.predicted_l2 > target && !chooser_.are_too_many(ssize(best_.vertices)) && advance(target)) {
  }
  // The latest choice is the best that reaches the target, since growth stops there.
  if (best_.predicted_l2 > target || chooser_.options().lattice || batches_) return best_;
  ConeSet fewer = set_;
  drop_unneeded(fewer, target, isometric_l2);
  return chooser_.settled(fewer);
}

ConeChoice ConeGrowth::shrink_to(double target) const {
  if (chooser_.options().lattice || batches_) return best_;
  ConeSet fewer = set_;
  drop_unneeded(fewer, target, 1);
  return chooser_.settled(fewer);
}

bool ConeGrowth::advance(double target) {
  if (!has_room_) return false;
  if (!batches_) {
    while (next_stage_ < std::size(cone_stages)) {
      const int stage = cone_stages[next_stage_++], before = set_.cone_count();
      if (stage <= before) continue;
      if (stage > most_automatic()) break;
      chooser_.search().grow(set_, stage);
      if (set_.cone_count() == before) break;  // no room
      chooser_.search().exchange(set_);
      keep_better(chooser_.settled(set_));
      return true;
    }
    has_room_ = set_.cone_count() < most_automatic();
    if (!has_room_) return false;
    batches_.emplace(chooser_.batches(reach_));
    batches_->add(set_.sites());
  }
  advance_in_batches(target);
  return true;
}

// The stages continue if Gauss-Bonnet requires more cones, as on surfaces with many handles.
void ConeGrowth::advance_in_batches(double target) {
  const int before = batches_->cone_count(), most = most_automatic();
  batches_->grow(std::min(most, static_cast<int>(stage_growth * before)));
  const bool has_grown = batches_->cone_count() > before;
  has_room_ = has_grown && batches_->cone_count() < most;
  if (!batches_->feasible()) return;
  if (chooser_.are_too_many(batches_->cone_count())) {
    best_ = chooser_.settled(*batches_);
    return;
  }
  if (has_grown) batches_->exchange(1);
  // Rounding the angles cannot lower the stretch.
  if (chooser_.options().lattice && has_room_ && chooser_.predicted_l2(*batches_) > target) return;
  keep_better(chooser_.settled(*batches_));
}

// More than the stages only if the curvature that Gauss-Bonnet requires has more quarter turns.
int ConeGrowth::most_automatic() const {
  const int room = chooser_.task().mesh.vertex_count() / least_vertices_a_cone;
  const bool refines_grid = chooser_.options().lattice.has_value();  // every cone, which is on a point of it
  const int most = refines_grid ? most_on_any : std::clamp(room, most_on_any, *std::rbegin(cone_stages));
  return std::max(most, static_cast<int>(std::ceil(chooser_.required_count())));
}

// Among impossible choices, the one with more cones is nearer to a map.
void ConeGrowth::keep_better(ConeChoice choice) {
  const bool both_impossible = !best_.is_possible() && !choice.is_possible();
  if (both_impossible ? choice.vertices.size() > best_.vertices.size() : choice.predicted_l2 < best_.predicted_l2) {
    best_ = std::move(choice);
  }
}

// worth_all: no cone is dropped at a stretch this low or lower.
void ConeGrowth::drop_unneeded(ConeSet& set, double target, double worth_all) const {
  const ConeSearch& search = chooser_.search();
  while (search.can_drop(set) && chooser_.predicted_l2(set) > worth_all) {
    ConeSet fewer = set;
    search.drop(fewer);
    if (chooser_.predicted_l2(fewer) > target) fewer = chooser_.exchanged(std::move(fewer));
    if (chooser_.predicted_l2(fewer) > target) return;
    set = std::move(fewer);
  }
}

bool AutomaticCones::is_exhausted(double target) const { return target <= missed_; }

ConeChoice AutomaticCones::shrink_to(double target) const { return growths_[latest_].shrink_to(target); }

ConeChoice AutomaticCones::reach(double target) {
  ConeChoice best;
  for (std::size_t i = 0; i < std::size(reaches); ++i) {
    if (i >= usual_reaches && best.predicted_l2 <= poor_l2) break;
    if (i == growths_.size()) growths_.emplace_back(chooser_, reaches[i]);
    ConeChoice choice = growths_[i].grow_to(target);
    if (i == 0 || choice.predicted_l2 < best.predicted_l2) {
      best = std::move(choice);
      latest_ = i;
    }
    if (best.predicted_l2 <= target || chooser_.are_too_many(ssize(best.vertices))) return best;
  }
  missed_ = std::max(missed_, target);
  return best;
}

}  // namespace lsgp

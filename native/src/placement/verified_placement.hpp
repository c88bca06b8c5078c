// SPDX-License-Identifier: GPL-3.0-or-later
// Automatic cones, verified on their maps.
#pragma once

#include <optional>

#include "placement/map_trial.hpp"
#include "placement/natural_cones.hpp"
#include "search/cone_chooser.hpp"
#include "search/cone_growth.hpp"

namespace lsgp {

// Cones and the map with them.
struct VerifiedChoice {
  ConeChoice cones;
  TriedMap map;
};

// The log scale predicts the stretch in the limit of fine meshes; maps of coarse ones have more stretch. So the map
// with the chosen cones is computed and measured.
//
// Without a number of cones the target applies to the map: if it is missed, corners of a polyhedron become cones, cones
// are added where the map is stretched, or chosen for a lower target, continuing the previous choice, with as few as
// suffice; if that misses, too, more cones than the stages have. If angles or seams of the map are off with all of
// these, fewer are taken. A given number of cones is kept, but other choices are
// tried if the map is worse than predicted, and then one cone after another is moved, on small surfaces also with
// angles of least distortion at the new places. If all of these miss, these angles are tried, and so they are where the
// prediction is hopeless.
//
// At most some ten maps are computed, most of them with local repairs only, and more to move cones, hundreds of small
// surfaces; one or two if the prediction is hopeless or there are more cones, existing or requested, than are chosen
// one by one. The map of the result is repaired as far as it can be, unless it is one of many cones or of a very large
// surface; others are not if a large share of their triangles have defects.
class VerifiedPlacement {
 public:
  VerifiedPlacement(ConeChooser& chooser, ProgressMonitor& monitor);

  VerifiedChoice place();
  // Whether repairs, which were not made, cannot help either: the surface is rough all over.
  bool is_hopeless(const VerifiedChoice& choice) const;
  int maps() const { return trial_.made(); }
  // The system of the latest map, if it is that of these cones; none otherwise, and none from then on.
  KeptSystem take_system(const ConeChoice& choice) { return trial_.take_system(chooser_.with_angles(choice)); }

 private:
  // Of cones that are moved: within the bounds of the sites, or, where these are no better, those of least distortion.
  enum class MovedAngles { bounded, least_distortion };

  VerifiedChoice place_to_target();
  VerifiedChoice place_count(int count);
  VerifiedChoice verified(ConeChoice cones);
  void repair(VerifiedChoice& choice);
  bool is_worth_repairing(const VerifiedChoice& choice) const;
  VerifiedChoice place_as_asked();
  ConeChoice choose(std::optional<AutomaticCones>& automatic);
  double cost(const ConeChoice& choice) const;
  ConeChoice choose_where_cheap(std::optional<AutomaticCones>& automatic);
  bool misses(const VerifiedChoice& choice) const;
  std::optional<VerifiedChoice> placed_naturally(Corners corners);
  std::optional<VerifiedChoice> placed_at_corners();
  std::optional<VerifiedChoice> verified_within(double most_l2, std::optional<ConeChoice> cones);
  void add_where_stretched(VerifiedChoice& best, double share);
  void move_cones(MovedAngles angles, VerifiedChoice& best);
  bool move_cone(VerifiedChoice& best, std::size_t cone, MovedAngles angles, int& left);
  Array<Index> places_near(const VerifiedChoice& choice, Index cone) const;
  void lower_target(AutomaticCones& automatic, VerifiedChoice& best);
  void take_fewer(const AutomaticCones& automatic, double missed, double reached, VerifiedChoice& best);
  void take_many(VerifiedChoice& best);
  void take_other_stage(VerifiedChoice& best);
  bool is_small() const;
  bool is_tangled(const TriedMap& map) const;  // defects all over
  bool has_many() const;                       // cones there or asked for
  bool is_worth_trying(const ConeChoice& cones) const;
  bool chooses_angles() const;
  bool is_short(const VerifiedChoice& choice) const;  // of the target, and not hopelessly
  void take_angles(const TriedMap& other, MapTrial::Repairs repairs, VerifiedChoice& choice);
  void take_least_distortion(MapTrial::Repairs repairs, VerifiedChoice& choice);
  void choose_other_angles(VerifiedChoice& best);

  ConeChooser& chooser_;
  ProgressMonitor& monitor_;
  MapTrial trial_;
  int hard_repairs_ = 0;
  Index hopeless_defects_ = 0;  // before them, of the latest map that became valid with high stretch
};

}  // namespace lsgp

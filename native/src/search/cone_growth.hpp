// SPDX-License-Identifier: GPL-3.0-or-later
// Grows a set of cones in stages until it reaches a target stretch, and continues for a lower one.
#pragma once

#include <optional>

#include "search/cone_chooser.hpp"

namespace lsgp {

// Growth with curvatures within `reach` of the angle defects, in units of pi.
class ConeGrowth {
 public:
  ConeGrowth(ConeChooser& chooser, double reach);

  // The fewest cones predicted to reach the target, or those that come nearest to it.
  ConeChoice grow_to(double target);

  // After that for a lower target: fewer cones, as long as they are predicted to reach this one.
  ConeChoice shrink_to(double target) const;

 private:
  bool advance(double target);  // to the next stage, if there is one
  void advance_in_batches(double target);
  int most_automatic() const;
  void keep_better(ConeChoice choice);
  void drop_unneeded(ConeSet& set, double target, double worth_all) const;

  ConeChooser& chooser_;
  double reach_;
  ConeSet set_;
  std::size_t next_stage_ = 0;
  std::optional<BatchPlacement> batches_;  // beyond the stages
  bool has_room_ = true;
  ConeChoice best_;  // of all stages so far
};

// Growth within the usual reach, and within wider ones if that misses the target.
class AutomaticCones {
 public:
  explicit AutomaticCones(ConeChooser& chooser) : chooser_(chooser) {}
  ConeChoice reach(double target);
  ConeChoice shrink_to(double target) const;  // the latest ones
  bool is_exhausted(double target) const;     // whether it was requested before and not reached

 private:
  ConeChooser& chooser_;
  Array<ConeGrowth> growths_;  // within the first reaches
  std::size_t latest_ = 0;     // the one that reached the target
  double missed_ = 1;          // the largest target that was not reached
};

}  // namespace lsgp

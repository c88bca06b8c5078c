// SPDX-License-Identifier: GPL-3.0-or-later
// Collects the missed targets of placement, to be reported once for the whole surface.
#pragma once

#include <vector>

#include "base/array.hpp"
#include "lsgp/placement.hpp"

namespace lsgp {

// Fewer cones than requested.
struct MissingCones {
  enum class Why { left_flat, only_pairs, no_room };
  int placed = 0;
  Why why = Why::no_room;
};

class Shortfalls {
 public:
  explicit Shortfalls(const PlacementOptions& options) : options_(options) {}

  // A component with fewer cones than requested, and its triangles.
  void add(const MissingCones& missing, const Array<Index>& triangles);

  // A component that misses the target, its cones and triangles, and the L2 stretch of its map, infinite if it is not
  // valid.
  void add(double l2, const Array<Index>& cones, const Array<Index>& triangles);

  // The triangles of a component that should get symmetric cones but is not symmetric.
  void add_asymmetric(const Array<Index>& triangles);

  // One NOT_SYMMETRIC for all of these, and PLACEMENT_NOT_REACHED: one for each reason why cones are missing, and one
  // for the target.
  void report(std::vector<Finding>& findings) const;

 private:
  struct Missing {
    int parts = 0, placed = 0;
    Array<Index> triangles;
  };
  static constexpr int reasons = 3;

  Finding told(MissingCones::Why why, const Missing& missing) const;
  Finding told_of_stretch() const;
  Finding told_of_asymmetry() const;

  const PlacementOptions& options_;
  Missing missing_[reasons];
  int asymmetric_components_ = 0;
  Array<Index> asymmetric_;  // their triangles
  int parts_ = 0;            // that miss the target
  double worst_l2_ = 1;
  std::size_t worst_cones_ = 0;
  bool all_have_cones_ = true;
  Array<Index> cones_, triangles_;
};

}  // namespace lsgp

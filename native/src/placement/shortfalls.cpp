// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/shortfalls.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.hpp"

namespace lsgp {

namespace {

const char* remedy_for(MissingCones::Why why) {
  switch (why) {
    case MissingCones::Why::left_flat:
      return "the others became flat when angles were rounded for the lattice. Ask for fewer, or choose a lattice with "
             "smaller rotations.";
    case MissingCones::Why::only_pairs:
      return "the remaining sites come in mirrored pairs. Ask for one more or one fewer.";
    case MissingCones::Why::no_room: break;
  }
  return "no other interior vertex remains where a cone may be. Ask for fewer, or subdivide the mesh there.";
}

void append(Array<Index>& to, const Array<Index>& more) { to.insert(to.end(), more.begin(), more.end()); }

}  // namespace

void Shortfalls::add(const MissingCones& missing, const Array<Index>& triangles) {
  Missing& of_reason = missing_[static_cast<int>(missing.why)];
  ++of_reason.parts;
  of_reason.placed += missing.placed;
  append(of_reason.triangles, triangles);
}

void Shortfalls::add(double l2, const Array<Index>& cones, const Array<Index>& triangles) {
  if (parts_++ == 0 || l2 > worst_l2_) {
    worst_l2_ = l2;
    worst_cones_ = cones.size();
  }
  all_have_cones_ &= !cones.empty();
  append(cones_, cones);
  append(triangles_, triangles);
}

void Shortfalls::add_asymmetric(const Array<Index>& triangles) {
  ++asymmetric_components_;
  append(asymmetric_, triangles);
}

void Shortfalls::report(std::vector<Finding>& findings) const {
  if (asymmetric_components_ > 0) findings.push_back(told_of_asymmetry());
  for (int i = 0; i < reasons; ++i) {
    if (missing_[i].parts > 0) findings.push_back(told(static_cast<MissingCones::Why>(i), missing_[i]));
  }
  if (parts_ > 0) findings.push_back(told_of_stretch());
}

Finding Shortfalls::told(MissingCones::Why why, const Missing& missing) const {
  const int asked = options_.count.value_or(0);
  const std::string how_many =
      missing.parts == 1 ? concat(missing.placed, " of the ", count(asked, "cone", "cones"), " asked for ",
                                  missing.placed == 1 ? "was" : "were", " placed on a component of the surface: ")
                         : concat(missing.placed, missing.placed == 1 ? " cone was" : " cones were", " placed on ",
                                  missing.parts, " components of the surface instead of ", asked, " on each: ");
  return {Code::placement_not_reached, how_many + remedy_for(why), {ElementKind::triangles, missing.triangles}};
}

Finding Shortfalls::told_of_asymmetry() const {
  const bool is_one = asymmetric_components_ == 1;
  const std::string which = is_one ? "A component of the surface is not its own mirror image"
                                   : concat(asymmetric_components_, " components are not their own mirror images");
  return {Code::not_symmetric,
          concat(which, " in ", options_.mirror ? "the given plane" : "any plane that was tried", "; ",
                 is_one ? "its" : "their",
                 " cones were placed without regard to symmetry. Symmetrize the mesh, or give its mirror plane."),
          {ElementKind::triangles, asymmetric_}};
}

Finding Shortfalls::told_of_stretch() const {
  Array<Index> places = all_have_cones_ ? cones_ : triangles_;
  std::sort(places.begin(), places.end());
  const std::string cones = count(worst_cones_, "cone", "cones");
  const std::string stretch = std::isfinite(worst_l2_) ? concat("has an L2 stretch of ", rounded(worst_l2_))
                                                       : "has flipped triangles or wrong angles";
  const std::string missed =
      parts_ == 1
          ? concat("With ", cones, " the map ", stretch, "; an L2 stretch of ", options_.target, " was asked for. ")
          : concat("On ", parts_, " components of the surface the requested L2 stretch of ", options_.target,
                   " is not reached: with ", cones, " the worst map ", stretch, ". ");
  return {Code::placement_not_reached,
          missed + "Mark cones at thin tips, clean up spikes and thin triangles, or ask for less.",
          {all_have_cones_ ? ElementKind::vertices : ElementKind::triangles, std::move(places)}};
}

}  // namespace lsgp

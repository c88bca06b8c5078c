// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/report_defects.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

namespace {

void report_overlapping(const Options& options, const Defects& found, Result& result) {
  const auto report = [&](const std::vector<Index>& triangles, const char* what) {
    if (triangles.empty()) return;
    result.warnings.push_back(
        {Code::overlapping_triangles,
         concat(count(triangles.size(), "triangle overlaps", "triangles overlap"), " others ", what),
         {ElementKind::triangles, triangles}});
  };
  if (options.overlaps == Overlaps::keep) {
    report(result.overlapping, "in the layout. To bake onto it, choose to split overlaps.");
    return;
  }
  std::vector<Index> across_faces;
  std::set_difference(result.overlapping.begin(), result.overlapping.end(), found.on_own_face.begin(),
                      found.on_own_face.end(), std::back_inserter(across_faces));
  report(found.on_own_face,
         "of the same face in the layout, and no cut divides a face. Divide such faces, best into triangles.");
  report(across_faces, found.pinned ? "in the layout. Islands with several pins are not split: unpin corners."
                       : result.flipped.empty()
                           ? "in the layout, and could not be split. Move or add cones nearby."
                           : "in the layout, and could not be split because triangles are flipped. Improve the "
                             "mesh there, or add a cone nearby.");
}

}  // namespace

void report_defects(const Options& options, Defects found, Result& result) {
  std::vector<Index>& flipped = result.flipped;
  std::vector<Index>& wrong = result.wrong_angle_sums;
  std::sort(flipped.begin(), flipped.end());
  sort_unique(wrong);
  sort_unique(found.inexact_angles);
  // One of its copies may be off by more than another.
  const auto is_wrong = [&](Index v) { return std::binary_search(wrong.begin(), wrong.end(), v); };
  found.inexact_angles.erase(std::remove_if(found.inexact_angles.begin(), found.inexact_angles.end(), is_wrong),
                             found.inexact_angles.end());
  const bool foretold = std::any_of(result.warnings.begin(), result.warnings.end(),
                                    [](const Finding& finding) { return finding.code == Code::high_distortion; });
  if (!foretold && flipped.empty() && !(result.distortion.l2_stretch < high_l2)) {
    result.warnings.push_back(
        {Code::high_distortion,
         concat("The map has high stretch: its L2 stretch is ", rounded(result.distortion.l2_stretch),
                ", 1 being none. Add cones where the texture becomes too small."),
         {}});
  }
  if (!found.inexact_seams.empty()) {
    result.warnings.push_back(
        {Code::inexact_seams,
         concat("At ", count(found.inexact_seams.size() / 2, "cut edge", "cut edges"),
                " the two sides do not match exactly, because the layout shrinks too much there or a component is much "
                "smaller than the others. Add cones nearby, or unwrap small components separately."),
         {ElementKind::edges, found.inexact_seams}});
  }
  if (!found.inexact_angles.empty()) {
    result.warnings.push_back({Code::inexact_angles,
                               concat("The angles around ", count(found.inexact_angles.size(), "vertex", "vertices"),
                                      " are not exactly those imposed, but off by up to a degree, because the layout "
                                      "shrinks too much there. Add cones nearby."),
                               {ElementKind::vertices, found.inexact_angles}});
  }
  if (!flipped.empty()) {
    result.warnings.push_back({Code::flipped_triangles,
                               concat(count(flipped.size(), "triangle is", "triangles are"),
                                      " flipped in the layout. Add a cone nearby or improve the mesh there."),
                               {ElementKind::triangles, flipped}});
  }
  if (!wrong.empty()) {
    result.warnings.push_back({Code::wrong_angle_sums,
                               concat("At ", count(wrong.size(), "vertex", "vertices"),
                                      " angles are off by more than a degree: by a full turn, where the layout winds "
                                      "once too often or too little, or because it shrinks too much. Move or add cones "
                                      "nearby."),
                               {ElementKind::vertices, wrong}});
  }
  report_overlapping(options, found, result);
}

}  // namespace lsgp

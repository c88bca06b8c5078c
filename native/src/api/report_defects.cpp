// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/report_defects.hpp"

#include <algorithm>
#include <utility>

#include "base/text.hpp"
#include "prescription/curvature.hpp"

namespace lsgp {

namespace {

void report_overlapping(const Options& options, Result& result) {
  const std::vector<Index>& overlapping = result.overlapping;
  if (overlapping.empty()) return;
  const char* remedy = options.overlaps == Overlaps::keep
                           ? "To bake onto it, choose to split overlaps."
                           : "They could not be split: unpin corners, or improve the mesh where triangles are flipped.";
  result.warnings.push_back(
      {Code::overlapping_triangles,
       concat(count(overlapping.size(), "triangle lies", "triangles lie"), " on others in the layout. ", remedy),
       {ElementKind::triangles, overlapping}});
}

}  // namespace

void report_defects(const Options& options, InexactElements inexact, Result& result) {
  std::vector<Index>& flipped = result.flipped;
  std::vector<Index>& wrong = result.wrong_angle_sums;
  std::sort(flipped.begin(), flipped.end());
  sort_unique(wrong);
  sort_unique(inexact.angles);
  // One of its copies may be off by more than another.
  const auto is_wrong = [&](Index v) { return std::binary_search(wrong.begin(), wrong.end(), v); };
  inexact.angles.erase(std::remove_if(inexact.angles.begin(), inexact.angles.end(), is_wrong), inexact.angles.end());
  const bool foretold = std::any_of(result.warnings.begin(), result.warnings.end(),
                                    [](const Finding& finding) { return finding.code == Code::high_distortion; });
  if (!foretold && flipped.empty() && !(result.distortion.l2_stretch < high_l2)) {
    result.warnings.push_back({Code::high_distortion,
                               concat("The map stretches much: its L2 stretch is ", result.distortion.l2_stretch,
                                      ", 1 being none. Add cones where the texture becomes too small."),
                               {}});
  }
  if (!inexact.seams.empty()) {
    result.warnings.push_back(
        {Code::inexact_seams,
         concat(
             "At ", count(inexact.seams.size() / 2, "cut edge", "cut edges"),
             " the two sides agree to fewer than nine digits, because the layout shrinks too much there or a part is "
             "much smaller than the others. Add cones nearby, or unwrap small parts by themselves."),
         {ElementKind::edges, inexact.seams}});
  }
  if (!inexact.angles.empty()) {
    result.warnings.push_back({Code::inexact_angles,
                               concat("The angles around ", count(inexact.angles.size(), "vertex", "vertices"),
                                      " miss what was imposed by more than a millionth. Add cones nearby."),
                               {ElementKind::vertices, inexact.angles}});
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
                                      " angles are off by more than a degree: by a turn, where the layout turns once "
                                      "too often or too little, or because it shrinks too much. Move or add cones "
                                      "nearby."),
                               {ElementKind::vertices, wrong}});
  }
  report_overlapping(options, result);
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly/doubled_triangles.hpp"

#include <algorithm>
#include <vector>

namespace lsgp {

namespace {

void share_map(const Surface& surface, Index triangle, Index original, Result& result) {
  element(result.island, triangle) = element(result.island, original);
  if (result.direction_errors.size() > 0) {
    result.direction_errors[triangle] = result.direction_errors[original];
  }
  for (Index corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
    for (Index other = 3 * original; other < 3 * original + 3; ++other) {
      if (surface.triangles.data()[corner] == surface.triangles.data()[other]) {
        result.corner_uv.row(corner) = result.corner_uv.row(other);
      }
    }
  }
}

void name_unmapped(const Array<std::pair<Index, Index>>& duplicates, Result& result) {
  for (Finding& finding : result.warnings) {
    if (finding.code != Code::component_skipped) continue;
    std::vector<Index>& skipped = finding.elements.indices;
    const std::vector<Index> originals = skipped;  // sorted, as a component lists its triangles
    for (const auto& [f, original] : duplicates) {
      if (std::binary_search(originals.begin(), originals.end(), original)) skipped.push_back(f);
    }
    std::sort(skipped.begin(), skipped.end());
  }
}

}  // namespace

void share_maps(const Surface& surface, const Array<std::pair<Index, Index>>& duplicates, Result& result) {
  for (const auto& [f, original] : duplicates) share_map(surface, f, original, result);
  name_unmapped(duplicates, result);
}

}  // namespace lsgp

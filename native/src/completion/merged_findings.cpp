// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/merged_findings.hpp"

#include <algorithm>

namespace lsgp {

std::vector<Finding> merged(std::vector<Finding> of_placement, const std::vector<Finding>& of_map) {
  const auto is_said = [&](const Finding& finding) {
    return std::any_of(of_map.begin(), of_map.end(), [&](const Finding& other) {
      return other.code == finding.code && other.message == finding.message;
    });
  };
  of_placement.erase(std::remove_if(of_placement.begin(), of_placement.end(), is_said), of_placement.end());
  of_placement.insert(of_placement.end(), of_map.begin(), of_map.end());
  return of_placement;
}

}  // namespace lsgp

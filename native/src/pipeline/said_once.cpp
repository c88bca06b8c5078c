// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/said_once.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/array.hpp"
#include "base/text.hpp"

namespace lsgp {

namespace {

bool is_counted(Code code) { return code == Code::degenerate_faces || code == Code::cone_on_boundary; }

std::string sentence(Code code, std::size_t n) {
  if (code == Code::degenerate_faces) {
    return concat(count(n, "triangle has", "triangles have"),
                  " no area: those with an edge of no length were left out of the computation, others got a little. "
                  "Merge by distance to be rid of this note.");
  }
  return concat(count(n, "cone lies", "cones lie"),
                " on a boundary, where angles are free anyway; nothing was prescribed there. Give an angle to make a "
                "corner.");
}

}  // namespace

Finding counted(Code code, Elements elements) {
  std::string message = sentence(code, elements.indices.size());
  return {code, std::move(message), std::move(elements)};
}

void say_once(std::vector<Finding>& findings) {
  struct Group {
    Finding* first;
    Index times;
  };
  std::map<std::pair<Code, std::string>, Group> groups;
  std::vector<Finding> joined;
  joined.reserve(findings.size());  // groups point into it
  for (Finding& finding : findings) {
    const auto key = std::make_pair(finding.code, is_counted(finding.code) ? std::string() : finding.message);
    const auto [known, is_new] = groups.try_emplace(key, Group{nullptr, 1});
    if (is_new) {
      joined.push_back(std::move(finding));
      known->second.first = &joined.back();
    } else {
      auto& [first, times] = known->second;
      const std::vector<Index>& more = finding.elements.indices;
      first->elements.indices.insert(first->elements.indices.end(), more.begin(), more.end());
      ++times;
    }
  }
  for (const auto& [key, group] : groups) {
    if (group.times == 1) continue;
    Finding& finding = *group.first;
    // Edges are pairs of vertices.
    if (finding.elements.kind != ElementKind::edges) sort_unique(finding.elements.indices);
    finding.message = is_counted(finding.code) ? sentence(finding.code, finding.elements.indices.size())
                                               : concat(finding.message, " This was found ", group.times, " times.");
  }
  findings = std::move(joined);
}

}  // namespace lsgp

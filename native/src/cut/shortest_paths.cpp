// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/shortest_paths.hpp"

#include <numeric>

namespace lsgp {

Array<Bridge> cheapest_of_pairs(const Array<Bridge>& bridges, Index vertex_count) {
  // Sorted by the lower source, then the few of each.
  Array<Index> end(vertex_count + 1, 0);
  for (const Bridge& bridge : bridges) ++end[bridge.low + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  Array<Bridge> sorted(bridges.size());
  for (const Bridge& bridge : bridges) sorted[end[bridge.low]++] = bridge;
  Array<Bridge> out;
  Index begin = 0;
  for (Index v = 0; v < vertex_count; ++v) {
    std::sort(sorted.begin() + begin, sorted.begin() + end[v],
              [](const Bridge& a, const Bridge& b) { return a.high != b.high ? a.high < b.high : a < b; });
    for (Index i = begin; i < end[v]; ++i) {
      if (i == begin || sorted[i].high != sorted[i - 1].high) out.push_back(sorted[i]);
    }
    begin = end[v];
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/split_overlaps.hpp"

#include "split/overlap_splitter.hpp"
#include "split/part_merger.hpp"

namespace lsgp {

Array<Index> split_overlaps(const OpenedSurface& surface, const Array<Overlap>& overlaps, CutCost rule,
                            const std::function<void()>& before_cut) {
  const FaceGraph graph = build_face_graph(surface);
  const OverlapPairs pairs = collect_pairs(graph, overlaps);
  MinimumCutter cutter(graph, rule);
  FaceParts parts = OverlapSplitter(graph, pairs, cutter, before_cut).split();
  PartMerger merger(graph, pairs, cutter, before_cut, parts);
  merger.merge_back();
  merger.improve();
  merger.straighten(surface);
  Array<Index> opened;
  for (const FaceGraph::Link& link : graph.links) {
    if (parts.of_face[link.faces[0]] != parts.of_face[link.faces[1]]) opened.push_back(link.halfedge);
  }
  return opened;
}

}  // namespace lsgp

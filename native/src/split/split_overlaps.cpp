// SPDX-License-Identifier: GPL-3.0-or-later
#include "split/split_overlaps.hpp"

#include "split/face_cells.hpp"
#include "split/overlap_splitter.hpp"
#include "split/part_merger.hpp"

namespace lsgp {

namespace {

constexpr Index many_faces = 6000;          // of a graph whose cells are divided first
constexpr Index most_divided_cells = 3000;  // that it has

using BeforeCut = std::function<void()>;

// number: faces of different numbers are divided already.
FaceParts find_parts(const FaceGraph& graph, const OverlapPairs& pairs, MinimumCutter& cutter,
                     const BeforeCut& before_cut, const PerFace<Index>& number) {
  FaceParts parts = OverlapSplitter(graph, pairs, cutter, before_cut, number).split();
  PartMerger(graph, pairs, cutter, before_cut, parts).merge_back();
  return parts;
}

// Divides cells of faces instead of all faces of a large graph: which parts there are hardly depends on their number.
PerFace<Index> divide_cells(const FaceGraph& graph, const Array<Overlap>& overlaps, CutCost rule,
                            const BeforeCut& before_cut) {
  PerFace<Index> number(graph.face_count(), 0);
  if (graph.face_count() <= many_faces) return number;
  const FaceGraph cells = build_cell_graph(graph, most_divided_cells);
  const OverlapPairs pairs = collect_pairs(cells, overlaps);
  MinimumCutter cutter(cells, rule);
  FaceParts parts = find_parts(cells, pairs, cutter, before_cut, PerFace<Index>(cells.face_count(), 0));
  PartMerger(cells, pairs, cutter, before_cut, parts).improve();
  for (Index f = 0; f < ssize(graph.face_of); ++f) number[graph.face_of[f]] = parts.of_face[cells.face_of[f]];
  return number;
}

}  // namespace

Array<Index> split_overlaps(const OpenedSurface& surface, const Array<Overlap>& overlaps, CutCost rule,
                            const std::function<void()>& before_cut) {
  const FaceGraph graph = build_face_graph(surface);
  const OverlapPairs pairs = collect_pairs(graph, overlaps);
  MinimumCutter cutter(graph, rule);
  const PerFace<Index> number = divide_cells(graph, overlaps, rule, before_cut);
  FaceParts parts = find_parts(graph, pairs, cutter, before_cut, number);
  PartMerger merger(graph, pairs, cutter, before_cut, parts);
  if (graph.face_count() <= many_faces) merger.improve();
  merger.straighten(surface);
  Array<Index> opened;
  for (const FaceGraph::Link& link : graph.links) {
    if (parts.of_face[link.faces[0]] != parts.of_face[link.faces[1]]) opened.push_back(link.halfedge);
  }
  return opened;
}

}  // namespace lsgp

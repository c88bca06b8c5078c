# SPDX-License-Identifier: GPL-3.0-or-later
"""Every loop ends, and long ones have cancellation points: those whose head does not tell the number of rounds are
listed here with what bounds it and where they can be cancelled. A new one fails until it has been thought about."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from loops import heads, is_counted, open_loops

SOURCES = Path(__file__).parents[3] / "native" / "src"

# Where they can be cancelled.
SHORT = "not: linear in the surface at most, or small"
OWN = "a checkpoint or the monitor in each round"
WITHIN = "by what a round does: factorizations, solves, flows"

AROUND_A_VERTEX = "the triangles around a vertex, a cycle or ended by a border"
LINKED = "a linked list or the way up in a forest, without cycles by construction"
NEAREST = "every queue entry lowered a distance; as many as edges in the usual case"
ONCE_EACH = "each element is put in once, when it is marked"
SIDES = "the sides of a closed border, each once"

# file: [(head, what bounds the rounds, where the caller is let in)]
REVIEWED = {
    "assembly/assembly.cpp": [
        ("for (auto side = sides.begin(); side != sides.end();)", "passes an edge each time", SHORT)
    ],
    "assembly/carried_map.cpp": [
        ("for (Index f = home; count < most_steps;)", "a fixed number of steps", SHORT),
        ("while (count > 0)", "the steps before", SHORT),
        ("for (int k = i; k > 0; k = steps[k].before)", LINKED, SHORT),
    ],
    "assembly/cut_paths.cpp": [
        ("while (at != start && !is_node_[at])", "edges, each once, to a node or back to the start", SHORT),
    ],
    "creases/opened_tube.cpp": [
        ("while (!ends(first))", SIDES, SHORT),
        ("for (Index h = first;;)", SIDES, SHORT),
        ("while (at != none && passed < ssize(quads_))", "passes a quad each time, as many as there are", SHORT),
    ],
    "kept/kept_components.cpp": [
        (
            "for (const KeptComponents* kept = earlier_.get(); kept != nullptr; kept = kept->earlier_.get())",
            LINKED,
            SHORT,
        ),
    ],
    "measures/objective.cpp": [
        (
            "while (const std::optional<Estimate> next = most_promising(candidates))",
            "candidates, each once",
            WITHIN,
        ),
    ],
    "api/measure_distortion.cpp": [
        ("for (std::size_t i = 0, end = 0; i < sides.size(); i = end)", "passes a side each time", SHORT),
        ("for (end = i + 1; same_edge(i, end);)", "passes a side each time", SHORT),
    ],
    "base/memory.cpp": [("while (!word.empty() && file >> read && read != word)", "words of a short file", SHORT)],
    "base/thread_team.cpp": [
        ("while (forest.left > 0 && !failure_)", "tasks, each once, or waits for those of other threads", WITHIN),
        ("while (forest.running > 0)", "waits for tasks of other threads, which end", SHORT),
        ("while (loop.next < loop.count && !failure_)", "rounds, each once", WITHIN),
        ("while (loop.running > 0)", "waits for rounds of other threads, which end", SHORT),
        ("while (!is_over_)", "waits for work until the call that started the thread ends", WITHIN),
    ],
    "base/union_find.hpp": [("while (parent_[i] != i)", LINKED, SHORT)],
    "transitions/cone_triangulation.cpp": [
        (
            "while (i != a.translations.end() || j != b.translations.end())",
            "each round moves on one of two ends",
            SHORT,
        ),
        ("for (const Index first = h;;)", AROUND_A_VERTEX, SHORT),
        ("for (int pass = 1; !left.empty(); ++pass)", "a pass that removes no vertex ends it", OWN),
        ("while (!suspects_.empty())", "a budget of flips", OWN),
        ("while (h != outgoing_[v])", AROUND_A_VERTEX, SHORT),
        ("while (h != outgoing_[v])", AROUND_A_VERTEX, SHORT),
        ("for (int degree;;)", "each flip takes an edge away from the vertex", SHORT),
    ],
    "cut/cut_graph.cpp": [
        (
            "for (Index h = forest.reached[end].by; h != none && !is_cut[h]; h = forest.reached[mesh.origin(h)].by)",
            LINKED,
            SHORT,
        ),
        (
            "for (Index at = v; degree[at] == 1 && !is_cone[at] && mesh.loop_of_vertex[at] == none;)",
            "each round takes an edge off the cut",
            SHORT,
        ),
        ("while (true)", "edges of the cut, each once, to an end or back to the start", SHORT),
    ],
    "creases/tubes.cpp": [
        ("for (Index at = 4 * quad + side; at != none;)", "each direction of a quad, once in all", SHORT),
        ("while (const auto beyond = rings_.across(ring, rim))", "each ring, once in all", SHORT),
    ],
    "cut/cut_across.cpp": [
        ("for (Index h = first;;)", AROUND_A_VERTEX, SHORT),
        ("while (h != none && h != first && !is_passed[h])", "halfedges, each once in all", SHORT),
        ("for (std::size_t i = 0, end = 0; i < crossings.size(); i = end)", "passes a crossing each time", SHORT),
        ("while (end < crossings.size() && crossings[end] == crossings[i])", "crossings, each once in all", SHORT),
    ],
    "creases/bevels.cpp": [("while (!queue.empty())", "three entries for each triangle", OWN)],
    "creases/crease_borders.cpp": [
        (
            "for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end)",
            "borders, each once: the first of a group is in it",
            SHORT,
        ),
        (
            "while (end < order.size() && order[end].first <= (1 - same_share) * order[begin].first)",
            "borders, each once",
            SHORT,
        ),
        (
            "while (!smallest.empty() && smallest.top().first < least_area)",
            "an entry for each patch and each time two become one",
            OWN,
        ),
        ("while (!is_border_[g])", AROUND_A_VERTEX, SHORT),
        ("while (h != none && !is_border_[h])", AROUND_A_VERTEX, SHORT),
        ("while (true)", "edges of a border, each once, to a node or back to the start", SHORT),
        ("for (;; g = next(mesh.twin[g]))", AROUND_A_VERTEX, SHORT),
        ("while (h != first)", SIDES, SHORT),
        ("while (!queue.empty())", NEAREST, OWN),
        (
            "for (auto at = from.find(mesh.origin(last)); at != from.end(); at = from.find(mesh.origin(path.back())))",
            LINKED,
            SHORT,
        ),
        ("while (found)", "each round but the last opens a tube, which joins two borders", OWN),
    ],
    "cut/cut_reroute.cpp": [
        ("for (Index h = reached[v].by; h != none; h = reached[mesh_.origin(h)].by)", LINKED, SHORT),
    ],
    "cut/cut_network.cpp": [
        ("while (!is_node(mesh.origin(h)))", "edges of the cuts, each once, to a node or back to the start", SHORT),
        (
            "while (!is_node(mesh.target(h)) && mesh.target(h) != tail)",
            "edges of the cuts, each once, to a node or back to the start",
            SHORT,
        ),
    ],
    "cut/cut_regions.cpp": [
        ("for (Index h = at(mesh.origin(bridge)).by; h != none; h = at(mesh.origin(h)).by)", LINKED, SHORT),
        ("for (Index h = at(mesh.target(bridge)).by; h != none; h = at(mesh.origin(h)).by)", LINKED, SHORT),
    ],
    "cut/key_path_exchange.cpp": [("while (true)", "each round takes a vertex of the cuts, each once", SHORT)],
    "cut/star_exchange.cpp": [
        ("for (std::size_t i = 0; i + (out.size() == 2) < out.size(); ++i)", "cuts at a vertex", SHORT),
        ("for (Index h = from[v].by; h != none; h = from[mesh_.origin(h)].by)", LINKED, SHORT),
        ("for (std::size_t i = 0; work_left_ > 0; ++i)", "pairs of cuts at a vertex, while work is left", OWN),
    ],
    "cut/bucket_queue.cpp": [
        ("while (!(filled_ >> begun_ & 1))", "at most 64 buckets, one of them filled", SHORT),
        ("while (at != none)", LINKED, SHORT),
        ("while (!early_.empty() && bucket_of(early_.top().first) < bucket_count)", "takes an entry each time", SHORT),
    ],
    "cut/shortest_paths.hpp": [("while (!queue.empty())", NEAREST, OWN)],
    "cut/strip_search.cpp": [
        ("while (!is_border(g))", AROUND_A_VERTEX, SHORT),
        ("while (h != first)", SIDES, SHORT),
        ("while (h != first)", SIDES, SHORT),
        ("while (!queue.empty() && queue.top().first < below)", NEAREST, OWN),
        ("for (Index h = last; h != none;)", LINKED, SHORT),
    ],
    "cut/cut_mesh.cpp": [
        ("while (!cut_graph.is_cut[first])", AROUND_A_VERTEX, SHORT),
        ("for (Index h = mesh.rotate(first); h != none && h != first; h = mesh.rotate(h))", AROUND_A_VERTEX, SHORT),
        ("for (Index h = mesh.rotate(first); h != none && h != first; h = mesh.rotate(h))", AROUND_A_VERTEX, SHORT),
    ],
    "cut/parts.cpp": [
        ("for (Index along = h; !is_traced[along];)", SIDES, SHORT),
        ("while (!is_border[along])", AROUND_A_VERTEX, SHORT),
    ],
    "mesh/border.cpp": [("while (mesh.rotate(last) != none)", AROUND_A_VERTEX, SHORT)],
    "mesh/topology.cpp": [
        (
            "for (Index at = v; mesh.loop_of_vertex[at] == none; at = mesh.target(mesh.outgoing[at]))",
            SIDES,
            SHORT,
        ),
        ("while (h != none && h != corner)", AROUND_A_VERTEX, SHORT),
        ("while (h == none && mesh.twin[first] != none)", AROUND_A_VERTEX, SHORT),
    ],
    "shaping/rectangle.cpp": [
        ("for (std::size_t at = corners[i]; at != end; at = (at + 1) % count)", SIDES, SHORT),
    ],
    "mesh/sheets.cpp": [
        ("for (; parent_[root] != root; root = parent_[root])", LINKED, SHORT),
        ("for (bool rest = turned; parent_[i] != root && parent_[i] != i;)", LINKED, SHORT),
        ("while (true)", AROUND_A_VERTEX, SHORT),
    ],
    "mesh/nearest_distance.cpp": [("while (!reached.empty())", NEAREST, SHORT)],
    "mesh/topology.hpp": [("while (h != none && h != outgoing[v])", AROUND_A_VERTEX, SHORT)],
    "placement/verified_placement.cpp": [
        (
            "for (bool is_moved = true; is_moved && left > 0;)",
            "each round tries moves of cones, hundreds at most, or ends it",
            OWN,
        ),
    ],
    "search/batch_placement.cpp": [
        ("while (rings > 0 && cones * vertices_within() > vertices)", "rings fall from 2", SHORT),
        ("while (cone_count() < cones)", "each round adds a cone, or ends it", OWN),
    ],
    "search/cone_chooser.cpp": [
        ("while (set.cone_count() < count)", "each round adds a cone, or ends it", OWN),
    ],
    "search/cone_growth.cpp": [
        (
            "while (best_.predicted_l2 > target && !chooser_.are_too_many(ssize(best_.vertices)) && advance(target))",
            "each round adds cones, up to the stages or those that Gauss-Bonnet asks for, or ends it",
            WITHIN,
        ),
        ("while (next_stage_ < std::size(cone_stages))", "stages, each once", WITHIN),
        (
            "while (search.can_drop(set) && chooser_.predicted_l2(set) > worth_all)",
            "each round drops a cone",
            WITHIN,
        ),
    ],
    "search/cone_search.cpp": [
        ("while (set.cone_count() < cones)", "each round adds a cone, or ends it", OWN),
    ],
    "search/cone_set.cpp": [
        ("while (!reaches_sum() && out.used_reach <= widest_reach)", "the reach grows by a tenth up to 8", SHORT),
    ],
    "mesh/refined_surface.cpp": [
        ("while (is_replaced(place.triangle))", "triangles are replaced by later ones", SHORT),
    ],
    "mesh/thinned_surface.cpp": [
        ("for (int pass = 1; count > most && !left_.empty(); ++pass)", "the second pass that removes no vertex", OWN),
        *[("while (h != outgoing_[v])", AROUND_A_VERTEX, SHORT)] * 2,
        ("while (h != outgoing_[a])", AROUND_A_VERTEX, SHORT),
        ("while (polygon_.size() > 3)", "each round cuts off a corner", SHORT),
        ("for (Index point = first_point_[f]; point != none; point = next_point_[point])", LINKED, SHORT),
    ],
    "mesh/coarse_surface.cpp": [
        (
            "for (int pass = 1; ssize(removals) < most && !left_.empty(); ++pass)",
            "a pass that removes no vertex ends it",
            OWN,
        ),
        ("while (!suspects_.empty())", "a budget of flips", OWN),
        ("while (h != outgoing_[v])", AROUND_A_VERTEX, SHORT),
        ("while (++degree <= most_degree && h != outgoing_[v])", AROUND_A_VERTEX, SHORT),
        ("while (h != outgoing_[v])", AROUND_A_VERTEX, SHORT),
    ],
    "sites/cone_sites.cpp": [
        (
            "while (static_cast<double>(candidates) > most * vertices_within())",
            "rings grow until they cover the component",
            SHORT,
        ),
        (
            "for (int rings = least_rings(ssize(candidates), most); static_cast<int>(spread.size()) > most; ++rings)",
            "rings grow until they cover the component",
            SHORT,
        ),
    ],
    "plane/aabb_tree.hpp": [
        ("while (!open.empty())", "pairs of nodes of a finite tree, each once", OWN),
        ("while (!open.empty())", "nodes of a finite tree, each once", SHORT),
    ],
    "plane/boundary_polygon.hpp": [
        ("for (Index h = first; !traced[h];)", ONCE_EACH, SHORT),
        ("while (!ends_at(h))", AROUND_A_VERTEX, SHORT),
    ],
    "plane/convex_hull.cpp": [
        (
            "while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], *point - hull.back()) <= 0)",
            "takes out a point that was put in once",
            SHORT,
        ),
        (
            "while (point < i + count && height(at(point + 1)) >= height(at(point)))",
            "a point that only moves on, twice around at most",
            SHORT,
        ),
    ],
    "prescription/border_turning.cpp": [("while (true)", "each round lets go of a border, or ends it", WITHIN)],
    "prescription/log_scale.cpp": [("for (; length > 1e-6; length /= 2)", "20 halvings", SHORT)],
    "prescription/straight_angles.cpp": [
        ("for (Index waited = 0; trees_ < most; ++waited)", "each round counts a tree", WITHIN),
    ],
    "prescription/straightness.cpp": [
        ("while (boundary.count_crossings() > 0 && boundary.swap_worst())", "each swap lowers the crossings", OWN),
    ],
    "prescription/turn_exchange.cpp": [
        (
            "for (int missing = sum - turns_.sum(); missing != 0; missing = sum - turns_.sum())",
            "each round takes a turn off what is missing, and the bounds leave room for all",
            SHORT,
        ),
        ("while (trials < most)", "a budget of trials, at least one a round", OWN),
    ],
    "quads/grid_edges.cpp": [
        ("for (;;)", "a straight line leaves each triangle that it crosses, and ends after a cell", OWN),
        ("for (int visited = 0; !grid_.leads_into(corner, ray.direction); ++visited)", AROUND_A_VERTEX, SHORT),
    ],
    "repair/flat_metric.cpp": [("for (double length = 1; length > shortest_step; length /= 2)", "20 halvings", SHORT)],
    "repair/line_constraints.cpp": [
        ("for (Eigen::Index first = 0, end = 0; first < right.cols(); first = end)", "passes a column each time", OWN),
        ("while (end < right.cols() && products < products_at_once)", "passes a column each time", SHORT),
    ],
    "repair/newton.cpp": [("for (double length = longest; length > 1e-8; length /= 2)", "27 halvings", SHORT)],
    "repair/straight_sides.cpp": [
        ("for (Index h = first; !is_listed[h];)", SIDES, SHORT),
        ("while (!is_open(mesh, cut_mesh, h))", AROUND_A_VERTEX, SHORT),
        ("for (Index h = first; h != none && is_left_[h]; h = following(is_crease, h))", ONCE_EACH, SHORT),
        (
            "for (Complex turn = out.turn; !found.empty(); turn = turn_to_axes(chords_of(found), most_bend))",
            "takes sides away each time, all within an angle of 0.06 degrees at least",
            SHORT,
        ),
    ],
    "seamless/feature_alignment.cpp": [
        ("for (int trimmings = 0; reason; ++trimmings)", "up to four trimmings of lines", WITHIN),
        ("for (Index begin = 0, end = 0; begin < ssize(lines); begin = end)", "passes a line each time", SHORT),
        ("while (end < ssize(lines) && rank(end) == rank(begin))", "lines, each once", SHORT),
        (
            "for (Array<Index> at_fault = contradicting(lines, chosen); !at_fault.empty(); "
            "at_fault = contradicting(lines, chosen))",
            "each round releases a line at least",
            WITHIN,
        ),
    ],
    "seamless/feature_layout.cpp": [
        ("for (;;)", "each round rounds a coordinate, or ends it", OWN),
        ("for (;;)", "each round rounds a coordinate of a corner, or ends it", OWN),
        ("while (!task_.is_valid(start_))", "takes a choice off a list each time", WITHIN),
    ],
    "repair/feature_lines.cpp": [
        ("for (Index at = next(h);; at = next(mesh_.twin[at]))", AROUND_A_VERTEX, SHORT),
        ("for (Index h = first; h != none && !is_traced_[h]; h = following(h))", ONCE_EACH, SHORT),
        ("while (!is_border(prev(h)))", AROUND_A_VERTEX, SHORT),
        ("while (turn_one())", "opens a corner by a quarter turn or more each time, and closes none as far", OWN),
        ("for (Index begin = 0, end = 0; begin < ssize(angle); begin = end)", "passes an edge each time", SHORT),
        ("while (end < ssize(angle) && axis[end] == axis[begin])", "edges, each once", SHORT),
    ],
    "seamless/whole_values.cpp": [
        ("for (;;)", "Euclid's algorithm: each round lowers the smallest coefficient, or ends it", OWN),
        ("while (factor * out <= most_divisor && !is_whole(factor * out * coefficient))", "up to 840 factors", SHORT),
    ],
    "seamless/grid_search.cpp": [
        ("while (tiles < least)", "each round enlarges it by a third at least", SHORT),
        ("for (; tiles <= finest; tiles = next_size(tiles))", "27 sizes up to 16384 on a component", WITHIN),
        ("for (; tiles <= finest; tiles = next_size(tiles))", "the same sizes", SHORT),
        (
            "for (double size = tiles; size <= std::min(most_refinement * tiles, most_tiles); size = next_size(size))",
            "three sizes",
            WITHIN,
        ),
        (
            "while (tiles < most_tiles && energy_of_scales(scales, usual * tiles / extent()) > acceptable_growth)",
            "the same sizes",
            SHORT,
        ),
        ("while (low < high)", "halvings of as many sizes", WITHIN),
        ("while (!found && give_up_cones(i, size, options))", "each round gives up a cone", WITHIN),
    ],
    "seamless/lattice_search.cpp": [
        ("for (Eigen::Index k = 1; k < size;)", "a budget of exchanges", OWN),
    ],
    "seamless/rounding_repair.cpp": [
        ("while (!flipped.empty() && rings <= farthest_ring)", "a budget of visits of vertices", OWN),
    ],
    "seamless/seamless.cpp": [("for (;;)", "each round leaves out a part, or ends it", WITHIN)],
    "solvers/cholesky.cpp": [
        ("while (!waiting.empty() && plan.parent[waiting.back()] == i)", "children in a tree, each once", SHORT),
        ("for (int child = newest_child; child != -1; child = plan.earlier_sibling[child])", LINKED, SHORT),
        ("for (int i = 0, end = 0; i < plan.front_count(); i = end)", "passes a front each time", OWN),
    ],
    "solvers/dense_kernels_for.cpp": [("for (; j % 4 != 0; --j)", "three rounds", SHORT)],
    "solvers/eigenproblem.cpp": [
        ("for (double share = shift;; share *= next_shift)", "up to the largest shift", WITHIN),
    ],
    "solvers/elimination.cpp": [
        ("while (other != at && other != size_)", LINKED, SHORT),
        ("for (int root = child[eliminated_]; root != -1; root = sibling[root])", LINKED, SHORT),
        ("while (!stack.empty())", ONCE_EACH, SHORT),
        ("for (int node = at; node != size_ && first[node] == -1; node = parent_[node])", LINKED, SHORT),
        ("while (root < at && ancestor[root] != size_)", LINKED, SHORT),
        ("while (leaf < root)", LINKED, SHORT),
        (
            "for (int end = eliminated_ - 1, begin = end; end >= 0; end = begin - 1, begin = end)",
            "columns, each once",
            SHORT,
        ),
        (
            "while (begin > 0 && parent_[begin - 1] == begin && count_[begin - 1] == count_[begin] + 1)",
            "columns, each once",
            SHORT,
        ),
        (
            "for (int front = front_of[column]; front != -1 && mark[front] != at; front = out_.parent[front])",
            LINKED,
            SHORT,
        ),
    ],
    "solvers/smallest_cut.cpp": [
        ("while (highest_active_ > 0 && arrived_ < enough)", "distances only grow, up to the number of nodes", OWN),
        ("while (excess_[node] > 0 && distance_[node] < count_)", "each round but the last lifts the node", SHORT),
        ("while (nodes->first(level) >= 0)", "nodes of a list, each once", SHORT),
    ],
    "solvers/max_flow.cpp": [
        ("while (find_distances(source, sink))", "the distance grows each time, up to the number of nodes", OWN),
        ("while (!front.empty())", ONCE_EACH, SHORT),
        ("for (int a = first_[node]; a >= 0; a = next_[a])", LINKED, SHORT),
        ("for (int a = first_[queue[i]]; a >= 0; a = next_[a])", LINKED, SHORT),
        ("for (;;)", "each walk blocks an arc or a node", OWN),
        ("while (a >= 0 && (residual_[a] == 0 || distance_[to_[a]] != distance_[node] - 1))", LINKED, SHORT),
    ],
    "solvers/nested_dissection.cpp": [
        ("while (!parts.empty())", "both halves of a part are smaller", SHORT),
        ("for (int head = 0; tail < divided_; start = next)", "rows, each once", SHORT),
        ("while (next < rows_ && level_[next] != -1)", "rows, each once", SHORT),
    ],
    "solvers/sparse_assembly.hpp": [
        ("while (column < entry.column)", "columns, each once", SHORT),
        ("while (column < size_)", "columns, each once", SHORT),
    ],
    "pieces/candidate_cuts.cpp": [
        (
            "for (Index by = reached[end].by; by != none && !out[by]; by = reached[mesh.origin(by)].by)",
            LINKED,
            SHORT,
        ),
    ],
    "division/compact_islands.cpp": [("while (!pending.empty())", "each division pays a price out of a sum", WITHIN)],
    "split/merge_islands.cpp": [("while (left_ > 0 && merge_next())", "each round makes two groups one", WITHIN)],
    "split/mirrored_islands.cpp": [
        ("while (!queue.empty() && queue.top().second != to)", NEAREST, OWN),
        ("for (Index h = at(to).by; h != none; h = at(mesh_.origin(h)).by)", LINKED, SHORT),
    ],
    "division/minimum_cut.cpp": [
        ("while (!queue.empty())", NEAREST, SHORT),
        ("for (;;)", "each round holds more cells, or ends it", WITHIN),
        (
            "for (; next[side] < nearest[side].size() && taken[side] < target; ++next[side])",
            "cells, each once",
            SHORT,
        ),
        ("while (cells.count() > most_cells)", "a round that leaves 0.9 of the cells ends it", SHORT),
        ("while (!front.empty())", ONCE_EACH, SHORT),
    ],
    "split/overlap_pairs.cpp": [("while (!front.empty())", ONCE_EACH, SHORT)],
    "split/overlap_splitter.cpp": [
        ("while (!front.empty())", ONCE_EACH, SHORT),
        (
            "while (ring < scope.size() && (ring == 0 || scope.size() < faces_nearby))",
            "a ring of faces, each once",
            SHORT,
        ),
        ("while (!has_taken_long())", "each cut parts a pair of triangles that lay on each other", OWN),
    ],
    "split/own_overlaps.cpp": [("while (!waiting.empty())", "each round parts faces", WITHIN)],
    "split/part_merger.cpp": [
        ("while (!borders.empty())", "each round makes two parts one", OWN),
        ("for (auto border = borders.begin(); border != borders.end();)", "erases what it does not step over", SHORT),
    ],
    "pieces/piece_graph.cpp": [
        (
            "for (Index smallest = find_smallest(); smallest != none; smallest = find_smallest())",
            "each round makes two groups one, or one as large as need be",
            OWN,
        ),
        (
            "for (Index at = node; degree[at] == 1 && !graph.is_end[at];)",
            "each round closes a path",
            SHORT,
        ),
    ],
    "pieces/regroup.cpp": [
        ("while (join_once())", "each round lowers the score by least_saving", OWN),
        ("while (exchange())", "each round lowers the score by least_saving", OWN),
        (
            "for (Index p = 0, unchanged = 0; unchanged < count && !is_spent(); p = (p + 1) % count, ++unchanged)",
            "all paths in turn, again only after one that lowers the score by least_saving",
            OWN,
        ),
        (
            "for (Index p = 0, unchanged = 0; unchanged < count; p = (p + 1) % count, ++unchanged)",
            "all paths in turn, again only after one that lowers the score by least_saving",
            OWN,
        ),
    ],
    "pieces/recut.cpp": [
        (
            "for (Index p = 0, tried = 0; tried < count && work_ < most_work; p = (p + 1) % count, ++tried)",
            "all paths in turn, again only after one that lowers the score by least_gain",
            OWN,
        ),
    ],
    "packing/bit_rows.hpp": [
        ("while (begin < end)", "words of a row", SHORT),
        ("while (column < end)", "words of a row", SHORT),
    ],
    "packing/bit_rows.cpp": [
        ("for (auto crossing = of_row; end - crossing > 1; ++crossing)", "crossings of a row", SHORT),
    ],
    "packing/construction.cpp": [
        ("for (int row = first_row_; left > 0; ++row)", "rows of the tile: below the last one nothing fits", OWN),
        (
            "for (std::size_t s = 0; s < spans.size(); s += spans.size() / looks + 1)",
            "a fixed number of rows of a footprint",
            SHORT,
        ),
    ],
    "packing/footprint.cpp": [
        ("while (length >> (level + 1))", "bits of an int", SHORT),
        ("for (int begin = raster.next(true, row, 0, columns); begin < columns;)", "taken stretches of a row", SHORT),
        ("for (int begin = 0, taken = 0; taken < end; begin = taken)", "free stretches of a row", SHORT),
    ],
    "packing/footprint.hpp": [
        ("for (int column = begin; column <= last; column += BitRows::word_bits)", "words of a row", SHORT),
    ],
    "packing/layout_search.cpp": [
        (
            "for (int i = 0; i < most && (i == 0 || !is_done()); ++i)",
            "a fixed number of layouts",
            WITHIN,
        ),
        ("for (int count = directions; count > 1; count /= 2)", "halves a constant", SHORT),
        ("while (now_.side > near * low)", "each round halves what is between the two", WITHIN),
        *[
            (
                "for (double share = 0; share < 1; share = budget.share(work_ - work_before))",
                "the budget of work, of which each round takes some",
                OWN,
            )
        ]
        * 3,
    ],
    "packing/outline.cpp": [
        ("while (next[v] < begin[v + 1])", "sides from a vertex, each once", OWN),
        ("while (at != static_cast<Index>(v))", "sides, each once, as many end at a vertex as begin there", SHORT),
        (
            "for (std::size_t begin = 0, end; begin < sides_.size(); begin = end)",
            "passes a side each time",
            SHORT,
        ),
        ("while (!open.empty())", "parts of a polygon, each divided at a corner", OWN),
    ],
    "packing/separation.cpp": [
        ("for (int step = first_step; step > 0;)", "halved unless the cost gets lower, over places in a raster", SHORT),
        (
            "for (int tried = 0, first = uniform_below(random, count); !fits(pose); ++tried)",
            "poses of an island, each once",
            SHORT,
        ),
    ],
    "division/straight_cuts.cpp": [
        ("while (mesh_.twin[g] != none && !open_[g] && !parts_differ(g))", AROUND_A_VERTEX, SHORT),
        ("for (Index h = first; h != none; h = next_on[h])", LINKED, SHORT),
        ("for (;; g = next(mesh_.twin[g]))", AROUND_A_VERTEX, SHORT),
        ("for (g = next(h); mesh_.twin[g] != h; g = next(mesh_.twin[g]))", AROUND_A_VERTEX, SHORT),
        ("for (Index g = next(h);; g = next(mesh_.twin[g]))", AROUND_A_VERTEX, SHORT),
        ("while (!is_border(prev(g)))", AROUND_A_VERTEX, SHORT),
        ("for (Index g = border; !is_border(prev(g));)", AROUND_A_VERTEX, SHORT),
        ("while (!queue.empty())", NEAREST, OWN),
        ("for (Index g = h; g != none; g = before_[g])", LINKED, SHORT),
        ("while (!front.empty())", ONCE_EACH, SHORT),
    ],
    "systems/quadratic_forms.cpp": [
        ("while (inner[at - 1] > row)", "entries of a column, its first one below", SHORT),
    ],
    "unfold/lscm.cpp": [
        ("for (Index at = copy; border.empty() || at != copy; at = next_copy[at])", SIDES, SHORT),
    ],
    "unfold/spectral.cpp": [
        (
            "while (std::abs(from_center[first]) < nearly * farthest)",
            "ends at the farthest position, if not before",
            SHORT,
        ),
    ],
}


def test_every_open_loop_is_listed_with_its_bound() -> None:
    listed = Counter((file, head) for file, loops in REVIEWED.items() for head, _, _ in loops)
    found = Counter(open_loops(SOURCES))
    assert found - listed == Counter(), "new loops: what bounds them, and where can they be cancelled?"
    assert listed - found == Counter(), "loops that are gone"


@pytest.mark.parametrize(
    ("head", "counted"),
    [
        ("for (const Index v : vertices)", True),
        ("for (int i = 0; i < count; ++i)", True),
        ("for (int i = 0, used; i < count; i += used)", True),
        ("for (int i = count; i-- > 0;)", True),
        ("for (int round = 0; lowered && round < most_rounds; ++round)", True),
        ("for (Matrix::InnerIterator it(form, j); it; ++it)", True),
        ("for (int i = 0; i < count;)", False),
        ("for (int i = 0; i < count || more; ++i)", False),
        ("for (int pass = 1; !left.empty(); ++pass)", False),
        ("for (bool lowered = true; lowered;)", False),
        ("for (;;)", False),
        ("while (i < count)", False),
    ],
)
def test_what_counts_as_counted(head: str, counted: bool) -> None:
    assert is_counted(head) == counted


def test_heads_are_read_across_lines_and_without_comments() -> None:
    source = 'while (a &&\n       b("(")) {} // while (not)\nfor (;;) {}'
    assert list(heads(source)) == ['while (a && b(""))', "for (;;)"]

// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept/component_results.hpp"

#include <algorithm>
#include <utility>

namespace lsgp {

namespace {

// Auto-unwrap compares maps of usual and of symmetric cones, of these with other cuts, and of some for creases.
constexpr std::size_t most_kept = 4;

// Eigen compares only what has the same size.
template <typename Matrix>
bool is_equal(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}

// Fields are counted: a further one does not compile before it is compared.
bool is_same_lattice(const Seamless& a, const Seamless& b) {
  const auto& [lattice, tiles, tile_size, parity, feature_places, coarse_grid, cell] = a;
  return lattice == b.lattice && parity == b.parity && coarse_grid == b.coarse_grid && cell == b.cell;
}

// Whether seamless layouts differ only in the size of tiles and in what runs along them or has straight sides, and
// other ones only in how islands fill a square; the number of threads does not matter, and the task says which cuts are
// symmetric.
bool has_same_maps(const Options& a, const Options& b) {
  const auto& [prescription, unfold, method, seams, border, loop_turning, seamless, mode, stretch, straighten, repair,
               hard_repairs, overlaps, compact, mirrored_cuts, follow_strokes, square_share, factorization, threads] =
      a;
  return prescription == b.prescription && unfold == b.unfold && method == b.method && seams == b.seams &&
         border == b.border && loop_turning == b.loop_turning && seamless.has_value() == b.seamless.has_value() &&
         (seamless ? is_same_lattice(*seamless, *b.seamless) : straighten == b.straighten) && mode == b.mode &&
         stretch == b.stretch && follow_strokes == b.follow_strokes && repair == b.repair &&
         hard_repairs == b.hard_repairs && overlaps == b.overlaps && factorization == b.factorization &&
         (!seamless || (compact == b.compact && square_share == b.square_share));
}

bool has_same_features(const Options& a, const Options& b) {
  return a.straighten == b.straighten && (!a.seamless || a.seamless->feature_places == b.seamless->feature_places);
}

bool is_same(const ComponentCones& a, const ComponentCones& b) {
  const auto& [vertices, angles, border, loop_turning, holes, range, rotation_order, mirroring] = a;
  return vertices == b.vertices && angles == b.angles && border == b.border && loop_turning == b.loop_turning &&
         holes == b.holes && range.smallest == b.range.smallest && range.largest == b.range.largest &&
         range.widened == b.range.widened && rotation_order == b.rotation_order && mirroring.image == b.mirroring.image;
}

bool is_same(const ComponentTask& a, const ComponentTask& b) {
  const auto& [cones, border_cones, pinned_corners, importance, directions, has_directed_borders, may_be_strip,
               is_strip, strokes_price] = a;
  return is_same(cones, b.cones) && border_cones == b.border_cones && pinned_corners == b.pinned_corners &&
         is_equal(importance, b.importance) && is_equal(directions.along_first, b.directions.along_first) &&
         is_equal(directions.along_last, b.directions.along_last) && is_equal(directions.weight, b.directions.weight) &&
         has_directed_borders == b.has_directed_borders && may_be_strip == b.may_be_strip && is_strip == b.is_strip &&
         strokes_price == b.strokes_price;
}

// Images say what is symmetric, strokes are followed by what was placed without regard to them, and what becomes a
// strip gets no cones by their count.
bool is_same(const PlacementInput& a, const PlacementInput& b) {
  const auto& [count, most, target, lattice, prefer_sharp, symmetric, mirror, follow_strokes, seams, border,
               without_noise, hard_repairs, threads] = a.options;
  return is_same(a.existing, b.existing) && a.allowed == b.allowed && a.mirrored == b.mirrored &&
         is_equal(a.directions, b.directions) && count == b.options.count && most == b.options.most &&
         target == b.options.target && lattice == b.options.lattice && prefer_sharp == b.options.prefer_sharp &&
         seams == b.options.seams && without_noise == b.options.without_noise && hard_repairs == b.options.hard_repairs;
}

template <typename Entry>
void drop_earliest(Array<Entry>& entries) {
  if (entries.size() == most_kept) entries.erase(entries.begin());
}

// Whether straight sides are a matter of a map, and not only of its lattice: cuts would have to fit that as well.
bool may_have_straight_sides(const MapResult& kept) { return kept.map && kept.map->map.cut_graph.cuts.empty(); }

}  // namespace

MapResult& ComponentResults::of_map(const ComponentTask& task, const Options& options) {
  const auto known = std::find_if(maps_.begin(), maps_.end(), [&](const OfMap& kept) {
    return is_same(kept.task, task) && has_same_maps(kept.options, options) &&
           (kept.options.straighten == options.straighten || !may_have_straight_sides(kept.result));
  });
  if (known == maps_.end()) {
    drop_earliest(maps_);
    maps_.push_back({task, options, {}});
    return maps_.back().result;
  }
  if (!has_same_features(known->options, options)) known->result.alignment.reset();
  known->options = options;
  return known->result;
}

const PlacementResult* ComponentResults::find_placement(const PlacementInput& input) const {
  const auto known = std::find_if(placements_.begin(), placements_.end(),
                                  [&](const OfPlacement& kept) { return is_same(kept.input, input); });
  return known == placements_.end() ? nullptr : &known->result;
}

void ComponentResults::keep_placement(PlacementInput input, PlacementResult result) {
  drop_earliest(placements_);
  placements_.push_back({std::move(input), std::move(result)});
}

bool is_same(const Component& a, const Component& b) {
  const HalfedgeMesh &mesh = a.mesh, &other = b.mesh;
  return a.orientable == b.orientable && a.source_vertex == b.source_vertex && a.source_triangle == b.source_triangle &&
         a.reversed == b.reversed && is_equal(mesh.positions, other.positions) && is_equal(mesh.scale, other.scale) &&
         is_equal(mesh.triangles, other.triangles) && mesh.twin == other.twin && mesh.outgoing == other.outgoing &&
         mesh.cuttable == other.cuttable && mesh.seam == other.seam && mesh.feature == other.feature &&
         mesh.is_feature_junction == other.is_feature_junction && mesh.cut_factor == other.cut_factor &&
         mesh.boundary_loops == other.boundary_loops;
}

}  // namespace lsgp

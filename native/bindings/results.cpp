// SPDX-License-Identifier: GPL-3.0-or-later
#include "results.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include "new_arrays.hpp"

py::dict to_dict(const lsgp::Distortion& distortion) {
  py::dict out;
  out["quasi_conformal"] = distortion.quasi_conformal;
  out["quasi_conformal_area_weighted"] = distortion.quasi_conformal_area_weighted;
  out["area"] = distortion.area;
  out["area_p10"] = distortion.area_p10;
  out["area_p90"] = distortion.area_p90;
  out["l2_stretch"] = distortion.l2_stretch;
  return out;
}

py::dict to_dict(const lsgp::SeamQuality& seams) {
  py::dict out;
  out["sister_ratio_max"] = seams.sister_ratio_max;
  out["rotation_residual"] = seams.rotation_residual;
  out["translation_residual"] = seams.translation_residual;
  return out;
}

namespace {

py::dict to_dict(const lsgp::RepairReport& repair) {
  py::dict out;
  out["flipped_before"] = repair.flipped_before;
  out["wrong_angle_sums_before"] = repair.wrong_angle_sums_before;
  out["iterations"] = repair.iterations;
  return out;
}

// The fields of lsgp.SeamlessReport.
py::dict to_dict(const lsgp::SeamlessReport& report) {
  std::vector<Index> nodes, turns;
  std::vector<std::int64_t> translations;
  std::vector<double> errors;
  for (const lsgp::SeamlessCut& cut : report.cuts) {
    nodes.insert(nodes.end(), {cut.tail, cut.head});
    turns.push_back(cut.turns);
    translations.insert(translations.end(), cut.translation.begin(), cut.translation.end());
    errors.push_back(cut.error);
  }
  const auto count = static_cast<py::ssize_t>(report.cuts.size());
  py::dict out;
  out["rotation_order"] = report.rotation_order;
  out["tiles"] = report.tiles;
  out["tile_size"] = report.tile_size;
  out["cell"] = report.cell;
  out["energy_before"] = report.energy_before;
  out["energy_after"] = report.energy_after;
  out["cut_nodes"] = to_array(nodes.data(), {count, 2});
  out["cut_turns"] = to_array(turns);
  out["cut_translations"] = to_array(translations.data(), {count, 2});
  out["cut_errors"] = to_array(errors);
  out["error"] = report.error;
  out["flat_cones"] = to_array(report.flat_cones);
  out["merged_cones"] = to_array(report.merged_cones);
  out["feature_share"] = report.feature_share;
  out["creases"] = to_array(report.creases.data(), {static_cast<py::ssize_t>(report.creases.size() / 2), 2});
  out["is_crease_aligned"] = to_array(report.is_crease_aligned).attr("astype")("bool");
  out["relaxed_cones"] = to_array(report.relaxed_cones);
  return out;
}

py::list to_names(const std::vector<lsgp::CutPathKind>& kinds) {
  constexpr std::array names{"seam", "required", "added"};
  py::list out;
  for (const lsgp::CutPathKind kind : kinds) out.append(names[static_cast<std::size_t>(kind)]);
  return out;
}

// The fields of lsgp.FeatureReport.
py::dict to_dict(const lsgp::FeatureReport& report) {
  constexpr std::array names{"curved", "contradiction", "stretch", "lattice", "unsupported"};
  py::list released;
  for (const lsgp::ReleasedFeature& feature : report.released) {
    py::dict of;
    of["path"] = to_array(feature.path);
    of["reason"] = names[static_cast<std::size_t>(feature.reason)];
    of["share"] = feature.share;
    released.append(of);
  }
  py::dict out;
  out["share"] = report.share;
  out["released"] = released;
  return out;
}

}  // namespace

py::dict to_dict(const lsgp::Result& result) {
  auto solved = new_array<bool>({static_cast<py::ssize_t>(result.island.size())});
  for (std::size_t f = 0; f < result.island.size(); ++f) solved.mutable_at(f) = result.island[f] >= 0;
  py::dict seconds;
  for (const auto& [stage, spent] : result.stage_seconds) seconds[stage.c_str()] = spent;
  py::dict out;
  out["corner_uv"] = to_array(result.corner_uv.data(), {static_cast<py::ssize_t>(result.island.size()), 3, 2});
  out["solved"] = solved;
  out["island"] = to_array(result.island);
  out["cut_edges"] = to_array(result.cut_edges);
  out["required_cuts"] = to_array(result.required_cuts);
  out["cut_paths"] = to_arrays(result.cut_paths);
  out["cut_kinds"] = to_names(result.cut_kinds);
  out["cones"] = to_array(result.cones);
  out["cone_angles"] = to_array(result.cone_angles);
  out["distortion"] = to_dict(result.distortion);
  out["seams"] = to_dict(result.seams);
  out["flipped"] = to_array(result.flipped);
  out["wrong_angle_sums"] = to_array(result.wrong_angle_sums);
  out["overlapping"] = to_array(result.overlapping);
  out["overlap_area"] = result.overlap_area;
  out["repair"] = to_dict(result.repair);
  out["cone_angle_error"] = result.cone_angle_error;
  out["log_scale"] = to_array(result.log_scale);
  out["direction_errors"] =
      result.direction_errors.size() > 0 ? py::object(to_array(result.direction_errors)) : py::none();
  out["direction_error"] = result.direction_error;
  out["seamless"] = result.seamless ? py::object(to_dict(*result.seamless)) : py::none();
  out["features"] = result.features ? py::object(to_dict(*result.features)) : py::none();
  out["warnings"] = to_findings(result.warnings);
  out["stage_seconds"] = seconds;
  out["factorizations"] = result.linear_algebra.factorizations;
  out["back_substitutions"] = result.linear_algebra.back_substitutions;
  return out;
}

py::dict to_dict(const lsgp::Placement& result) {
  py::dict out;
  out["cones"] = to_array(result.cones);
  out["cone_angles"] = to_array(result.cone_angles);
  out["log_scale"] = to_array(result.log_scale);
  out["predicted_l2"] = result.predicted_l2;
  out["mapped_l2"] = result.mapped_l2;
  out["reached"] = result.reached;
  out["maps"] = result.maps;
  out["warnings"] = to_findings(result.warnings);
  out["factorizations"] = result.linear_algebra.factorizations;
  out["back_substitutions"] = result.linear_algebra.back_substitutions;
  return out;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calls.hpp"
#include "lsgp/lsgp.hpp"
#include "new_arrays.hpp"
#include "options.hpp"
#include "results.hpp"
#include "surfaces.hpp"
#include "verbs.hpp"

namespace {

py::typing::Tuple<IndexArray, FloatArray> feature_cones(const SurfaceArrays& surface_arrays, bool with_creases,
                                                        const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::Cones found = without_gil([&] { return lsgp::feature_cones(surface, with_creases, tell); });
  std::vector<double> angles;
  for (const std::optional<double>& angle : found.angles) angles.push_back(*angle);
  return py::make_tuple(to_array(found.vertices), to_array(angles));
}

py::dict prescribe_curvature(const SurfaceArrays& surface_arrays, const ConeArrays& cones,
                             const py::dict& option_values, const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Cones wanted = to_cones(cones);
  const lsgp::Options options = to_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::Prescription result =
      without_gil([&] { return lsgp::prescribe_curvature(surface, wanted, options, tell); });
  py::dict out;
  out["cones"] = to_array(result.cones);
  out["cone_angles"] = to_array(result.cone_angles);
  out["log_scale"] = to_array(result.log_scale);
  out["predicted_l2"] = result.predicted_l2;
  out["warnings"] = to_findings(result.warnings);
  return out;
}

py::typing::List<py::dict> build_ledger(const SurfaceArrays& surface_arrays, const ConeArrays& cones,
                                        const py::dict& option_values, bool gets_cones) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Cones given = to_cones(cones);
  const lsgp::Options options = to_options(option_values);
  const auto of = gets_cones ? lsgp::LedgerOf::placement : lsgp::LedgerOf::map;
  py::typing::List<py::dict> out;
  for (const lsgp::LedgerPart& part : without_gil([&] { return lsgp::build_ledger(surface, given, options, of); })) {
    py::dict values;
    values["triangles"] = to_array(part.triangles);
    values["cones"] = to_array(part.cones);
    values["curvature"] = to_array(part.curvature);
    values["euler"] = part.euler;
    values["borders"] = part.borders;
    values["assigned"] = part.assigned;
    values["required"] = part.required;
    values["border_takes_up"] = part.border_takes_up;
    values["room"] = py::make_tuple(part.room[0], part.room[1]);
    out.append(values);
  }
  return out;
}

py::dict place_cones(const SurfaceArrays& surface_arrays, const ConeArrays& cones, const py::dict& option_values,
                     const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Cones existing = to_cones(cones);
  const lsgp::PlacementOptions options = to_placement_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return to_dict(without_gil([&] { return lsgp::place_cones(surface, existing, options, tell); }));
}

py::dict cone_gains(const SurfaceArrays& surface_arrays, const ConeArrays& cones, const std::string& seam_mode,
                    const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Cones existing = to_cones(cones);
  const lsgp::SeamMode mode = to_seam_mode(seam_mode);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::ConeGains result = without_gil([&] { return lsgp::cone_gains(surface, existing, mode, tell); });
  py::dict out;
  out["predicted_l2"] = to_array(result.predicted_l2);
  out["present_l2"] = result.present_l2;
  out["best"] = result.best < 0 ? py::object(py::none()) : py::int_(result.best);
  out["warnings"] = to_findings(result.warnings);
  return out;
}

}  // namespace

void define_cones(py::module_& module) {
  using py::literals::operator""_a;
  module.def("feature_cones", &feature_cones, "surface"_a, "with_creases"_a, "progress"_a);
  module.def("prescribe_curvature", &prescribe_curvature, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("build_ledger", &build_ledger, "surface"_a, "cones"_a, "options"_a, "gets_cones"_a);
  module.def("place_cones", &place_cones, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("cone_gains", &cone_gains, "surface"_a, "cones"_a, "seam_mode"_a, "progress"_a);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "calls.hpp"
#include "lsgp/lsgp.hpp"
#include "made_objects.hpp"
#include "new_arrays.hpp"
#include "options.hpp"
#include "results.hpp"
#include "surfaces.hpp"
#include "verbs.hpp"

namespace {

// What the verb and the method of the solver take after the surface.
struct Call {
  lsgp::Cones cones;
  lsgp::Options options;
  lsgp::Pins pins;
  lsgp::Progress progress;

  Call(const ConeArrays& cones, const py::dict& option_values, const PinArrays& pins, const ProgressCallback& progress)
      : cones(to_cones(cones)),
        options(to_options(option_values)),
        pins(to_pins(pins)),
        progress(to_progress(progress)) {}
};

py::dict parameterize(const SurfaceArrays& surface_arrays, const ConeArrays& cones, const py::dict& option_values,
                      const PinArrays& pins, const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const Call call(cones, option_values, pins, progress);
  return to_dict(
      without_gil([&] { return lsgp::parameterize(surface, call.cones, call.options, call.pins, call.progress); }));
}

py::dict parameterize_again(lsgp::Solver& solver, const ConeArrays& cones, const py::dict& option_values,
                            const PinArrays& pins, const ProgressCallback& progress) {
  const Call call(cones, option_values, pins, progress);
  return to_dict(without_gil([&] { return solver.parameterize(call.cones, call.options, call.pins, call.progress); }));
}

py::dict parameterize_small(const lsgp::Preview& preview, const ConeArrays& cones, const py::dict& option_values,
                            const ProgressCallback& progress) {
  const lsgp::Cones wanted = to_cones(cones);
  const lsgp::Options options = to_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return to_dict(without_gil([&] { return preview.parameterize(wanted, options, tell); }));
}

py::dict place_cones_again(lsgp::Solver& solver, const ConeArrays& cones, const py::dict& option_values,
                           const ProgressCallback& progress) {
  const lsgp::Cones existing = to_cones(cones);
  const lsgp::PlacementOptions options = to_placement_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return to_dict(without_gil([&] { return solver.place_cones(existing, options, tell); }));
}

lsgp::CompletedCones complete_cones(lsgp::Solver& solver, const ConeArrays& cones, std::optional<int> count,
                                    double target, const py::dict& option_values, const ProgressCallback& progress) {
  const lsgp::Cones given = to_cones(cones);
  lsgp::CompletionOptions completion;
  completion.count = count;
  completion.target = target;
  const lsgp::MapOptions options = to_map_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return without_gil([&] { return lsgp::complete_cones(solver, given, completion, options, tell); });
}

std::optional<lsgp::CompletedCones> complete_feature_cones(lsgp::Solver& solver, double target,
                                                           const py::dict& option_values,
                                                           const ProgressCallback& progress) {
  const lsgp::MapOptions options = to_map_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return without_gil([&] { return lsgp::complete_feature_cones(solver, options, target, tell); });
}

// The map, and as "told" the findings of it and of the placement of its cones.
py::dict parameterize_through(lsgp::Solver& solver, const lsgp::CompletedCones& cones, const py::dict& option_values,
                              const ProgressCallback& progress) {
  const lsgp::Options options = to_map_options(option_values).through(cones.cones);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::Result result = without_gil([&] { return solver.parameterize(cones.cones, options, {}, tell); });
  py::dict out = to_dict(result);
  out["told"] = to_findings(lsgp::findings_of(cones, result, options));
  return out;
}

py::typing::List<py::dict> measure_charts(const SurfaceArrays& surface_arrays, const py::dict& option_values,
                                          const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Options options = to_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  py::typing::List<py::dict> out;
  for (const lsgp::Chart& chart : without_gil([&] { return lsgp::measure_charts(surface, options, tell); })) {
    py::dict of;
    of["triangles"] = to_array(chart.triangles);
    of["euler"] = chart.euler;
    of["borders"] = chart.borders;
    of["is_mapped"] = chart.is_mapped;
    of["l2_stretch"] = chart.l2_stretch;
    of["flipped"] = chart.flipped;
    of["overlapping"] = chart.overlapping;
    of["missing"] = to_array(chart.missing);
    out.append(of);
  }
  return out;
}

py::dict measure_distortion(const SurfaceArrays& surface_arrays, const FloatArray& corner_uv,
                            const std::optional<IndexArray>& cones, const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, surface.triangles.rows());
  const std::vector<Index> given = cones ? to_vector("cones", *cones) : std::vector<Index>{};
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::Measurement result =
      without_gil([&] { return lsgp::measure_distortion(surface, uv, cones ? &given : nullptr, tell); });
  py::dict out;
  out["distortion"] = to_dict(result.distortion);
  out["seams"] = to_dict(result.seams);
  out["flipped"] = to_array(result.flipped);
  out["cut_edges"] = to_array(result.cut_edges);
  out["island"] = to_array(result.island);
  return out;
}

}  // namespace

void define_maps(py::module_& module) {
  using py::literals::operator""_a;
  module.def("parameterize", &parameterize, "surface"_a, "cones"_a, "options"_a, "pins"_a, "progress"_a);
  py::class_<lsgp::CompletedCones>(module, "CompletedCones")
      .def_property_readonly("cones", [](const lsgp::CompletedCones& of) { return to_array(of.cones.vertices); })
      .def_property_readonly("angles", [](const lsgp::CompletedCones& of) { return of.cones.angles; })
      .def_property_readonly("placement", [](const lsgp::CompletedCones& of) {
        return of.placement ? std::optional<py::dict>(to_dict(*of.placement)) : std::nullopt;
      });
  py::class_<lsgp::Solver>(module, "Solver")
      .def(py::init([](const SurfaceArrays& surface, const lsgp::Solver* earlier) {
             return earlier == nullptr ? lsgp::Solver(to_surface(surface))
                                       : lsgp::Solver(to_surface(surface), *earlier);
           }),
           "surface"_a, "earlier"_a)
      .def("parameterize", &parameterize_again, "cones"_a, "options"_a, "pins"_a, "progress"_a)
      .def("place_cones", &place_cones_again, "cones"_a, "options"_a, "progress"_a)
      .def("complete_cones", &complete_cones, "cones"_a, "count"_a, "target"_a, "options"_a, "progress"_a)
      .def("complete_feature_cones", &complete_feature_cones, "target"_a, "options"_a, "progress"_a)
      .def("parameterize_through", &parameterize_through, "cones"_a, "options"_a, "progress"_a);
  py::class_<lsgp::Preview>(module, "Preview")
      .def(py::init([](const SurfaceArrays& surface, Index triangles, const ProgressCallback& progress) {
             lsgp::Surface given = to_surface(surface);
             const lsgp::Progress tell = to_progress(progress);
             return without_gil([&] { return lsgp::Preview(std::move(given), triangles, tell); });
           }),
           "surface"_a, "triangles"_a, "progress"_a)
      .def("parameterize", &parameterize_small, "cones"_a, "options"_a, "progress"_a);
  module.def("measure_charts", &measure_charts, "surface"_a, "options"_a, "progress"_a);
  module.def("measure_distortion", &measure_distortion, "surface"_a, "corner_uv"_a, "cones"_a, "progress"_a);
}

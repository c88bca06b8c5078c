// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "calls.hpp"
#include "lsgp/lsgp.hpp"
#include "new_arrays.hpp"
#include "options.hpp"
#include "results.hpp"
#include "surfaces.hpp"
#include "verbs.hpp"

namespace {

lsgp::Preset to_preset(const std::string& name) {
  return choose<lsgp::Preset>(
      name, {{"paint", lsgp::Preset::paint}, {"tile", lsgp::Preset::tile}, {"bake", lsgp::Preset::bake}});
}

lsgp::Weights to_weights(const py::dict& values) {
  const auto weight = [&](const char* name) { return values[name].cast<double>(); };
  return {weight("islands"), weight("cuts"),   weight("borders"), weight("cones"),
          weight("square"),  weight("strips"), weight("symmetry")};
}

// What a preset changes of the options of a map, its weights, and how long it looks for a layout.
py::dict preset(const std::string& name) {
  const lsgp::Preset chosen = to_preset(name);
  const lsgp::Options options = lsgp::preset_options(chosen).of_map;
  const lsgp::Weights weights = lsgp::preset_weights(chosen);
  using lsgp::Compactness, lsgp::Mode, lsgp::Overlaps;
  constexpr std::array compact{"off", "sparing", "full"}, efforts{"quick", "good", "best"};
  py::dict of_map, of_weights, out;
  of_map["mode"] = options.mode == Mode::low_stretch ? "low-stretch" : "conformal";
  of_map["straighten"] = options.straighten;
  of_map["overlaps"] = options.overlaps == Overlaps::split ? "split" : "keep";
  of_map["compact"] = compact[static_cast<std::size_t>(options.compact)];
  of_weights["islands"] = weights.islands;
  of_weights["cuts"] = weights.cuts;
  of_weights["borders"] = weights.borders;
  of_weights["cones"] = weights.cones;
  of_weights["square"] = weights.square;
  of_weights["strips"] = weights.strips;
  of_weights["symmetry"] = weights.symmetry;
  out["options"] = of_map;
  out["is_seamless"] = options.seamless.has_value();
  out["weights"] = of_weights;
  out["effort"] = efforts[static_cast<std::size_t>(lsgp::preset_effort(chosen))];
  return out;
}

// A dictionary with the arguments of lsgp.auto_unwrap that have a part in the choice.
lsgp::AutoUnwrapOptions to_auto_unwrap_options(const py::dict& values) {
  lsgp::AutoUnwrapOptions options;
  options.preset = to_preset(values["preset"].cast<std::string>());
  options.map = to_map_options(values["options"].cast<py::dict>());
  options.weights = to_weights(values["weights"].cast<py::dict>());
  options.count = values["count"].cast<std::optional<int>>();
  options.target = values["target"].cast<double>();
  options.symmetric = values["symmetric"].cast<bool>();
  options.charts = values["charts"].cast<bool>();
  options.creases = values["creases"].cast<bool>();
  options.seconds = values["seconds"].cast<std::optional<double>>();
  options.pack = false;
  return options;
}

// The map, where its surface ends, the placement of its cones, what it was chosen from, and its islands as they were
// packed for that.
py::dict auto_unwrap(const SurfaceArrays& surface_arrays, const ConeArrays& cones, const IndexArray& sharp,
                     const py::dict& option_values, const PinArrays& pin_arrays, const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Cones given = to_cones(cones);
  lsgp::AutoUnwrapOptions options = to_auto_unwrap_options(option_values);
  options.sharp = to_matrix<lsgp::VertexPairs>("sharp", sharp);
  const lsgp::Pins pins = to_pins(pin_arrays);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::Unwrapped found = without_gil([&] { return lsgp::auto_unwrap(surface, given, options, pins, tell); });
  py::list choices;
  for (const lsgp::Choice& choice : found.choices) {
    choices.append(py::make_tuple(choice.name, choice.estimate, choice.cost, choice.reason, choice.is_best));
  }
  py::dict out;
  out["result"] = to_dict(found.result);
  out["borders"] = to_array(found.borders);
  out["placement"] = found.placement ? py::object(to_dict(*found.placement)) : py::none();
  out["choices"] = choices;
  out["packed_quickly"] = py::none();
  if (const auto& packed = found.packed_quickly) {
    out["packed_quickly"] = to_array(packed->data(), {static_cast<py::ssize_t>(packed->rows() / 3), 3, 2});
  }
  return out;
}

}  // namespace

void define_presets(py::module_& module) {
  using py::literals::operator""_a;
  module.def("least_inside", [] { return lsgp::AutoUnwrapOptions::least_inside; });
  module.def("preset", &preset, "name"_a);
  module.def("auto_unwrap", &auto_unwrap, "surface"_a, "cones"_a, "sharp"_a, "options"_a, "pins"_a, "progress"_a);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "calls.hpp"
#include "lsgp/lsgp.hpp"
#include "new_arrays.hpp"
#include "options.hpp"
#include "surfaces.hpp"
#include "verbs.hpp"

namespace {

// A dictionary with the fields of lsgp::PackingOptions; locks: which islands keep place, rotation and scale.
lsgp::PackingOptions to_packing_options(const py::dict& values) {
  lsgp::PackingOptions options;
  options.margin = values["margin"].cast<double>();
  options.fill = values["fill"].cast<bool>();
  options.turns = choose<lsgp::IslandTurns>(
      values["turns"].cast<std::string>(),
      {{"none", lsgp::IslandTurns::none}, {"quarters", lsgp::IslandTurns::quarters}, {"any", lsgp::IslandTurns::any}});
  options.effort =
      choose<lsgp::PackingEffort>(values["effort"].cast<std::string>(), {{"quick", lsgp::PackingEffort::quick},
                                                                         {"good", lsgp::PackingEffort::good},
                                                                         {"best", lsgp::PackingEffort::best}});
  options.seconds = values["seconds"].cast<std::optional<double>>();
  if (!values["area"].is_none()) {
    const auto [left, bottom, right, top] = values["area"].cast<std::array<double, 4>>();
    options.area = lsgp::UvRectangle{left, bottom, right, top};
  }
  options.tiles = values["tiles"].cast<int>();
  options.snap = values["snap"].cast<double>();
  options.groups = to_vector("groups", values["groups"].cast<IndexArray>());
  const auto locks = values["locks"].cast<BoolArray>();
  const View<bool, 2> lock("locks", locks, {any_length, 3});
  for (py::ssize_t i = 0; i < lock.length(); ++i) options.locks.push_back({lock(i, 0), lock(i, 1), lock(i, 2)});
  return options;
}

FloatArray pack_islands(const FloatArray& corner_uv, const IndexArray& island, const py::dict& option_values,
                        const ProgressCallback& progress, const std::optional<FloatArray>& packed_quickly) {
  const std::vector<Index> islands = to_vector("island", island);
  const auto count = static_cast<py::ssize_t>(islands.size());
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, count);
  std::optional<lsgp::CornerUv> quick;
  if (packed_quickly) quick = to_corner_uv(*packed_quickly, count);
  const lsgp::PackingOptions options = to_packing_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::CornerUv packed =
      without_gil([&] { return lsgp::pack_islands(uv, islands, options, tell, quick ? &*quick : nullptr); });
  return to_array(packed.data(), {count, 3, 2});
}

py::dict shape_patches(const SurfaceArrays& surface_arrays, const FloatArray& corner_uv, const IndexArray& triangles,
                       const std::string& shape, const IndexArray& corners, const IndexArray& pinned,
                       const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, any_length);
  const lsgp::Progress tell = to_progress(progress);
  const auto wanted = choose<lsgp::PatchShape>(shape, {{"grid", lsgp::PatchShape::grid},
                                                       {"even-grid", lsgp::PatchShape::even_grid},
                                                       {"strip", lsgp::PatchShape::strip},
                                                       {"rectangle", lsgp::PatchShape::rectangle}});
  const lsgp::ShapeRequest request{to_vector("triangles", triangles), wanted, to_vector("corners", corners),
                                   to_vector("pinned", pinned)};
  const lsgp::ShapedMap shaped = without_gil([&] { return lsgp::shape_patches(surface, uv, request, tell); });
  py::dict out;
  out["corner_uv"] = to_array(shaped.corner_uv.data(), {static_cast<py::ssize_t>(shaped.corner_uv.rows() / 3), 3, 2});
  out["moved"] = to_array(shaped.moved);
  out["patches"] = shaped.patches;
  out["warnings"] = to_findings(shaped.warnings);
  return out;
}

double usual_margin(const FloatArray& corner_uv, const IndexArray& island, int tiles) {
  const std::vector<Index> islands = to_vector("island", island);
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, static_cast<py::ssize_t>(islands.size()));
  return without_gil([&] { return lsgp::usual_margin(uv, islands, tiles); });
}

IndexArray hidden_islands(const SurfaceArrays& surface_arrays, const IndexArray& island,
                          const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const std::vector<Index> islands = to_vector("island", island);
  const lsgp::Progress tell = to_progress(progress);
  return to_array(without_gil([&] { return lsgp::hidden_islands(surface, islands, tell); }));
}

py::array_t<Index> overlapping_triangles(const FloatArray& corner_uv) {
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, any_length);
  return to_array(without_gil([&] { return lsgp::overlapping_triangles(uv); }));
}

}  // namespace

void define_layouts(py::module_& module) {
  using py::literals::operator""_a;
  module.def("overlapping_triangles", &overlapping_triangles, "corner_uv"_a);
  module.def("shape_patches", &shape_patches, "surface"_a, "corner_uv"_a, "triangles"_a, "shape"_a, "corners"_a,
             "pinned"_a, "progress"_a);
  module.def("usual_margin", &usual_margin, "corner_uv"_a, "island"_a, "tiles"_a);
  module.def("hidden_islands", &hidden_islands, "surface"_a, "island"_a, "progress"_a);
  module.def("pack_islands", &pack_islands, "corner_uv"_a, "island"_a, "options"_a, "progress"_a, "packed_quickly"_a);
}

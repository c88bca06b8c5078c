// SPDX-License-Identifier: GPL-3.0-or-later
#include "calls.hpp"
#include "lsgp/lsgp.hpp"
#include "new_arrays.hpp"
#include "surfaces.hpp"
#include "verbs.hpp"

namespace {

void require_closed(const SurfaceArrays& surface_arrays) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  without_gil([&] { lsgp::require_closed(surface); });
}

// The fields of lsgp.QuadMesh.
py::dict to_dict(const lsgp::QuadMesh& mesh) {
  py::dict out;
  out["positions"] = to_array(mesh.positions.data(), {mesh.positions.rows(), 3});
  out["quads"] = to_array(mesh.quads.data(), {mesh.quads.rows(), 4});
  out["valences"] = to_array(mesh.valences);
  out["triangles"] = to_array(mesh.triangles);
  out["weights"] = to_array(mesh.weights.data(), {mesh.weights.rows(), 3});
  out["surface_vertices"] = to_array(mesh.surface_vertices);
  return out;
}

py::dict extract_quads(const SurfaceArrays& surface_arrays, const FloatArray& corner_uv, double cell,
                       const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, surface.triangles.rows());
  const lsgp::Progress tell = to_progress(progress);
  return to_dict(without_gil([&] { return lsgp::extract_quads(surface, uv, cell, tell); }));
}

}  // namespace

void define_quads(py::module_& module) {
  using py::literals::operator""_a;
  module.def("require_closed", &require_closed, "surface"_a);
  module.def("extract_quads", &extract_quads, "surface"_a, "corner_uv"_a, "cell"_a, "progress"_a);
}

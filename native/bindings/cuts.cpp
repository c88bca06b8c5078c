// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "calls.hpp"
#include "lsgp/lsgp.hpp"
#include "made_objects.hpp"
#include "new_arrays.hpp"
#include "options.hpp"
#include "surfaces.hpp"
#include "verbs.hpp"

namespace {

py::dict find_cuts(const SurfaceArrays& surface_arrays, const IndexArray& cones, const py::dict& option_values,
                   const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const std::vector<Index> wanted = to_vector("cones", cones);
  const lsgp::Options options = to_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::CutPaths cuts = without_gil([&] { return lsgp::find_cuts(surface, wanted, options, tell); });
  py::dict out;
  out["edges"] = to_array(cuts.edges);
  out["paths"] = to_arrays(cuts.paths);
  return out;
}

py::typing::List<IndexArray> split_into_paths(const IndexArray& edges, const IndexArray& nodes) {
  const auto pairs = to_matrix<lsgp::VertexPairs>("edges", edges);
  const std::vector<Index> ends = to_vector("nodes", nodes);
  return to_arrays(without_gil([&] { return lsgp::split_into_paths(pairs, ends); }));
}

// Front, creases, sharp edges and paint.
using CutPreferenceArrays = std::tuple<std::optional<std::array<double, 3>>, bool, IndexArray, FloatArray>;

lsgp::CutPreferences to_cut_preferences(const CutPreferenceArrays& arrays) {
  const auto& [front, creases, sharp, paint] = arrays;
  lsgp::CutPreferences preferences;
  if (front) preferences.front = Eigen::Vector3d((*front)[0], (*front)[1], (*front)[2]);
  preferences.creases = creases;
  preferences.sharp = to_matrix<lsgp::VertexPairs>("sharp", sharp);
  preferences.paint = to_vector_of_numbers("paint", paint);
  return preferences;
}

py::array_t<double> cut_costs(const SurfaceArrays& surface_arrays, const CutPreferenceArrays& preference_arrays,
                              const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::CutPreferences preferences = to_cut_preferences(preference_arrays);
  const lsgp::Progress tell = to_progress(progress);
  return to_array(without_gil([&] { return lsgp::cut_costs(surface, preferences, tell); }));
}

// Angle, sharp edges, the number of corners and the share of curvature.
using CreaseOptionArrays = std::tuple<double, IndexArray, Index, double>;

py::array_t<Index> crease_borders(const SurfaceArrays& surface_arrays, const IndexArray& cones,
                                  const CreaseOptionArrays& option_arrays, const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const std::vector<Index> marked = to_vector("cones", cones);
  const auto& [angle, sharp, most_corners, least_share] = option_arrays;
  const lsgp::CreaseOptions options{angle, to_matrix<lsgp::VertexPairs>("sharp", sharp), most_corners, least_share};
  const lsgp::Progress tell = to_progress(progress);
  return to_array(without_gil([&] { return lsgp::crease_borders(surface, marked, options, tell); }));
}

py::typing::Tuple<IndexArray, IndexArray> find_tubes(const SurfaceArrays& surface_arrays, const IndexArray& cones,
                                                     const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const std::vector<Index> marked = to_vector("cones", cones);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::Tubes found = without_gil([&] { return lsgp::find_tubes(surface, marked, tell); });
  return py::make_tuple(to_array(found.borders), to_array(found.triangles));
}

// A path, triangles and powers, and pairs of corners.
py::dict move_through(const lsgp::GrabbedCut& grabbed, Index vertex) {
  const lsgp::ReroutedCut moved = without_gil([&] { return grabbed.through(vertex); });
  py::dict out;
  out["path"] = to_array(moved.path);
  out["triangles"] = to_array(moved.triangles);
  out["powers"] = to_array(moved.powers);
  out["joins"] = to_array(moved.joins.data(), {static_cast<py::ssize_t>(moved.joins.size() / 2), 2});
  return out;
}

lsgp::GrabbedCut grab(const lsgp::CutRouter& router, const IndexArray& cuts, const IndexArray& path,
                      const IndexArray& nodes) {
  const auto edges = to_matrix<lsgp::VertexPairs>("cuts", cuts);
  const std::vector<Index> vertices = to_vector("path", path), kept_off = to_vector("nodes", nodes);
  return without_gil([&] { return router.grab(edges, vertices, kept_off); });
}

}  // namespace

void define_cuts(py::module_& module) {
  using py::literals::operator""_a;
  py::class_<lsgp::GrabbedCut>(module, "GrabbedCut")
      .def_property_readonly("left", [](const lsgp::GrabbedCut& grabbed) { return to_array(grabbed.left()); })
      .def_property_readonly("right", [](const lsgp::GrabbedCut& grabbed) { return to_array(grabbed.right()); })
      .def("through", &move_through, "vertex"_a);
  py::class_<lsgp::CutRouter>(module, "CutRouter")
      .def(py::init([](const SurfaceArrays& surface) {
             lsgp::Surface given = to_surface(surface);
             return without_gil([&] { return lsgp::CutRouter(std::move(given)); });
           }),
           "surface"_a)
      .def("grab", &grab, "cuts"_a, "path"_a, "nodes"_a);
  module.def("find_cuts", &find_cuts, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("split_into_paths", &split_into_paths, "edges"_a, "nodes"_a);
  module.def("crease_borders", &crease_borders, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("find_tubes", &find_tubes, "surface"_a, "cones"_a, "progress"_a);
  module.def("cut_costs", &cut_costs, "surface"_a, "preferences"_a, "progress"_a);
}

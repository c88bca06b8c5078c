// SPDX-License-Identifier: GPL-3.0-or-later
// The native verbs over numpy arrays: checked views in, owning arrays out, the GIL released while computing.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <new>

#include "arrays.hpp"
#include "binary_rows.hpp"
#include "ear_clipping.hpp"
#include "lsgp/lsgp.hpp"
#include "mesh_text.hpp"
#include "polygons.hpp"

namespace py = pybind11;

namespace {

using lsgp::Index;

using FloatArray = Numbers;
using IndexArray = Vertices;
using BoolArray = Marks;

template <typename Matrix, typename Array>
Matrix to_matrix(const char* name, const Array& array) {
  using Scalar = typename Matrix::Scalar;
  const View<Scalar, 2> view(name, array, {any_length, Matrix::ColsAtCompileTime});
  return Eigen::Map<const Matrix>(view.data(), view.length(0), view.length(1));
}

std::vector<Index> to_vector(const char* name, const IndexArray& array) {
  const View<Index, 1> view(name, array, {any_length});
  return {view.begin(), view.end()};
}

Eigen::VectorXd to_vector_of_numbers(const char* name, const FloatArray& array) {
  const View<double, 1> view(name, array, {any_length});
  return Eigen::Map<const Eigen::VectorXd>(view.data(), view.size());
}

// triangle_count: any_length where it is not known.
lsgp::CornerUv to_corner_uv(const FloatArray& array, py::ssize_t triangle_count) {
  const View<double, 3> view("corner_uv", array, {triangle_count, 3, 2});
  return Eigen::Map<const lsgp::CornerUv>(view.data(), 3 * view.length(), 2);
}

// Positions, triangles, edges, seams, importance, costs of cuts along the edges, borders, directions, features,
// whether triangles may collapse, and the scale.
using SurfaceArrays = std::tuple<FloatArray, IndexArray, std::optional<IndexArray>, IndexArray, FloatArray, FloatArray,
                                 IndexArray, FloatArray, IndexArray, bool, FloatArray>;

lsgp::Surface to_surface(const SurfaceArrays& arrays) {
  const auto& [positions, triangles, edges, seams, importance, cut_costs, borders, directions, features, may_collapse,
               scale] = arrays;
  lsgp::Surface surface;
  surface.positions = to_matrix<lsgp::Positions>("positions", positions);
  surface.triangles = to_matrix<lsgp::Triangles>("triangles", triangles);
  if (edges) surface.edges = to_matrix<lsgp::VertexPairs>("edges", *edges);
  surface.seams = to_matrix<lsgp::VertexPairs>("seams", seams);
  surface.borders = to_matrix<lsgp::VertexPairs>("borders", borders);
  surface.features = to_matrix<lsgp::VertexPairs>("features", features);
  surface.importance = to_vector_of_numbers("importance", importance);
  surface.cut_costs = to_vector_of_numbers("cut_costs", cut_costs);
  surface.directions = to_matrix<lsgp::Positions>("directions", directions);
  surface.may_collapse = may_collapse;
  surface.scale = to_vector_of_numbers("scale", scale);
  return surface;
}

// Vertices, angles, and which of them are given.
using ConeArrays = std::tuple<IndexArray, FloatArray, BoolArray>;

lsgp::Cones to_cones(const ConeArrays& arrays) {
  const auto& [vertices, angles, has_angle] = arrays;
  const View<double, 1> angle("angles", angles, {any_length});
  const View<bool, 1> is_given("has_angle", has_angle, {angle.length()});
  lsgp::Cones cones{to_vector("cones", vertices), {}};
  for (py::ssize_t i = 0; i < angle.length(); ++i) {
    cones.angles.push_back(is_given(i) ? std::optional<double>(angle(i)) : std::nullopt);
  }
  return cones;
}

// Throws OUT_OF_MEMORY where numpy has a MemoryError.
template <typename Scalar>
py::array_t<Scalar> new_array(std::vector<py::ssize_t> shape) {
  double bytes = sizeof(Scalar);
  for (const py::ssize_t length : shape) bytes *= static_cast<double>(length);
  try {
    return py::array_t<Scalar>(std::move(shape));
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_MemoryError)) throw;
    constexpr double megabyte = 1e6;
    throw lsgp::Error(lsgp::Code::out_of_memory,
                      "A part of the result needs " + std::to_string(std::lround(bytes / megabyte)) +
                          " MB of memory, which are not left. Unwrap fewer faces at once, or close other programs.");
  }
}

template <typename Scalar>
py::array_t<Scalar> to_array(const Scalar* data, std::vector<py::ssize_t> shape) {
  py::array_t<Scalar> out = new_array<Scalar>(std::move(shape));
  if (out.size() > 0) std::memcpy(out.mutable_data(), data, sizeof(Scalar) * static_cast<std::size_t>(out.size()));
  return out;
}

template <typename Scalar>
py::array_t<Scalar> to_array(const std::vector<Scalar>& values) {
  return to_array(values.data(), {static_cast<py::ssize_t>(values.size())});
}

py::array_t<double> to_array(const Eigen::VectorXd& values) { return to_array(values.data(), {values.size()}); }

py::array_t<Index> to_array(const lsgp::VertexPairs& pairs) { return to_array(pairs.data(), {pairs.rows(), 2}); }

py::typing::List<IndexArray> to_arrays(const std::vector<std::vector<Index>>& lists) {
  py::typing::List<IndexArray> out;
  for (const std::vector<Index>& list : lists) out.append(to_array(list));
  return out;
}

py::object to_elements(const lsgp::Elements& elements) {
  const auto count = static_cast<py::ssize_t>(elements.indices.size());
  const bool pairs = elements.kind == lsgp::ElementKind::edges;
  return py::module_::import("lsgp.errors")
      .attr("Elements")(lsgp::name(elements.kind),
                        pairs ? to_array(elements.indices.data(), {count / 2, 2}) : to_array(elements.indices));
}

py::list to_findings(const std::vector<lsgp::Finding>& findings) {
  py::list out;
  const py::object type = py::module_::import("lsgp.errors").attr("Finding");
  for (const lsgp::Finding& finding : findings) {
    out.append(type(lsgp::name(finding.code), finding.message, to_elements(finding.elements)));
  }
  return out;
}

const char* exception_name(lsgp::ErrorKind kind) {
  switch (kind) {
    case lsgp::ErrorKind::input: return "InputError";
    case lsgp::ErrorKind::topology: return "TopologyError";
    case lsgp::ErrorKind::curvature: return "CurvatureError";
    case lsgp::ErrorKind::solver: return "SolverError";
    case lsgp::ErrorKind::cancelled: return "Cancelled";
  }
  return "LsgpError";
}

// Or what Python raises meanwhile, as KeyboardInterrupt.
void raise_in_python(const lsgp::Error& error) {
  try {
    const py::object type = py::module_::import("lsgp.errors").attr(exception_name(lsgp::error_kind(error.code())));
    const py::object exception = type(lsgp::name(error.code()), error.what(), to_elements(error.elements()));
    PyErr_SetObject(type.ptr(), exception.ptr());
  } catch (py::error_already_set& raised) {
    raised.restore();
  }
}

// Calls a verb without the GIL.
template <typename Verb>
auto without_gil(Verb verb) {
  py::gil_scoped_release release;
  return verb();
}

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

py::dict to_dict(const lsgp::RepairReport& repair) {
  py::dict out;
  out["flipped_before"] = repair.flipped_before;
  out["wrong_angle_sums_before"] = repair.wrong_angle_sums_before;
  out["iterations"] = repair.iterations;
  return out;
}

template <typename Choice>
Choice choose(const std::string& text, std::initializer_list<std::pair<const char*, Choice>> choices) {
  for (const auto& [name, choice] : choices) {
    if (text == name) return choice;
  }
  throw py::value_error("unknown choice '" + text + "'");
}

lsgp::SeamMode to_seam_mode(const std::string& name) {
  using lsgp::SeamMode;
  return choose<SeamMode>(name, {{"follow", SeamMode::follow},
                                 {"exact", SeamMode::exact},
                                 {"boundary", SeamMode::boundary},
                                 {"ignore", SeamMode::ignore}});
}

lsgp::BorderMode to_border_mode(const std::string& name) {
  using lsgp::BorderMode;
  return choose<BorderMode>(
      name, {{"free", BorderMode::free}, {"straight", BorderMode::straight}, {"strips", BorderMode::strips}});
}

lsgp::Lattice to_lattice(const std::string& name) {
  using lsgp::Lattice;
  return choose<Lattice>(name, {{"square", Lattice::square},
                                {"stripe", Lattice::stripe},
                                {"translation", Lattice::translation},
                                {"triangle", Lattice::triangle},
                                {"hexagon", Lattice::hexagon}});
}

// A dictionary with the fields of lsgp.Seamless.
lsgp::Seamless to_seamless(const py::dict& values) {
  using lsgp::CoarseGrid;
  using lsgp::FeaturePlaces;
  lsgp::Seamless seamless;
  seamless.lattice = to_lattice(values["lattice"].cast<std::string>());
  seamless.tiles = values["tiles"].cast<std::optional<double>>();
  seamless.tile_size = values["tile_size"].cast<std::optional<double>>();
  seamless.parity = values["parity"].cast<bool>();
  seamless.feature_places = choose<FeaturePlaces>(
      values["feature_places"].cast<std::string>(),
      {{"anywhere", FeaturePlaces::anywhere}, {"half", FeaturePlaces::half}, {"whole", FeaturePlaces::whole}});
  seamless.coarse_grid =
      choose<CoarseGrid>(values["coarse_grid"].cast<std::string>(),
                         {{"refine", CoarseGrid::refine}, {"merge", CoarseGrid::merge}, {"relax", CoarseGrid::relax}});
  seamless.cell = values["cell"].cast<double>();
  return seamless;
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

// A dictionary with the fields of lsgp.Options.
lsgp::Options to_options(const py::dict& values) {
  const auto text = [&](const char* field) { return values[field].cast<std::string>(); };
  lsgp::Options options;
  using lsgp::Method, lsgp::PrescriptionRule, lsgp::UnfoldMethod;
  if (!values["prescription"].is_none()) {
    options.prescription =
        choose<PrescriptionRule>(text("prescription"), {{"least-distortion", PrescriptionRule::least_distortion},
                                                        {"harmonic", PrescriptionRule::harmonic},
                                                        {"straightness", PrescriptionRule::straightness},
                                                        {"manual", PrescriptionRule::manual}});
  }
  options.unfold =
      choose<UnfoldMethod>(text("unfold"), {{"poisson", UnfoldMethod::poisson}, {"spectral", UnfoldMethod::spectral}});
  options.method = choose<Method>(text("method"), {{"lsgp", Method::lsgp}, {"lscm", Method::lscm}});
  options.seams = to_seam_mode(text("seams"));
  options.border = to_border_mode(text("border"));
  for (const auto& [vertex, turning] : values["loop_turning"].cast<py::dict>()) {
    options.loop_turning.emplace_back(vertex.cast<Index>(), turning.cast<double>());
  }
  using lsgp::Compactness, lsgp::Factorization, lsgp::Mode, lsgp::Overlaps;
  options.mode = choose<Mode>(text("mode"), {{"conformal", Mode::conformal}, {"low-stretch", Mode::low_stretch}});
  options.stretch = values["stretch"].cast<double>();
  options.straighten = values["straighten"].cast<bool>();
  options.repair = values["repair"].cast<bool>();
  options.overlaps = choose<Overlaps>(text("overlaps"), {{"keep", Overlaps::keep}, {"split", Overlaps::split}});
  options.compact = choose<Compactness>(
      text("compact"), {{"off", Compactness::off}, {"sparing", Compactness::sparing}, {"full", Compactness::full}});
  options.mirrored_cuts = values["mirrored_cuts"].cast<bool>();
  options.follow_strokes = values["follow_strokes"].cast<bool>();
  options.square_share = values["square_share"].cast<double>();
  options.factorization = choose<Factorization>(
      text("factorization"),
      {{"automatic", Factorization::automatic}, {"cut", Factorization::cut}, {"sparse", Factorization::sparse}});
  options.threads = values["threads"].cast<int>();
  if (!values["seamless"].is_none()) options.seamless = to_seamless(values["seamless"].cast<py::dict>());
  return options;
}

// The same, of maps whose rule for angles follows from their cones where the dictionary has none.
lsgp::MapOptions to_map_options(const py::dict& values) {
  lsgp::MapOptions options{to_options(values), {}};
  if (!values["prescription"].is_none()) options.prescription = options.of_map.prescription;
  return options;
}

// Python handles signals, such as that of Ctrl-C, only between its own instructions, and a running verb executes none.
void require_no_signal() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

bool is_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  return threading.attr("get_ident")().equal(threading.attr("main_thread")().attr("ident"));
}

// Without a callback progress only checks for signals, all of which go to the main thread.
lsgp::Progress watch_for_signals() {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between_looks(50);
  if (!is_main_thread()) return {};
  return [next = Clock::now() + between_looks](double) mutable {
    if (Clock::now() < next) return true;
    const py::gil_scoped_acquire acquire;
    require_no_signal();
    next = Clock::now() + between_looks;
    return true;
  };
}

// Whether a callback's answer is False, also as a bool of numpy; nothing else stops the work.
bool is_false(const py::object& answer) {
  py::detail::make_caster<bool> given;
  return given.load(answer, /*convert=*/false) && !py::detail::cast_op<bool>(given);
}

// Gets the fraction done. The verb stops if it returns False or raises an exception, and at a signal.
using ProgressCallback = std::optional<py::typing::Callable<std::optional<bool>(double)>>;

lsgp::Progress to_progress(const ProgressCallback& callback) {
  if (!callback) return watch_for_signals();
  return [&callback](double done) {
    const py::gil_scoped_acquire acquire;
    require_no_signal();
    return !is_false((*callback)(done));
  };
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

// Corners and their positions.
using PinArrays = std::tuple<IndexArray, FloatArray>;

lsgp::Pins to_pins(const PinArrays& arrays) {
  const auto& [corners, uv] = arrays;
  return {to_vector("pinned corners", corners), to_matrix<lsgp::CornerUv>("pinned uv", uv)};
}

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

// A dictionary with the fields of lsgp.api's placement options.
lsgp::PlacementOptions to_placement_options(const py::dict& values) {
  lsgp::PlacementOptions options;
  options.count = values["count"].cast<std::optional<int>>();
  options.target = values["target"].cast<double>();
  if (!values["lattice"].is_none()) options.lattice = to_lattice(values["lattice"].cast<std::string>());
  options.prefer_sharp = values["prefer_sharp"].cast<bool>();
  options.symmetric = values["symmetric"].cast<bool>();
  if (!values["mirror"].is_none()) {
    const auto numbers = values["mirror"].cast<std::array<double, 6>>();
    options.mirror = {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
  }
  options.follow_strokes = values["follow_strokes"].cast<bool>();
  options.seams = to_seam_mode(values["seams"].cast<std::string>());
  options.border = to_border_mode(values["border"].cast<std::string>());
  options.threads = values["threads"].cast<int>();
  return options;
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

py::dict place_cones(const SurfaceArrays& surface_arrays, const ConeArrays& cones, const py::dict& option_values,
                     const ProgressCallback& progress) {
  const lsgp::Surface surface = to_surface(surface_arrays);
  const lsgp::Cones existing = to_cones(cones);
  const lsgp::PlacementOptions options = to_placement_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return to_dict(without_gil([&] { return lsgp::place_cones(surface, existing, options, tell); }));
}

py::dict place_cones_again(lsgp::Solver& solver, const ConeArrays& cones, const py::dict& option_values,
                           const ProgressCallback& progress) {
  const lsgp::Cones existing = to_cones(cones);
  const lsgp::PlacementOptions options = to_placement_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  return to_dict(without_gil([&] { return solver.place_cones(existing, options, tell); }));
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

lsgp::CompletedCones complete_cones(lsgp::Solver& solver, const ConeArrays& cones, std::optional<int> count,
                                    double target, const py::dict& option_values, const ProgressCallback& progress) {
  const lsgp::Cones given = to_cones(cones);
  const lsgp::CompletionOptions completion{count, target, false, {}};
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

// The map, where its surface ends, the placement of its cones, and what it was chosen from.
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
  return out;
}

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
                        const ProgressCallback& progress) {
  const std::vector<Index> islands = to_vector("island", island);
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, static_cast<py::ssize_t>(islands.size()));
  const lsgp::PackingOptions options = to_packing_options(option_values);
  const lsgp::Progress tell = to_progress(progress);
  const lsgp::CornerUv packed = without_gil([&] { return lsgp::pack_islands(uv, islands, options, tell); });
  return to_array(packed.data(), {static_cast<py::ssize_t>(islands.size()), 3, 2});
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

py::array_t<Index> overlapping_triangles(const FloatArray& corner_uv) {
  const lsgp::CornerUv uv = to_corner_uv(corner_uv, any_length);
  return to_array(without_gil([&] { return lsgp::overlapping_triangles(uv); }));
}

}  // namespace

PYBIND11_MODULE(_lsgp, module) {
  module.doc() = "Native verbs of lsgp; call them through the functions of the package.";
  // Of this module alone: other modules have a std::bad_alloc, too.
  py::register_local_exception_translator([](std::exception_ptr pending) {
    try {
      if (pending) std::rethrow_exception(pending);
    } catch (const lsgp::Error& error) {
      raise_in_python(error);
    } catch (const py::cast_error&) {  // an option of another type, or a number that does not fit
      py::set_error(PyExc_TypeError, "An option has a type that it cannot have, or a number beyond its range.");
    } catch (const std::bad_alloc&) {
      raise_in_python({lsgp::Code::out_of_memory,
                       "There is not enough memory. Unwrap fewer faces at once, or close other programs."});
    }
  });
  using py::literals::operator""_a;
  define_mesh_text(module);
  define_binary_rows(module);
  define_ear_clipping(module);
  define_polygons(module);
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
  module.def("overlapping_triangles", &overlapping_triangles, "corner_uv"_a);
  module.def("shape_patches", &shape_patches, "surface"_a, "corner_uv"_a, "triangles"_a, "shape"_a, "corners"_a,
             "pinned"_a, "progress"_a);
  module.def("usual_margin", &usual_margin, "corner_uv"_a, "island"_a, "tiles"_a);
  module.def("pack_islands", &pack_islands, "corner_uv"_a, "island"_a, "options"_a, "progress"_a);
  module.def("measure_charts", &measure_charts, "surface"_a, "options"_a, "progress"_a);
  module.def("preset", &preset, "name"_a);
  module.def("auto_unwrap", &auto_unwrap, "surface"_a, "cones"_a, "sharp"_a, "options"_a, "pins"_a, "progress"_a);
  module.def("find_cuts", &find_cuts, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("split_into_paths", &split_into_paths, "edges"_a, "nodes"_a);
  module.def("crease_borders", &crease_borders, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("find_tubes", &find_tubes, "surface"_a, "cones"_a, "progress"_a);
  module.def("feature_cones", &feature_cones, "surface"_a, "with_creases"_a, "progress"_a);
  module.def("cut_costs", &cut_costs, "surface"_a, "preferences"_a, "progress"_a);
  module.def("prescribe_curvature", &prescribe_curvature, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("build_ledger", &build_ledger, "surface"_a, "cones"_a, "options"_a, "gets_cones"_a);
  module.def("place_cones", &place_cones, "surface"_a, "cones"_a, "options"_a, "progress"_a);
  module.def("cone_gains", &cone_gains, "surface"_a, "cones"_a, "seam_mode"_a, "progress"_a);
  module.def("measure_distortion", &measure_distortion, "surface"_a, "corner_uv"_a, "cones"_a, "progress"_a);
  module.def("require_closed", &require_closed, "surface"_a);
  module.def("extract_quads", &extract_quads, "surface"_a, "corner_uv"_a, "cell"_a, "progress"_a);
}

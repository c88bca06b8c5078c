// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.hpp"

#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <optional>

using lsgp::Index;

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

namespace {

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

}  // namespace

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

lsgp::MapOptions to_map_options(const py::dict& values) {
  lsgp::MapOptions options{to_options(values), {}};
  if (!values["prescription"].is_none()) options.prescription = options.of_map.prescription;
  return options;
}

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

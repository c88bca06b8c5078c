// SPDX-License-Identifier: GPL-3.0-or-later
// What is told of maps through placed cones.
#include <doctest/doctest.h>

#include <vector>

#include "balls.hpp"
#include "choices/feature_choice.hpp"
#include "lsgp/lsgp.hpp"

using namespace lsgp;

namespace {

std::vector<Code> codes(const std::vector<Finding>& findings) {
  std::vector<Code> out;
  out.reserve(findings.size());
  for (const Finding& finding : findings) out.push_back(finding.code);
  return out;
}

CompletedCones placed_with(const Finding& finding) {
  CompletedCones out;
  out.placement = Placement{};
  out.placement->warnings = {finding};
  out.target = 1.05;
  return out;
}

// An empty map with this L2 stretch.
Result stretched(double l2_stretch) {
  Result out;
  out.distortion.l2_stretch = l2_stretch;
  return out;
}

// A box of two triangles a side.
Surface box() {
  Surface out;
  out.positions.resize(8, 3);
  for (int v = 0; v < 8; ++v) out.positions.row(v) << v % 2, v / 2 % 2, 2 * (v / 4);
  out.triangles.resize(12, 3);
  out.triangles << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1,
      7, 5;
  return out;
}

}  // namespace

TEST_CASE("a target that only the conformal map misses is not told") {
  const Finding missed{Code::placement_not_reached, "The target is not reached.", {}};
  CompletedCones cones = placed_with(missed);
  Options conformal, low_stretch;
  low_stretch.mode = Mode::low_stretch;
  const auto is_told = [&](const Result& result, const Options& options) {
    return !findings_of(cones, result, options).empty();
  };
  CHECK_FALSE(is_told(stretched(1.05), low_stretch));
  CHECK(is_told(stretched(1.051), low_stretch));
  CHECK(is_told(stretched(1.05), conformal));
  // Creases along the lattice may cost a tenth.
  Result seamless = stretched(1.1 * 1.05);
  seamless.seamless = SeamlessReport{};
  CHECK(is_told(seamless, conformal));
  seamless.seamless->feature_share = 0.5;
  CHECK_FALSE(is_told(seamless, conformal));
  seamless.distortion.l2_stretch += 1e-3;
  CHECK(is_told(seamless, conformal));
  // A number of cones is missed whatever the stretch is.
  cones.target.reset();
  CHECK(is_told(stretched(1.05), low_stretch));
}

TEST_CASE("what placement leaves out but has a map is not told to be left out") {
  const CompletedCones cones = placed_with({Code::component_skipped,
                                            "A component of the surface was left out (SOLVER_FAILED): There are none.",
                                            {ElementKind::triangles, {0, 1}}});
  Result result = stretched(2);
  result.island = {0, 0};
  const std::vector<Finding> told = findings_of(cones, result, {});
  REQUIRE(codes(told) == std::vector{Code::placement_not_reached});
  CHECK(told[0].message == "A component was unwrapped without placed cones: There are none.");
  CHECK(told[0].elements.indices == std::vector<Index>{0, 1});
  result.island = {0, -1};  // the map itself names the triangles that it leaves out of a component
  CHECK(codes(findings_of(cones, result, {})) == std::vector{Code::placement_not_reached});
  result.island = {-1, -1};
  CHECK(codes(findings_of(cones, result, {})) == std::vector{Code::component_skipped});
}

TEST_CASE("what placement and map both find is told once, and what cuts could not be is not") {
  const Finding both{Code::degenerate_faces, "There are some.", {}};
  const CompletedCones cones = placed_with(both);
  Result result = stretched(1);
  result.warnings = {{Code::cuts_not_mirrored, "They are not.", {}}, both};
  CHECK(codes(findings_of(cones, result, {})) == std::vector{Code::degenerate_faces});
}

TEST_CASE("placement ends without a map where it takes more cones than are wanted") {
  const Surface ball = uneven_ball(1000);
  PlacementOptions options;
  options.target = 1.005;
  const Placement whole = place_cones(ball, {}, options);
  REQUIRE(whole.reached);
  const int count = static_cast<int>(whole.cones.size());
  options.most = count / 2;
  const Placement left = place_cones(ball, {}, options);
  CHECK_FALSE(left.reached);
  CHECK(left.maps == 0);
  CHECK(static_cast<int>(left.cones.size()) > count / 2);
  options.most = 4 * count;
  const Placement same = place_cones(ball, {}, options);
  CHECK(same.cones == whole.cones);
  CHECK(same.cone_angles == whole.cone_angles);
}

TEST_CASE("the usual layout is made once where cones for creases admit none") {
  BorderedSurfaces surfaces(box());
  BorderedSurface& surface = *surfaces.first();
  MapOptions tile = preset_options(Preset::tile);
  const GivenCones given;
  const CompletedCones usual = complete_cones(surface.solver, {}, {}, tile);
  // Gauss-Bonnet requires more than one cone of half a turn.
  CompletedCones refused;
  refused.cones = {{usual.cones.vertices[0]}, {M_PI}};
  std::vector<std::size_t> tried;
  const Pins no_pins;
  const MapThrough maps = [&](const CompletedCones& cones, const MapOptions& options, const Progress& progress) {
    tried.push_back(cones.cones.vertices.size());
    return maps_of(surfaces.first(), no_pins)(cones, options, progress);
  };
  Objective objective({}, {});
  SymmetryChoice others(surface, maps, given, Symmetry::not_tried, objective);
  const Made made = FeatureMaps(surface.parts, maps, tile, objective).best_on_lattice(refused, others, {});
  const std::size_t count = usual.cones.vertices.size();
  CHECK(tried == std::vector<std::size_t>{1, count, count});  // the last one with its creases along the lattice
  CHECK(made->cones.cones.vertices == usual.cones.vertices);
  CHECK(made->result.corner_uv == parameterize(box(), usual.cones, tile.through(usual.cones)).corner_uv);
}

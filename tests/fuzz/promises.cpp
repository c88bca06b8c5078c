// SPDX-License-Identifier: GPL-3.0-or-later
#include "promises.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using lsgp::Code;
using lsgp::Index;

namespace {

std::vector<Index> named_by(const lsgp::Result& result, Code code) {
  std::vector<Index> out;
  for (const lsgp::Finding& finding : result.warnings) {
    if (finding.code == code) out.insert(out.end(), finding.elements.indices.begin(), finding.elements.indices.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool contains(const std::vector<Index>& sorted, Index value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

// Every triangle is skipped and named, or finite and turned the right way, or named as flipped.
void require_triangles(const lsgp::Result& result, Index count) {
  const std::vector<Index> skipped = named_by(result, Code::component_skipped);
  const std::vector<Index> reversed = named_by(result, Code::reoriented);
  const std::vector<Index> doubles = named_by(result, Code::duplicate_face);
  const std::vector<Index> flipped = named_by(result, Code::flipped_triangles);
  bool solved = false;
  for (Index f = 0; f < count; ++f) {
    const auto uv = result.corner_uv.middleRows<3>(3 * f);
    if (result.island[static_cast<std::size_t>(f)] < 0) {
      require(contains(skipped, f), "a triangle without a map that no warning names");
      require(uv.array().isNaN().all(), "coordinates of a triangle without a map");
      continue;
    }
    solved = true;
    require(!contains(skipped, f), "a triangle with a map that is reported as skipped");
    require(uv.allFinite(), "coordinates that are not finite");
    const double area = (uv(1, 0) - uv(0, 0)) * (uv(2, 1) - uv(0, 1)) - (uv(1, 1) - uv(0, 1)) * (uv(2, 0) - uv(0, 0));
    const bool up = contains(reversed, f) ? area < 0 : area > 0;
    require(up || contains(flipped, f) || contains(doubles, f), "a flipped triangle that no warning names");
  }
  require(solved, "a result without a map");
  require(flipped.size() == result.flipped.size(), "flipped triangles are listed but not named");
}

template <typename Matrix>
bool same_bytes(const Matrix& one, const Matrix& other) {
  using Scalar = typename Matrix::Scalar;
  return one.rows() == other.rows() && one.cols() == other.cols() &&
         (one.size() == 0 ||
          std::memcmp(one.data(), other.data(), sizeof(Scalar) * static_cast<std::size_t>(one.size())) == 0);
}

}  // namespace

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "fuzz_surface: %s\n", what);
  std::abort();
}

void require_elements(const std::vector<lsgp::Finding>& findings, const lsgp::Surface& surface) {
  for (const lsgp::Finding& finding : findings) {
    require(!finding.message.empty(), "a finding without a sentence");
    const bool triangles = finding.elements.kind == lsgp::ElementKind::triangles;
    const auto limit = triangles ? surface.triangles.rows() : surface.positions.rows();
    for (const Index i : finding.elements.indices) require(i >= 0 && i < limit, "a finding names what does not exist");
  }
}

void require_cones(const lsgp::Surface& surface, const std::vector<Index>& cones, const std::vector<double>& angles) {
  require(cones.size() == angles.size(), "cones and angles differ in number");
  for (const Index v : cones) require(v >= 0 && v < surface.positions.rows(), "a cone outside the surface");
  for (const double angle : angles) require(angle > 0 && std::isfinite(angle), "an impossible cone angle");
}

void require_honest(const lsgp::Surface& surface, const lsgp::Options& options, const lsgp::Result& result) {
  const auto m = static_cast<Index>(surface.triangles.rows());
  require(result.corner_uv.rows() == 3 * m && static_cast<Index>(result.island.size()) == m, "wrong lengths");
  require_elements(result.warnings, surface);
  require_triangles(result, m);
  require(named_by(result, Code::wrong_angle_sums).size() == result.wrong_angle_sums.size(),
          "wrong sums are not named");
  require(result.log_scale.allFinite(), "a log scale that is not finite");
  require_cones(surface, result.cones, result.cone_angles);
  if (result.flipped.empty()) {
    require(std::isfinite(result.distortion.l2_stretch), "a stretch that is not finite without a flipped triangle");
  }
  require(result.seamless.has_value() == options.seamless.has_value(), "a seamless report of another map");
  if (options.overlaps == lsgp::Overlaps::split && result.overlap_area > 0) {
    require(!named_by(result, Code::overlapping_triangles).empty(), "overlaps that no warning names");
  }
}

void require_same(const lsgp::Result& one, const lsgp::Result& other) {
  require(same_bytes(one.corner_uv, other.corner_uv), "two ways to the same map differ in its coordinates");
  require(same_bytes(one.cut_edges, other.cut_edges), "two ways to the same map differ in its cuts");
  require(one.cones == other.cones && one.cone_angles == other.cone_angles && one.island == other.island,
          "two ways to the same map differ in its cones or islands");
}

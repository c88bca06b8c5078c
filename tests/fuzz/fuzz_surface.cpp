// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a small surface with cones, seams and options, through all verbs: each must end with a result that keeps
// its word or with lsgp::Error.  Anything else ends the process: another exception, a sanitizer's report, a NaN.
//
//   cmake -S tests/fuzz -B build/fuzz -DCMAKE_CXX_COMPILER=clang++ && cmake --build build/fuzz
//   mkdir -p build/fuzz/corpus && build/fuzz/fuzz_surface -max_len=512 -len_control=0 -timeout=10 build/fuzz/corpus
//   FUZZ_PRINT=1 build/fuzz/fuzz_surface crash-...   replays a finding, says what was wrong and prints the input
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "lsgp/lsgp.hpp"
#include "small_surfaces.hpp"

namespace {

using lsgp::Index;

// Bytes one after the other, zeros after their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  int byte() { return at_ == end_ ? 0 : *at_++; }
  bool empty() const { return at_ == end_; }

  // Mostly plain numbers near 0, some extreme, some that are none.
  double number() {
    const int kind = byte();
    if (kind < 0xe0) return (kind - 0x70) / 16.0;
    constexpr double special[] = {1e-300, 1e-30, 1e-12, 1e-7, 1e7, 1e30, 1e150, 1e300};
    if (kind < 0xf8) return special[kind & 7] * (byte() - 127.5);
    if (kind < 0xfc) return std::numeric_limits<double>::denorm_min();
    return kind == 0xff ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
  }

  // A number below count, rarely one outside the range.
  Index index(Index count) {
    const int value = byte();
    if (value == 0xff) return -1;
    return value == 0xfe || count == 0 ? count + byte() : value % count;
  }

 private:
  const std::uint8_t *at_, *end_;
};

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "fuzz_surface: %s\n", what);
  std::abort();
}

void require(bool condition, const char* what) {
  if (!condition) fail(what);
}

lsgp::Surface make_surface(Bytes& bytes) {
  lsgp::Surface surface;
  surface.positions.resize(0, 3);
  surface.triangles.resize(0, 3);
  for (int parts = 1 + bytes.byte() % 2; parts > 0; --parts) {
    const int shape = bytes.byte();
    const Index a = 3 + bytes.byte() % 5, b = 3 + bytes.byte() % 4;
    if (shape % 5 < 3) add_sheet(surface, a, b, shape % 5);
    if (shape % 5 == 3) add_double_pyramid(surface, a);
    if (shape % 5 == 4) surface.positions.conservativeResize(surface.positions.rows() + a, 3);
    if (shape % 5 == 4) surface.positions.bottomRows(a).setRandom();  // overwritten or free of meaning
  }
  // Then anything may be moved, added, or changed.
  for (int count = bytes.byte() % 24; count > 0; --count) {
    const Index vertex = bytes.index(static_cast<Index>(surface.positions.rows()));
    const double x = bytes.number(), y = bytes.number(), z = bytes.number();
    if (vertex >= 0 && vertex < surface.positions.rows()) surface.positions.row(vertex) << x, y, z;
  }
  for (int count = bytes.byte() % 24; count > 0; --count) {
    const Index n = static_cast<Index>(surface.positions.rows()), m = static_cast<Index>(surface.triangles.rows());
    const int what = bytes.byte();
    const Index corner[] = {bytes.index(n), bytes.index(n), bytes.index(n)};
    if (what % 2 == 0 || m == 0) {
      add_triangle(surface.triangles, corner[0], corner[1], corner[2]);
    } else {
      surface.triangles((what / 6) % m, what / 2 % 3) = corner[0];
    }
  }
  if (const int scale = bytes.byte(); scale > 250) surface.positions *= std::pow(10, 20 * (scale - 253));
  return surface;
}

// (count) pairs: sides of triangles, at times anything.
lsgp::VertexPairs make_pairs(Bytes& bytes, const lsgp::Surface& surface, int count) {
  lsgp::VertexPairs pairs(count, 2);
  const Index n = static_cast<Index>(surface.positions.rows()), m = static_cast<Index>(surface.triangles.rows());
  for (int i = 0; i < count; ++i) {
    const int which = bytes.byte() + 256 * bytes.byte();
    if (m == 0 || which == 0xffff) {
      pairs.row(i) << bytes.index(n), bytes.index(n);
    } else {
      const Index triangle = which / 3 % m, side = which % 3;
      pairs.row(i) << surface.triangles(triangle, side), surface.triangles(triangle, (side + 1) % 3);
    }
  }
  return pairs;
}

lsgp::Pins make_pins(Bytes& bytes, const lsgp::Surface& surface, int count) {
  lsgp::Pins pins;
  pins.positions.resize(count, 2);
  for (int i = 0; i < count; ++i) {
    pins.corners.push_back(bytes.index(3 * static_cast<Index>(surface.triangles.rows())));
    const double u = bytes.number();
    pins.positions.row(i) << u, bytes.number();
  }
  return pins;
}

std::vector<Index> named_by(const lsgp::Result& result, lsgp::Code code) {
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

void require_elements(const std::vector<lsgp::Finding>& findings, const lsgp::Surface& surface) {
  for (const lsgp::Finding& finding : findings) {
    require(!finding.message.empty(), "a finding without a sentence");
    const auto limit =
        finding.elements.kind == lsgp::ElementKind::triangles ? surface.triangles.rows() : surface.positions.rows();
    for (const Index i : finding.elements.indices) require(i >= 0 && i < limit, "a finding names what does not exist");
  }
}

void require_honest(const lsgp::Surface& surface, const lsgp::Result& result) {
  using lsgp::Code;
  const auto m = surface.triangles.rows();
  require(result.corner_uv.rows() == 3 * m && static_cast<Eigen::Index>(result.island.size()) == m, "wrong lengths");
  require_elements(result.warnings, surface);
  const std::vector<Index> skipped = named_by(result, Code::component_skipped);
  const std::vector<Index> reversed = named_by(result, Code::reoriented);
  const std::vector<Index> doubles = named_by(result, Code::duplicate_face);
  const std::vector<Index> flipped = named_by(result, Code::flipped_triangles);
  bool solved = false;
  for (Index f = 0; f < m; ++f) {
    const auto uv = result.corner_uv.middleRows<3>(3 * f);
    if (result.island[f] < 0) {
      require(contains(skipped, f), "a triangle without a map that no warning names");
      continue;
    }
    solved = true;
    require(uv.allFinite(), "coordinates that are not finite");
    const double area = (uv(1, 0) - uv(0, 0)) * (uv(2, 1) - uv(0, 1)) - (uv(1, 1) - uv(0, 1)) * (uv(2, 0) - uv(0, 0));
    const bool up = contains(reversed, f) ? area < 0 : area > 0;
    require(up || contains(flipped, f) || contains(doubles, f), "a flipped triangle that no warning names");
  }
  require(solved, "a result without a map");
  require(flipped.size() == result.flipped.size(), "flipped triangles are listed but not named");
  require(named_by(result, Code::wrong_angle_sums).size() == result.wrong_angle_sums.size(),
          "wrong sums are not named");
  require(result.log_scale.allFinite(), "a log scale that is not finite");
  require(result.cones.size() == result.cone_angles.size(), "cones and angles differ in number");
  for (const double angle : result.cone_angles) require(angle > 0 && std::isfinite(angle), "an impossible cone angle");
  if (flipped.empty()) {
    require(std::isfinite(result.distortion.l2_stretch), "a stretch that is not finite without a flipped triangle");
  }
}

// The input as Python, for a test.
void print(const lsgp::Surface& surface, const lsgp::Cones& cones, const lsgp::Pins& pins) {
  const auto rows = [](const char* name, const auto& matrix) {
    std::printf("%s = [", name);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      std::printf(i ? ", [" : "[");
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) std::printf(j ? ", %.17g" : "%.17g", double(matrix(i, j)));
      std::printf("]");
    }
    std::printf("]\n");
  };
  rows("positions", surface.positions);
  rows("triangles", surface.triangles);
  rows("seams", surface.seams);
  if (surface.edges) rows("edges", *surface.edges);
  std::printf("cones = [");
  for (const Index v : cones.vertices) std::printf("%d, ", v);
  std::printf("]\nangles = [");
  for (const auto& angle : cones.angles) angle ? std::printf("%.17g, ", *angle) : std::printf("None, ");
  std::printf("]\n");
  if (pins.corners.empty()) return;
  std::printf("pinned = [");
  for (const Index corner : pins.corners) std::printf("%d, ", corner);
  std::printf("]\n");
  rows("pinned_uv", pins.positions);
}

// Runs a verb; every error of the library is an answer.
template <typename Verb>
void ask(const lsgp::Surface& surface, Verb verb) {
  try {
    verb();
  } catch (const lsgp::Error& error) {
    if (std::getenv("FUZZ_PRINT")) std::printf("# %s: %s\n", lsgp::name(error.code()), error.what());
    require_elements({{error.code(), error.what(), error.elements()}}, surface);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const int options = bytes.byte(), extras = bytes.byte();
  lsgp::Surface surface = make_surface(bytes);
  surface.seams = make_pairs(bytes, surface, bytes.byte() % 16);
  if (extras % 8 == 7) surface.edges = make_pairs(bytes, surface, bytes.byte() % 64);
  lsgp::Cones cones;
  for (int count = bytes.byte() % 12; count > 0; --count) {
    cones.vertices.push_back(bytes.index(static_cast<Index>(surface.positions.rows())));
    const int angle = bytes.byte();
    cones.angles.push_back(angle < 128   ? std::nullopt
                           : angle < 250 ? std::optional((angle - 128) / 4 * M_PI / 4)
                                         : std::optional(bytes.number()));
  }
  if (extras >= 0xf8) cones.angles.resize(cones.vertices.size() + extras - 0xf8);
  lsgp::Options chosen;
  chosen.prescription = static_cast<lsgp::PrescriptionRule>(options % 4);
  chosen.unfold = static_cast<lsgp::UnfoldMethod>(options / 4 % 2);
  chosen.method = options / 8 % 8 == 7 ? lsgp::Method::lscm : lsgp::Method::lsgp;
  const int borders = bytes.byte();
  chosen.seams = static_cast<lsgp::SeamMode>(borders % 3);
  chosen.border = static_cast<lsgp::BorderMode>(borders / 3 % 2);
  for (int count = borders / 6 % 8 - 5; count > 0; --count) {
    const Index vertex = bytes.index(static_cast<Index>(surface.positions.rows()));
    chosen.loop_turning.emplace_back(vertex, (bytes.byte() - 64) / 16 * M_PI / 2);
  }
  const lsgp::Pins pins = make_pins(bytes, surface, borders / 48 == 5 ? bytes.byte() % 8 : 0);

  if (std::getenv("FUZZ_PRINT")) {
    print(surface, cones, pins);
    std::printf("# prescription %d unfold %d method %d seams %d border %d, %d turnings\n", int(chosen.prescription),
                int(chosen.unfold), int(chosen.method), int(chosen.seams), int(chosen.border),
                int(chosen.loop_turning.size()));
    std::fflush(stdout);
  }
  ask(surface, [&] {
    const lsgp::Result result = lsgp::parameterize(surface, cones, chosen, pins);
    require_honest(surface, result);
    lsgp::measure_distortion(surface, result.corner_uv, options & 128 ? &cones.vertices : nullptr);
  });
  ask(surface, [&] { lsgp::find_cuts(surface, cones.vertices, chosen); });
  ask(surface, [&] { lsgp::prescribe_curvature(surface, cones, chosen); });
  ask(surface, [&] {
    lsgp::PlacementOptions placement;
    if (extras / 8 % 8 > 0) placement.count = extras / 8 % 8 - 1;
    placement.seams = chosen.seams;
    for (const Index v : lsgp::place_cones(surface, cones, placement).cones) {
      require(v >= 0 && v < surface.positions.rows(), "a cone placed outside the surface");
    }
  });
  return 0;
}

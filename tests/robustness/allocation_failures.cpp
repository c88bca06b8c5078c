// SPDX-License-Identifier: GPL-3.0-or-later
// Every allocation of every verb fails: each such call has to end in std::bad_alloc, with nothing leaked and
// nothing changed that the next call could see.  tools/sanitize builds and runs this; by hand, in any build:
//
//   cmake -S . -B build/faults -DLSGP_PYTHON=OFF -DLSGP_FAULTS=ON && cmake --build build/faults
//   build/faults/tests/robustness/allocation_failures          50: the first fifty of every call and as many later ones
//
// operator new is replaced for the whole process; malloc, calloc, realloc and free, by which Eigen allocates, are
// wrapped by the linker in the library's own code only, so that exceptions themselves find memory.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../fuzz/small_surfaces.hpp"
#include "lsgp/lsgp.hpp"

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void __real_free(void* block);
}

namespace {

// What happens to allocations while `armed`.
struct Memory {
  bool armed = false;
  long count = 0;          // allocations so far
  long first_failing = 0;  // 0: none
  bool all_after = false;  // not only that one fails, but everything after it
  bool refused = false;
  bool refused_softly = false;  // only such allocations failed as may, std::stable_sort's for speed
  long live = 0;                // blocks not yet freed, armed or not

  bool refuses(bool softly) {
    if (!armed) return false;
    ++count;
    const bool now = first_failing > 0 && (all_after ? count >= first_failing : count == first_failing);
    if (now) {
      refused_softly = softly && (refused_softly || !refused);
      refused = true;
    }
    return now;
  }

  void* counted(void* block) {
    live += block != nullptr;
    return block;
  }
};

Memory memory;

}  // namespace

extern "C" {
void* __wrap_malloc(std::size_t size) { return memory.refuses(false) ? nullptr : memory.counted(__real_malloc(size)); }
void* __wrap_calloc(std::size_t count, std::size_t size) {
  return memory.refuses(false) ? nullptr : memory.counted(__real_calloc(count, size));
}
void* __wrap_realloc(void* block, std::size_t size) {
  if (memory.refuses(false)) return nullptr;
  memory.live -= block != nullptr;
  return memory.counted(__real_realloc(block, size));
}
void __wrap_free(void* block) {
  memory.live -= block != nullptr;
  __real_free(block);
}
}

void* operator new(std::size_t size) {
  void* block = memory.refuses(false) ? nullptr : memory.counted(__real_malloc(size));
  if (!block) throw std::bad_alloc();
  return block;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return memory.refuses(true) ? nullptr : memory.counted(__real_malloc(size));
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return operator new(size, std::nothrow); }
void operator delete(void* block) noexcept { __wrap_free(block); }
void operator delete(void* block, std::size_t) noexcept { __wrap_free(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { __wrap_free(block); }
void operator delete[](void* block) noexcept { __wrap_free(block); }
void operator delete[](void* block, std::size_t) noexcept { __wrap_free(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { __wrap_free(block); }

namespace {

using lsgp::Index;

// The bytes of arguments and answers, for comparison.  Only called while memory is not armed.
class Bytes {
 public:
  template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>>>
  Bytes& operator<<(T value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Bytes& operator<<(const std::string& value) {
    text_ += value;
    return *this << value.size();
  }
  template <typename T, int... Shape>
  Bytes& operator<<(const Eigen::Matrix<T, Shape...>& value) {
    *this << value.rows() << value.cols();
    for (Eigen::Index i = 0; i < value.size(); ++i) *this << value.data()[i];
    return *this;
  }
  template <typename T>
  Bytes& operator<<(const std::vector<T>& values) {
    *this << values.size();
    for (const T& value : values) *this << value;
    return *this;
  }
  template <typename T>
  Bytes& operator<<(const std::optional<T>& value) {
    *this << value.has_value();
    return value ? *this << *value : *this;
  }
  Bytes& operator<<(const lsgp::Elements& value) { return *this << value.kind << value.indices; }
  Bytes& operator<<(const lsgp::Finding& value) { return *this << value.code << value.message << value.elements; }
  Bytes& operator<<(const lsgp::Distortion& d) {
    return *this << d.quasi_conformal << d.quasi_conformal_area_weighted << d.area << d.area_p10 << d.area_p90
                 << d.l2_stretch;
  }
  Bytes& operator<<(const lsgp::SeamQuality& s) {
    return *this << s.sister_ratio_max << s.rotation_residual << s.translation_residual;
  }
  Bytes& operator<<(const lsgp::SeamlessCut& c) {
    return *this << c.tail << c.head << c.turns << c.translation[0] << c.translation[1] << c.error;
  }
  Bytes& operator<<(const lsgp::SeamlessReport& r) {
    return *this << r.rotation_order << r.tiles << r.tile_size << r.cell << r.energy_before << r.energy_after << r.cuts
                 << r.error << r.flat_cones << r.merged_cones << r.relaxed_cones;
  }
  // All but the time it took.
  Bytes& operator<<(const lsgp::Result& r) {
    return *this << r.corner_uv << r.island << r.cut_edges << r.cones << r.cone_angles << r.distortion << r.seams
                 << r.flipped << r.wrong_angle_sums << r.cone_angle_error << r.log_scale << r.warnings
                 << r.stage_seconds.size() << r.seamless;
  }
  Bytes& operator<<(const lsgp::CutPaths& c) { return *this << c.edges << c.paths; }
  Bytes& operator<<(const lsgp::Prescription& p) {
    return *this << p.cones << p.cone_angles << p.log_scale << p.predicted_l2 << p.warnings;
  }
  Bytes& operator<<(const lsgp::Placement& p) {
    return *this << p.cones << p.cone_angles << p.log_scale << p.predicted_l2 << p.reached << p.warnings;
  }
  Bytes& operator<<(const lsgp::Measurement& m) {
    return *this << m.distortion << m.seams << m.flipped << m.cut_edges << m.island;
  }
  Bytes& operator<<(const lsgp::Surface& s) { return *this << s.positions << s.triangles << s.edges << s.seams; }
  Bytes& operator<<(const lsgp::Cones& c) { return *this << c.vertices << c.angles; }
  Bytes& operator<<(const lsgp::Pins& p) { return *this << p.corners << p.positions; }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  std::fprintf(stderr, "allocation_failures: %s, allocation %ld: %s\n", name.c_str(), memory.first_failing,
               what.c_str());
  std::exit(1);
}

// A call, its arguments, and how to make it: with memory armed while the library works.
struct Case {
  std::string name;
  lsgp::Surface surface;
  lsgp::Cones cones;
  lsgp::Options options;
  lsgp::Pins pins;
  std::function<void(const Case&, Bytes&)> call;
  std::optional<lsgp::Code> refusal;  // none: the call has a result

  std::string arguments() const { return (Bytes() << surface << cones << pins).text(); }
};

template <typename Verb>
auto while_armed(Verb verb) {
  struct Armed {
    Armed() { memory.armed = true; }
    ~Armed() { memory.armed = false; }
  } armed;
  return verb();
}

void parameterize(const Case& c, Bytes& out) {
  out << while_armed([&] { return lsgp::parameterize(c.surface, c.cones, c.options, c.pins); });
}

void find_cuts(const Case& c, Bytes& out) {
  out << while_armed([&] { return lsgp::find_cuts(c.surface, c.cones.vertices, c.options); });
}

void prescribe_curvature(const Case& c, Bytes& out) {
  out << while_armed([&] { return lsgp::prescribe_curvature(c.surface, c.cones, c.options); });
}

void place_some_cones(const Case& c, Bytes& out) {
  lsgp::PlacementOptions some;
  some.count = 4;
  some.seams = c.options.seams;
  out << while_armed([&] { return lsgp::place_cones(c.surface, c.cones, some); });
}

void place_cones(const Case& c, Bytes& out) {
  out << while_armed([&] { return lsgp::place_cones(c.surface); });
}

void measure_distortion(const Case& c, Bytes& out) {
  const lsgp::CornerUv uv = lsgp::parameterize(c.surface, c.cones, c.options, c.pins).corner_uv;
  out << while_armed([&] { return lsgp::measure_distortion(c.surface, uv); });
  out << while_armed([&] { return lsgp::measure_distortion(c.surface, uv, &c.cones.vertices); });
}

void extract_quads(const Case& c, Bytes& out) {
  const lsgp::CornerUv uv = lsgp::parameterize(c.surface, c.cones, c.options, c.pins).corner_uv;
  const lsgp::QuadMesh mesh = while_armed([&] { return lsgp::extract_quads(c.surface, uv); });
  out << mesh.positions << mesh.valences;
}

// The bytes of the answer, be it a result or an error of the library; none where memory ended.
std::optional<std::string> answer(const Case& c, long first_failing, bool all_after) {
  memory.count = 0;
  memory.first_failing = first_failing;
  memory.all_after = all_after;
  memory.refused = memory.refused_softly = false;
  Bytes out;
  try {
    c.call(c, out);
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  } catch (const lsgp::Error& error) {
    if (error.code() != c.refusal) fail(c.name, std::string("refused as ") + lsgp::name(error.code()));
    out << error.code() << std::string(error.what()) << error.elements();
  } catch (const std::exception& error) {
    fail(c.name, std::string("another exception: ") + error.what());
  }
  return out.text();
}

// Lets allocations of a case fail, alone and with all that come after them: the first `dense` ones and about as many
// later ones.
void test(const Case& c, long dense) {
  const std::string arguments = c.arguments();
  const std::optional<std::string> expected = answer(c, 0, false);  // also allocates what the runtime keeps
  const long total = memory.count;
  long tried = 0;
  for (const bool all_after : {false, true}) {
    const long stride = std::max(1L, (total - dense) / dense);
    for (long k = 1; k <= total; k += k < dense ? 1 : stride) {
      const long live = memory.live;
      {
        const std::optional<std::string> ended = answer(c, k, all_after);
        if (!memory.refused) fail(c.name, "the same call allocates less than before");
        if (ended && !memory.refused_softly) fail(c.name, "there is an answer although it failed");
        if (ended && ended != expected) fail(c.name, "another answer because it failed");
      }
      if (memory.live != live) fail(c.name, "leaked blocks: " + std::to_string(memory.live - live));
      ++tried;
      if (tried % 10 == 0 && answer(c, 0, false) != expected) fail(c.name, "another answer in the call after it");
    }
  }
  if (answer(c, 0, false) != expected) fail(c.name, "another answer at last");
  if (c.arguments() != arguments) fail(c.name, "changed arguments");
  std::printf("%-30s %6ld allocations, %6ld failures\n", c.name.c_str(), total, tried);
}

// n x n cells on each side of a cube that is blown up to a sphere; corners: the vertices at the cube's.
lsgp::Surface make_cube_sphere(int n, std::vector<Index>& corners) {
  lsgp::Surface surface;
  std::map<std::array<int, 3>, Index> numbers;
  std::vector<Eigen::Vector3d> points;
  const auto vertex = [&](std::array<int, 3> at) {
    const auto [place, is_new] = numbers.try_emplace(at, static_cast<Index>(points.size()));
    if (is_new) points.push_back(Eigen::Vector3d(at[0], at[1], at[2]) * 2 / n - Eigen::Vector3d::Ones());
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool top : {false, true}) {
      for (int i = 0; i < n * n; ++i) {
        Index corner[4];
        for (int c = 0; c < 4; ++c) {
          std::array<int, 3> at;
          at[axis] = top ? n : 0;
          at[(axis + 1) % 3] = i / n + (c == 1 || c == 2);
          at[(axis + 2) % 3] = i % n + (c == 2 || c == 3);
          corner[c] = vertex(at);
        }
        if (!top) std::swap(corner[1], corner[3]);
        add_triangle(surface.triangles, corner[0], corner[1], corner[2]);
        add_triangle(surface.triangles, corner[0], corner[2], corner[3]);
      }
    }
  }
  for (const auto& [at, v] : numbers) {
    if (at[0] % n + at[1] % n + at[2] % n == 0) corners.push_back(v);
  }
  surface.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Eigen::Vector3d point = points[v] / (0.5 + points[v].norm() / 2);
    surface.positions.row(static_cast<Eigen::Index>(v)) = point.cwiseProduct(Eigen::Vector3d(1, 1.2, 0.9)).transpose();
  }
  return surface;
}

std::deque<Case> make_cases() {
  std::deque<Case> cases;  // references to its elements stay
  const auto add = [&](const char* name, const auto& call, const Case& base) -> Case& {
    cases.push_back(base);
    cases.back().name = name;
    cases.back().call = call;
    return cases.back();
  };
  const auto automatic = [](std::vector<Index> vertices) {
    lsgp::Cones cones;
    cones.angles.resize(vertices.size());
    cones.vertices = std::move(vertices);
    return cones;
  };

  Case sphere, ring, tube, sheet, messy;
  std::vector<Index> corners;
  sphere.surface = make_cube_sphere(3, corners);
  sphere.cones = automatic(corners);
  add_sheet(ring.surface, 6, 4, 2);
  ring.cones = automatic({3, 14});
  add_sheet(tube.surface, 6, 3, 1);
  add_sheet(sheet.surface, 4, 4, 0);
  sheet.cones = automatic({0, 4, 20, 24});
  // A closed part without cones, a sheet and a tube; a fin, a double, a turned triangle, some without area, a loose
  // vertex.
  add_sheet(messy.surface, 3, 3, 0);
  add_double_pyramid(messy.surface, 4);
  add_sheet(messy.surface, 3, 2, 1);
  add_triangle(messy.surface.triangles, 5, 6, 16);
  add_triangle(messy.surface.triangles, 0, 1, 5);
  std::swap(messy.surface.triangles(7, 0), messy.surface.triangles(7, 1));
  messy.surface.positions.row(0) = messy.surface.positions.row(1);
  messy.surface.positions.conservativeResize(messy.surface.positions.rows() + 1, 3);
  messy.surface.positions.bottomRows<1>().setZero();

  add("poisson", parameterize, sphere);
  add("spectral", parameterize, sphere).options.unfold = lsgp::UnfoldMethod::spectral;
  add("lscm", parameterize, sphere).options.method = lsgp::Method::lscm;
  add("harmonic", parameterize, sphere).options.prescription = lsgp::PrescriptionRule::harmonic;
  add("straightness", parameterize, sphere).options.prescription = lsgp::PrescriptionRule::straightness;
  Case& manual = add("repair", parameterize, sphere);
  manual.options.prescription = lsgp::PrescriptionRule::manual;
  // Sharp and blunt in turn: two triangles are flipped until they are repaired.
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool sharp = i % 2 == (i / 2 + i / 4) % 2;
    manual.cones.angles[i] = (sharp ? 0.35 : 2.65) * M_PI;
  }
  add("low stretch", parameterize, sphere).options.mode = lsgp::Mode::low_stretch;
  add("split overlaps", parameterize, manual).options.overlaps = lsgp::Overlaps::split;
  add("compact islands", parameterize, manual).options.compact = lsgp::Compactness::full;
  Case& seams = add("seams to follow", parameterize, sphere);
  seams.surface.seams = seams.surface.triangles.topLeftCorner(12, 2);
  add("seams as borders", parameterize, seams).options.seams = lsgp::SeamMode::boundary;
  Case& opened = add("seams to open", parameterize, seams);
  opened.cones = {};
  add("handle", parameterize, ring);
  Case& turned = add("border that turns", parameterize, tube);
  turned.options.loop_turning = {{0, 0.5}};
  add("straight borders", parameterize, tube).options.border = lsgp::BorderMode::straight;
  add("straight borders with corners", parameterize, sheet).options.border = lsgp::BorderMode::straight;
  Case& corner = add("corner", parameterize, sheet);
  corner.options.prescription = lsgp::PrescriptionRule::manual;
  corner.cones.angles[0] = M_PI / 2;
  Case& pins = add("pins", parameterize, sphere);
  pins.pins.corners = {0, 31, 62};
  pins.pins.positions.resize(3, 2);
  pins.pins.positions << 0, 0, 1, 0.2, 0.4, 1;
  add("seamless", parameterize, sphere).options.seamless.emplace();
  Case& along = add("seamless with features", parameterize, sphere);
  along.surface.features = along.surface.triangles.topLeftCorner(4, 2);
  along.options.seamless.emplace();
  Case& lattice = add("seamless with a handle", parameterize, ring);
  lattice.cones = {};
  lattice.options.seamless.emplace();
  add("leftovers", parameterize, messy);
  add("cuts", find_cuts, ring);
  add("angles", prescribe_curvature, messy);
  add("some cones", place_some_cones, sphere);
  add("as many cones as it takes", place_cones, sphere);
  add("measure", measure_distortion, ring);
  Case& quads = add("quads", extract_quads, sphere);
  quads.options.seamless.emplace();
  quads.options.seamless->tiles = 16;

  Case& missing = add("refused: cones missing", parameterize, sphere);
  missing.cones = {};
  missing.refusal = lsgp::Code::too_few_cones;
  Case& sum = add("refused: sum of angles", parameterize, manual);
  sum.cones.angles[0] = 0.75 * M_PI;
  sum.refusal = lsgp::Code::gauss_bonnet;
  Case& seam = add("refused: seams", parameterize, sheet);
  seam.surface.seams = lsgp::VertexPairs::Constant(9, 2, 99);
  seam.refusal = lsgp::Code::index_out_of_range;
  Case& place = add("refused: place of a vertex", parameterize, sheet);
  place.surface.positions(3, 1) = std::numeric_limits<double>::quiet_NaN();
  place.refusal = lsgp::Code::non_finite_position;
  return cases;
}

}  // namespace

int main(int count, char** arguments) {
  const long dense = count > 1 ? std::atol(arguments[1]) : std::numeric_limits<int>::max();
  if (dense < 1) return 2;
  for (const Case& c : make_cases()) test(c, dense);
}

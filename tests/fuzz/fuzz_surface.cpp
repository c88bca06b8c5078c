// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a small surface with cones, seams and options, through every verb: each must end with an answer that
// keeps its word or with lsgp::Error.  Anything else ends the process: another exception, a sanitizer's report, a NaN.
// tools/fuzz builds and runs this, and replays what it found.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>

#include "bytes.hpp"
#include "inputs.hpp"
#include "print_input.hpp"
#include "promises.hpp"

namespace {

// Runs a verb; every error of the library is an answer. Returns its code and sentence.
template <typename Verb>
std::optional<std::string> error_of(const lsgp::Surface& surface, Verb verb) {
  try {
    verb();
    return std::nullopt;
  } catch (const lsgp::Error& error) {
    if (printing()) std::printf("# %s: %s\n", lsgp::name(error.code()), error.what());
    require(std::strlen(error.what()) > 0, "an error without a sentence");
    require_elements({{error.code(), error.what(), error.elements()}}, surface);
    return std::string(lsgp::name(error.code())) + ": " + error.what();
  }
}

// Says no after some reports, or never; reports never go back.
class Patience {
 public:
  explicit Patience(Bytes& bytes) : left_(bytes.once_in(4) ? bytes.byte() : -1) {}

  lsgp::Progress progress() {
    return [this](double done) {
      require(done >= last_ && done <= 1, "progress goes back or beyond its end");
      last_ = done;
      cancelled_ = left_ == 0;
      if (left_ > 0) --left_;
      return !cancelled_;
    };
  }

  bool cancelled() const { return cancelled_; }

 private:
  int left_;
  double last_ = 0;
  bool cancelled_ = false;
};

// Everything a map is made from beside its surface.
struct Call {
  lsgp::Cones cones;
  lsgp::Options options;
  lsgp::Pins pins;

  Call(Bytes& bytes, const lsgp::Surface& surface)
      : cones(make_cones(bytes, surface)), options(make_options(bytes, surface)), pins(make_pins(bytes, surface)) {
    if (!printing()) return;
    print(cones);
    print(options);
    print(pins);
    std::fflush(stdout);
  }
};

void ask_parameterize(Bytes& bytes, const lsgp::Surface& surface) {
  const Call call(bytes, surface);
  Patience patience(bytes);
  error_of(surface, [&] {
    const lsgp::Result result = lsgp::parameterize(surface, call.cones, call.options, call.pins, patience.progress());
    require(!patience.cancelled(), "a result in spite of a cancel");
    require_honest(surface, call.options, result);
    lsgp::measure_distortion(surface, result.corner_uv, bytes.once_in(2) ? &call.cones.vertices : nullptr);
  });
}

// Each call of a solver answers as if it were the first, whatever went before it.
void ask_solver(Bytes& bytes, const lsgp::Surface& surface) {
  lsgp::Solver solver(surface);
  for (int calls = 2 + bytes.below(3); calls > 0; --calls) {
    const Call call(bytes, surface);
    Patience patience(bytes);
    lsgp::Result kept, fresh;
    const auto error = error_of(
        surface, [&] { kept = solver.parameterize(call.cones, call.options, call.pins, patience.progress()); });
    if (patience.cancelled()) continue;
    const auto expected =
        error_of(surface, [&] { fresh = lsgp::parameterize(surface, call.cones, call.options, call.pins); });
    require(error == expected, "a solver that was used before gives another error");
    if (!error) require_same(kept, fresh);
  }
}

void ask_parts(Bytes& bytes, const lsgp::Surface& surface) {
  const Call call(bytes, surface);
  Patience with_cuts(bytes), with_angles(bytes);
  error_of(surface, [&] {
    const auto n = surface.positions.rows();
    const auto progress = with_cuts.progress();
    for (const auto& path : lsgp::find_cuts(surface, call.cones.vertices, call.options, progress).paths) {
      for (const lsgp::Index v : path) require(v >= 0 && v < n, "a cut outside the surface");
    }
  });
  error_of(surface, [&] {
    const double angle = bytes.below(8) / 2.0;
    lsgp::Surface ending = surface;
    const lsgp::CreaseOptions creases{angle, surface.seams, bytes.below(3), bytes.below(5) / 4.0};
    ending.borders = lsgp::crease_borders(surface, call.cones.vertices, creases);
    const lsgp::Pins no_pins;
    require_honest(ending, call.options, lsgp::parameterize(ending, call.cones, call.options, no_pins));
  });
  error_of(surface, [&] {
    const lsgp::Prescription chosen =
        lsgp::prescribe_curvature(surface, call.cones, call.options, with_angles.progress());
    require_elements(chosen.warnings, surface);
    require_cones(surface, chosen.cones, chosen.cone_angles);
    require(chosen.log_scale.size() == surface.positions.rows() && chosen.log_scale.allFinite(),
            "a log scale that is not finite");
  });
}

void ask_placement(Bytes& bytes, const lsgp::Surface& surface) {
  const lsgp::Cones existing = bytes.once_in(2) ? make_cones(bytes, surface) : lsgp::Cones{};
  const lsgp::PlacementOptions options = make_placement_options(bytes);
  if (printing()) print(existing), print(options), std::fflush(stdout);
  Patience patience(bytes);
  lsgp::Placement placement;
  const auto error =
      error_of(surface, [&] { placement = lsgp::place_cones(surface, existing, options, patience.progress()); });
  if (error) return;
  require_elements(placement.warnings, surface);
  require_cones(surface, placement.cones, placement.cone_angles);
  require(placement.log_scale.allFinite(), "a log scale that is not finite");
  lsgp::Options unwrap;
  unwrap.seams = options.seams;
  unwrap.prescription = lsgp::PrescriptionRule::manual;
  lsgp::Cones cones{placement.cones, {placement.cone_angles.begin(), placement.cone_angles.end()}};
  error_of(surface, [&] { require_honest(surface, unwrap, lsgp::parameterize(surface, cones, unwrap)); });
}

void ask_gains(Bytes& bytes, const lsgp::Surface& surface) {
  const lsgp::Cones existing = bytes.once_in(2) ? make_cones(bytes, surface) : lsgp::Cones{};
  const auto seams = bytes.choice<lsgp::SeamMode>(4);
  if (printing()) print(existing), std::printf("# seams: choice %d\n", int(seams)), std::fflush(stdout);
  Patience patience(bytes);
  error_of(surface, [&] {
    const lsgp::ConeGains gains = lsgp::cone_gains(surface, existing, seams, patience.progress());
    const auto n = surface.positions.rows();
    require(gains.predicted_l2.size() == n && gains.best >= -1 && gains.best < n, "a best cone outside the surface");
    require(!(gains.predicted_l2.array() < 1 - 1e-9).any(), "a stretch below that of an isometry");
    require_elements(gains.warnings, surface);
  });
}

void ask_measurement(Bytes& bytes, const lsgp::Surface& surface) {
  const lsgp::CornerUv uv = make_corner_uv(bytes, surface);
  const lsgp::Cones cones = make_cones(bytes, surface);
  const bool given = bytes.once_in(2);
  if (printing()) print(cones), std::fflush(stdout);
  Patience patience(bytes);
  error_of(surface, [&] {
    const lsgp::Measurement measured =
        lsgp::measure_distortion(surface, uv, given ? &cones.vertices : nullptr, patience.progress());
    require(uv.rows() == surface.triangles.size(), "texture coordinates of another number of corners are measured");
    for (const lsgp::Index f : measured.flipped) require(f >= 0 && f < surface.triangles.rows(), "no such triangle");
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const int verb = bytes.below(8);
  const lsgp::Surface surface = make_surface(bytes);
  if (printing()) print(surface), std::fflush(stdout);
  if (verb < 2) ask_parameterize(bytes, surface);
  if (verb == 2) ask_solver(bytes, surface);
  if (verb == 3) ask_parts(bytes, surface);
  if (verb == 4 || verb == 5) ask_placement(bytes, surface);
  if (verb == 6) ask_gains(bytes, surface);
  if (verb == 7) ask_measurement(bytes, surface);
  return 0;
}

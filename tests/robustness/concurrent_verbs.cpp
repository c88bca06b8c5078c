// SPDX-License-Identifier: GPL-3.0-or-later
// All verbs at once on several threads, on surfaces that they share and on others of their own: no data race, which
// ThreadSanitizer would report, and the same bytes as on one thread.  `tools/sanitize --threads` builds and runs this.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../fuzz/small_surfaces.hpp"
#include "lsgp/lsgp.hpp"

namespace {

using Bytes = std::string;
using Verb = std::function<Bytes(const lsgp::Surface&)>;

template <typename Matrix>
Bytes bytes_of(const Matrix& matrix) {
  const auto size = sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(matrix.size());
  return {reinterpret_cast<const char*>(matrix.data()), size};
}

Bytes bytes_of(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(double) * values.size()};
}

lsgp::Surface sheet(int joined) {
  lsgp::Surface surface;
  surface.positions.resize(0, 3);
  surface.triangles.resize(0, 3);
  surface.seams.resize(0, 2);
  add_sheet(surface, 8, 6, joined);
  return surface;
}

lsgp::Surface pyramids() {
  lsgp::Surface surface;
  surface.positions.resize(0, 3);
  surface.triangles.resize(0, 3);
  surface.seams.resize(0, 2);
  add_double_pyramid(surface, 7);
  add_double_pyramid(surface, 5);
  return surface;
}

lsgp::Cones automatic(std::vector<lsgp::Index> vertices) {
  const std::size_t count = vertices.size();
  return {std::move(vertices), std::vector<std::optional<double>>(count)};
}

Bytes unwrap(const lsgp::Surface& surface, const lsgp::Options& options) {
  const lsgp::Placement placed = lsgp::place_cones(surface, {}, {});
  const lsgp::Cones cones{placed.cones, {placed.cone_angles.begin(), placed.cone_angles.end()}};
  return bytes_of(lsgp::parameterize(surface, cones, options).corner_uv);
}

lsgp::Options manual() {
  lsgp::Options options;
  options.prescription = lsgp::PrescriptionRule::manual;
  return options;
}

std::vector<Verb> all_verbs() {
  lsgp::Options seamless, low_stretch = manual(), spectral, split = manual();
  seamless.seamless.emplace().tiles = 8;
  low_stretch.mode = lsgp::Mode::low_stretch;
  spectral.unfold = lsgp::UnfoldMethod::spectral;
  split.overlaps = lsgp::Overlaps::split;
  split.compact = lsgp::Compactness::full;
  std::vector<Verb> verbs;
  for (const lsgp::Options& options : {manual(), seamless, low_stretch, spectral, split}) {
    verbs.push_back([options](const lsgp::Surface& surface) { return unwrap(surface, options); });
  }
  verbs.push_back([](const lsgp::Surface& surface) {
    lsgp::Solver solver(surface);
    const lsgp::Placement placed = lsgp::place_cones(surface, {}, {});
    const lsgp::Cones cones{placed.cones, {placed.cone_angles.begin(), placed.cone_angles.end()}};
    solver.parameterize(cones);
    return bytes_of(solver.parameterize(cones, manual()).corner_uv);
  });
  verbs.push_back([](const lsgp::Surface& surface) { return bytes_of(lsgp::find_cuts(surface, {1, 4}).edges); });
  verbs.push_back([](const lsgp::Surface& surface) {
    return bytes_of(lsgp::prescribe_curvature(surface, automatic({0, 2, 3, 5})).cone_angles);
  });
  verbs.push_back([](const lsgp::Surface& surface) {
    lsgp::PlacementOptions options;
    options.count = 4;
    options.symmetric = true;
    return bytes_of(lsgp::place_cones(surface, {}, options).cone_angles);
  });
  verbs.push_back([](const lsgp::Surface& surface) {
    return bytes_of(lsgp::cone_gains(surface, {}, lsgp::SeamMode::follow, [](double) { return true; }).predicted_l2);
  });
  verbs.push_back([](const lsgp::Surface& surface) {
    lsgp::CornerUv seen_from_above(surface.triangles.size(), 2);
    for (Eigen::Index corner = 0; corner < surface.triangles.size(); ++corner) {
      seen_from_above.row(corner) = surface.positions.row(surface.triangles.data()[corner]).head<2>();
    }
    return std::to_string(lsgp::measure_distortion(surface, seen_from_above).distortion.quasi_conformal);
  });
  verbs.push_back([](const lsgp::Surface& surface) {
    lsgp::Options options;
    options.seamless.emplace().tiles = 16;
    const lsgp::Result layout = lsgp::parameterize(surface, automatic({0, 2, 3, 5}), options);
    return bytes_of(lsgp::extract_quads(surface, layout.corner_uv).positions);
  });
  return verbs;
}

// What a verb returns, or the error it ends with.
Bytes answer(const Verb& verb, const lsgp::Surface& surface) {
  try {
    return verb(surface);
  } catch (const lsgp::Error& error) {
    return std::string(lsgp::name(error.code())) + ": " + error.what();
  }
}

// A solver that all threads call: each call is refused as long as another one is at work, and otherwise answers.
class SharedSolver {
 public:
  SharedSolver() : solver_(pyramids()), expected_(call()) {}

  // Whether the answer is right or a refusal.
  bool try_once() {
    try {
      return call() == expected_;
    } catch (const lsgp::Error& error) {
      return error.code() == lsgp::Code::solver_busy;
    }
  }

 private:
  Bytes call() { return bytes_of(solver_.parameterize(automatic({0, 2, 3, 4, 9, 11, 12, 13})).corner_uv); }

  lsgp::Solver solver_;
  Bytes expected_;
};

}  // namespace

int main() {
  const std::vector<Verb> verbs = all_verbs();
  const std::vector<lsgp::Surface> shared{sheet(0), sheet(1), sheet(2), pyramids()};
  std::vector<Bytes> expected;
  for (const Verb& verb : verbs) {
    for (const lsgp::Surface& surface : shared) expected.push_back(answer(verb, surface));
  }

  SharedSolver solver;
  std::atomic<bool> solver_right = true;

  // Each thread begins with another verb, so that all pairs of verbs meet.
  constexpr std::size_t thread_count = 4;
  std::vector<std::vector<Bytes>> found(thread_count, std::vector<Bytes>(expected.size()));
  const auto work = [&](std::size_t thread) {
    const std::vector<lsgp::Surface> own = shared;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const std::size_t at = (i + thread * expected.size() / thread_count) % expected.size();
      const std::vector<lsgp::Surface>& surfaces = (i + thread) % 2 == 0 ? shared : own;
      if (!solver.try_once()) solver_right = false;
      found[thread][at] = answer(verbs[at / shared.size()], surfaces[at % shared.size()]);
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < thread_count; ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
  if (!solver_right) {
    std::fprintf(stderr, "a solver that several threads call gives another map\n");
    return EXIT_FAILURE;
  }

  for (std::size_t thread = 0; thread < thread_count; ++thread) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (found[thread][i] == expected[i]) continue;
      std::fprintf(stderr, "verb %zu on surface %zu differs between one thread and several\n", i / shared.size(),
                   i % shared.size());
      return EXIT_FAILURE;
    }
  }
  std::printf("%zu threads, %zu calls each: the same bytes as on one\n", thread_count, expected.size());
  return EXIT_SUCCESS;
}

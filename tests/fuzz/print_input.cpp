// SPDX-License-Identifier: GPL-3.0-or-later
#include "print_input.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

// As Python reads it back, with `from math import inf, nan`.
void print_number(double value) { std::printf("%.17g", value); }

template <typename Matrix>
void print_rows(const char* name, const Matrix& matrix) {
  std::printf("%s = [", name);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    std::printf(i > 0 ? ", [" : "[");
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (j > 0) std::printf(", ");
      print_number(static_cast<double>(matrix(i, j)));
    }
    std::printf("]");
  }
  std::printf("]\n");
}

void print_choice(const char* name, int value) { std::printf("# %s: choice %d\n", name, value); }

void print_value(const char* name, double value) { std::printf("# %s: %.17g\n", name, value); }

void print_seamless(const lsgp::Seamless& seamless) {
  print_choice("seamless.lattice", static_cast<int>(seamless.lattice));
  if (seamless.tiles) print_value("seamless.tiles", *seamless.tiles);
  if (seamless.tile_size) print_value("seamless.tile_size", *seamless.tile_size);
  print_choice("seamless.parity", seamless.parity);
  print_choice("seamless.feature_places", static_cast<int>(seamless.feature_places));
  print_choice("seamless.coarse_grid", static_cast<int>(seamless.coarse_grid));
  print_value("seamless.cell", seamless.cell);
}

}  // namespace

bool printing() {
  static const bool asked = std::getenv("FUZZ_PRINT") != nullptr;
  return asked;
}

void print(const lsgp::Surface& surface) {
  print_rows("positions", surface.positions);
  print_rows("triangles", surface.triangles);
  print_rows("seams", surface.seams);
  print_rows("borders", surface.borders);
  print_rows("features", surface.features);
  if (surface.edges) print_rows("edges", *surface.edges);
  if (surface.importance.size() > 0) print_rows("importance", surface.importance.transpose());
  if (surface.directions.size() > 0) print_rows("directions", surface.directions);
  if (surface.scale.size() > 0) print_rows("scale", surface.scale.transpose());
}

void print(const lsgp::Cones& cones) {
  std::printf("cones = [");
  for (const lsgp::Index v : cones.vertices) std::printf("%d, ", v);
  std::printf("]\nangles = [");
  for (const auto& angle : cones.angles) angle ? std::printf("%.17g, ", *angle) : std::printf("None, ");
  std::printf("]\n");
}

void print(const lsgp::Options& options) {
  print_choice("prescription", static_cast<int>(options.prescription));
  print_choice("unfold", static_cast<int>(options.unfold));
  print_choice("method", static_cast<int>(options.method));
  print_choice("seams", static_cast<int>(options.seams));
  print_choice("border", static_cast<int>(options.border));
  for (const auto& [vertex, turning] : options.loop_turning) {
    std::printf("# loop_turning[%d]: %.17g\n", vertex, turning);
  }
  if (options.seamless) print_seamless(*options.seamless);
  print_choice("mode", static_cast<int>(options.mode));
  print_value("stretch", options.stretch);
  print_choice("repair", options.repair);
  print_choice("overlaps", static_cast<int>(options.overlaps));
  print_choice("compact", static_cast<int>(options.compact));
  print_choice("follow_strokes", options.follow_strokes);
  print_value("square_share", options.square_share);
  print_choice("factorization", static_cast<int>(options.factorization));
}

void print(const lsgp::Pins& pins) {
  if (pins.corners.empty()) return;
  std::printf("pinned = [");
  for (const lsgp::Index corner : pins.corners) std::printf("%d, ", corner);
  std::printf("]\n");
  print_rows("pinned_uv", pins.positions);
}

void print(const lsgp::PlacementOptions& options) {
  if (options.count) print_choice("count", *options.count);
  print_value("target", options.target);
  if (options.lattice) print_choice("lattice", static_cast<int>(*options.lattice));
  print_choice("prefer_sharp", options.prefer_sharp);
  print_choice("symmetric", options.symmetric);
  if (options.mirror) {
    print_rows("mirror_point", options.mirror->point.transpose());
    print_rows("mirror_normal", options.mirror->normal.transpose());
  }
  print_choice("seams", static_cast<int>(options.seams));
  print_choice("border", static_cast<int>(options.border));
  print_choice("follow_strokes", options.follow_strokes);
}

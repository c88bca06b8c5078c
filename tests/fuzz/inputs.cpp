// SPDX-License-Identifier: GPL-3.0-or-later
#include "inputs.hpp"

#include <algorithm>
#include <cmath>

#include "small_surfaces.hpp"

using lsgp::Index;

namespace {

void add_part(Bytes& bytes, lsgp::Surface& surface) {
  const int shape = bytes.below(6);
  const Index a = 3 + bytes.below(5), b = 3 + bytes.below(4);
  const auto first = static_cast<Index>(surface.positions.rows());
  if (shape < 3) {
    add_sheet(surface, a, b, shape);
  } else if (shape == 3) {
    add_double_pyramid(surface, a);
  } else {  // points for triangles to come, or one triangle without an inner vertex
    surface.positions.conservativeResize(first + a, 3);
    for (Index i = 0; i < a; ++i) surface.positions.row(first + i) << i % 3, i / 2 % 2, i % 2;
    if (shape == 5) add_triangle(surface.triangles, first, first + 1, first + 2);
  }
}

void move_vertices(Bytes& bytes, lsgp::Surface& surface) {
  for (int count = bytes.below(24); count > 0; --count) {
    const Index vertex = bytes.index(surface.positions.rows());
    const double x = bytes.number(), y = bytes.number(), z = bytes.number();
    if (vertex >= 0 && vertex < surface.positions.rows()) surface.positions.row(vertex) << x, y, z;
  }
}

void change_triangles(Bytes& bytes, lsgp::Surface& surface) {
  for (int count = bytes.below(24); count > 0; --count) {
    const auto n = surface.positions.rows(), m = surface.triangles.rows();
    const int what = bytes.byte();
    const Index corner[] = {bytes.index(n), bytes.index(n), bytes.index(n)};
    if (what % 2 == 0 || m == 0) {
      add_triangle(surface.triangles, corner[0], corner[1], corner[2]);
    } else {
      surface.triangles((what / 6) % m, what / 2 % 3) = corner[0];
    }
  }
}

// (count) pairs: sides of triangles, at times anything.
lsgp::VertexPairs make_pairs(Bytes& bytes, const lsgp::Surface& surface, int count) {
  lsgp::VertexPairs pairs(count, 2);
  const auto n = surface.positions.rows(), m = surface.triangles.rows();
  for (int i = 0; i < count; ++i) {
    const int which = bytes.byte() + 256 * bytes.byte();
    if (m == 0 || which == 0xffff) {
      const Index a = bytes.index(n), b = bytes.index(n);
      pairs.row(i) << a, b;
    } else {
      const auto triangle = which / 3 % m;
      const int side = which % 3;
      pairs.row(i) << surface.triangles(triangle, side), surface.triangles(triangle, (side + 1) % 3);
    }
  }
  return pairs;
}

lsgp::Seamless make_seamless(Bytes& bytes) {
  lsgp::Seamless seamless;
  seamless.lattice = bytes.choice<lsgp::Lattice>(5);
  const int size = bytes.below(8);
  if (size == 1) seamless.tiles = bytes.number();
  if (size == 2) seamless.tile_size = bytes.number();
  if (size > 2) seamless.tiles = 1 << (size - 2);
  seamless.parity = bytes.once_in(4);
  seamless.feature_places = bytes.choice<lsgp::FeaturePlaces>(3);
  seamless.coarse_grid = bytes.choice<lsgp::CoarseGrid>(3);
  if (const int cell = bytes.below(16); cell > 12)
    seamless.cell = cell == 13 ? bytes.number() : std::ldexp(1, cell - 16);
  return seamless;
}

}  // namespace

lsgp::Surface make_surface(Bytes& bytes) {
  lsgp::Surface surface;
  surface.positions.resize(0, 3);
  surface.triangles.resize(0, 3);
  for (int parts = 1 + bytes.below(3); parts > 0; --parts) add_part(bytes, surface);
  move_vertices(bytes, surface);
  change_triangles(bytes, surface);
  if (const int scale = bytes.byte(); scale > 250) surface.positions *= std::pow(10, 20 * (scale - 253));
  surface.seams = make_pairs(bytes, surface, bytes.below(16));
  if (bytes.once_in(8)) surface.borders = make_pairs(bytes, surface, bytes.below(16));
  if (bytes.once_in(8)) surface.features = make_pairs(bytes, surface, bytes.below(16));
  if (bytes.once_in(8)) surface.edges = make_pairs(bytes, surface, bytes.below(64));
  if (bytes.once_in(8)) {
    surface.importance.setOnes(bytes.once_in(8) ? bytes.below(4) : surface.positions.rows());
    for (double& weight : surface.importance) weight = bytes.once_in(4) ? bytes.number() : bytes.below(8);
  }
  if (bytes.once_in(8)) {
    surface.directions.setZero(bytes.once_in(8) ? bytes.below(4) : surface.triangles.rows(), 3);
    for (Eigen::Index i = 0; i < surface.directions.size(); ++i) {
      surface.directions.data()[i] = bytes.once_in(4) ? bytes.number() : bytes.below(3) - 1;
    }
  }
  if (bytes.once_in(8)) {
    surface.scale.setOnes(bytes.once_in(8) ? bytes.below(4) : surface.positions.rows());
    for (double& factor : surface.scale) factor = bytes.once_in(16) ? bytes.number() : 1 + bytes.below(8) / 8.0;
  }
  return surface;
}

lsgp::Cones make_cones(Bytes& bytes, const lsgp::Surface& surface) {
  lsgp::Cones cones;
  for (int count = bytes.below(12); count > 0; --count) {
    cones.vertices.push_back(bytes.index(surface.positions.rows()));
    const int angle = bytes.byte();
    if (angle < 128) {
      cones.angles.emplace_back();
    } else {
      cones.angles.emplace_back(angle < 250 ? (angle - 128) / 4 * M_PI / 4 : bytes.number());
    }
  }
  if (bytes.once_in(64)) cones.angles.resize(static_cast<std::size_t>(bytes.below(8)));
  return cones;
}

lsgp::Options make_options(Bytes& bytes, const lsgp::Surface& surface) {
  lsgp::Options options;
  options.prescription = bytes.choice<lsgp::PrescriptionRule>(4);
  options.unfold = bytes.choice<lsgp::UnfoldMethod>(2);
  if (bytes.once_in(8)) options.method = lsgp::Method::lscm;
  options.seams = bytes.choice<lsgp::SeamMode>(4);
  options.border = bytes.choice<lsgp::BorderMode>(3);
  for (int count = bytes.below(8) - 5; count > 0; --count) {
    const Index vertex = bytes.index(surface.positions.rows());
    options.loop_turning.emplace_back(vertex, (bytes.byte() - 64) / 16 * M_PI / 2);
  }
  if (bytes.once_in(4)) options.seamless = make_seamless(bytes);
  if (bytes.once_in(4)) {
    options.mode = lsgp::Mode::low_stretch;
    const int stretch = bytes.below(8);
    options.stretch = stretch == 7 ? bytes.number() : std::min(stretch / 4.0, 1.0);
  }
  options.repair = !bytes.once_in(4);
  if (bytes.once_in(4)) options.overlaps = lsgp::Overlaps::split;
  if (bytes.once_in(4)) options.compact = bytes.choice<lsgp::Compactness>(3);
  if (bytes.once_in(4)) options.square_share = bytes.number();
  options.follow_strokes = !bytes.once_in(4);
  options.factorization = bytes.choice<lsgp::Factorization>(3);
  return options;
}

lsgp::Pins make_pins(Bytes& bytes, const lsgp::Surface& surface) {
  lsgp::Pins pins;
  const int count = bytes.once_in(6) ? bytes.below(8) : 0;
  pins.positions.resize(count, 2);
  for (int i = 0; i < count; ++i) {
    pins.corners.push_back(bytes.index(3 * surface.triangles.rows()));
    const double u = bytes.number(), v = bytes.number();
    pins.positions.row(i) << u, v;
  }
  return pins;
}

lsgp::PlacementOptions make_placement_options(Bytes& bytes) {
  lsgp::PlacementOptions options;
  if (const int count = bytes.below(16); count > 0) options.count = count == 15 ? 1000 : count - 2;
  if (bytes.once_in(4)) options.target = bytes.once_in(4) ? bytes.number() : 1 + bytes.byte() / 256.0;
  if (bytes.once_in(4)) options.lattice = bytes.choice<lsgp::Lattice>(5);
  options.prefer_sharp = bytes.once_in(4);
  options.symmetric = bytes.once_in(4);
  if (options.symmetric && bytes.once_in(2)) {
    options.mirror.emplace();
    for (double& x : options.mirror->point) x = bytes.number();
    for (double& x : options.mirror->normal) x = bytes.number();
  }
  options.seams = bytes.choice<lsgp::SeamMode>(4);
  options.follow_strokes = !bytes.once_in(4);
  return options;
}

lsgp::CornerUv make_corner_uv(Bytes& bytes, const lsgp::Surface& surface) {
  lsgp::CornerUv uv(bytes.once_in(16) ? bytes.below(8) : 3 * surface.triangles.rows(), 2);
  for (auto row : uv.rowwise()) {
    const double u = bytes.number(), v = bytes.number();
    row << u, v;
  }
  return uv;
}

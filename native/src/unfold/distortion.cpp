// SPDX-License-Identifier: GPL-3.0-or-later
#include "unfold/distortion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/thread_team.hpp"
#include "mesh/geometry.hpp"

namespace lsgp {

namespace {

constexpr double exact_seam = 1e-9;          // of an edge's length, and radians
constexpr double exact_translation = 1e-12;  // of the layout, beside the rounding of its coordinates
constexpr double coordinate_rounding = 4 * std::numeric_limits<double>::epsilon();
constexpr double exact_angle = 1e-6;  // radians
constexpr double wrong_angle = M_PI / 180;
constexpr double unlimited = std::numeric_limits<double>::infinity();

// numpy's percentile: linear between the two nearest ranks.
double percentile(Array<double>& values, double share) {
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), values.begin() + below, values.end());
  const double low = values[below], beyond = rank - static_cast<double>(below);
  if (beyond == 0 || std::isinf(low)) return low;
  const double high = *std::min_element(values.begin() + below + 1, values.end());
  return low + beyond * (high - low);
}

// A triangle on the surface and in the plane.
struct Measured {
  double doubled, uv_doubled;  // areas; the one on the surface is 0 where there is nothing to measure
  double ratio;                // of the singular values, the larger one to the smaller one
  double shrinkage;            // of the areas, that on the surface to that in the plane
  double largest_square;       // of the singular values
};

Measured measure(const Surface& surface, const CornerUv& corner_uv, Index f) {
  Complex z[3];
  for (int c = 0; c < 3; ++c) z[c] = {corner_uv(3 * f + c, 0), corner_uv(3 * f + c, 1)};
  const auto [square, dot, doubled] = two_sides(surface.positions, surface.triangles, surface.scale, f);
  Measured out{};
  if (!(doubled > 0)) return out;
  out.doubled = doubled;
  // The derivatives along the first edge and across it, times the edge's length.
  const Complex along = z[1] - z[0], across = ((z[2] - z[0]) * square - along * dot) / doubled;
  const double both =
      std::sqrt(std::norm(along - Complex(0, 1) * across)) + std::sqrt(std::norm(along + Complex(0, 1) * across));
  out.largest_square = both * both / (4 * square);
  // The product of both by the area, not as a difference, which would lose the digits of thin images.
  out.uv_doubled = std::abs(std::imag(std::conj(along) * (z[2] - z[0])));
  const bool is_point = !(out.largest_square > 0);  // no ratio of directions: as bad as a line
  out.shrinkage = doubled / out.uv_doubled;
  out.ratio = is_point ? unlimited : out.largest_square * out.shrinkage;
  return out;
}

// Of an edge with a length and a direction: shorter ones are points to within the single precision of positions.
double shortest_edge(const Positions& positions) {
  return std::numeric_limits<float>::epsilon() *
         (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

}  // namespace

Distortion measure_triangles(const Surface& surface, const CornerUv& corner_uv, const Array<Index>& triangles) {
  Distortion out;
  Array<double> ratios;  // of the areas on the surface to those in the plane
  ratios.reserve(triangles.size());
  L2Stretch stretch;
  double area = 0, uv_area = 0;
  Array<Measured> measured(triangles.size());
  for_each_at_once(ssize(triangles),
                   [&](std::ptrdiff_t i) { measured[i] = measure(surface, corner_uv, triangles[i]); });
  for (const Measured& one : measured) {
    if (!(one.doubled > 0)) continue;
    area += one.doubled / 2;
    uv_area += one.uv_doubled / 2;
    out.quasi_conformal += one.ratio;
    out.quasi_conformal_area_weighted += one.ratio * one.doubled / 2;
    stretch.add(one.doubled / 2, one.uv_doubled / 2, (1 / one.largest_square + one.ratio * one.shrinkage) / 2);
    ratios.push_back(one.shrinkage);
  }
  if (ratios.empty()) return out;
  // Everything on one line or point.
  if (!(uv_area > 0)) return {unlimited, unlimited, unlimited, unlimited, unlimited, unlimited};
  const double count = static_cast<double>(ratios.size());
  out.quasi_conformal /= count;
  out.quasi_conformal_area_weighted /= area;
  for (double& ratio : ratios) {
    ratio *= uv_area / area;
    out.area += ratio / count;
  }
  out.area_p10 = percentile(ratios, 0.1);
  out.area_p90 = percentile(ratios, 0.9);
  out.l2_stretch = stretch.value();
  return out;
}

SeamQuality measure_seams(const HalfedgeMesh& mesh, const CutGraph& cut_graph, const CornerPositions& position,
                          const Eigen::VectorXd* rotation, Array<Index>* inexact) {
  PositionBox box;
  for (const Complex z : position) box.add(z);
  Array<SisterEdges> seams;
  for (std::size_t p = 0; p < cut_graph.cuts.size(); ++p) {
    seams.push_back({cut_graph.cuts[p].halfedges, std::nullopt, box.size()});
    if (rotation) seams.back().rotation = (*rotation)[static_cast<Eigen::Index>(p)];
  }
  return measure_seams(mesh, seams, position, inexact);
}

SeamQuality measure_seams(const HalfedgeMesh& mesh, const Array<SisterEdges>& seams, const CornerPositions& position,
                          Array<Index>* inexact) {
  SeamQuality out;
  if (inexact) inexact->clear();
  const double shortest = shortest_edge(mesh.positions);
  const auto is_point = [&](Index h) {
    return !((mesh.positions.row(mesh.origin(h)) - mesh.positions.row(mesh.target(h))).norm() > shortest);
  };
  for (const auto& [halfedges, rotation, size] : seams) {
    // Corners of both sides of one halfedge: left origin, left target, right origin, right target.
    const auto ends = [&](Index h) {
      const Index twin = mesh.twin[h];
      return std::array<Complex, 4>{position[h], position[next(h)], position[next(twin)], position[twin]};
    };
    Complex turn = 0;
    for (const Index h : halfedges) {
      const auto z = ends(h);
      const Complex left = z[1] - z[0], right = z[3] - z[2];
      turn += std::conj(left) * right;
      if (is_point(h)) continue;
      const double longer = std::max(std::abs(left), std::abs(right)),
                   shorter = std::min(std::abs(left), std::abs(right));
      // A collapsed edge counts as the smallest number, so that the ratio stays finite.
      out.sister_ratio_max =
          std::max(out.sister_ratio_max, longer / std::max(shorter, std::numeric_limits<double>::min()));
    }
    turn = rotation ? std::polar(1.0, *rotation) : turn / std::max(std::abs(turn), std::numeric_limits<double>::min());
    Complex translation = 0;
    for (const Index h : halfedges) {
      const auto z = ends(h);
      translation += ((z[2] - turn * z[0]) + (z[3] - turn * z[1])) / (2.0 * static_cast<double>(halfedges.size()));
      if (is_point(h)) continue;
      const double off = std::abs(std::arg((z[3] - z[2]) * std::conj(turn * (z[1] - z[0]))));
      out.rotation_residual = std::max(out.rotation_residual, off);
      const double left = std::abs(z[1] - z[0]), right = std::abs(z[3] - z[2]);
      if (inexact && !(std::max(off, std::abs(left - right) / std::min(left, right)) <= exact_seam))
        inexact->push_back(h);
    }
    for (const Index h : halfedges) {
      const auto z = ends(h);
      for (const std::size_t end : {0u, 1u}) {
        const double off = std::abs(z[2 + end] - turn * z[end] - translation) / size;
        out.translation_residual = std::max(out.translation_residual, off);
        const double rounding = coordinate_rounding * std::max(std::abs(z[end]), std::abs(z[2 + end])) / size;
        if (inexact && !(off <= exact_translation + rounding)) inexact->push_back(h);
      }
    }
  }
  if (inexact) sort_unique(*inexact);
  return out;
}

SeamQuality worse(const SeamQuality& a, const SeamQuality& b) {
  return {std::max(a.sister_ratio_max, b.sister_ratio_max), std::max(a.rotation_residual, b.rotation_residual),
          std::max(a.translation_residual, b.translation_residual)};
}

Eigen::VectorXd angle_sums(const HalfedgeMesh& mesh, const CornerPositions& position) {
  // Around a vertex where the layout continues, upright triangles make full turns: it suffices to count how often they
  // sweep over one direction. Elsewhere angles have to be measured.
  PerVertex<char> is_parted(mesh.vertex_count(), 0), is_measured(mesh.vertex_count(), 0);
  for (const auto& loop : mesh.boundary_loops) {
    for (const Index v : loop) is_measured[v] = 1;
  }
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(mesh.vertex_count());
  const Eigen::VectorXcd at_vertex = position(mesh.outgoing);  // in one of its corners
  constexpr int parted = 1, sweeps = 8, turned = 64;           // bits; the first two for each corner
  PerTriangle<char> seen(mesh.triangle_count());
  for_each_at_once(mesh.triangle_count(), [&](Index f) {
    const Complex z[]{position[3 * f], position[3 * f + 1], position[3 * f + 2]};
    int bits = side(z[0], z[1], z[2]) > 0 ? 0 : turned;
    for (int c = 0; c < 3; ++c) {
      if (z[c] != at_vertex[mesh.triangles(f, c)]) bits |= parted << c;
      if (z[(c + 1) % 3].imag() < z[c].imag() && z[(c + 2) % 3].imag() >= z[c].imag()) bits |= sweeps << c;
    }
    seen[f] = static_cast<char>(bits);
  });
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const Index v = mesh.triangles(f, c);
      if (seen[f] & (parted << c)) is_parted[v] = 1;
      if (seen[f] & (sweeps << c)) sums[v] += 2 * M_PI;
      if (seen[f] & turned) is_measured[v] = 1;
    }
  }
  for (Index f = 0; f < mesh.triangle_count(); ++f) {  // the layout ends at edges of parted vertices
    const Index a = mesh.triangles(f, 0), b = mesh.triangles(f, 1), c = mesh.triangles(f, 2);
    if (is_parted[a] | is_parted[b] | is_parted[c]) is_measured[a] = is_measured[b] = is_measured[c] = 1;
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (is_measured[v]) sums[v] = 0;
  }
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    const auto is_ours = [&](Index corner) { return is_measured[mesh.origin(corner)] != 0; };
    if (!is_ours(3 * f) && !is_ours(3 * f + 1) && !is_ours(3 * f + 2)) continue;
    double third = std::copysign(M_PI, doubled_area(position, f));
    for (const Index corner : {3 * f, 3 * f + 1}) {
      const Complex here = position[corner];
      const double angle = std::arg((position[prev(corner)] - here) * std::conj(position[next(corner)] - here));
      if (is_ours(corner)) sums[mesh.origin(corner)] += angle;
      third -= angle;
    }
    if (is_ours(3 * f + 2)) sums[mesh.origin(3 * f + 2)] += third;
  }
  return sums;
}

Validity check_map(const HalfedgeMesh& mesh, const CornerPositions& position, const Eigen::VectorXd& curvature,
                   const PerVertex<char>& is_free) {
  Validity out;
  for (Index f = 0; f < mesh.triangle_count(); ++f) {
    if (!(doubled_area(position, f) > 0)) out.flipped.push_back(f);
  }
  const Eigen::VectorXd sums = angle_sums(mesh, position);
  const auto excess = [&](Index v) { return sums[v] - (mesh.flat_angle(v) - curvature[v]); };
  // Along a free boundary single angles are free; only the total turning is known.
  PerLoop<double> excess_of_loop(mesh.boundary_loops.size(), 0.0), largest(excess_of_loop);
  PerLoop<Index> at_largest(excess_of_loop.size(), none);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double error = std::abs(excess(v));
    if (is_free[v]) {
      const Index loop = mesh.loop_of_vertex[v];
      excess_of_loop[loop] += excess(v);
      if (error < largest[loop]) continue;
      largest[loop] = error;
      at_largest[loop] = v;
      continue;
    }
    if (!(error <= wrong_angle))
      out.wrong_angle_sums.push_back(v);
    else if (!(error <= exact_angle))
      out.inexact_angles.push_back(v);
    if (curvature[v] != 0) out.cone_angle_error = std::max(out.cone_angle_error, error);
  }
  for (std::size_t loop = 0; loop < excess_of_loop.size(); ++loop) {
    if (!(std::abs(excess_of_loop[loop]) < M_PI)) out.wrong_angle_sums.push_back(at_largest[loop]);
  }
  std::sort(out.wrong_angle_sums.begin(), out.wrong_angle_sums.end());
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature.hpp"

#include <algorithm>
#include <cmath>

#include "energies/quadratic_forms.hpp"
#include "straightness.hpp"
#include "text.hpp"

namespace lsgp {

namespace {

// Automatic angles stay where a map with them can be expected to have no flips; the bounds are widened where the
// harmonic angles lie outside, since a sharp tip may need less and a branching limb more.
constexpr double smallest_angle = M_PI / 4;
constexpr double largest_angle = 4 * M_PI;
constexpr double largest_share_of_valence = 0.6;  // of pi per triangle
// Outside these no map exists, or none worth having.
constexpr double impossible_angle = 0.02 * M_PI;
constexpr double impossible_share_of_valence = 1;

constexpr double renormalized_mismatch = 1e-6;  // of Gauss-Bonnet, radians
constexpr double high_l2 = 3;

// Bounds of the cone curvatures; fixed cones have both equal.
struct Bounds {
  Eigen::VectorXd low, high;
};

Bounds bounds_from_angles(const HalfedgeMesh& mesh, const ComponentCones& cones, double smallest, double largest,
                          double share) {
  const Index k = static_cast<Index>(cones.vertices.size());
  Bounds bounds{Eigen::VectorXd(k), Eigen::VectorXd(k)};
  for (Index i = 0; i < k; ++i) {
    const double most = std::min(largest, share * M_PI * valence(mesh, cones.vertices[i]));
    bounds.high[i] = 2 * M_PI - (cones.angles[i] ? *cones.angles[i] : smallest);
    bounds.low[i] = 2 * M_PI - (cones.angles[i] ? *cones.angles[i] : most);
  }
  return bounds;
}

// The point between the bounds with the given sum that is nearest to the wanted one, by bisection on a common shift.
Eigen::VectorXd shift_into(const Bounds& bounds, const Eigen::VectorXd& wanted, double sum) {
  const auto at = [&](double shift) {
    return Eigen::VectorXd((wanted.array() + shift).matrix().cwiseMax(bounds.low).cwiseMin(bounds.high));
  };
  double below = (bounds.low - wanted).minCoeff() - 1, above = (bounds.high - wanted).maxCoeff() + 1;
  for (int i = 0; i < 200 && below < above; ++i) {
    const double middle = below + (above - below) / 2;
    if (middle <= below || middle >= above) break;
    (at(middle).sum() < sum ? below : above) = middle;
  }
  return at(above);
}

bool all_fixed(const ComponentCones& cones) {
  return std::all_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
}

[[noreturn]] void throw_gauss_bonnet(const ComponentCones& cones, double sum, double required, const char* remedy) {
  throw Error(Code::gauss_bonnet,
              concat("The ", count(cones.vertices.size(), "cone angle leaves", "cone angles leave"), " a curvature of ",
                     sum / M_PI, " pi in sum (", sum, "), but this surface requires ", required / M_PI, " pi (",
                     required, "). ", remedy),
              {ElementKind::vertices, cones.vertices});
}

// Refuses what no choice of the automatic angles can mend.
void require_feasible(const HalfedgeMesh& mesh, const ComponentCones& cones) {
  std::vector<Index> overloaded;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const int triangles = valence(mesh, cones.vertices[i]);
    if (cones.angles[i] && *cones.angles[i] >= M_PI * triangles) overloaded.push_back(cones.vertices[i]);
  }
  if (!overloaded.empty()) {
    throw Error(Code::cone_angle_range,
                concat(count(overloaded.size(), "cone has", "cones have"),
                       " an angle that the triangles around it cannot carry, less than 180 degrees each. Lower the "
                       "angle or subdivide the mesh there."),
                {ElementKind::vertices, overloaded});
  }
  if (!mesh.closed()) return;
  const double required = 2 * M_PI * mesh.euler;
  if (cones.vertices.empty()) {
    if (mesh.euler == 0) return;
    throw Error(Code::too_few_cones,
                concat("A closed surface without cones cannot be unfolded: its curvature of ", required / M_PI,
                       " pi has to go somewhere. Mark cones at tips and corners, or place them automatically."));
  }
  const Bounds widest =
      bounds_from_angles(mesh, cones, impossible_angle, largest_angle * 1e3, impossible_share_of_valence);
  if (all_fixed(cones)) {
    const double sum = widest.low.sum();
    if (std::abs(sum - required) > renormalized_mismatch) {
      throw_gauss_bonnet(cones, sum, required, "Change an angle, or leave one automatic to take up the rest.");
    }
    return;
  }
  if (widest.low.sum() <= required && required <= widest.high.sum()) return;
  const bool some_fixed =
      std::any_of(cones.angles.begin(), cones.angles.end(), [](const auto& a) { return a.has_value(); });
  if (some_fixed) {
    throw_gauss_bonnet(cones, required < widest.low.sum() ? widest.low.sum() : widest.high.sum(), required,
                       "The automatic cones cannot take up the rest: change the given angles or add cones.");
  }
  throw Error(
      Code::too_few_cones,
      concat(count(cones.vertices.size(), "cone cannot", "cones cannot"), " take up the surface's curvature of ",
             required / M_PI, " pi, less than 2 pi each. Mark more cones, or place them automatically."),
      {ElementKind::vertices, cones.vertices});
}

Eigen::VectorXd least_distortion(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale) {
  const Eigen::VectorXd harmonic = scale.harmonic_curvature();
  Bounds bounds = bounds_from_angles(mesh, cones, smallest_angle, largest_angle, largest_share_of_valence);
  const Bounds widest =
      bounds_from_angles(mesh, cones, impossible_angle, largest_angle * 1e3, impossible_share_of_valence);
  for (Eigen::Index i = 0; i < harmonic.size(); ++i) {
    if (cones.angles[i]) continue;
    bounds.low[i] = std::max(widest.low[i], std::min(bounds.low[i], harmonic[i]));
    bounds.high[i] = std::min(widest.high[i], std::max(bounds.high[i], harmonic[i]));
  }
  Eigen::VectorXd start = harmonic.cwiseMax(bounds.low).cwiseMin(bounds.high);
  if (mesh.closed()) {
    const double required = 2 * M_PI * mesh.euler;
    if (bounds.low.sum() > required || bounds.high.sum() < required) bounds = widest;
    start = shift_into(bounds, start, required);
  }
  return scale.least_distortion_curvature(bounds.low, bounds.high, std::move(start));
}

Eigen::VectorXd harmonic(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale) {
  const Eigen::VectorXd curvature = scale.harmonic_curvature();
  std::vector<Index> impossible;
  for (Eigen::Index i = 0; i < curvature.size(); ++i) {
    const double angle = 2 * M_PI - curvature[i];
    if (angle < impossible_angle || angle >= M_PI * valence(mesh, cones.vertices[i]))
      impossible.push_back(cones.vertices[i]);
  }
  if (!impossible.empty()) {
    throw Error(Code::cone_angle_range,
                concat("The harmonic angle of ", count(impossible.size(), "cone", "cones"),
                       " is one no map can have. Add cones near it, or use the least-distortion prescription."),
                {ElementKind::vertices, impossible});
  }
  return curvature;
}

// The paper's rule; the angles that junctions of the cut read are handed on to the cones in equal parts.
std::optional<Eigen::VectorXd> straightness(const HalfedgeMesh& mesh, const Geometry& geometry,
                                            const CutGraph& cut_graph, const CutMesh& cut_mesh,
                                            const ComponentCones& cones, std::vector<Finding>& findings) {
  if (!mesh.closed()) {
    // With a free border the straightened layout is an arbitrary one of many, and so are its angles.
    findings.push_back(
        {Code::straightness_failed,
         "Straight cuts give usable cone angles on closed surfaces only, and this one has an open border. The "
         "least-distortion angles were used instead.",
         {ElementKind::vertices, cones.vertices}});
    return std::nullopt;
  }
  const StraightenedLayout layout = straighten(mesh, geometry, cut_graph, cut_mesh);
  const Index k = static_cast<Index>(cones.vertices.size());
  Eigen::VectorXd curvature(k);
  for (Index i = 0; i < k; ++i) curvature[i] = layout.curvature[cones.vertices[i]];
  const double junctions = layout.curvature.sum() - curvature.sum();
  curvature.array() += junctions / k;

  std::string failure = layout.failure;
  for (Index i = 0; i < k && failure.empty(); ++i) {
    const double angle = 2 * M_PI - curvature[i];
    if (angle < impossible_angle || angle >= M_PI * valence(mesh, cones.vertices[i])) {
      failure = concat("a cone would keep an angle of ", angle / M_PI, " pi");
    }
  }
  if (!failure.empty()) {
    findings.push_back({Code::straightness_failed,
                        concat("Straight cuts give no usable cone angles here: ", failure, " (", layout.crossings,
                               " crossings at first). The least-distortion angles were used instead."),
                        {ElementKind::vertices, cones.vertices}});
    return std::nullopt;
  }
  std::vector<Index> junction_vertices;
  for (const Cut& cut : cut_graph.cuts) {
    for (const Index v : {cut.tail, cut.head}) {
      const bool is_cone = std::find(cones.vertices.begin(), cones.vertices.end(), v) != cones.vertices.end();
      const bool listed = std::find(junction_vertices.begin(), junction_vertices.end(), v) != junction_vertices.end();
      if (!is_cone && !listed) junction_vertices.push_back(v);
    }
  }
  if (!junction_vertices.empty()) {
    findings.push_back({Code::junction_share,
                        concat("Straight cuts left a curvature of ", junctions / M_PI, " pi (", junctions, ") at ",
                               count(junction_vertices.size(), "junction", "junctions"),
                               " of the cut; it was shared out evenly among the cones."),
                        {ElementKind::vertices, junction_vertices}});
  }
  return curvature;
}

}  // namespace

int valence(const HalfedgeMesh& mesh, Index vertex) {
  int triangles = 0;
  mesh.for_each_outgoing(vertex, [&](Index) { ++triangles; });
  return triangles;
}

Curvature prescribe(const HalfedgeMesh& mesh, const Geometry& geometry, const CutGraph& cut_graph,
                    const CutMesh& cut_mesh, const ComponentCones& cones, PrescriptionRule rule,
                    std::vector<Finding>& findings) {
  ComponentCones asked = cones;
  if (rule != PrescriptionRule::manual) std::fill(asked.angles.begin(), asked.angles.end(), std::nullopt);
  require_feasible(mesh, asked);
  LogScale scale(mesh, geometry);
  scale.add_cones(asked.vertices);

  Eigen::VectorXd curvature(asked.vertices.size());
  std::optional<Eigen::VectorXd> straight;
  if (asked.vertices.empty()) {
    // A closed torus or a surface with boundary: flat everywhere.
  } else if (all_fixed(asked)) {
    for (Eigen::Index i = 0; i < curvature.size(); ++i) curvature[i] = 2 * M_PI - *asked.angles[i];
  } else if (rule == PrescriptionRule::harmonic) {
    curvature = harmonic(mesh, asked, scale);
  } else if (rule == PrescriptionRule::straightness &&
             (straight = straightness(mesh, geometry, cut_graph, cut_mesh, asked, findings))) {
    curvature = *straight;
  } else {
    curvature = least_distortion(mesh, asked, scale);
  }
  if (mesh.closed() && curvature.size() > 0) {
    curvature.array() += (2 * M_PI * mesh.euler - curvature.sum()) / static_cast<double>(curvature.size());
  }

  Curvature out;
  out.log_scale = scale.evaluate(curvature);
  out.predicted_l2 = scale.predicted_l2(out.log_scale);
  out.at_vertex = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index i = 0; i < curvature.size(); ++i) out.at_vertex[asked.vertices[i]] = curvature[i];
  if (!mesh.closed()) {
    // On a boundary the curvature is what the log scale makes of it: kappa = K + L y.
    const Eigen::VectorXd free = geometry.angle_defect + apply_laplacian(mesh, geometry, out.log_scale);
    for (const auto& loop : mesh.boundary_loops) {
      for (const Index v : loop) out.at_vertex[v] = free[v];
    }
  }
  if (!(out.predicted_l2 < high_l2)) {
    findings.push_back({Code::high_distortion,
                        concat("With these cones the map stretches much: an L2 stretch of ", out.predicted_l2,
                               " is expected, 1 being none. Add cones where the texture becomes too small."),
                        {ElementKind::vertices, asked.vertices}});
  }
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "prescription/curvature.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text.hpp"
#include "prescription/angle_flow.hpp"
#include "prescription/border_turning.hpp"
#include "prescription/component_system.hpp"
#include "prescription/quantize_curvature.hpp"
#include "prescription/straight_angles.hpp"
#include "prescription/stroke_fit.hpp"
#include "solvers/box_qp.hpp"
#include "systems/quadratic_forms.hpp"

namespace lsgp {

namespace {

// Bounds of automatic angles for which maps are expected to have no flips.
constexpr double largest_share_of_valence = 0.6;  // of pi per triangle
// Outside these no useful map exists.
constexpr double impossible_angle = 0.02 * M_PI;
constexpr double impossible_share_of_valence = 1;

constexpr double renormalized_mismatch = 1e-6;  // of Gauss-Bonnet, radians

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
    const double flat = mesh.flat_angle(cones.vertices[i]);
    bounds.high[i] = flat - (cones.angles[i] ? *cones.angles[i] : smallest);
    bounds.low[i] = flat - (cones.angles[i] ? *cones.angles[i] : most);
  }
  return bounds;
}

// Beyond these no map exists.
Bounds widest_bounds(const HalfedgeMesh& mesh, const ComponentCones& cones) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  return bounds_from_angles(mesh, cones, impossible_angle, unlimited, impossible_share_of_valence);
}

bool all_fixed(const ComponentCones& cones) {
  return std::all_of(cones.angles.begin(), cones.angles.end(), [](const auto& angle) { return angle.has_value(); });
}

// Whether a sum of curvatures is fixed by given angles or bounded by chosen ones.
enum class Sum { is, is_at_most, is_at_least };

[[noreturn]] void throw_gauss_bonnet(const ComponentCones& cones, Sum how, double sum, double required) {
  const char* bound = how == Sum::is ? "" : how == Sum::is_at_most ? "at most " : "at least ";
  const std::string missing = concat(rounded(std::abs(required - sum) * 180 / M_PI), " degrees");
  throw Error(Code::gauss_bonnet,
              concat("The ", count(cones.vertices.size(), "cone angle leaves", "cone angles leave"), " a curvature of ",
                     bound, degrees(sum), " in sum, but this surface requires ", degrees(required), ": the angles are ",
                     missing, " too ", sum < required ? "large" : "small", " together. ",
                     how == Sum::is ? "Change an angle, or leave one automatic to take up the rest."
                                    : "The automatic cones cannot take up the rest: change the given angles or add "
                                      "cones."),
              {ElementKind::vertices, cones.vertices});
}

// Curvatures of least distortion, and the bounds they were chosen within.
struct LeastDistortion {
  Bounds bounds;
  Eigen::VectorXd curvature;
};

LeastDistortion least_distortion(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale) {
  const Eigen::VectorXd harmonic = scale.harmonic_curvature();
  Bounds bounds = bounds_from_angles(mesh, cones, cones.range.smallest, cones.range.largest, largest_share_of_valence);
  const Bounds widest = widest_bounds(mesh, cones);
  for (Eigen::Index i = 0; i < harmonic.size(); ++i) {
    if (cones.angles[i] || !cones.range.widened) continue;
    bounds.low[i] = std::max(widest.low[i], std::min(bounds.low[i], harmonic[i]));
    bounds.high[i] = std::min(widest.high[i], std::max(bounds.high[i], harmonic[i]));
  }
  Eigen::VectorXd start = harmonic.cwiseMax(bounds.low).cwiseMin(bounds.high);
  if (scale.balanced()) {
    const double required = scale.required_sum();
    if (bounds.low.sum() > required) bounds.low = widest.low;
    if (bounds.high.sum() < required) bounds.high = widest.high;
    start = nearest_with_sum(bounds.low, bounds.high, start, required);
  }
  Eigen::VectorXd curvature = scale.least_distortion_curvature(bounds.low, bounds.high, std::move(start));
  return {std::move(bounds), std::move(curvature)};
}

// The curvatures that `choose(misfit, price)` returns for the highest price of the strokes' misfit that costs little
// stretch, or the usual ones.
template <typename Choose>
Eigen::VectorXd follow_strokes(const LogScale& scale, const StrokeFit& fit, const Eigen::VectorXd& usual,
                               const Choose& choose) {
  constexpr double prices[] = {16, 4, 1, 0.25, 0.0625};  // of 1 radian^2, in the logarithm of the L2 stretch
  constexpr double most_growth = 1.1;
  const auto l2 = [&](const Eigen::VectorXd& curvature) { return scale.predicted_l2(scale.evaluate_held(curvature)); };
  const double most_l2 = most_growth * l2(usual), missed = fit.misfit(usual);
  const LogScale::Variance form = fit.form_near(usual);
  for (const double price : prices) {
    Eigen::VectorXd found = choose(form, price);
    if (fit.misfit(found) < missed && l2(found) <= most_l2) return found;
  }
  return usual;
}

// The same with curvatures within the bounds of those of least distortion. To second order, the logarithm of the L2
// stretch grows by twice what the variance of the log scale does.
Eigen::VectorXd follow_strokes(const LogScale& scale, const StrokeFit& fit, const LeastDistortion& least) {
  constexpr double ridge = 1e-9;  // relative; the sum may have no effect on the variance
  const Eigen::MatrixXd variance = scale.variance().hessian;
  const Eigen::VectorXd low = least.bounds.low - least.curvature, high = least.bounds.high - least.curvature;
  return follow_strokes(scale, fit, least.curvature, [&](const LogScale::Variance& misfit, double price) {
    Eigen::MatrixXd hessian = 4 * variance + 2 * price * misfit.hessian;
    hessian.diagonal().array() += ridge * hessian.trace();
    BoxProgram program(scale.balanced());
    program.set_hessian(std::move(hessian));
    const Eigen::VectorXd gradient = 2 * price * (misfit.gradient + misfit.hessian * least.curvature);
    return Eigen::VectorXd(least.curvature + program.minimize(gradient, low, high));
  });
}

// If it is a number worth comparing.
std::string expected_stretch(double l2) {
  constexpr double telling = 1e6;
  return l2 < telling ? concat("an L2 stretch of ", rounded(l2), " is expected, 1 being none, and ") : "";
}

Eigen::VectorXd harmonic(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale) {
  const Eigen::VectorXd curvature = scale.harmonic_curvature();
  Array<Index> impossible;
  for (Eigen::Index i = 0; i < curvature.size(); ++i) {
    if (!is_possible(mesh, cones.vertices[i], curvature[i])) impossible.push_back(cones.vertices[i]);
  }
  if (!impossible.empty()) {
    throw Error(Code::cone_angle_range,
                concat("The harmonic angle of ", count(impossible.size(), "cone is", "cones is"),
                       " one that no map can have. Add cones near it, or use the least-distortion prescription."),
                {ElementKind::vertices, impossible});
  }
  return curvature;
}

// Of straight cuts, which the system then keeps, or those of least distortion.
Eigen::VectorXd straightness(ComponentSystem& system, const ComponentCones& cones, const Eigen::VectorXd& least,
                             std::vector<Finding>& findings) {
  const StraightAngles& straight = system.straight_angles(cones, least);
  findings.insert(findings.end(), straight.findings.begin(), straight.findings.end());
  return straight.curvature.size() > 0 ? straight.curvature : least;
}

}  // namespace

bool is_possible(const HalfedgeMesh& mesh, Index vertex, double curvature) {
  const double angle = mesh.flat_angle(vertex) - curvature;
  return angle >= impossible_angle && angle < M_PI * valence(mesh, vertex);
}

std::pair<double, double> room_of_automatic(const HalfedgeMesh& mesh, const ComponentCones& cones) {
  const Bounds bounds = widest_bounds(mesh, cones);
  double low = 0, high = 0;
  for (Eigen::Index i = 0; i < bounds.low.size(); ++i) {
    if (cones.angles[i]) continue;
    low += bounds.low[i];
    high += bounds.high[i];
  }
  return {low, high};
}

int valence(const HalfedgeMesh& mesh, Index vertex) {
  int triangles = 0;
  mesh.for_each_outgoing(vertex, [&](Index) { ++triangles; });
  return triangles;
}

BorderConditions border_conditions(const MetricMesh& surface, const ComponentCones& cones) {
  const HalfedgeMesh& mesh = surface.mesh;
  return cones.border == BorderMode::straight && !mesh.closed() ? straight_border(surface, cones.vertices)
                                                                : free_border(mesh, cones.vertices);
}

void require_feasible(const HalfedgeMesh& mesh, const ComponentCones& cones, const BorderConditions& border) {
  Array<Index> overloaded;
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
  if (!border.balanced) return;
  const double required = 2 * M_PI * mesh.euler - border.curvature.sum();
  if (cones.vertices.empty()) {
    if (std::abs(required) < renormalized_mismatch) return;
    if (!mesh.closed()) {
      throw Error(Code::too_few_cones, concat("A straight boundary has to turn by ", degrees(required),
                                              " in all, at marked corners. Mark the boundary's corners as cones, or "
                                              "leave the boundary free."));
    }
    throw Error(Code::too_few_cones,
                concat("A closed surface without cones cannot be unfolded: its curvature of ", degrees(required),
                       " has to be at cones. Mark cones at tips and corners, or place them automatically."));
  }
  const Bounds widest = widest_bounds(mesh, cones);
  if (all_fixed(cones)) {
    const double sum = widest.low.sum();
    if (std::abs(sum - required) > renormalized_mismatch) {
      throw_gauss_bonnet(cones, Sum::is, sum, required);
    }
    return;
  }
  if (widest.low.sum() <= required && required <= widest.high.sum()) return;
  const bool some_fixed =
      std::any_of(cones.angles.begin(), cones.angles.end(), [](const auto& a) { return a.has_value(); });
  if (some_fixed) {
    if (required < widest.low.sum()) throw_gauss_bonnet(cones, Sum::is_at_least, widest.low.sum(), required);
    throw_gauss_bonnet(cones, Sum::is_at_most, widest.high.sum(), required);
  }
  const char* most = required > 0 ? ", less than 360 degrees each" : " with the triangles around them";
  throw Error(
      Code::too_few_cones,
      concat(count(cones.vertices.size(), "cone cannot", "cones cannot"), " take up the surface's curvature of ",
             degrees(required), most, ". Mark more cones, or place them automatically."),
      {ElementKind::vertices, cones.vertices});
}

AngleSums required_angles(const MetricMesh& surface, const ComponentCones& cones) {
  const HalfedgeMesh& mesh = surface.mesh;
  const BorderConditions border = border_conditions(surface, cones);
  AngleSums out{Eigen::VectorXd(mesh.vertex_count()), border.held};
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    out.angle[v] = mesh.flat_angle(v) - border.curvature[v];
    out.is_free[v] |= border.curvature[v] != 0;  // teeth
  }
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Index v = cones.vertices[i];
    out.is_free[v] = !cones.angles[i] || cones.rotation_order > 0;  // rounded angles are the tool's own choice
    if (!out.is_free[v]) out.angle[v] = *cones.angles[i];
  }
  return out;
}

namespace {

// The angles of a metric to first order in its log scale, (3m): those of every triangle add up to half a turn, and
// those around every vertex to what the prescribed curvature leaves, as the log scale solves a linear equation. Where
// it changes much within a triangle, they may be negative.
Eigen::VectorXd linear_angles(const MetricMesh& surface, const Eigen::VectorXd& log_scale) {
  const auto& [mesh, geometry] = surface;
  Eigen::VectorXd out = geometry.angle;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const double change = geometry.half_cotangent[h] * (log_scale[mesh.target(h)] - log_scale[mesh.origin(h)]);
    out[h] += change;
    out[next(h)] -= change;
  }
  return out;
}

}  // namespace

void require_possible(const MetricMesh& surface, const ComponentCones& cones, const Eigen::VectorXd& log_scale) {
  const AngleSums required = required_angles(surface, cones);
  Array<Index> given;
  for (const Index v : cones.vertices) {
    if (!required.is_free[v]) given.push_back(v);
  }
  require_possible_angles(surface.mesh, required.angle, required.is_free, linear_angles(surface, log_scale), given);
}

Curvature prescribe(ComponentSystem& system, const ComponentCones& cones, PrescriptionRule rule,
                    std::vector<Finding>& findings, const TextureDirections* strokes) {
  const HalfedgeMesh& mesh = system.mesh();
  ComponentCones asked = cones;
  if (rule != PrescriptionRule::manual) std::fill(asked.angles.begin(), asked.angles.end(), std::nullopt);
  const BorderConditions& border = system.border();
  require_feasible(mesh, asked, border);
  const LogScale& scale = system.log_scale();

  std::optional<StrokeFit> fit;
  Eigen::VectorXd curvature(asked.vertices.size());
  if (asked.vertices.empty()) {
    // A closed torus or a surface with boundary: flat everywhere.
  } else if (all_fixed(asked)) {
    for (Eigen::Index i = 0; i < curvature.size(); ++i) {
      curvature[i] = mesh.flat_angle(asked.vertices[i]) - *asked.angles[i];
    }
  } else if (rule == PrescriptionRule::harmonic) {
    curvature = harmonic(mesh, asked, scale);
  } else {
    const LeastDistortion least = least_distortion(mesh, asked, scale);
    const bool is_straight = rule == PrescriptionRule::straightness;
    curvature = is_straight ? straightness(system, asked, least.curvature, findings) : least.curvature;
    if (strokes != nullptr && !is_straight && scale.has_effects()) {
      fit.emplace(fit_of_curvature(scale, system.all_cuts(), *strokes, asked.rotation_order));
      if (asked.rotation_order == 0) curvature = follow_strokes(scale, *fit, least);
    }
  }
  if (asked.rotation_order > 0) {
    const Eigen::VectorXd wanted = curvature;
    curvature = quantize_curvature(asked, scale, wanted, asked.rotation_order);
    if (fit) {
      curvature = follow_strokes(scale, *fit, curvature, [&](const LogScale::Variance& form, double price) {
        return quantize_curvature(asked, scale, wanted, asked.rotation_order, PricedForm{form, price});
      });
    }
  } else if (border.balanced && curvature.size() > 0) {
    curvature.array() += (scale.required_sum() - curvature.sum()) / static_cast<double>(curvature.size());
  }
  return impose(scale, asked, curvature, scale.evaluate_held(curvature), findings);
}

Curvature impose(const LogScale& scale, const ComponentCones& asked, const Eigen::VectorXd& curvature,
                 Eigen::VectorXd log_scale, std::vector<Finding>& findings) {
  const HalfedgeMesh& mesh = scale.mesh();
  const Geometry& geometry = scale.geometry();
  const BorderConditions& border = scale.border();
  Curvature out;
  out.log_scale = std::move(log_scale);
  prescribe_turning(scale, asked, out);
  out.predicted_l2 = scale.predicted_l2(out.log_scale);
  out.at_vertex = border.curvature;
  for (Eigen::Index i = 0; i < curvature.size(); ++i) out.at_vertex[asked.vertices[i]] += curvature[i];
  // Where the scale is held, the curvature follows from it: kappa = K + L y.
  const Eigen::VectorXd free = geometry.angle_defect + apply_laplacian({mesh, geometry}, out.log_scale);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (border.held[v]) out.at_vertex[v] = free[v];
  }
  out.is_free = border.held;
  for (Index v = 0; v < mesh.vertex_count(); ++v) out.is_free[v] |= border.curvature[v] != 0;  // at teeth
  for (const Index v : asked.vertices) out.is_free[v] = 0;
  out.log_scale.array() -= geometry.vertex_area.dot(out.log_scale) / geometry.total_area;
  const double range = out.log_scale.maxCoeff() - out.log_scale.minCoeff();
  if (!(out.predicted_l2 < high_l2 && range < wide_range)) {
    findings.push_back({Code::high_distortion,
                        concat("With these cones the map stretches much: ", expected_stretch(out.predicted_l2),
                               "lengths in it would differ by a factor of ", factor(range),
                               ". Add cones where the texture becomes too small."),
                        {ElementKind::vertices, asked.vertices}});
  }
  return out;
}

}  // namespace lsgp

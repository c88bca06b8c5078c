// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "angle_flow.hpp"
#include "component_system.hpp"
#include "cut_mesh.hpp"
#include "energies/quadratic_forms.hpp"
#include "quantize_curvature.hpp"
#include "solvers/box_qp.hpp"
#include "straightness.hpp"
#include "text.hpp"

namespace lsgp {

namespace {

// Automatic angles stay where a map with them can be expected to have no flips.
constexpr double largest_share_of_valence = 0.6;  // of pi per triangle
// Outside these no map exists, or none worth having.
constexpr double impossible_angle = 0.02 * M_PI;
constexpr double impossible_share_of_valence = 1;

constexpr double renormalized_mismatch = 1e-6;  // of Gauss-Bonnet, radians
// From wider ranges of the log scale maps without flips can hardly be computed.
constexpr double wide_range = 15;

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

[[noreturn]] void throw_gauss_bonnet(const ComponentCones& cones, double sum, double required, const char* remedy) {
  throw Error(Code::gauss_bonnet,
              concat("The ", count(cones.vertices.size(), "cone angle leaves", "cone angles leave"), " a curvature of ",
                     sum / M_PI, " pi in sum (", sum, "), but this surface requires ", required / M_PI, " pi (",
                     required, "). ", remedy),
              {ElementKind::vertices, cones.vertices});
}

Eigen::VectorXd least_distortion(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale) {
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
  return scale.least_distortion_curvature(bounds.low, bounds.high, std::move(start));
}

bool possible(const HalfedgeMesh& mesh, Index vertex, double curvature) {
  const double angle = mesh.flat_angle(vertex) - curvature;
  return angle >= impossible_angle && angle < M_PI * valence(mesh, vertex);
}

Eigen::VectorXd harmonic(const HalfedgeMesh& mesh, const ComponentCones& cones, const LogScale& scale) {
  const Eigen::VectorXd curvature = scale.harmonic_curvature();
  std::vector<Index> impossible;
  for (Eigen::Index i = 0; i < curvature.size(); ++i) {
    if (!possible(mesh, cones.vertices[i], curvature[i])) impossible.push_back(cones.vertices[i]);
  }
  if (!impossible.empty()) {
    throw Error(Code::cone_angle_range,
                concat("The harmonic angle of ", count(impossible.size(), "cone is", "cones is"),
                       " one no map can have. Add cones near it, or use the least-distortion prescription."),
                {ElementKind::vertices, impossible});
  }
  return curvature;
}

// The paper's rule; the angles that junctions of the cut read are handed on to the cones in equal parts.
std::optional<Eigen::VectorXd> straightness(ComponentSystem& system, const ComponentCones& cones,
                                            std::vector<Finding>& findings) {
  const HalfedgeMesh& mesh = system.mesh();
  if (!mesh.closed()) {
    // With a free border the straightened layout is an arbitrary one of many, and so are its angles.
    findings.push_back(
        {Code::straightness_failed,
         "Straight cuts give usable cone angles on closed surfaces only, and this one has an open border. The "
         "least-distortion angles were used instead.",
         {ElementKind::vertices, cones.vertices}});
    return std::nullopt;
  }
  const CutMesh cut_mesh = cut_open(mesh, system.all_cuts());
  const StraightenedLayout layout = straighten(system.open(system.all_cuts(), cut_mesh));
  const Index k = static_cast<Index>(cones.vertices.size());
  Eigen::VectorXd curvature(k);
  for (Index i = 0; i < k; ++i) curvature[i] = layout.curvature[cones.vertices[i]];
  const double junctions = layout.curvature.sum() - curvature.sum();
  curvature.array() += junctions / k;

  std::string failure = layout.failure;
  for (Index i = 0; i < k && failure.empty(); ++i) {
    if (!possible(mesh, cones.vertices[i], curvature[i])) {
      failure = concat("a cone would keep an angle of ", 2 - curvature[i] / M_PI, " pi");
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
  for (const Cut& cut : system.all_cuts().cuts) {
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

// Holes about which the metric turns almost exactly once are made to turn exactly once where that takes no more than
// this shift of the log scale along their border: the layout closes around them without a cut.
constexpr double largest_hole_shift = 0.1;
constexpr double nearly_once = 0.5;  // radians off a full turn

// Log scales c along the borders (loops) that bring the turning of the wanted ones to the wanted value, the others
// staying at 0: the turning is affine in c.
class LoopScales {
 public:
  LoopScales(const HalfedgeMesh& mesh, const Geometry& geometry, const LogScale& scale)
      : mesh_(mesh), geometry_(geometry), scale_(scale) {}

  Eigen::VectorXd turning(const Eigen::VectorXd& log_scale) const {
    return turning_of(geometry_.angle_defect + apply_laplacian(mesh_, geometry_, log_scale));
  }

  // The log scale changed so that loop i turns by wanted[i] where given, and the shifts that took, (loops).
  std::pair<Eigen::VectorXd, Eigen::VectorXd> adjust(const Eigen::VectorXd& log_scale,
                                                     const std::vector<std::optional<double>>& wanted) const {
    std::vector<Index> loops;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i]) loops.push_back(static_cast<Index>(i));
    }
    const Eigen::VectorXd before = turning(log_scale);
    if (loops.size() == wanted.size()) {
      // Shifting all borders alike changes nothing: the last turning follows from the others.
      double sum = 0;
      for (const auto& turning : wanted) sum += *turning;
      if (!(std::abs(sum - before.sum()) <= renormalized_mismatch)) {
        throw Error(Code::loop_turning, concat("The turning prescribed for all borders adds up to ", sum / M_PI,
                                               " pi, but with these cone angles it has to be ", before.sum() / M_PI,
                                               " pi. Leave the turning of one border free."));
      }
      loops.pop_back();
    }
    const Index k = static_cast<Index>(loops.size());
    Eigen::VectorXd shifts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wanted.size()));
    if (k == 0) return {log_scale, shifts};
    Eigen::MatrixXd functions(mesh_.vertex_count(), k), effect(k, k);
    Eigen::VectorXd missing(k);
    for (Index j = 0; j < k; ++j) {
      Eigen::VectorXd one = Eigen::VectorXd::Zero(mesh_.vertex_count());
      for (const Index v : mesh_.boundary_loops[loops[j]]) one[v] = 1;
      functions.col(j) = one - scale_.solve(apply_laplacian(mesh_, geometry_, one));
      const Eigen::VectorXd change = turning_of(apply_laplacian(mesh_, geometry_, functions.col(j)));
      for (Index i = 0; i < k; ++i) effect(i, j) = change[loops[i]];
      missing[j] = *wanted[loops[j]] - before[loops[j]];
    }
    const Eigen::VectorXd shift = effect.partialPivLu().solve(missing);
    for (Index j = 0; j < k; ++j) shifts[loops[j]] = shift[j];
    return {log_scale + functions * shift, shifts};
  }

 private:
  Eigen::VectorXd turning_of(const Eigen::VectorXd& curvature) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh_.boundary_loops.size()));
    for (std::size_t i = 0; i < mesh_.boundary_loops.size(); ++i) {
      for (const Index v : mesh_.boundary_loops[i]) out[i] += curvature[v];
    }
    return out;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const LogScale& scale_;
};

// Borders whose scale can be shifted: those with a vertex that is no corner.
std::vector<char> shiftable_loops(const HalfedgeMesh& mesh, const BorderConditions& border) {
  std::vector<char> out;
  for (const auto& loop : mesh.boundary_loops) {
    out.push_back(std::any_of(loop.begin(), loop.end(), [&](Index v) { return border.held[v]; }));
  }
  return out;
}

// The turning of all borders rounded to multiples of 2 pi / symmetry, the sum kept: those that lose most by it give
// way.
void quantize_turning(const Eigen::VectorXd& turning, int symmetry, std::vector<std::optional<double>>& wanted) {
  const Eigen::Index count = turning.size();
  Eigen::VectorXd exact = turning * (symmetry / (2 * M_PI));
  for (Eigen::Index i = 0; i < count; ++i) {
    if (wanted[i]) exact[i] = *wanted[i] * symmetry / (2 * M_PI);
  }
  Eigen::VectorXd rounded = exact.array().round();
  for (double missing = std::round(turning.sum() * symmetry / (2 * M_PI)) - rounded.sum(); missing != 0;) {
    const double step = missing > 0 ? 1 : -1;
    Eigen::Index at;
    (step * (exact - rounded)).maxCoeff(&at);
    rounded[at] += step;
    missing -= step;
  }
  for (Eigen::Index i = 0; i < count; ++i) wanted[i] = rounded[i] * 2 * M_PI / symmetry;
}

// Prescribed turning, and holes closed without a cut.  Changes the log scale, which is 0 along held borders.
void prescribe_turning(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones,
                       const BorderConditions& border, const LogScale& scale, Curvature& curvature) {
  curvature.needs_no_cut.assign(mesh.boundary_loops.size(), 0);
  const std::vector<char> shiftable = shiftable_loops(mesh, border);
  for (std::size_t i = 0; i < cones.loop_turning.size(); ++i) {
    if (!cones.loop_turning[i] || shiftable[i]) continue;
    throw Error(
        Code::loop_turning,
        "The turning of a border cannot be prescribed where the border is straight or all its vertices are corners: "
        "their angles say how it turns. Leave its turning free.",
        {ElementKind::vertices, mesh.boundary_loops[i]});
  }
  if (border.balanced) return;
  const LoopScales loops(mesh, geometry, scale);
  std::vector<std::optional<double>> wanted = cones.loop_turning;
  wanted.resize(mesh.boundary_loops.size());
  if (cones.symmetry > 0) quantize_turning(loops.turning(curvature.log_scale), cones.symmetry, wanted);
  curvature.log_scale = loops.adjust(curvature.log_scale, wanted).first;
  const Eigen::VectorXd turning = loops.turning(curvature.log_scale);
  std::vector<std::optional<double>> closed = wanted;
  std::size_t left_free = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const bool hole = shiftable[i] && !wanted[i] && std::abs(turning[i] + 2 * M_PI) < nearly_once;
    if (hole) closed[i] = -2 * M_PI;
    left_free += !closed[i] && shiftable[i];
  }
  // Without the holes that take too much, until those that are left can be closed.
  while (left_free > 0) {  // one border has to take up the rest
    const auto [log_scale, shifts] = loops.adjust(curvature.log_scale, closed);
    bool dropped = false;
    for (std::size_t i = 0; i < closed.size(); ++i) {
      if (wanted[i] || !closed[i] || std::abs(shifts[static_cast<Eigen::Index>(i)]) <= largest_hole_shift) continue;
      closed[i].reset();
      dropped = true;
    }
    if (dropped) continue;
    curvature.log_scale = log_scale;
    break;
  }
  const std::vector<std::optional<double>>& reached = left_free > 0 ? closed : wanted;
  for (std::size_t i = 0; i < reached.size(); ++i) curvature.needs_no_cut[i] = reached[i] && *reached[i] == -2 * M_PI;
}

}  // namespace

int valence(const HalfedgeMesh& mesh, Index vertex) {
  int triangles = 0;
  mesh.for_each_outgoing(vertex, [&](Index) { ++triangles; });
  return triangles;
}

BorderConditions border_conditions(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones) {
  return cones.border == BorderMode::straight && !mesh.closed() ? straight_border(mesh, geometry, cones.vertices)
                                                                : free_border(mesh, cones.vertices);
}

void require_feasible(const HalfedgeMesh& mesh, const ComponentCones& cones, const BorderConditions& border) {
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
  if (!border.balanced) return;
  const double required = 2 * M_PI * mesh.euler - border.curvature.sum();
  if (cones.vertices.empty()) {
    if (std::abs(required) < renormalized_mismatch) return;
    if (!mesh.closed()) {
      throw Error(Code::too_few_cones, concat("A straight border has to turn by ", required / M_PI,
                                              " pi in all, at marked corners. Mark the "
                                              "border's corners as cones, or leave the border free."));
    }
    throw Error(Code::too_few_cones,
                concat("A closed surface without cones cannot be unfolded: its curvature of ", required / M_PI,
                       " pi has to go somewhere. Mark cones at tips and corners, or place them automatically."));
  }
  const Bounds widest = widest_bounds(mesh, cones);
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

void require_possible(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& cones) {
  if (cones.symmetry > 0) return;  // rounded angles are the tool's own choice
  const BorderConditions border = border_conditions(mesh, geometry, cones);
  Eigen::VectorXd angle(mesh.vertex_count());
  std::vector<char> is_free = border.held;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    angle[v] = mesh.flat_angle(v) - border.curvature[v];
    is_free[v] |= border.curvature[v] != 0;  // teeth
  }
  std::vector<Index> given;
  for (std::size_t i = 0; i < cones.vertices.size(); ++i) {
    const Index v = cones.vertices[i];
    is_free[v] = !cones.angles[i];
    if (!cones.angles[i]) continue;
    angle[v] = *cones.angles[i];
    given.push_back(v);
  }
  if (!given.empty()) require_possible_angles(mesh, angle, is_free, given);
}

Curvature prescribe(ComponentSystem& system, const ComponentCones& cones, PrescriptionRule rule,
                    std::vector<Finding>& findings) {
  const HalfedgeMesh& mesh = system.mesh();
  const Geometry& geometry = system.geometry();
  ComponentCones asked = cones;
  if (rule != PrescriptionRule::manual) std::fill(asked.angles.begin(), asked.angles.end(), std::nullopt);
  const BorderConditions& border = system.border();
  require_feasible(mesh, asked, border);
  const LogScale& scale = system.log_scale();

  Eigen::VectorXd curvature(asked.vertices.size());
  std::optional<Eigen::VectorXd> straight;
  if (asked.vertices.empty()) {
    // A closed torus or a surface with border: flat everywhere.
  } else if (all_fixed(asked)) {
    for (Eigen::Index i = 0; i < curvature.size(); ++i) {
      curvature[i] = mesh.flat_angle(asked.vertices[i]) - *asked.angles[i];
    }
  } else if (rule == PrescriptionRule::harmonic) {
    curvature = harmonic(mesh, asked, scale);
  } else if (rule == PrescriptionRule::straightness && (straight = straightness(system, asked, findings))) {
    curvature = *straight;
  } else {
    curvature = least_distortion(mesh, asked, scale);
  }
  if (asked.symmetry > 0) {
    curvature = quantize_curvature(mesh, asked, scale, curvature, asked.symmetry);
  } else if (border.balanced && curvature.size() > 0) {
    curvature.array() += (scale.required_sum() - curvature.sum()) / static_cast<double>(curvature.size());
  }
  return impose(mesh, geometry, asked, border, scale, curvature, findings);
}

Curvature impose(const HalfedgeMesh& mesh, const Geometry& geometry, const ComponentCones& asked,
                 const BorderConditions& border, const LogScale& scale, const Eigen::VectorXd& curvature,
                 std::vector<Finding>& findings) {
  Curvature out;
  out.log_scale = scale.evaluate_held(curvature);
  prescribe_turning(mesh, geometry, asked, border, scale, out);
  out.predicted_l2 = scale.predicted_l2(out.log_scale);
  out.at_vertex = border.curvature;
  for (Eigen::Index i = 0; i < curvature.size(); ++i) out.at_vertex[asked.vertices[i]] += curvature[i];
  // Where the scale is held, the curvature is what it makes of it: kappa = K + L y.
  const Eigen::VectorXd free = geometry.angle_defect + apply_laplacian(mesh, geometry, out.log_scale);
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
                        concat("With these cones the map stretches much: an L2 stretch of ", out.predicted_l2,
                               " is expected, 1 being none, and lengths that differ by a factor of ", std::exp(range),
                               ". Add cones where the texture becomes too small."),
                        {ElementKind::vertices, asked.vertices}});
  }
  return out;
}

}  // namespace lsgp

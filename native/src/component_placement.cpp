// SPDX-License-Identifier: GPL-3.0-or-later
#include "component_placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "point_lattice.hpp"
#include "quantize_curvature.hpp"
#include "relocation.hpp"
#include "text.hpp"

namespace lsgp {

namespace {

constexpr int stages[] = {4, 6, 8, 10, 12, 15, 19, 24, 30, 37, 46, 57};  // cones at which the target is looked at
constexpr double isometric = 1.001;                                      // an L2 stretch that every cone is worth
constexpr double hopeless_l2 = 1.3;  // the variance does not see stretch beyond this well
constexpr int most_relocations = 3;
// Of a given number of cones.  Beyond the second, maps begin to miss their prediction; beyond the fourth, many do.
constexpr double reaches[] = {usual_reach, wider_reach, 1.0, 1.15, 1.6};
constexpr double trusted_reach = 1.15;
constexpr double low_l2 = 1.03;             // an L2 stretch that stronger cones need not lower
constexpr double worth_strong_cones = 0.9;  // of the stretch above 1 that weaker ones leave
constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

// The effort that a mesh of some size is worth.
struct Effort {
  int sites, probes, sweeps;
};
constexpr Index large = 60000;  // vertices
Effort effort_for(Index vertices) { return vertices > large ? Effort{12000, 24, 1} : Effort{12000, 48, 2}; }

class Placing {
 public:
  Placing(const PlacementTask& task, const Effort& effort, bool prefer_sharp, Monitor& monitor)
      : task_(task),
        effort_(effort),
        monitor_(monitor),
        border_(free_border(task.mesh, task.existing.vertices)),
        scale_(task.mesh, task.geometry, border_),
        sites_(find_cone_sites(task.mesh, task.geometry, task.existing, task.allowed, task.mirrored, effort.sites)),
        kernel_(make_kernel()),
        limits_(task.mesh, task.geometry, kernel_.sites(), given_curvature()),
        problem_{kernel_, limits_, scale_.balanced(), scale_.required_sum()},
        search_(task.mesh, problem_, sites_.existing, prefer_sharp, monitor) {}

  PlacedCones place(const PlacementOptions& options, std::vector<Finding>& findings);
  ComponentGains gains();

 private:
  VarianceKernel make_kernel();
  Eigen::VectorXd given_curvature() const;
  ConeSet existing(double reach) const;
  double predicted_l2(const ConeSet& set);
  ConeChoice choice_of(const ConeSet& set);
  ConeChoice place_count(int count, const PlacementOptions& options);
  ConeChoice place_harmonically(int count);
  ConeChoice place_automatically(const PlacementOptions& options);
  ConeChoice grow_to_target(double reach, const PlacementOptions& options);
  void drop_unneeded(ConeSet& set, double target);
  ConeChoice settled(ConeSet& set, const PlacementOptions& options);
  ConeChoice rounded(const ConeSet& set, Lattice lattice);
  ConeChoice quantized(ConeChoice choice, int symmetry);
  void use_cones(const std::vector<Index>& vertices);
  ComponentCones with_given_angles(const std::vector<Index>& vertices, int symmetry) const;
  std::vector<Index> vertices_of(const std::vector<int>& sites) const;

  const PlacementTask& task_;
  Effort effort_;
  Monitor& monitor_;
  BorderConditions border_;
  LogScale scale_;
  ConeSites sites_;
  VarianceKernel kernel_;
  SiteLimits limits_;
  PlacementProblem problem_;
  ConeSearch search_;
};

VarianceKernel Placing::make_kernel() {
  monitor_.advance(0.1);
  const Monitor::Part part(monitor_, 0.1, 0.3);
  return VarianceKernel(task_.geometry, scale_, border_, sites_.sites, effort_.probes, monitor_);
}

Eigen::VectorXd Placing::given_curvature() const {
  Eigen::VectorXd given = Eigen::VectorXd::Constant(task_.mesh.vertex_count(), not_given);
  for (std::size_t i = 0; i < task_.existing.vertices.size(); ++i) {
    const Index v = task_.existing.vertices[i];
    if (task_.existing.angles[i]) given[v] = task_.mesh.flat_angle(v) - *task_.existing.angles[i];
  }
  return given;
}

ConeSet Placing::existing(double reach) const {
  ConeSet set(problem_, reach);
  for (int i = 0; i < sites_.existing; ++i) set.add(i);
  return set;
}

double Placing::predicted_l2(const ConeSet& set) {
  if (!set.feasible()) return unlimited;
  return scale_.predicted_l2(kernel_.log_scale(set.sites(), set.curvature()));
}

ConeChoice Placing::choice_of(const ConeSet& set) {
  ConeChoice out{vertices_of(set.sites()), {}, predicted_l2(set)};
  out.curvature.resize(static_cast<Eigen::Index>(out.vertices.size()));
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < set.sites().size(); ++i) {
    const int cones = kernel_.sites()[set.sites()[i]].cones();
    out.curvature.segment(first, cones).setConstant(set.curvature()[static_cast<Eigen::Index>(i)] / cones);
    first += cones;
  }
  return out;
}

// Where so few cones stretch much, stronger ones stretch less.
ConeChoice Placing::place_count(int count, const PlacementOptions& options) {
  std::optional<ConeChoice> best;
  for (const double reach : reaches) {
    if (reach > trusted_reach && best->predicted_l2 <= hopeless_l2) break;
    ConeSet set = existing(reach);
    for (const int stage : stages) {
      if (stage <= set.cone_count() || stage >= count) continue;
      search_.grow(set, stage);
      if (stage < count / 2) continue;
      search_.exchange(set, 1);
      break;
    }
    search_.grow(set, count);
    search_.exchange(set, effort_.sweeps);
    ConeChoice choice = options.lattice ? rounded(set, *options.lattice) : choice_of(set);
    if (!best || choice.predicted_l2 - 1 < worth_strong_cones * (best->predicted_l2 - 1)) best = std::move(choice);
    if (best->predicted_l2 <= low_l2 || options.lattice || !search_.can_drop(set)) break;
  }
  if (best->predicted_l2 <= hopeless_l2 || best->predicted_l2 == unlimited || options.lattice) return *best;
  ConeChoice other = place_harmonically(static_cast<int>(best->vertices.size()));
  return other.predicted_l2 < best->predicted_l2 ? other : *best;
}

// Cones at the extrema of the log scale that is 0 at the cones so far (Ben-Chen et al. 2008), then exchanged: where
// limbs have too few cones this sees better what is stretched most.
ConeChoice Placing::place_harmonically(int count) {
  ConeSet set = existing(usual_reach);
  while (set.cone_count() < count) {
    const ConeChoice now = choice_of(set);
    use_cones(now.vertices);
    Eigen::VectorXd y =
        now.vertices.empty() ? kernel_.log_scale({}, {}) : scale_.evaluate_held(scale_.harmonic_curvature());
    if (!now.vertices.empty()) y.array() -= y[now.vertices.front()];
    const std::vector<char> open = search_.open_sites(set.sites());
    int best = -1;
    double most = -1;
    for (int i = 0; i < kernel_.site_count(); ++i) {
      const Site& site = kernel_.sites()[i];
      if (!open[i] || site.cones() > count - set.cone_count() || std::abs(y[site.vertex]) <= most) continue;
      most = std::abs(y[site.vertex]);
      best = i;
    }
    if (best < 0) break;
    set.add(best);
    monitor_.tick();
  }
  search_.exchange(set, effort_.sweeps);
  return choice_of(set);
}

ConeChoice Placing::place_automatically(const PlacementOptions& options) {
  ConeChoice usual = grow_to_target(usual_reach, options);
  if (usual.predicted_l2 <= options.target) return usual;
  ConeChoice wider = grow_to_target(wider_reach, options);
  return wider.predicted_l2 < usual.predicted_l2 ? wider : usual;
}

// As few cones as reach the target, or those that come nearest to it.
ConeChoice Placing::grow_to_target(double reach, const PlacementOptions& options) {
  ConeSet set = existing(reach);
  ConeChoice best = settled(set, options);
  for (const int stage : stages) {
    if (best.predicted_l2 <= options.target) break;
    if (stage <= set.cone_count()) continue;
    const int before = set.cone_count();
    search_.grow(set, stage);
    if (set.cone_count() == before) break;  // no room
    search_.exchange(set, 1);
    ConeChoice choice = settled(set, options);
    if (choice.predicted_l2 < best.predicted_l2) best = std::move(choice);
  }
  return best;
}

// What becomes of a set: without cones it can do without, or rounded.
ConeChoice Placing::settled(ConeSet& set, const PlacementOptions& options) {
  if (options.lattice) return rounded(set, *options.lattice);
  if (predicted_l2(set) <= options.target) drop_unneeded(set, options.target);
  return choice_of(set);
}

void Placing::drop_unneeded(ConeSet& set, double target) {
  while (search_.can_drop(set) && predicted_l2(set) > isometric) {
    ConeSet fewer = set;
    search_.drop(fewer);
    if (predicted_l2(fewer) > target) search_.exchange(fewer, effort_.sweeps);
    if (predicted_l2(fewer) > target) return;
    set = std::move(fewer);
  }
}

// Curvatures that are multiples of the lattice's turn, and places that suit them, in turn; cones left flat are none.
ConeChoice Placing::rounded(const ConeSet& set, Lattice lattice) {
  const int q = symmetry(lattice);
  if (!set.feasible()) return choice_of(set);
  std::vector<int> sites = set.sites();
  ConeChoice best = quantized(choice_of(set), q);
  for (int round = 0; round < most_relocations; ++round) {
    Eigen::VectorXd curvature(sites.size());
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const int cones = kernel_.sites()[sites[i]].cones();
      curvature[static_cast<Eigen::Index>(i)] = best.curvature.segment(first, cones).sum();
      first += cones;
    }
    if (!relocate(problem_, search_, sites_.existing, curvature, sites)) break;
    ConeChoice moved = quantized({vertices_of(sites), best.curvature}, q);
    if (!(moved.predicted_l2 < best.predicted_l2)) break;
    best = std::move(moved);
    monitor_.tick();
  }
  ConeChoice out{{}, Eigen::VectorXd(best.curvature.size()), best.predicted_l2};
  const std::size_t kept = vertices_of({set.sites().begin(), set.sites().begin() + sites_.existing}).size();
  for (std::size_t i = 0; i < best.vertices.size(); ++i) {
    const double kappa = best.curvature[static_cast<Eigen::Index>(i)];
    if (i >= kept && std::abs(kappa) < M_PI / q) continue;
    out.curvature[static_cast<Eigen::Index>(out.vertices.size())] = kappa;
    out.vertices.push_back(best.vertices[i]);
  }
  out.curvature.conservativeResize(static_cast<Eigen::Index>(out.vertices.size()));
  return out;
}

ConeChoice Placing::quantized(ConeChoice choice, int symmetry) {
  use_cones(choice.vertices);
  const ComponentCones cones = with_given_angles(choice.vertices, symmetry);
  choice.curvature = quantize_curvature(task_.mesh, cones, scale_, choice.curvature, symmetry);
  choice.predicted_l2 = scale_.predicted_l2(scale_.evaluate(choice.curvature));
  return choice;
}

ComponentCones Placing::with_given_angles(const std::vector<Index>& vertices, int symmetry) const {
  ComponentCones out = task_.existing;
  out.symmetry = symmetry;
  out.vertices = vertices;
  out.angles.clear();
  const Eigen::VectorXd given = given_curvature();
  for (const Index v : vertices) {
    out.angles.push_back(std::isnan(given[v]) ? std::nullopt
                                              : std::optional<double>(task_.mesh.flat_angle(v) - given[v]));
  }
  return out;
}

void Placing::use_cones(const std::vector<Index>& vertices) {
  scale_.remove_cones();
  scale_.add_cones(vertices);
}

std::vector<Index> Placing::vertices_of(const std::vector<int>& sites) const {
  std::vector<Index> out;
  for (const int i : sites) {
    const Site& site = kernel_.sites()[i];
    out.push_back(site.vertex);
    if (site.mirrored != none) out.push_back(site.mirrored);
  }
  return out;
}

PlacedCones Placing::place(const PlacementOptions& options, std::vector<Finding>& findings) {
  const Monitor::Part part(monitor_, 0.3, 1);
  const int symmetry = options.lattice ? lsgp::symmetry(*options.lattice) : 0;
  const ConeChoice choice = options.count ? place_count(*options.count, options) : place_automatically(options);
  PlacedCones out;
  out.cones = with_given_angles(choice.vertices, symmetry);
  require_feasible(task_.mesh, out.cones, border_);
  if (choice.predicted_l2 == unlimited) {
    throw Error(Code::too_few_cones,
                concat(count(choice.vertices.size(), "cone is", "cones are"),
                       " too few for the curvature of this surface. Place more, or as many as it takes."),
                {ElementKind::vertices, choice.vertices});
  }
  require_possible(task_.mesh, task_.geometry, out.cones);
  for (std::size_t i = 0; i < choice.vertices.size(); ++i) {
    out.cones.angles[i] = task_.mesh.flat_angle(choice.vertices[i]) - choice.curvature[static_cast<Eigen::Index>(i)];
  }
  use_cones(choice.vertices);
  out.curvature = impose(task_.mesh, task_.geometry, out.cones, border_, scale_, choice.curvature, findings);
  out.reached = out.curvature.predicted_l2 <= options.target;
  if (!options.count && !out.reached) {
    findings.push_back(
        {Code::placement_not_reached,
         concat("With ", count(choice.vertices.size(), "cone", "cones"), " an L2 stretch of ",
                out.curvature.predicted_l2, " is expected, more than the ", options.target,
                " asked for. Mark cones at thin tips, clean up spikes and thin triangles, or ask for less."),
         {ElementKind::vertices, choice.vertices}});
  }
  return out;
}

ComponentGains Placing::gains() {
  const ConeSet set = existing(usual_reach);
  ComponentGains out;
  out.present_l2 = predicted_l2(set);
  out.predicted_l2 = Eigen::VectorXd::Constant(task_.mesh.vertex_count(), not_given);
  const Eigen::VectorXd gains = set.gains();
  const std::vector<char> open = search_.open_sites(set.sites());
  for (int i = 0; i < kernel_.site_count(); ++i) {
    if (!open[i]) continue;
    // The L2 stretch is e^{2 J} to leading order.
    const double with_cone = out.present_l2 == unlimited ? std::exp(2 * (set.variance() - gains[i]))
                                                         : out.present_l2 * std::exp(-2 * gains[i]);
    out.predicted_l2[kernel_.sites()[i].vertex] = std::max(1.0, with_cone);
  }
  return out;
}

}  // namespace

PlacedCones place_component(const PlacementTask& task, const PlacementOptions& options, std::vector<Finding>& findings,
                            Monitor& monitor) {
  return Placing(task, effort_for(task.mesh.vertex_count()), options.prefer_sharp, monitor).place(options, findings);
}

ComponentGains component_gains(const PlacementTask& task, Monitor& monitor) {
  Effort effort = effort_for(task.mesh.vertex_count());
  effort.sites = std::numeric_limits<int>::max();
  return Placing(task, effort, false, monitor).gains();
}

}  // namespace lsgp

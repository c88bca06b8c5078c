// SPDX-License-Identifier: GPL-3.0-or-later
#include "search/cone_chooser.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "plane/point_lattice.hpp"
#include "prescription/quantize_curvature.hpp"
#include "search/relocation.hpp"
#include "sites/site_prices.hpp"

namespace lsgp {

namespace {

constexpr double usual_turn = M_PI / 2;  // of a cone where Gauss-Bonnet asks for many
constexpr double hopeless_l2 = 1.1;      // the variance does not see stretch beyond this well
constexpr int most_relocations = 3;
constexpr double trusted_reach = 1.15;
constexpr double low_l2 = 1.01;             // an L2 stretch that stronger cones need not lower
constexpr double worth_strong_cones = 0.9;  // of the stretch above 1 with weaker ones
constexpr int batch_sweeps = 2;
constexpr int batch_reaches = 2;  // tried for more, of which few carry much
constexpr double unlimited = std::numeric_limits<double>::infinity();

}  // namespace

ConeChooser::ConeChooser(const PlacementTask& task, PlacementOptions options, int most_sites, ProgressMonitor& monitor)
    : task_(task),
      options_(std::move(options)),
      effort_(options_.count && !options_.lattice ? thorough_effort : usual_effort),
      monitor_(monitor),
      border_(free_border(task.mesh, task.existing.vertices)),
      scale_(task, border_),
      sites_(find_cone_sites(task, most_sites)),
      model_(scale_, sites_.sites),
      kernel_(make_kernel()),
      limits_(task, kernel_.sites(), given_curvature()),
      prices_(site_prices(task, kernel_.sites())),
      problem_{kernel_, limits_, scale_.balanced(), scale_.required_sum(), {}},
      search_(task.mesh, problem_, sites_.existing, options_.prefer_sharp, effort_.exchange, monitor) {
  weigh_prices(0);
}

// e^{2 J} is the L2 stretch to leading order.
void ConeChooser::weigh_prices(double weight) { problem_.price = prices_ * (weight * std::log(options_.target) / 2); }

void ConeChooser::forget_prices() {
  prices_.setZero();
  weigh_prices(0);
}

int ConeChooser::existing_count() const { return static_cast<int>(vertices_of(existing_sites()).size()); }

double ConeChooser::required_count() const {
  return problem_.balanced ? std::abs(problem_.required_sum) / usual_turn : 0;
}

Index ConeChooser::place_count() const {
  Index out = 0;
  for (const Site& site : sites()) out += site.cones();
  return out;
}

LogScaleVariance ConeChooser::make_kernel() {
  monitor_.advance(0.1);
  const ProgressMonitor::Interval interval(monitor_, 0.1, 0.3);
  return LogScaleVariance(model_, sites_.sites, effort_.probes, monitor_);
}

Eigen::VectorXd ConeChooser::given_curvature() const {
  constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd given = Eigen::VectorXd::Constant(task_.mesh.vertex_count(), not_given);
  for (std::size_t i = 0; i < task_.existing.vertices.size(); ++i) {
    const Index v = task_.existing.vertices[i];
    if (task_.existing.angles[i]) given[v] = task_.mesh.flat_angle(v) - *task_.existing.angles[i];
  }
  return given;
}

ConeSet ConeChooser::existing(double reach) const {
  ConeSet set(problem_, reach);
  set.add(existing_sites());
  return set;
}

Array<int> ConeChooser::existing_sites() const {
  Array<int> out(sites_.existing);
  std::iota(out.begin(), out.end(), 0);
  return out;
}

template <typename Set>
double ConeChooser::predicted_l2(const Set& set) const {
  if (!set.feasible()) return unlimited;
  return scale_.predicted_l2(kernel_.log_scale(set.sites(), set.curvature()));
}

ConeChoice ConeChooser::choose_more(const ConeChoice& present, const Eigen::VectorXd& wanted, int more) {
  const Array<Site>& all = kernel_.sites();
  PerVertex<char> is_cone(task_.mesh.vertex_count(), 0), near(task_.mesh.vertex_count(), 0);
  for (const Index v : present.vertices) is_cone[v] = 1;
  Array<int> sites, others;
  for (int i = 0; i < kernel_.site_count(); ++i) (is_cone[all[i].vertex] ? sites : others).push_back(i);
  const bool has_price = !problem_.price.isZero(0);
  Eigen::VectorXd wanted_at(kernel_.site_count());
  for (int i = 0; i < kernel_.site_count(); ++i) {
    const double at_both = wanted[all[i].vertex] + (all[i].mirrored == none ? 0 : wanted[all[i].mirrored]);
    wanted_at[i] = has_price ? at_both * (1 - prices_[i] / all[i].cones()) : at_both;
  }
  std::stable_sort(others.begin(), others.end(), [&](int a, int b) { return wanted_at[a] > wanted_at[b]; });
  for (const int i : others) {
    if (more <= 0) break;
    if (near[all[i].vertex]) continue;
    sites.push_back(i);
    more -= all[i].cones();
    for (const Index v : {all[i].vertex, all[i].mirrored}) {
      if (v != none) mark_rings(task_.mesh, v, 1, near);
    }
  }
  return choose_at(sites);
}

std::optional<ConeChoice> ConeChooser::choose_moved(const ConeChoice& present, Index from, Index to) {
  PerVertex<char> is_cone(task_.mesh.vertex_count(), 0);
  for (const Index v : present.vertices) is_cone[v] = 1;
  if (is_cone[to]) return std::nullopt;
  is_cone[from] = 0;
  is_cone[to] = 1;
  Array<int> sites;
  bool is_site = false;
  for (int i = 0; i < kernel_.site_count(); ++i) {
    const Index v = kernel_.sites()[i].vertex;
    if (is_cone[v]) sites.push_back(i);
    is_site |= v == to;
  }
  if (!is_site) return std::nullopt;
  return choose_at(sites);
}

// Stronger cones if these are predicted to stretch much less.
ConeChoice ConeChooser::choose_at(const Array<int>& sites) {
  std::optional<ConeChoice> best;
  for (const double reach : {usual_reach, wider_reach}) {
    ConeSet set(problem_, reach);
    set.add(sites);
    ConeChoice choice = settled(set);
    if (!best || choice.predicted_l2 < worth_strong_cones * best->predicted_l2) best = std::move(choice);
  }
  return *best;
}

template <typename Set>
ConeChoice ConeChooser::settled(const Set& set) {
  return options_.lattice ? rounded(set, *options_.lattice) : choice_of(set);
}

template <typename Set>
ConeChoice ConeChooser::choice_of(const Set& set) const {
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

ConeChoice ConeChooser::choose(int count) {
  const int most = std::max(count, sites_.existing);
  if (most > most_one_by_one) return choose_in_batches(most);
  // If the stretch is high with so few cones, it is lower with stronger ones.
  std::optional<ConeChoice> best;
  for (const double reach : reaches) {
    if (reach > trusted_reach && best->predicted_l2 <= hopeless_l2) break;
    ConeChoice choice = choose_within(reach, count);
    if (!best || choice.predicted_l2 - 1 < worth_strong_cones * (best->predicted_l2 - 1)) best = std::move(choice);
    if (best->predicted_l2 <= low_l2 || options_.lattice) break;
  }
  if (best->predicted_l2 <= hopeless_l2 || !best->is_possible() || options_.lattice) return *best;
  ConeChoice other = choose_harmonically(static_cast<int>(best->vertices.size()));
  return other.predicted_l2 < best->predicted_l2 ? other : *best;
}

ConeChoice ConeChooser::choose_within(double reach, int count) {
  ConeSet set = existing(reach);
  for (const int stage : cone_stages) {
    if (stage <= set.cone_count() || stage >= count) continue;
    search_.grow(set, stage);
    if (stage < count / 2) continue;
    search_.exchange(set);
    break;
  }
  search_.grow(set, count);
  return settled(exchanged(std::move(set)));
}

// The variance does not see all stretch: of spikes it sees hardly any, and their cones may be moved elsewhere.
ConeSet ConeChooser::exchanged(ConeSet set) const {
  ConeSet best = set;
  double least = unlimited;
  for (int sweep = 0; sweep < effort_.sweeps; ++sweep) {
    if (!search_.exchange(set) && sweep > 0) break;
    const double l2 = predicted_l2(set);
    if (l2 >= least && !options_.prefer_sharp) continue;
    least = l2;
    best = set;
  }
  return best;
}

// The first cones are chosen one by one, the rest in batches.
ConeChoice ConeChooser::choose_in_batches(int count) {
  std::optional<ConeChoice> best;
  for (int i = 0; i < batch_reaches; ++i) {
    BatchPlacement set = batches(reaches[i]);
    if (sites_.existing < most_one_by_one) {
      ConeSet first = existing(reaches[i]);
      search_.grow(first, std::min(count, most_one_by_one));
      search_.exchange(first);
      set.add(first.sites());
    } else {
      set.add(existing_sites());
    }
    set.grow(count);
    set.exchange(batch_sweeps);
    ConeChoice choice = settled(set);
    if (!best || choice.predicted_l2 < best->predicted_l2) best = std::move(choice);
    if (best->predicted_l2 <= low_l2 || options_.lattice) break;
  }
  return *best;
}

ConeChoice ConeChooser::choose_harmonically(int count) {
  ConeSet set = existing(usual_reach);
  LogScale& scale = model_.scale();
  while (set.cone_count() < count) {
    const Array<Index> now = vertices_of(set.sites());
    Array<Index> nodes;
    for (const Index vertex : now) nodes.push_back(model_.node(vertex));
    scale.set_cones(nodes);
    Eigen::VectorXd y =
        now.empty() ? kernel_.log_scale({}, {}) : model_.at_vertices(scale.evaluate_held(scale.harmonic_curvature()));
    if (!now.empty()) y.array() -= y[now.front()];
    const Array<char> open = search_.open_sites(set.sites());
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
  const ConeChoice others = choice_of(exchanged(set));
  const ConeChoice chosen = choice_of(set);
  return others.predicted_l2 < chosen.predicted_l2 ? others : chosen;
}

// Alternates between curvatures that are multiples of the lattice's rotation and sites for them; flat cones are
// dropped.
template <typename Set>
ConeChoice ConeChooser::rounded(const Set& set, Lattice lattice) {
  const int q = rotation_order(lattice);
  if (!set.feasible()) return choice_of(set);
  Array<int> sites = set.sites();
  ConeChoice best = quantized(choice_of(set), q);
  for (int round = 0; round < most_relocations; ++round) {
    Eigen::VectorXd curvature(sites.size());
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const int cones = kernel_.sites()[sites[i]].cones();
      curvature[static_cast<Eigen::Index>(i)] = best.curvature.segment(first, cones).sum();
      first += cones;
    }
    if (!relocate(problem_, task_.mesh, sites_.existing, curvature, sites)) break;
    ConeChoice moved = quantized({vertices_of(sites), best.curvature}, q);
    if (!(moved.predicted_l2 < best.predicted_l2)) break;
    best = std::move(moved);
    monitor_.tick();
  }
  ConeChoice out{{}, Eigen::VectorXd(best.curvature.size()), best.predicted_l2};
  const std::size_t kept = vertices_of({set.sites().begin(), set.sites().begin() + sites_.existing}).size();
  for (std::size_t i = 0; i < best.vertices.size(); ++i) {
    const double kappa = best.curvature[static_cast<Eigen::Index>(i)];
    if (i >= kept && std::abs(kappa) < M_PI / q) {
      ++out.left_flat;
      continue;
    }
    out.curvature[static_cast<Eigen::Index>(out.vertices.size())] = kappa;
    out.vertices.push_back(best.vertices[i]);
  }
  out.curvature.conservativeResize(static_cast<Eigen::Index>(out.vertices.size()));
  return out;
}

ConeChoice ConeChooser::quantized(ConeChoice choice, int rotation_order) {
  scale_.set_cones(choice.vertices);
  const ComponentCones cones = with_given_angles(choice.vertices);
  choice.curvature = quantize_curvature(cones, scale_, choice.curvature, rotation_order);
  choice.predicted_l2 = scale_.predicted_l2(scale_.evaluate(choice.curvature));
  return choice;
}

ComponentCones ConeChooser::with_given_angles(const Array<Index>& vertices) const {
  ComponentCones out = task_.existing;
  out.rotation_order = options_.lattice ? rotation_order(*options_.lattice) : 0;
  out.vertices = vertices;
  out.angles.clear();
  const Eigen::VectorXd given = given_curvature();
  for (const Index v : vertices) {
    out.angles.push_back(std::isnan(given[v]) ? std::nullopt
                                              : std::optional<double>(task_.mesh.flat_angle(v) - given[v]));
  }
  return out;
}

ComponentCones ConeChooser::with_angles(const ConeChoice& choice) const {
  ComponentCones out = with_given_angles(choice.vertices);
  for (std::size_t i = 0; i < choice.vertices.size(); ++i) {
    out.angles[i] = task_.mesh.flat_angle(choice.vertices[i]) - choice.curvature[static_cast<Eigen::Index>(i)];
  }
  return out;
}

ConeChoice ConeChooser::choice_with(const Array<Index>& vertices, const Eigen::VectorXd& curvature) const {
  return {vertices, curvature, scale_.predicted_l2(scale_.evaluate_held(vertices, curvature))};
}

Array<Index> ConeChooser::vertices_of(const Array<int>& sites) const {
  Array<Index> out;
  for (const int i : sites) {
    const Site& site = kernel_.sites()[i];
    out.push_back(site.vertex);
    if (site.mirrored != none) out.push_back(site.mirrored);
  }
  return out;
}

template double ConeChooser::predicted_l2(const ConeSet& set) const;
template double ConeChooser::predicted_l2(const BatchPlacement& set) const;
template ConeChoice ConeChooser::settled(const ConeSet& set);
template ConeChoice ConeChooser::settled(const BatchPlacement& set);

}  // namespace lsgp

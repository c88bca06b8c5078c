// SPDX-License-Identifier: GPL-3.0-or-later
#include "search/cone_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lsgp {

namespace {

constexpr double sharp_price = 1.25;  // the factor by which the variance may grow for it

}  // namespace

Neighborhoods::Neighborhoods(const HalfedgeMesh& mesh, const Array<Site>& all, const Array<int>& sites, int rings)
    : mesh_(mesh), all_(all), rings_(rings), count_(mesh.vertex_count()) {
  for (; rings_ >= 0; --rings_) {
    std::fill(count_.begin(), count_.end(), 0);
    for (const int site : sites) add(site, 1);
    if (std::any_of(all.begin(), all.end(), [&](const Site& site) { return is_outside(site); })) return;
  }
}

void Neighborhoods::add(int site, int times) {
  for (const Index center : {all_[site].vertex, all_[site].mirrored}) {
    if (center == none) continue;
    for (const Index v : rings_around(mesh_, center, rings_)) count_[v] += times;
  }
}

ConeSearch::ConeSearch(const HalfedgeMesh& mesh, const PlacementProblem& problem, int kept, bool sharp,
                       ExchangeEffort effort, ProgressMonitor& monitor)
    : mesh_(mesh), problem_(problem), kept_(kept), prefers_sharp_(sharp), effort_(effort), monitor_(monitor) {}

bool ConeSearch::is_sharp(int site) const { return std::abs(problem_.limits.defect(site)) >= sharp_defect; }

Array<char> ConeSearch::open_sites(const Array<int>& used, int rings) const {
  const Array<Site>& sites = problem_.kernel.sites();
  const Neighborhoods near(mesh_, sites, used, rings);
  Array<char> open(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) open[i] = near.is_outside(sites[i]);
  return open;
}

std::optional<int> ConeSearch::best_site(const Eigen::VectorXd& gains, const Array<char>& open) const {
  std::optional<int> best, sharp;
  const Array<Site>& sites = problem_.kernel.sites();
  const auto gain = [&](int i) { return gains[i] / sites[i].cones(); };
  for (int i = 0; i < gains.size(); ++i) {
    if (!open[i]) continue;
    if (!best || gain(i) > gain(*best)) best = i;
    if (prefers_sharp_ && is_sharp(i) && (!sharp || gain(i) > gain(*sharp))) sharp = i;
  }
  if (sharp && gain(*sharp) >= sharp_share * gain(*best)) return sharp;
  return best;
}

void ConeSearch::grow(ConeSet& set, int cones) const {
  while (set.cone_count() < cones) {
    Array<char> open = open_sites(set.sites());
    for (std::size_t i = 0; i < open.size(); ++i) {
      open[i] = open[i] && problem_.kernel.sites()[i].cones() <= cones - set.cone_count();
    }
    const std::optional<int> best = best_site(set.gains() - problem_.price_among(cones), open);
    if (!best) break;
    set.add(*best);
    monitor_.tick();
  }
}

Array<int> ConeSearch::by_need(const Array<int>& sites, const Eigen::VectorXd& losses) const {
  Array<int> places(sites.size() - static_cast<std::size_t>(kept_));
  std::iota(places.begin(), places.end(), kept_);
  const Eigen::VectorXd need = losses - problem_.price_among(problem_.cone_count(sites))(sites);
  std::stable_sort(places.begin(), places.end(), [&](int a, int b) { return need[a] < need[b]; });
  return places;
}

bool ConeSearch::exchange(ConeSet& set) const {
  bool moved = false;
  Array<int> sites;
  for (const int place : by_need(set.sites(), set.losses())) sites.push_back(set.sites()[place]);
  ConeSet::Explained explained = set.explain();
  for (const int site : sites) {
    monitor_.tick();
    if (!exchange_one(set, explained, site)) continue;
    moved = true;
    explained = set.explain();
  }
  return moved;
}

bool ConeSearch::exchange_one(ConeSet& set, const ConeSet::Explained& explained, int site) const {
  const Array<Site>& sites = problem_.kernel.sites();
  const int place = static_cast<int>(std::find(set.sites().begin(), set.sites().end(), site) - set.sites().begin());
  ConeSet rest = set;
  rest.remove(place);
  const auto price = problem_.price_among(set.cone_count());
  const Eigen::VectorXd gains = rest.gains(explained.without(place)), priced = gains - price;
  Array<char> open = open_sites(rest.sites());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = open[i] && sites[i].cones() == sites[site].cones();
  for (int i = 0; i < effort_.tries; ++i) {
    const std::optional<int> best = best_site(priced, open);
    if (!best || *best == site) return false;
    const bool sharper = prefers_sharp_ && is_sharp(*best) && !is_sharp(site);
    const double saved = price[site] - price[*best];
    const double most = set.variance() * (sharper ? sharp_price : effort_.worth_an_exchange) + saved;
    if (rest.variance() - gains[*best] >= most) return false;
    ConeSet moved = rest;
    moved.add(*best);
    if (moved.variance() < most) {
      set = std::move(moved);
      return true;
    }
    open[*best] = 0;
  }
  return false;
}

void ConeSearch::drop(ConeSet& set) const { set.remove(by_need(set.sites(), set.losses()).front()); }

}  // namespace lsgp

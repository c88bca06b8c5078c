// SPDX-License-Identifier: GPL-3.0-or-later
// The search for sites of cones: growth by matching pursuit, then exchange of cone after cone.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "search/cone_set.hpp"

namespace lsgp {

constexpr int free_rings = 2;  // around each cone: cones side by side cancel each other

// How often each vertex is within some rings of the cones of a set.
class Neighborhoods {
 public:
  // Fewer rings if there is no room for a further cone outside them.
  Neighborhoods(const HalfedgeMesh& mesh, const Array<Site>& all, const Array<int>& sites, int rings);

  void add(int site, int times);
  bool is_outside(const Site& site) const {
    return count_[site.vertex] == 0 && (site.mirrored == none || count_[site.mirrored] == 0);
  }

 private:
  const HalfedgeMesh& mesh_;
  const Array<Site>& all_;
  int rings_;
  PerVertex<int> count_;
};

struct ExchangeEffort {
  int tries;                 // of new sites for a cone that is exchanged
  double worth_an_exchange;  // of the variance: less is not worth an exchange
};

class ConeSearch {
 public:
  // The first `kept` sites of every set are fixed.  sharp: sharp corners are preferred if they gain nearly as much.
  ConeSearch(const HalfedgeMesh& mesh, const PlacementProblem& problem, int kept, bool sharp, ExchangeEffort effort,
             ProgressMonitor& monitor);

  const HalfedgeMesh& mesh() const { return mesh_; }
  const PlacementProblem& problem() const { return problem_; }
  int kept() const { return kept_; }

  // Adds the site with the largest gain repeatedly, until there are so many cones or no room is left.
  void grow(ConeSet& set, int cones) const;

  // Removes every cone in turn, the least important first, and places it where it gains most; false if all remain.
  bool exchange(ConeSet& set) const;

  // Drops the least important cone.
  void drop(ConeSet& set) const;
  bool can_drop(const ConeSet& set) const { return static_cast<int>(set.sites().size()) > kept_; }

  // The weight of a gain at a site.
  double preference(int site) const { return prefers_sharp_ && is_sharp(site) ? 1 / sharp_share : 1; }

  // Places in a set that may change, the least needed one first.  losses: (k) of variance without each site.
  Array<int> by_need(const Array<int>& sites, const Eigen::VectorXd& losses) const;

  // Marks sites, (all), not within so many rings of given ones, or fewer rings if the mesh has no room.
  Array<char> open_sites(const Array<int>& used, int rings = free_rings) const;

 private:
  static constexpr double sharp_share = 0.5;  // of the largest gain, which a sharp corner needs to be preferred

  std::optional<int> best_site(const Eigen::VectorXd& gains, const Array<char>& open) const;
  bool exchange_one(ConeSet& set, const ConeSet::Explained& explained, int site) const;
  bool is_sharp(int site) const;

  const HalfedgeMesh& mesh_;
  const PlacementProblem& problem_;
  int kept_;
  bool prefers_sharp_;
  ExchangeEffort effort_;
  ProgressMonitor& monitor_;
};

}  // namespace lsgp

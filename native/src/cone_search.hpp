// SPDX-License-Identifier: GPL-3.0-or-later
// The search for sites of cones: growth by matching pursuit, then exchange of cone after cone.
#pragma once

#include <optional>
#include <vector>

#include "cone_set.hpp"
#include "monitor.hpp"

namespace lsgp {

class ConeSearch {
 public:
  // The first `kept` sites of every set stay.  sharp: sharp corners are taken where they gain nearly as much.
  ConeSearch(const HalfedgeMesh& mesh, const PlacementProblem& problem, int kept, bool sharp, Monitor& monitor);

  // Adds the site that gains most, again and again, until there are so many cones or no room is left.
  void grow(ConeSet& set, int cones) const;

  // Takes out every cone in turn, the one that matters least first, and puts it where it gains most.
  void exchange(ConeSet& set, int sweeps) const;

  // Drops the cone that matters least.
  void drop(ConeSet& set) const;
  bool can_drop(const ConeSet& set) const { return static_cast<int>(set.sites().size()) > kept_; }

  // Sites, (all), near none of some: not within two rings where the mesh has room.
  std::vector<char> open_sites(const std::vector<int>& used) const;

 private:
  std::optional<int> best_site(const Eigen::VectorXd& gains, const std::vector<char>& open) const;
  bool exchange_one(ConeSet& set, const ConeSet::Explained& explained, int site) const;
  std::vector<int> by_loss(const ConeSet& set) const;  // places that may change
  bool is_sharp(int site) const;

  const HalfedgeMesh& mesh_;
  const PlacementProblem& problem_;
  int kept_;
  bool prefers_sharp_;
  Monitor& monitor_;
};

}  // namespace lsgp

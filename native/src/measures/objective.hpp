// SPDX-License-Identifier: GPL-3.0-or-later
// The choice among candidates by what they cost.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "measures/made_map.hpp"
#include "measures/quality.hpp"

namespace lsgp {

// How far estimates are off, in hundredths of L2 stretch: what is expected to cost more than the best one made by this
// is not made. Half of the estimates of further islands are off by less; most of those of other cones and cuts are too
// low, so that more than this gains nothing.
constexpr double error_of_estimates = 0.15;

// A smaller difference of costs is to decide nothing: the first of two such candidates is taken.
constexpr double rounding_of_costs = 0.01;

// One of several maps to choose from.
struct Candidate {
  std::string name;  // for the trace
  // What it will cost, told without a map, from those made so far; none where it cannot be made, or is one of them.
  std::function<std::optional<double>()> expected;
  // Throws Error where it cannot be made; null where its cones take it beyond the bound.
  std::function<Made(const Progress&)> make;
  std::function<Quality(const Made&, const Progress&)> quality;
  std::function<std::string()> name_of_made;  // or empty: its name
};

// By which the maps of one surface are compared, and the trace of what was chosen from.
class Objective {
 public:
  Objective(const Weights& weights, SquareShare share) : weights_(weights), share_(share) {}

  const Weights& weights() const { return weights_; }
  SquareShare share() const { return share_; }
  const std::vector<Choice>& choices() const { return choices_; }

  // Of a map.  progress: of packing.  Throws CANCELLED.
  Quality quality(MadeMap& made, const Progress& progress, double asymmetry = 0) const;

  // The same in one number.
  double cost_of(MadeMap& made, const Progress& progress) const { return cost(quality(made, progress), weights_); }

  // The candidate with the fewest triangles left out, the fewest defects, and the lowest cost. The one that is expected
  // to cost least is made first; then others as long as they may cost less than the best.
  // Null where none is made, and not because all of them throw. Throws CANCELLED, and what the last one throws where
  // none can be made.
  Made choose(std::vector<Candidate> candidates, const Progress& progress);

  // Of all maps that were made until now, in any choice; null where there is none.
  const Made& best_so_far() const { return best_so_far_; }

  // What is expected of a map through these cones: as few islands as components, stretched as was measured when they
  // were placed, and during the lifetime of a bound on as good a lattice as its map.
  Quality expected_through(const SurfaceParts& parts, const CompletedCones& cones, const Options& options) const;

  // During that lifetime, the most cones of a map of one component that may cost less than the bound; none: any number.
  std::optional<int> most_cones(const SurfaceParts& parts) const;

  // Whether that is expected to cost more than the bound.
  bool is_beyond_bound(const Quality& expected) const;

  // Whether the bound is one of first candidates as well.
  bool bounds_first() const { return rival_ && bounds_first_; }

  // Whether they are bounded as wholes: of several components one may gain, whatever the cones cost on the others.
  bool bounds_whole(const SurfaceParts& parts) const { return parts.count() == 1 && bounds_first(); }

  // The map of the bound.
  const std::optional<Quality>& rival() const { return rival_; }

  // Whether a map with any defect costs more than that.
  bool bounds_defects() const { return bounds_first() && bound() < infinity; }

  // Adds a map to the trace.
  void note(const std::string& name, const Quality& quality, double estimate, bool is_best);

  // Adds a map that is not made, or not compared.
  void note_unmade(const std::string& name, double estimate, const std::string& why);

  // Adds the trace of another choice, on a surface that is named.
  void note_all(const std::string& surface, const std::vector<Choice>& others);

  // During its lifetime nothing is made that is expected to cost more than another map does; of the first candidate of
  // a choice, which has no estimate, its `make` may tell once its cones are placed.
  class Bound {
   public:
    enum class Of { others, all };  // than the first candidate

    Bound(Objective& objective, const Quality& rival, Of of = Of::others) : objective_(objective) {
      objective_.rival_ = rival;
      objective_.bounds_first_ = of == Of::all;
    }
    ~Bound() { objective_.rival_.reset(); }
    Bound(const Bound&) = delete;
    Bound& operator=(const Bound&) = delete;

   private:
    Objective& objective_;
  };

  static constexpr double infinity = std::numeric_limits<double>::infinity();

 private:
  // By which candidates are compared.
  struct Rank {
    double left_out = infinity, defects = infinity, cost = infinity;

    bool has_defects() const { return left_out > 0 || defects > 0; }
    bool is_better_than(const Rank& best) const;
  };

  // Nothing outweighs what a map lacks.
  double bound() const {
    return rival_ && rival_->left_out == 0 && rival_->defects == 0 ? cost(*rival_, weights_) : infinity;
  }

  const Weights weights_;
  const SquareShare share_;
  std::vector<Choice> choices_;
  std::optional<Quality> rival_;  // of the bound
  bool bounds_first_ = false;
  Made best_so_far_;
  Rank rank_so_far_;
};

}  // namespace lsgp

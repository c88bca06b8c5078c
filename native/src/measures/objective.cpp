// SPDX-License-Identifier: GPL-3.0-or-later
#include "measures/objective.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <tuple>
#include <utility>

#include "base/array.hpp"
#include "base/progress_share.hpp"
#include "lsgp/errors.hpp"

namespace lsgp {

namespace {

struct Estimate {
  double cost;
  std::size_t place;
};

// The candidate that is expected to cost least; none where none can be made.
std::optional<Estimate> most_promising(const std::vector<Candidate>& candidates) {
  std::optional<Estimate> least;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const std::optional<double> expected = candidates[i].expected();
    if (expected && (!least || *expected < least->cost)) least = {*expected, i};
  }
  return least;
}

}  // namespace

bool Objective::Rank::is_better_than(const Rank& best) const {
  const auto flaws = std::tie(left_out, defects), of_best = std::tie(best.left_out, best.defects);
  return flaws < of_best || (flaws == of_best && cost < best.cost - rounding_of_costs);
}

Quality Objective::quality(MadeMap& made, const Progress& progress, double asymmetry) const {
  Quality out = measured(made, share_, progress);
  out.asymmetry = asymmetry;
  return out;
}

Made Objective::choose(std::vector<Candidate> candidates, const Progress& progress) {
  Made best;
  Rank rank;
  ProgressSteps steps(progress);
  std::exception_ptr failure;
  const std::size_t count = candidates.size();
  while (const std::optional<Estimate> next = most_promising(candidates)) {
    const double most = std::min(rank.has_defects() ? infinity : rank.cost, bound());
    const bool is_first = candidates.size() == count;
    if (!is_first && most < infinity && next->cost - error_of_estimates >= most) break;
    const auto place = candidates.begin() + static_cast<std::ptrdiff_t>(next->place);
    const Candidate candidate = std::move(*place);
    candidates.erase(place);
    const Progress step = steps.next();
    Made made;
    const auto refuse = [&](Code code) {
      failure = std::current_exception();
      note_unmade(candidate.name, next->cost, std::string("is refused: ") + name(code));
    };
    try {
      made = candidate.make(step);
    } catch (const Error& error) {
      if (error.code() == Code::cancelled) throw;
      refuse(error.code());
      continue;
    } catch (const std::bad_alloc&) {
      refuse(Code::out_of_memory);
      continue;
    }
    const auto name_of_made = [&] { return candidate.name_of_made ? candidate.name_of_made() : candidate.name; };
    if (!made) {
      note_unmade(name_of_made(), next->cost, "is expected to cost more through its cones");
      continue;
    }
    if (!best_so_far_) best_so_far_ = made;  // measuring may be stopped
    const Quality quality = candidate.quality(made, share_of(step, 1, 1));
    const Rank own{static_cast<double>(quality.left_out), static_cast<double>(quality.defects),
                   cost(quality, weights_)};
    const bool is_best = own.is_better_than(rank);
    if (is_best) {
      best = made;
      rank = own;
    }
    if (own.is_better_than(rank_so_far_)) {
      best_so_far_ = made;
      rank_so_far_ = own;
    }
    note(name_of_made(), quality, next->cost, is_best);
  }
  for (const Candidate& candidate : candidates) {
    const std::optional<double> expected = candidate.expected();
    if (expected) note_unmade(candidate.name, *expected, "is expected to cost more");
  }
  if (!best && failure) std::rethrow_exception(failure);
  tell(progress, 1);
  return best;
}

Quality Objective::expected_through(const SurfaceParts& parts, const CompletedCones& cones,
                                    const Options& options) const {
  Quality out;
  out.islands = parts.count();
  out.cones = count_by_area(parts, cones.cones.vertices);
  const double l2 = cones.placement ? cones.placement->mapped_l2 : 1;
  if (!std::isfinite(l2)) {
    if (!options.hard_repairs) out.defects = 1;
  } else {
    out.stretch = 100 * left_of_stretch(options.mode) * (l2 - 1);
  }
  if (rival_) out.on_lattice = rival_->on_lattice;
  return out;
}

std::optional<int> Objective::most_cones(const SurfaceParts& parts) const {
  const double left = bound() + error_of_estimates - cost(expected_through(parts, {}, {}), weights_);
  if (!(weights_.cones > 0) || !(left / weights_.cones < std::numeric_limits<int>::max())) return {};
  return static_cast<int>(std::max(left / weights_.cones, 0.0));
}

bool Objective::is_beyond_bound(const Quality& expected) const {
  if (!rival_) return false;
  const auto flaws = std::tie(expected.left_out, expected.defects),
             of_rival = std::tie(rival_->left_out, rival_->defects);
  return flaws != of_rival ? of_rival < flaws : cost(expected, weights_) - error_of_estimates >= bound();
}

void Objective::note(const std::string& name, const Quality& quality, double estimate, bool is_best) {
  choices_.push_back({name, estimate, cost(quality, weights_), quality, in_words(quality), is_best});
}

void Objective::note_unmade(const std::string& name, double estimate, const std::string& why) {
  choices_.push_back({name, estimate, {}, {}, why, false});
}

void Objective::note_all(const std::string& surface, const std::vector<Choice>& others) {
  for (const Choice& choice : others) {
    choices_.push_back(choice);
    choices_.back().name = surface + ": " + choice.name;
  }
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// By what presets choose, and how.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "balls.hpp"
#include "measures/objective.hpp"

using namespace lsgp;

namespace {

Quality some_quality() {
  Quality out;
  out.stretch = 1.5;
  out.islands = 3;
  out.cuts = 4;
  out.borders = 2;
  out.cones = 9;
  out.empty = 0.8;
  out.asymmetry = 0.5;
  return out;
}

// A part of the quality and its weight.
struct Part {
  double Quality::* part;
  double Weights::* weight;
};

const std::vector<Part> parts{{&Quality::islands, &Weights::islands}, {&Quality::cuts, &Weights::cuts},
                              {&Quality::borders, &Weights::borders}, {&Quality::cones, &Weights::cones},
                              {&Quality::empty, &Weights::square},    {&Quality::asymmetry, &Weights::symmetry}};

// What is expected of a candidate, and what it costs; none where it cannot be made, or is refused.
struct Told {
  std::optional<double> expected, cost;
  Index defects = 0;
};

// The choice among such candidates.
struct Trial {
  std::vector<std::size_t> made;  // their numbers, as they are made
  std::vector<double> progress;
  Objective objective{Weights{}, {}};

  // The number of the best one.
  std::size_t choose(const std::vector<Told>& told, const Progress& given = {}) {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < told.size(); ++i) {
      const auto make = [this, i, of = told[i]](const Progress&) {
        made.push_back(i);
        if (!of.cost) throw Error(Code::solver_failed, std::to_string(i));
        auto map = std::make_shared<MadeMap>();
        map->cones.cones.vertices = {static_cast<Index>(i)};
        return map;
      };
      const auto quality = [of = told[i]](const Made&, const Progress&) {
        Quality out;
        out.defects = of.defects;
        out.stretch = *of.cost;
        return out;
      };
      candidates.push_back({std::to_string(i), [of = told[i]] { return of.expected; }, make, quality, {}});
    }
    const Progress tell = [this](double done) {
      progress.push_back(done);
      return true;
    };
    const Made best = objective.choose(candidates, given ? given : tell);
    return static_cast<std::size_t>(best->cones.cones.vertices.front());
  }
};

}  // namespace

TEST_CASE("each part costs what its weight says") {
  for (const Part& part : parts) {
    const Weights weights;
    Quality worse = some_quality();
    worse.*part.part += 1;
    CHECK(cost(worse, weights) - cost(some_quality(), weights) == doctest::Approx(weights.*part.weight));
    Weights without;
    without.*part.weight = 0;
    CHECK(cost(worse, without) == cost(some_quality(), without));
  }
  Quality stretched = some_quality();
  stretched.stretch += 1;
  CHECK(cost(stretched, {}) - cost(some_quality(), {}) == doctest::Approx(1));
}

TEST_CASE("of many islands a tenth counts as one") {
  const auto with = [](double islands) {
    Quality out = some_quality();
    out.islands = islands;
    return cost(out, {});
  };
  CHECK(with(2) - with(1) == doctest::Approx(Weights().islands));
  CHECK(with(10) - with(9) == doctest::Approx(Weights().islands));
  CHECK(with(220) - with(200) == doctest::Approx(Weights().islands).epsilon(0.05));
}

TEST_CASE("others are made as long as they may cost less") {
  const double infinity = Objective::infinity;
  struct Case {
    std::vector<Told> told;
    std::vector<std::size_t> made;
    std::size_t best;
  };
  const std::vector<Case> cases{
      {{{1.0, 2.0}, {0.5, 3.0}}, {1, 0}, 0},                           // the most promising first
      {{{0.0, 2.0}, {2.0 + 2 * error_of_estimates, 0.0}}, {0}, 0},     // not worth a try
      {{{0.0, 2.0}, {2.0 + error_of_estimates / 2, 1.0}}, {0, 1}, 1},  // estimates may be off
      {{{0.0, 2.0}, {{}, 1.0}}, {0}, 0},                               // cannot be made
      {{{0.0, {}}, {infinity, 9.0}}, {0, 1}, 1},                       // the last resort
      {{{0.0, 1.0, 1}, {50.0, 60.0}}, {0, 1}, 1},                      // no defect is worth anything
  };
  for (const Case& one : cases) {
    Trial trial;
    CHECK(trial.choose(one.told) == one.best);
    CHECK(trial.made == one.made);
    CHECK(trial.progress.back() == 1);
    CHECK(std::is_sorted(trial.progress.begin(), trial.progress.end()));
    for (const Choice& choice : trial.objective.choices()) {
      const Told& told = one.told[std::stoul(choice.name)];
      CHECK(choice.estimate == told.expected);
      const bool is_made = std::count(one.made.begin(), one.made.end(), std::stoul(choice.name)) > 0;
      CHECK(choice.cost == (is_made ? told.cost : std::nullopt));
      CHECK(choice.cost.has_value() == choice.quality.has_value());
    }
    const auto can_be = [](const Told& told) { return told.expected.has_value(); };
    CHECK(static_cast<std::ptrdiff_t>(trial.objective.choices().size()) ==
          std::count_if(one.told.begin(), one.told.end(), can_be));
  }
}

TEST_CASE("a choice is left where its cones take it beyond the bound") {
  Trial trial;
  const auto no_map = [](const Progress&) { return Made(); };
  const auto quality = [](const Made&, const Progress&) { return Quality(); };
  Quality rival;
  const Objective::Bound bound(trial.objective, rival);
  const auto with = [&](const char* name, double expected) {
    return Candidate{name, [expected] { return expected; }, no_map, quality, {}};
  };
  CHECK(trial.objective.choose({with("first", 0), with("another", error_of_estimates)}, {}) == nullptr);
  REQUIRE(trial.objective.choices().size() == 2);
  for (const Choice& choice : trial.objective.choices()) CHECK_FALSE(choice.cost);
}

TEST_CASE("beyond the bound is what costs more than another map by more than estimates are off") {
  Objective objective{Weights{}, {}};
  Quality rival;
  rival.stretch = 2;
  rival.on_lattice = -10;
  Quality other = rival;
  CHECK_FALSE(objective.is_beyond_bound(other));  // there is none
  const Objective::Bound bound(objective, rival, Objective::Bound::Of::all);
  CHECK(objective.bounds_first());
  other.stretch = 2 + error_of_estimates / 2;
  CHECK_FALSE(objective.is_beyond_bound(other));
  other.stretch = 2 + 2 * error_of_estimates;
  CHECK(objective.is_beyond_bound(other));
}

TEST_CASE("beyond the bound is what has defects, as cones do that only hard repairs would give a map") {
  Objective objective{Weights{}, {}};
  const Surface ball = uneven_ball(100);
  const SurfaceParts parts(ball);
  CompletedCones cones;
  cones.placement = Placement();
  cones.placement->mapped_l2 = std::numeric_limits<double>::infinity();
  Options options;
  Quality rival;
  rival.stretch = 5;
  CHECK_FALSE(objective.bounds_defects());
  {
    const Objective::Bound bound(objective, rival, Objective::Bound::Of::all);
    CHECK(objective.bounds_defects());
    CHECK_FALSE(objective.is_beyond_bound(objective.expected_through(parts, cones, options)));
    options.hard_repairs = false;
    CHECK(objective.is_beyond_bound(objective.expected_through(parts, cones, options)));
  }
  rival.defects = 1;
  const Objective::Bound bound(objective, rival, Objective::Bound::Of::all);
  CHECK_FALSE(objective.bounds_defects());
  CHECK_FALSE(objective.is_beyond_bound(objective.expected_through(parts, cones, options)));
}

TEST_CASE("a map with defects bounds nothing but those with further ones") {
  Objective objective{Weights{}, {}};
  Quality rival, dearer;
  rival.defects = 1;
  dearer.stretch = 100;
  const Objective::Bound bound(objective, rival, Objective::Bound::Of::all);
  CHECK_FALSE(objective.is_beyond_bound(dearer));
  dearer.defects = 2;
  CHECK(objective.is_beyond_bound(dearer));
  dearer.defects = 0;
  dearer.left_out = 1;
  CHECK(objective.is_beyond_bound(dearer));
}

TEST_CASE("with one cone more than the most of a bound a map is beyond it") {
  Weights weights;
  weights.cones = 0.125;
  Objective objective{weights, {}};
  const Surface ball = uneven_ball(100);
  const SurfaceParts parts(ball);
  CHECK_FALSE(objective.most_cones(parts));  // there is no bound
  Quality rival;
  rival.stretch = 3;
  const Objective::Bound bound(objective, rival);
  const std::optional<int> most = objective.most_cones(parts);
  REQUIRE(most);
  const auto through = [&](int count) {
    Quality expected = objective.expected_through(parts, {}, {});
    expected.cones = count;
    return expected;
  };
  CHECK_FALSE(objective.is_beyond_bound(through(*most - 1)));
  CHECK(objective.is_beyond_bound(through(*most + 1)));
}

TEST_CASE("nothing is made that another map outdoes") {
  const std::vector<Told> told{{0.0, 3.0}, {2.5, 1.0}};
  Trial trial;
  {
    Quality rival;
    rival.stretch = 2;
    const Objective::Bound bound(trial.objective, rival);
    CHECK(trial.choose(told) == 0);
    CHECK(trial.made == std::vector<std::size_t>{0});
  }
  CHECK(trial.choose(told) == 1);
}

TEST_CASE("a map beyond all is made where nothing else can be, and not beside another map") {
  const std::vector<Told> told{{0.0, {}}, {Objective::infinity, 3.0}};
  Trial trial;
  CHECK(trial.choose(told) == 1);
  const Objective::Bound bound(trial.objective, Quality{});
  CHECK_THROWS_WITH_AS(trial.choose(told), "0", Error);
  CHECK(trial.made == std::vector<std::size_t>{0, 1, 0});
}

TEST_CASE("where none can be made the last one says why") {
  Trial trial;
  CHECK_THROWS_WITH_AS(trial.choose({{0.0, {}}, {1.0, {}}}), "1", Error);
}

TEST_CASE("cancelling ends the choice") {
  Trial trial;
  CHECK_THROWS_AS(trial.choose({{0.0, 1.0}}, [](double) { return false; }), Error);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The choice between usual cones and symmetric ones, each of them placed once it may gain.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

// Cones that are to be completed.
struct GivenCones {
  Cones cones;
  std::optional<int> count;  // as in CompletionOptions
  double target = CompletionOptions().target;
  PerTriangle<char> without = {};  // as in CompletionOptions

  // Neither cones nor their number are given.
  bool are_free() const { return !count && cones.vertices.empty(); }
};

// Whether symmetric cones are among the candidates.
enum class Symmetry { tried, not_tried };

class SymmetryChoice {
 public:
  // maps: of the surface. symmetry: symmetric cones are tried only where none are given.
  SymmetryChoice(BorderedSurface& surface, Borrowed<const MapThrough> maps, Borrowed<const GivenCones> given,
                 Symmetry symmetry, Objective& objective);

  // The best map with these options; null where its cones take it beyond the objective's bound.  Throws what
  // `complete_cones` and `parameterize` throw.
  Made best(const MapOptions& options, const Progress& progress);

 private:
  enum class Kind { symmetric, free_cuts, usual, partly };
  struct MadeCandidate {
    Kind kind;
    Made map;
    Quality quality;
  };

  enum class Placing { usual, symmetric };

  Candidate candidate(Kind kind, double asymmetry);
  std::optional<double> expected(Kind kind) const;
  Made make(Kind kind, const Progress& progress);
  Made through(const CompletedCones& cones, const Progress& progress) const;
  // Null beyond the bound.
  Made through_first(const CompletedCones& cones, const Progress& progress);
  CompletedCones placed(Placing how, const Progress& progress) const;
  CompletedCones symmetric_cones(const Progress& progress);

  // Of maps with other cones or cuts than those that were made: stretched as much, unless the cones are others and that
  // is more than they are placed for, with three quarters of the islands.
  std::optional<double> expected_of_others(Kind kind, double asymmetry) const;
  Quality with_stretch_of_others(Quality quality) const;
  // Whether it could cost less than one that is made, if all went well.
  bool may_cost_less(const MadeCandidate& made, Quality other) const;
  // Where both of the other ones were made: the sum over components, which is known.
  std::optional<double> expected_of_partly() const;

  const MadeCandidate* made(Kind kind) const;
  // On which components the symmetric map costs no more.
  PerComponent<char> are_cheaper_symmetric() const;
  // What each component costs in a map, but for the square; infinite with further defects.
  PerComponent<double> costs_of(const MadeCandidate& candidate) const;

  BorderedSurface& surface_;
  const MapThrough& maps_;
  const GivenCones& given_;
  Objective& objective_;
  const bool tries_symmetry_;
  MapOptions options_;
  std::optional<CompletedCones> alike_;  // symmetric cones, once they are placed
  double share_ = 0;                     // of the area, of symmetric components
  std::vector<MadeCandidate> made_;
  std::optional<Quality> beyond_;  // expected of the map that was not made, since it is beyond the bound
};

// Cones of one choice, and on some components, given by their vertices, those of another one.
CompletedCones joined(const CompletedCones& cones, const CompletedCones& others, const Surface& surface,
                      const PerVertex<char>& is_of_others);

// Which vertices are on components that are marked.
PerVertex<char> vertices_on(const SurfaceParts& parts, const PerComponent<char>& is_marked);

}  // namespace lsgp

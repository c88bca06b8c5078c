// SPDX-License-Identifier: GPL-3.0-or-later
// What a map has to gain by borders at creases, compared with the usual map without them.
#pragma once

#include "measures/made_map.hpp"
#include "measures/objective.hpp"

namespace lsgp {

// Borders at which components may end, and the component of each.
struct PossibleBorders {
  VertexPairs edges;
  Array<Index> component;

  PossibleBorders(const SurfaceParts& parts, VertexPairs borders);

  // Those of some components.
  VertexPairs of(const Array<Index>& components) const;
};

// A reason for which components may end at creases. chosen: numbers of components.
class BorderGain {
 public:
  BorderGain() = default;
  BorderGain(const BorderGain&) = delete;
  BorderGain& operator=(const BorderGain&) = delete;
  virtual ~BorderGain() = default;

  // The chosen components on which a map with borders is worth a try.  progress: of packing.  Throws CANCELLED.
  virtual Array<Index> promising(MadeMap& usual, const Array<Index>& chosen, const Progress& progress) = 0;

  // The chosen components that gain by that they all end at creases in the first map.
  virtual Array<Index> gaining(MadeMap& bordered, MadeMap& usual, const Array<Index>& chosen) = 0;

  // Whether the map is better as a whole.
  virtual bool may_replace(MadeMap& bordered, MadeMap& usual, const Progress& progress) = 0;
};

// What is expected of maps that end at borders of one kind.
struct BorderKind {
  const char* name;           // for the trace
  double stretch_kept = 0;    // what they leave of the stretch
  double stretch = 0;         // and hundredths of it besides
  bool counts_sight = false;  // whether they cost what the front sees of them, as cuts do
  double least_in_sight = 0;  // what a component's cuts have to cost beyond their length, if its map is measured alone
};

// At creases a tenth of the stretch is left.
constexpr BorderKind at_creases{"boundaries at creases", 0.1, 0, false, 0};
// Around the front, where cuts in sight cost as much as a hundredth of stretch. On twelve generated figures, six heads
// and six bodies, the stretch without cones was 2.7 to 4.6.
constexpr BorderKind around_front{"the front in one piece", 0, 3, true, 1};

// Maps that cost less.
class LowerCost : public BorderGain {
 public:
  // parts: of the surface without the borders.
  LowerCost(const SurfaceParts& parts, const PossibleBorders& borders, const BorderKind& kind, Objective& objective);

  // Those that are expected to cost less: they are stretched as borders of this kind leave it, are as many islands as
  // pieces between borders, and fill the square well if they do not.
  Array<Index> promising(MadeMap& usual, const Array<Index>& chosen, const Progress& progress) override;

  // All of them if the whole map costs less, otherwise those that do.
  Array<Index> gaining(MadeMap& bordered, MadeMap& usual, const Array<Index>& chosen) override;

  // Where it costs less as a whole, with no further defects.
  bool may_replace(MadeMap& bordered, MadeMap& usual, const Progress& progress) override;

 private:
  // The number of pieces between all possible borders that each component would have.
  PerComponent<Index> pieces() const;
  Quality with_sight(MadeMap& bordered, const Progress& progress) const;

  const SurfaceParts& parts_;
  const PossibleBorders& borders_;
  const BorderKind& kind_;
  Objective& objective_;
  PerComponent<double> seen_;  // what is seen of all borders costs
};

// Whether a seamless map of one component, even if all its creases ran along the lattice at its stretch, would be
// replaced by the one that ends at them, as `AlongLattice` decides.
bool is_outdone_at_creases(const Result& usual, const Quality& ended);

// Seamless maps whose marked features, or creases if none are marked, run along the lattice, at little stretch and with
// large tiles.
class AlongLattice : public BorderGain {
 public:
  // parts: of the surface without the borders.
  AlongLattice(const SurfaceParts& parts, const PossibleBorders& borders) : parts_(parts), borders_(borders) {}

  // Those many of whose creases do not, or that are stretched by more than a tenth or left out, if they are not small;
  // those with defects in any case.
  Array<Index> promising(MadeMap& usual, const Array<Index>& chosen, const Progress& progress) override;

  // Where more of them has a map, or as much with fewer defects, or with as few, if that is worth that the texture does
  // not run on across their creases; if they are not small, but for those with defects.
  Array<Index> gaining(MadeMap& bordered, MadeMap& usual, const Array<Index>& chosen) override;

  // Where all have gained, and it has no further defects.
  bool may_replace(MadeMap& bordered, MadeMap& usual, const Progress& progress) override;

 private:
  // These if they are large together, otherwise those with defects.
  Array<Index> if_large(const Array<Index>& components, const PerComponent<Index>& defects) const;
  // The marked features, or the possible borders and the creases found in any of these maps.
  VertexPairs creases(const Array<const MadeMap*>& maps) const;
  // Of the length of each component's edges what runs along the lattice; 1 without any.
  PerComponent<double> shares(const MadeMap& made, const VertexPairs& edges) const;

  const SurfaceParts& parts_;
  const PossibleBorders& borders_;
};

}  // namespace lsgp

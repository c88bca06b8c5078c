// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts on a square lattice whose features run along its lines (Bommes, Zimmer and Kobbelt 2009, sections 4 and 5:
// alignment constraints and greedy rounding).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <optional>

#include "base/array.hpp"
#include "base/union_find.hpp"
#include "lsgp/result.hpp"
#include "prescription/curvature.hpp"
#include "repair/feature_lines.hpp"
#include "repair/line_constraints.hpp"
#include "repair/newton.hpp"
#include "seamless/lattice_transitions.hpp"
#include "seamless/whole_values.hpp"
#include "solvers/cholesky.hpp"
#include "unfold/distortion.hpp"

namespace lsgp {

// A map whose features are to run along the axes.
struct FeatureTask {
  CutSurface surface;
  const Curvature& curvature;
  const Eigen::VectorXd& rotation;  // (cuts) radians, multiples of quarter turns
  const LatticeReduction& lattice;
  StepHook before_step;
};

// Features along the axes, before the lattice; the same for lattices of any size.
struct FeatureAlignment {
  Array<FeatureLine> lines;
  Eigen::VectorXcd start;              // (copies) the map with these lines along the axes
  PerHalfedge<ReleaseReason> reasons;  // of the others
};

class FeatureLayout {
 public:
  // feature: the FeatureKind of halfedges.  start: (copies) a valid map of the surface's area, without a lattice.
  // most_l2: the largest stretch that features may cost. As many as possible run along the axes, marked ones before
  // others, those of least cost first.  known: of an earlier layout of the same map, or empty, which is filled then.
  FeatureLayout(const FeatureTask& task, const PerHalfedge<char>& feature, const Eigen::VectorXcd& start,
                double most_l2, std::optional<FeatureAlignment>& known);

  // Whether any feature runs along an axis.
  bool is_aligned() const { return factor_.has_value(); }
  // The start with features along the axes.
  const Eigen::VectorXcd& start() const { return start_; }
  // Why halfedges of features do not run along an axis; meaningless for others.
  const PerHalfedge<ReleaseReason>& reasons() const { return reasons_; }

  // Releases features after no lattice that was tried has admitted all. Of two ways, whichever keeps more of their
  // length comes next: edges at the defects of the layout with the fewest are released, or the most expensive sixth of
  // the lines. False if none would be left.
  bool loosen();

  // The layout with about `density` cells per unit of length, with cones and translations on the lattice. Features are
  // on lines of the lattice or, where cells are too large for that and they need not be whole, at multiples of 1 / 256
  // of a cell. None where no such layout without flips is found that is accepted.  keeps_corners: ends and corners of
  // features are also at corners of cells, as far as that costs little; none where that is no other layout than
  // without.
  std::optional<Eigen::VectorXcd> quantize(double density, bool must_be_whole, bool keeps_corners,
                                           const std::function<bool(const Eigen::VectorXcd&)>& accepts);

  // Moves all points but those of features and cones to where they stretch least.  weights: (m) of triangles.
  void relax(const Eigen::VectorXd& weights, Eigen::VectorXcd& position) const;

 private:
  // A choice of values for the rounded coordinates.
  struct Choice {
    double scale;              // of the start
    Array<Index> independent;  // coordinates that determine the others
    Eigen::VectorXd pull;      // (independent) the forces that move them there
    Eigen::VectorXd values;    // of all rounded coordinates
    double cost;
  };

  // Where lines could not be aligned.
  struct Failure {
    Array<Index> vertices;
    bool is_of_lines = false;  // releasing their edges there has not helped
  };

  void align_all(const PerHalfedge<char>& feature);
  Array<FeatureLine> compatible(const Array<FeatureLine>& lines);
  void add_compatible(const Array<FeatureLine>& lines, const Index* begin, const Index* end, Array<char>& chosen);
  void add_faultless(const Array<FeatureLine>& lines, Index begin, Index end, Array<char>& chosen);
  Array<Index> contradicting(const Array<FeatureLine>& lines, const Array<char>& chosen);
  std::optional<Eigen::VectorXcd> fit(const DegreesOfFreedom& freedom) const;
  bool keeps_lengths(const FeatureLine& line, const Eigen::VectorXcd& position) const;
  void add(Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end);
  void add_trimmed();
  void release(Index h, ReleaseReason reason);
  bool are_few(const Array<Index>& vertices) const;
  void find_loosened();
  double length_along(const Array<FeatureLine>& lines, const Eigen::VectorXcd& position) const;
  FeatureLine part_of(const FeatureLine& line, const std::function<bool(Index)>& is_in) const;
  bool trim(const Failure& failure, Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end,
            Array<FeatureLine>* released) const;
  // None if all of them run along axes then, otherwise why they do not.  defects: vertices where the map fails.
  std::optional<ReleaseReason> align(const Array<FeatureLine>& lines, std::ptrdiff_t begin, std::ptrdiff_t end,
                                     Array<Index>& defects);
  DirectedEdges edges_of(const Array<FeatureLine>& lines) const;
  void hold_translation();
  void find_coordinates();
  void find_lattice_coordinates();
  void find_distances(const DirectedEdges& edges, const Array<char>& is_on_line, UnionFind& same);
  void find_corners(const Array<char>& is_on_line);
  std::optional<Choice> round(double scale, bool is_fine) const;
  void round_corners(Eigen::VectorXd& value, PivotedCholesky& cholesky, Choice& choice) const;
  std::optional<Choice> choose(double density, bool is_fine) const;
  std::optional<Eigen::VectorXcd> lay_out(const Choice& choice, double step_of_lines);
  void snap(double step, Eigen::VectorXcd& position) const;
  bool is_upright(Index triangle, const Eigen::VectorXcd& position) const;
  bool flips_at_most(double share, const Eigen::VectorXcd& position) const;
  bool minimize(Eigen::VectorXcd& position) const;
  bool is_valid(const Eigen::VectorXcd& position) const;
  bool is_on_lattice(const Eigen::VectorXcd& position) const;
  Validity validity_of(const Eigen::VectorXcd& position) const;
  Array<Index> defects_of(const Eigen::VectorXcd& position) const;

  const FeatureTask task_;
  Eigen::VectorXcd unaligned_;  // relaxed, with features near the axes
  const double most_l2_;
  Jacobians jacobians_;           // of it
  int left_ = 0, fits_left_ = 0;  // attempts, and fits before them
  PerHalfedge<ReleaseReason> reasons_;
  Array<FeatureLine> aligned_;
  Array<FeatureLine> trimmed_;  // released at defects
  double aligned_length_ = 0;   // before any was released for the lattice
  Eigen::VectorXcd start_;
  Array<Array<Index>> lines_;  // coordinates, 2 copy for u and 2 copy + 1 for v, that are the same
  PerVertex<char> is_cone_;
  // Lengths of lines between cones, the lattice's, distances between lines, one of each line, and those along lines of
  // their ends and corners.
  Array<CoordinateForm> rounded_;
  std::ptrdiff_t length_count_ = 0, lattice_count_ = 0, distance_count_ = 0, line_count_ = 0;  // ends of the first ones
  bool keeps_corners_ = false;
  bool may_shift_ = false;
  Array<CoordinateForm> held_translation_;  // its two coordinates, or empty
  struct Loosened {
    Array<FeatureLine> lines;
    Eigen::VectorXcd start;  // valid, along more lines
    int trimmings;           // of single edges for the lattice; -1 after releases of whole lines
  };
  Array<Loosened> loosened_;              // not tried yet
  int trimmings_ = 0;                     // of the present lines
  double hopeless_scale_ = 0;             // at which a layout failed at too many places to release edges there
  Array<Index> lattice_defects_;          // the fewest vertices at which a layout on a lattice failed, or empty
  DegreesOfFreedom held_, held_corners_;  // with the rounded coordinates fixed, but for those of corners, and with all
  std::optional<FreedomSystem> system_;
  std::optional<Cholesky<double>> factor_;
  Eigen::SparseMatrix<double> coefficients_;  // (rows, rounded)
  Eigen::MatrixXd compliance_;                // (rounded, rounded) how far each moves under a unit force on another
  std::optional<WholeValues> whole_values_, fine_values_;  // of the rounded ones; lines in cells, or in fine steps
};

}  // namespace lsgp

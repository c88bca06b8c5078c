// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts on a square lattice whose features run along its lines (Bommes, Zimmer and Kobbelt 2009, section 5: greedy
// rounding).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <optional>

#include "base/array.hpp"
#include "base/union_find.hpp"
#include "lsgp/result.hpp"
#include "repair/feature_lines.hpp"
#include "repair/line_constraints.hpp"
#include "repair/newton.hpp"
#include "seamless/feature_alignment.hpp"
#include "seamless/feature_task.hpp"
#include "seamless/whole_values.hpp"
#include "solvers/cholesky.hpp"

namespace lsgp {

class FeatureLayout {
 public:
  // alignment: of the task, with some lines. coarse_step: of their places, a whole cell or half of one.
  FeatureLayout(const FeatureTask& task, const FeatureAlignment& alignment, double coarse_step);

  // The start with features along the axes.
  const Eigen::VectorXcd& start() const { return start_; }
  // Why halfedges of features do not run along an axis; meaningless for others.
  const PerHalfedge<ReleaseReason>& reasons() const { return reasons_; }

  // Releases features after no lattice that was tried has admitted all. Of two ways, whichever keeps more of their
  // length comes next: edges at the defects of the layout with the fewest are released, or the most expensive sixth of
  // the lines. False if none would be left, or after all the work that choosing values may take.
  bool loosen();

  // The layout with about `density` cells per unit of length, with cones and translations on the lattice. Features are
  // at coarse steps or, where cells are too large for that and they need not be, at multiples of 1 / 256 of a cell.
  // None where no such layout without flips is found that is accepted.  keeps_corners, of those at coarse steps: ends
  // and corners of features are also at such steps along them, as far as that costs little; none where that is no other
  // layout than without.
  std::optional<Eigen::VectorXcd> quantize(double density, bool must_be_coarse, bool keeps_corners,
                                           const std::function<bool(const Eigen::VectorXcd&)>& accepts);

  // Whether choosing values took long before features were released.
  bool is_large() const { return is_large_; }

  // Moves all points of a layout but those of features and cones to where they stretch least.  weights: (m) of
  // triangles.
  void relax(bool keeps_corners, const Eigen::VectorXd& weights, Eigen::VectorXcd& position) const {
    task_.relax(held(keeps_corners), weights, position);
  }

 private:
  // Lines and corners are at coarse steps, lines only, or lines at fine steps.
  enum class Rounding { with_corners, coarse, fine };

  // A choice of values for the rounded coordinates.
  struct Choice {
    Rounding rounding;
    double scale;              // of the start
    Array<Index> independent;  // coordinates that determine the others
    Eigen::VectorXd pull;      // (independent) the forces that move them there
    Eigen::VectorXd values;    // of all rounded coordinates
    double cost;
  };

  void find_loosened();
  void hold_translation();
  void find_coordinates();
  void find_lattice_coordinates();
  void find_distances(const DirectedEdges& edges, const Array<char>& is_on_line, UnionFind& same);
  void find_corners(const Array<char>& is_on_line);
  std::optional<WholeValues> find_values(double step) const;
  double step_of(Rounding rounding) const;
  // None where rounding lines costs `too_much` or more, or after all the work that it may take.
  std::optional<Choice> round(double scale, Rounding rounding, double too_much);
  void round_corners(Eigen::VectorXd& value, PivotedCholesky& cholesky, Choice& choice) const;
  bool has_many_coordinates() const;
  std::optional<Choice> choose(double density, Rounding rounding);
  std::optional<Eigen::VectorXcd> lay_out(const Choice& choice);
  void snap(double step, Eigen::VectorXcd& position) const;
  bool is_on_lattice(const Eigen::VectorXcd& position) const;
  const DegreesOfFreedom& held(bool keeps_corners) const { return keeps_corners ? held_corners_ : held_; }

  const FeatureTask task_;
  const PerVertex<char> is_cone_;
  PerHalfedge<ReleaseReason> reasons_;
  Array<FeatureLine> aligned_;
  const double aligned_length_;  // before any was released for the lattice
  const double coarse_step_;     // cells
  Eigen::VectorXcd start_;
  Array<Array<Index>> lines_;  // coordinates, 2 copy for u and 2 copy + 1 for v, that are the same
  // Lengths of lines between cones, the lattice's, distances between lines, one of each line, and those along lines of
  // their ends and corners.
  Array<CoordinateForm> rounded_;
  std::ptrdiff_t length_count_ = 0, lattice_count_ = 0, distance_count_ = 0, line_count_ = 0;  // ends of the first ones
  double left_;  // multiplications that choosing values may still take
  bool may_shift_ = false, is_large_ = false, are_fine_values_known_ = false;
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
  std::optional<WholeValues> coarse_values_, fine_values_;  // of the rounded ones; lines in such steps
};

}  // namespace lsgp

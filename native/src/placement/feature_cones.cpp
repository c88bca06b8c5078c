// SPDX-License-Identifier: GPL-3.0-or-later
#include "placement/feature_cones.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/checkpoint.hpp"
#include "systems/laplace_solver.hpp"

namespace lsgp {

namespace {

constexpr double quarter = M_PI / 2;
constexpr double ambiguous = 15 * M_PI / 180;  // from a multiple of quarter turns: others may be chosen beyond
constexpr Index most_candidates = 200;         // examined at once, each with its effect on all vertices
constexpr Index most_on_border = 400;          // examined at once where only the boundary is left
constexpr int most_refinements = 4;            // of the places of cones
constexpr Index most_curvature = 2;            // of a cone inside, in quarter turns
constexpr Index widest = 4;                    // angle at the boundary

// The log scale of a map with the angles of `at_border` and cones inside has the Laplacian of imposed minus natural
// curvature; chooses the cones for which it varies least.
class PatchRounding {
 public:
  PatchRounding(const MetricMesh& patch, PerVertex<Index> at_border)
      : mesh_(patch.mesh),
        geometry_(patch.geometry),
        at_border_(std::move(at_border)),
        moved_(patch.mesh.vertex_count(), 0) {
    PerVertex<char> held(mesh_.vertex_count(), 0);
    held[0] = 1;
    solver_ = sparse_laplace(patch, held);
    missing_ = 4 * mesh_.euler;
    Eigen::VectorXd right(mesh_.vertex_count());
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      right[v] = -geometry_.angle_defect[v];
      if (!is_on_border(v)) continue;
      missing_ -= 2 - at_border_[v];
      right[v] += (2 - at_border_[v]) * quarter;
    }
    // Missing curvature is distributed evenly until it is in cones.
    right += missing_ * quarter / geometry_.total_area * geometry_.vertex_area;
    rest_ = centered(solver_->solve(Eigen::MatrixXd(right)));
  }

  // Returns whether all curvature is placed.
  bool place() {
    if (missing_ == 0) return true;
    const Array<Index> candidates = all_candidates();
    const std::ptrdiff_t stride = (ssize(candidates) + most_candidates - 1) / most_candidates;
    if (!choose(every(stride, 0, candidates))) return choose_on_border();  // a fan with a single vertex inside
    for (int refinement = 0; refinement < most_refinements && stride > 1; ++refinement) choose(near_cones());
    return true;
  }

  PatchAngles angles() const {
    PatchAngles out{at_border_, {}};
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (moved_[v] == 0) continue;
      if (is_on_border(v))
        out.at_border[v] -= moved_[v];
      else
        out.curvature.emplace_back(v, moved_[v]);
    }
    return out;
  }

 private:
  bool is_on_border(Index v) const { return mesh_.loop_of_vertex[v] != none; }

  Eigen::MatrixXd centered(Eigen::MatrixXd values) const {
    values.rowwise() -= (geometry_.vertex_area.transpose() * values / geometry_.total_area).eval();
    return values;
  }

  // Vertices inside, and corners of the boundary whose angle may also be rounded differently.
  Array<Index> all_candidates() const {
    Array<Index> out;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      const double off = M_PI - geometry_.angle_defect[v] - at_border_[v] * quarter;
      if (!is_on_border(v) || std::abs(off) > ambiguous) out.push_back(v);
    }
    return out;
  }

  static Array<Index> every(std::ptrdiff_t stride, std::ptrdiff_t begin, const Array<Index>& of) {
    Array<Index> out;
    for (std::ptrdiff_t i = begin; i < ssize(of); i += stride) out.push_back(of[i]);
    return out;
  }

  // Among some vertices of the boundary, evenly spread, and among others if these cannot take up all.
  bool choose_on_border() {
    Array<Index> border;
    for (const Array<Index>& loop : mesh_.boundary_loops) border.insert(border.end(), loop.begin(), loop.end());
    const std::ptrdiff_t stride = (ssize(border) + most_on_border - 1) / most_on_border;
    for (std::ptrdiff_t begin = 0; begin < stride; ++begin) {
      if (choose(every(stride, begin, border))) return true;
    }
    return false;
  }

  Array<Index> near_cones() const {
    Array<Index> out;
    PerVertex<char> is_listed(mesh_.vertex_count(), 0);
    const auto list = [&](Index v) {
      if (is_listed[v]) return;
      is_listed[v] = 1;
      out.push_back(v);
    };
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (moved_[v] != 0) list(v);
    }
    constexpr Index rings = 3;
    std::size_t begin = 0;
    for (Index ring = 0; ring < rings; ++ring) {
      const std::size_t end = out.size();
      for (; begin < end; ++begin) {
        if (is_on_border(out[begin])) continue;
        mesh_.for_each_outgoing(out[begin], [&](Index h) {
          if (!is_on_border(mesh_.target(h)) && ssize(out) < 2 * most_candidates) list(mesh_.target(h));
        });
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  bool may_move(Index v, Index by) const {
    const Index after = moved_[v] + by;
    if (!is_on_border(v)) return std::abs(after) <= most_curvature;
    return at_border_[v] - after >= 1 && at_border_[v] - after <= widest;
  }

  // one^T other, some columns at a time.
  static Eigen::MatrixXd product(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
    constexpr Eigen::Index block = 64;
    Eigen::MatrixXd out(one.cols(), other.cols());
    for (Eigen::Index first = 0, width = 0; first < other.cols(); first += width) {
      const Eigen::Index left = other.cols() - first;
      width = left < 2 * block ? left : block;
      out.middleCols(first, width).noalias() = one.transpose() * other.middleCols(first, width);
      checkpoint(static_cast<double>(one.rows() * one.cols() * width));
    }
    return out;
  }

  // Adds missing curvature to candidates, and moves it from one to another, as long as that lowers the variance.
  bool choose(const Array<Index>& candidates) {
    const Eigen::Index count = ssize(candidates);
    Eigen::MatrixXd impulses = Eigen::MatrixXd::Zero(mesh_.vertex_count(), count);
    for (Eigen::Index c = 0; c < count; ++c) {
      impulses.col(c) = -geometry_.vertex_area / geometry_.total_area;
      impulses(candidates[c], c) += 1;
    }
    const Eigen::MatrixXd responses = quarter * centered(solver_->solve(impulses));
    const Eigen::MatrixXd weighted = geometry_.vertex_area.asDiagonal() * responses;
    const Eigen::MatrixXd form = product(responses, weighted);
    Eigen::VectorXd slope = weighted.transpose() * rest_;
    const auto move = [&](Eigen::Index c, Index by) {
      moved_[candidates[c]] += by;
      slope += by * form.col(c);
      rest_ += by * responses.col(c);
    };
    const Index unit = missing_ > 0 ? 1 : -1;
    for (; missing_ != 0; missing_ -= unit) {
      Eigen::Index best = -1;
      double least = std::numeric_limits<double>::infinity();
      for (Eigen::Index c = 0; c < count; ++c) {
        const double change = 2 * unit * slope[c] + form(c, c);
        if (change < least && may_move(candidates[c], unit)) {
          least = change;
          best = c;
        }
      }
      if (best < 0) return false;
      move(best, unit);
    }
    exchange(candidates, form, slope, move);
    return true;
  }

  template <typename Move>
  void exchange(const Array<Index>& candidates, const Eigen::MatrixXd& form, const Eigen::VectorXd& slope,
                const Move& move) {
    constexpr double least_gain = 1e-9;  // of the area
    const Eigen::Index count = ssize(candidates);
    for (Eigen::Index round = 0; round < count; ++round) {
      checkpoint(static_cast<double>(count * count));
      double least = -least_gain * geometry_.total_area;
      Eigen::Index from = -1, to = -1;
      Index by = 0;
      for (Eigen::Index a = 0; a < count; ++a) {
        const Index has = moved_[candidates[a]];
        if (has == 0) continue;
        const Index unit = has > 0 ? 1 : -1;
        for (Eigen::Index b = 0; b < count; ++b) {
          if (a == b || !may_move(candidates[b], unit)) continue;
          const double change = 2 * unit * (slope[b] - slope[a]) + form(a, a) + form(b, b) - 2 * form(a, b);
          if (change < least) {
            least = change;
            from = a;
            to = b;
            by = unit;
          }
        }
      }
      if (from < 0) return;
      move(from, -by);
      move(to, by);
    }
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const PerVertex<Index> at_border_;
  PerVertex<Index> moved_;  // curvature in cones, and added at the boundary, in quarter turns
  std::unique_ptr<LaplaceSolver> solver_;
  Index missing_ = 0;  // quarter turns that are in no cone yet
  Eigen::VectorXd rest_;
};

}  // namespace

std::optional<PatchAngles> round_patch(const MetricMesh& patch) {
  const HalfedgeMesh& mesh = patch.mesh;
  const Eigen::VectorXd defect = defects_in_space(patch);
  PerVertex<Index> at_border(mesh.vertex_count(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.loop_of_vertex[v] == none) continue;
    const double angle = M_PI - defect[v];
    at_border[v] = std::clamp(static_cast<Index>(std::lround(angle / quarter)), Index(1), widest);
  }
  PatchRounding rounding(patch, std::move(at_border));
  if (!rounding.place()) return std::nullopt;
  return rounding.angles();
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/straight_sides.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lsgp {

namespace {

constexpr double degree = M_PI / 180;
constexpr double corner = 20 * degree;                  // the least turning at a corner
constexpr double most_turned = 10 * degree;             // edges of a side
constexpr double smooth_joint = 1 * degree;             // between edges of one line where a boundary has arcs
constexpr double most_bend_beside_arcs = 0.5 * degree;  // of such a line
constexpr double least_side = 0.004;                    // of a boundary: anything shorter is not a feature
constexpr double least_side_beside_arcs = 0.1;
constexpr double telling = 0.25;         // share of the boundaries from which straight sides and axes count
constexpr double kept_bend = 0.7;        // of the largest: sides that bend more are released
constexpr double exact_rotation = 1e-9;  // radians

bool is_quarter_turn(double rotation) { return std::abs(std::remainder(rotation, M_PI / 2)) < exact_rotation; }

// Halfedges around the opened surface, each loop starting at the lowest.
Array<Array<Index>> open_boundaries(const HalfedgeMesh& mesh, const CutMesh& cut_mesh) {
  Array<Array<Index>> out;
  PerHalfedge<char> is_listed(mesh.halfedge_count(), 0);
  for (Index first = 0; first < mesh.halfedge_count(); ++first) {
    if (is_listed[first] || !is_open(mesh, cut_mesh, first)) continue;
    out.emplace_back();
    for (Index h = first; !is_listed[h];) {
      is_listed[h] = 1;
      out.back().push_back(h);
      h = next(h);
      while (!is_open(mesh, cut_mesh, h)) h = next(mesh.twin[h]);
    }
  }
  return out;
}

Complex unit(Complex direction) { return direction / std::abs(direction); }

// Part of a boundary loop; the loop is closed, and a run may pass its end.
struct Run {
  std::size_t begin, count;
};

class BoundaryLoop {
 public:
  BoundaryLoop(const Array<Index>& halfedges, const CutMesh& cut_mesh, const Eigen::VectorXcd& position)
      : halfedges_(halfedges) {
    for (const Index h : halfedges) {
      edge_.push_back(position[cut_mesh.copy_of_corner[next(h)]] - position[cut_mesh.copy_of_corner[h]]);
      length_ += std::abs(edge_.back());
    }
  }

  // Maximal runs, in order, between joints that turn by at least `turn`; `whole` if there are no such joints.
  Array<Run> runs(const Run& whole, bool is_closed, double turn) const {
    Array<std::size_t> begins;
    for (std::size_t i = is_closed ? 0 : 1; i < whole.count; ++i) {
      if (std::abs(turning(whole.begin + i)) >= turn) begins.push_back(i);
    }
    if (begins.empty()) return {whole};
    Array<Run> out;
    if (!is_closed) out.push_back({whole.begin, begins.front()});
    for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
      out.push_back({whole.begin + begins[k], begins[k + 1] - begins[k]});
    }
    const std::size_t last = begins.back();
    out.push_back({whole.begin + last, whole.count - last + (is_closed ? begins.front() : 0)});
    return out;
  }

  Complex chord(const Run& run) const {
    Complex sum = 0;
    for (std::size_t i = 0; i < run.count; ++i) sum += edge(run.begin + i);
    return sum;
  }

  // The deviation of a run from a direction, radians: the angle of its chord, plus that at the ends of an arc with the
  // same sag. Short edges may deviate more.
  double bend(const Run& run, Complex direction) const {
    const Complex end = chord(run) / direction;
    double sag = 0;
    Complex at = 0;
    for (std::size_t i = 0; i < run.count; ++i) {
      at += edge(run.begin + i) / direction;
      sag = std::max(sag, std::abs(std::imag(at * std::conj(end))));
    }
    return std::abs(std::arg(end)) + 4 * sag / std::norm(end);
  }

  // Runs that bend by less than most_bend: from corner to corner, or lines between arcs.
  Array<Run> straight_runs(double most_bend) const {
    Array<Run> out;
    const Run whole{0, edge_.size()};
    const auto is_side = [&](const Run& run, double most, double least) {
      const Complex along = chord(run);
      return std::abs(along) > least * length_ && runs_on(run) && bend(run, unit(along)) < most;
    };
    for (const Run& side : runs(whole, true, corner)) {
      if (is_side(side, most_bend, least_side)) {
        out.push_back(side);
        continue;
      }
      const bool is_closed = side.count == whole.count && std::abs(turning(side.begin)) < corner;
      for (const Run& line : runs(side, is_closed, smooth_joint)) {
        if (is_side(line, most_bend_beside_arcs, least_side_beside_arcs)) out.push_back(line);
      }
    }
    return out;
  }

  double length() const { return length_; }
  Index halfedge(std::size_t i) const { return halfedges_[i % halfedges_.size()]; }

 private:
  // Whether all edges have about the direction of the chord.
  bool runs_on(const Run& run) const {
    const Complex along = std::conj(chord(run));
    for (std::size_t i = 0; i < run.count; ++i) {
      if (!(std::abs(std::arg(edge(run.begin + i) * along)) < most_turned)) return false;
    }
    return true;
  }

  Complex edge(std::size_t i) const { return edge_[i % edge_.size()]; }
  // From the previous edge to this one, radians.
  double turning(std::size_t i) const { return std::arg(edge(i) * std::conj(edge(i + edge_.size() - 1))); }

  const Array<Index>& halfedges_;
  Array<Complex> edge_;
  double length_ = 0;
};

// Angle to the nearest axis, radians.
double off_axis(Complex direction) { return std::remainder(std::arg(direction), M_PI / 2); }

struct FoundSide {
  const BoundaryLoop* loop;
  Run run;
  Complex chord;
};

// The rotation that aligns the greatest length of sides with the axes: by the mean direction of the sides within a
// window of 2 most_bend, modulo quarter turns.
Complex turn_to_axes(const Array<FoundSide>& sides, double most_bend) {
  Array<std::pair<double, double>> directions;  // angle to the axis, and length; repeated a quarter turn on
  for (const FoundSide& side : sides) directions.emplace_back(off_axis(side.chord), std::abs(side.chord));
  std::sort(directions.begin(), directions.end());
  const std::size_t count = directions.size();
  for (std::size_t i = 0; i < count; ++i) directions.emplace_back(directions[i].first + M_PI / 2, directions[i].second);
  double most = 0, best = 0, length = 0, sum = 0;
  for (std::size_t first = 0, end = 0; first < count; ++first) {
    for (; end < first + count && directions[end].first - directions[first].first < 2 * most_bend; ++end) {
      length += directions[end].second;
      sum += directions[end].second * directions[end].first;
    }
    if (length > most * (1 + 1e-9)) {
      most = length;
      best = sum / length;
    }
    length -= directions[first].second;
    sum -= directions[first].second * directions[first].first;
  }
  return std::polar(1.0, -best);
}

Complex nearest_axis(Complex direction) {
  if (std::abs(direction.real()) > std::abs(direction.imag())) return direction.real() > 0 ? 1 : -1;
  return {0, direction.imag() > 0 ? 1.0 : -1.0};
}

// Moves the sides that are along the axes after `turn` to the end; their begin.
Array<FoundSide>::iterator along_axes_of(Complex turn, double most_bend, Array<FoundSide>& sides) {
  return std::stable_partition(sides.begin(), sides.end(), [&](const FoundSide& side) {
    return !(std::abs(off_axis(side.chord * turn)) < most_bend);
  });
}

}  // namespace

bool StraightSides::is_bent() const {
  constexpr double rounding = 1e-9;
  return std::any_of(sides.begin(), sides.end(), [](const StraightSide& side) { return side.bend > rounding; });
}

StraightSides find_straight_sides(const CutSurface& surface, const Eigen::VectorXd& rotation,
                                  const Eigen::VectorXcd& position, double most_bend) {
  const auto& [mesh, geometry, cut_graph, cut_mesh, factor, frame_tree] = surface;
  const auto may_be_straight = [&, &cut_graph = cut_graph](Index h) {
    return cut_graph.cut_of[h] == none || is_quarter_turn(rotation[cut_graph.cut_of[h]]);
  };
  StraightSides out;
  const Array<Array<Index>> borders = open_boundaries(mesh, cut_mesh);
  Array<BoundaryLoop> measured;
  for (const Array<Index>& border : borders) measured.emplace_back(border, cut_mesh, position);
  Array<FoundSide> found;
  double length = 0, straight_length = 0, along_axes = 0;
  for (const BoundaryLoop& loop : measured) {
    length += loop.length();
    for (const Run& run : loop.straight_runs(most_bend)) {
      found.push_back({&loop, run, loop.chord(run)});
      straight_length += std::abs(found.back().chord);
    }
  }
  if (straight_length < telling * length) return out;
  out.turn = turn_to_axes(found, most_bend);
  // First the sides along the axes of the layout, then those along other axes, at right angles to each other.
  for (Complex turn = out.turn; !found.empty(); turn = turn_to_axes(found, most_bend)) {
    const bool is_first = turn == out.turn;
    const auto along = along_axes_of(turn, most_bend, found);
    if (along == found.end()) break;
    const bool is_alone = std::next(along) == found.end() && along->run.count == 1;  // already straight
    for (auto side = along; side != found.end(); ++side) {
      if (is_first) along_axes += std::abs(side->chord);
      const Complex axis = nearest_axis(side->chord * turn);
      const Complex direction = is_first ? axis : axis * std::conj(turn) * out.turn;
      StraightSide straight{{}, direction, side->loop->bend(side->run, direction * std::conj(out.turn))};
      for (std::size_t k = 0; k < side->run.count; ++k) {
        const Index h = side->loop->halfedge(side->run.begin + k);
        if (may_be_straight(h)) straight.halfedges.push_back(h);
      }
      if (!is_alone && !straight.halfedges.empty()) out.sides.push_back(std::move(straight));
    }
    found.erase(along, found.end());
  }
  out.has_axes = along_axes > telling * length;
  return out;
}

void release_bent_sides(StraightSides& straight) {
  double most = 0;
  for (const StraightSide& side : straight.sides) most = std::max(most, side.bend);
  const auto is_bent = [&](const StraightSide& side) { return side.bend > kept_bend * most; };
  straight.sides.erase(std::remove_if(straight.sides.begin(), straight.sides.end(), is_bent), straight.sides.end());
}

}  // namespace lsgp

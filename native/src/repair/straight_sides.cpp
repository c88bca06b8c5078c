// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/straight_sides.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "creases/features.hpp"

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

// Halfedges along the sharp edges inside the opened surface, one of each edge, from junction to junction; the first
// `open` of them are not closed.
struct Creases {
  Array<Array<Index>> lines;
  std::size_t open;
};

class CreaseTracer {
 public:
  CreaseTracer(const HalfedgeMesh& mesh, const CutMesh& cut_mesh)
      : mesh_(mesh), cut_mesh_(cut_mesh), is_left_(mesh.halfedge_count(), 0) {
    for (Index h = 0; h < mesh.halfedge_count(); ++h)
      is_left_[h] = !is_open(mesh, cut_mesh, h) && bend_at(mesh, h) >= crease_angle;
  }

  Creases trace() {
    const PerHalfedge<char> is_crease = is_left_;
    Creases out{};
    for (const bool is_closed : {false, true}) {
      for (Index first = 0; first < mesh_.halfedge_count(); ++first) {
        if (is_left_[first] && (is_closed || following(is_crease, mesh_.twin[first]) == none)) {
          out.lines.push_back(trace(is_crease, first));
        }
      }
      if (!is_closed) out.open = out.lines.size();
    }
    return out;
  }

 private:
  Array<Index> trace(const PerHalfedge<char>& is_crease, Index first) {
    Array<Index> line;
    for (Index h = first; h != none && is_left_[h]; h = following(is_crease, h)) {
      is_left_[h] = is_left_[mesh_.twin[h]] = 0;
      line.push_back(h);
    }
    return line;
  }

  // The only other crease at the target of h, in the same copy; none if there is none or more.
  Index following(const PerHalfedge<char>& is_crease, Index h) const {
    Index found = none;
    int count = 0;
    mesh_.for_each_outgoing(mesh_.target(h), [&](Index g) {
      if (!is_crease[g] || g == mesh_.twin[h]) return;
      found = g;
      ++count;
    });
    const auto copy = [&](Index corner) { return cut_mesh_.copy_of_corner[corner]; };
    return count == 1 && copy(found) == copy(next(h)) ? found : none;
  }

  const HalfedgeMesh& mesh_;
  const CutMesh& cut_mesh_;
  PerHalfedge<char> is_left_;  // creases that are not traced
};

Complex unit(Complex direction) { return direction / std::abs(direction); }

// A section of a polyline; if that is closed, a run may pass its end.
struct Run {
  std::size_t begin, count;
};

// A boundary loop, which is closed, or a line of creases inside.
class Polyline {
 public:
  Polyline(const Array<Index>& halfedges, bool is_closed, const CutMesh& cut_mesh, const Eigen::VectorXcd& position)
      : halfedges_(halfedges), is_closed_(is_closed) {
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

  // Runs that bend by less than most_bend: from corner to corner, or lines between arcs.  whole_length: of what they
  // are to be a considerable part of.
  Array<Run> straight_runs(double most_bend, double whole_length) const {
    Array<Run> out;
    const Run whole{0, edge_.size()};
    const auto is_side = [&](const Run& run, double most, double least) {
      const Complex along = chord(run);
      return std::abs(along) > least * whole_length && runs_on(run) && bend(run, unit(along)) < most;
    };
    for (const Run& side : runs(whole, is_closed_, corner)) {
      if (is_side(side, most_bend, least_side)) {
        out.push_back(side);
        continue;
      }
      const bool is_closed = is_closed_ && side.count == whole.count && std::abs(turning(side.begin)) < corner;
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
  const bool is_closed_;
  Array<Complex> edge_;
  double length_ = 0;
};

// Angle to the nearest axis, radians.
double off_axis(Complex direction) { return std::remainder(std::arg(direction), M_PI / 2); }

struct FoundSide {
  const Polyline* line;
  Run run;
  Complex chord;
  bool is_border;
};

// The rotation that aligns the greatest length of chords with the axes: by the mean direction of those within a window
// of 2 most_bend, modulo quarter turns.
Complex turn_to_axes(const Array<Complex>& chords, double most_bend) {
  Array<std::pair<double, double>> directions;  // angle to the axis, and length; repeated a quarter turn on
  for (const Complex chord : chords) directions.emplace_back(off_axis(chord), std::abs(chord));
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

Array<Complex> chords_of(const Array<FoundSide>& sides) {
  Array<Complex> out;
  for (const FoundSide& side : sides) out.push_back(side.chord);
  return out;
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

bool is_marked(const HalfedgeMesh& mesh, Index h) { return mesh.has_features() && mesh.feature[h]; }

// The marked features, aligned with the axes, as sides of one direction each, and the reasons of those that cannot be.
void add_marked_sides(const CutSurface& surface, const Eigen::VectorXd& rotation, const Eigen::VectorXcd& position,
                      LineReading reading, StraightSides& out) {
  const HalfedgeMesh& mesh = surface.mesh;
  PerHalfedge<char> feature(mesh.halfedge_count(), no_feature);
  PerVertex<char> ends(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index cut = surface.cut_graph.cut_of[h];
    const bool is_turned = cut != none && !is_quarter_turn(rotation[cut]);
    if (is_turned) ends[mesh.origin(h)] = ends[mesh.target(h)] = 1;
    if (mesh.feature[h] && !is_turned) feature[h] = marked_feature;
  }
  out.reasons.assign(mesh.halfedge_count(), ReleaseReason::contradiction);
  if (std::count(feature.begin(), feature.end(), no_feature) == ssize(feature)) return;
  out.turn = turn_to_features(surface, feature, position);
  const FeatureLines lines = trace_features(surface, feature, ends, out.turn * position, reading);
  for (const Index h : lines.curved) out.reasons[h] = ReleaseReason::curved;
  for (const FeatureLine& line : lines.straight) {
    for (Index i = 0; i < ssize(line.halfedges); ++i) {
      const Index h = line.halfedges[i];
      if (i == 0 || line.directions[i] != out.sides.back().direction) {
        out.sides.push_back({{}, line.directions[i], line.bend, 0, !is_open(mesh, surface.cut_mesh, h), true});
      }
      out.sides.back().halfedges.push_back(h);
      out.sides.back().length += surface.geometry.length[h];
    }
  }
  out.has_axes = !out.sides.empty();
}

}  // namespace

StraightSides find_straight_sides(const CutSurface& surface, const Eigen::VectorXd& rotation,
                                  const Eigen::VectorXcd& position, const SideLimits& limits) {
  const HalfedgeMesh& mesh = surface.mesh;
  const CutGraph& cut_graph = surface.cut_graph;
  const CutMesh& cut_mesh = surface.cut_mesh;
  const auto [most_bend, with_creases, only_marked, reading] = limits;
  const auto may_be_straight = [&, &cut_graph = cut_graph](Index h) {
    return !is_marked(mesh, h) && (cut_graph.cut_of[h] == none || is_quarter_turn(rotation[cut_graph.cut_of[h]]));
  };
  StraightSides out;
  if (mesh.has_features()) add_marked_sides(surface, rotation, position, reading, out);
  const bool has_marked = !out.sides.empty();
  if (only_marked) return out;
  const Array<Array<Index>> borders = open_boundaries(mesh, cut_mesh);
  Array<Polyline> loops;
  for (const Array<Index>& border : borders) loops.emplace_back(border, true, cut_mesh, position);
  Array<FoundSide> found;
  double length = 0, straight_length = 0, along_axes = 0;
  for (const Polyline& loop : loops) {
    length += loop.length();
    for (const Run& run : loop.straight_runs(most_bend, loop.length())) {
      found.push_back({&loop, run, loop.chord(run), true});
    }
  }
  for (const FoundSide& side : found) straight_length += std::abs(side.chord);
  if (straight_length < telling * length) return out;
  const Creases creases = with_creases ? CreaseTracer(mesh, cut_mesh).trace() : Creases{};
  Array<Polyline> inside;
  for (std::size_t i = 0; i < creases.lines.size(); ++i) {
    inside.emplace_back(creases.lines[i], i >= creases.open, cut_mesh, position);
  }
  for (const Polyline& crease : inside) {
    for (const Run& run : crease.straight_runs(most_bend, length)) {
      found.push_back({&crease, run, crease.chord(run), false});
    }
  }
  if (!has_marked) out.turn = turn_to_axes(chords_of(found), most_bend);
  // First the sides along the axes of the layout, then those along other axes, at right angles to each other.
  for (Complex turn = out.turn; !found.empty(); turn = turn_to_axes(chords_of(found), most_bend)) {
    const bool is_first = turn == out.turn;
    const auto along = along_axes_of(turn, most_bend, found);
    if (along == found.end() && is_first && has_marked) continue;  // which determine this turn
    if (along == found.end()) break;
    const bool is_alone = std::next(along) == found.end() && along->run.count == 1;  // already straight
    for (auto side = along; side != found.end(); ++side) {
      if (is_first && side->is_border) along_axes += std::abs(side->chord);
      const Complex axis = nearest_axis(side->chord * turn);
      const Complex direction = is_first ? axis : axis * std::conj(turn) * out.turn;
      StraightSide straight{{},
                            direction,
                            side->line->bend(side->run, direction * std::conj(out.turn)),
                            std::abs(side->chord),
                            !side->is_border};
      for (std::size_t k = 0; k < side->run.count; ++k) {
        const Index h = side->line->halfedge(side->run.begin + k);
        if (may_be_straight(h)) straight.halfedges.push_back(h);
      }
      if (!is_alone && !straight.halfedges.empty()) out.sides.push_back(std::move(straight));
    }
    found.erase(along, found.end());
  }
  out.has_axes = has_marked || along_axes > telling * length;
  return out;
}

Array<std::optional<Complex>> turns_to_axes(const HalfedgeMesh& mesh, const CutMesh& cut_mesh,
                                            const Eigen::VectorXcd& position, const PerTriangle<Index>& island) {
  constexpr double exactly = 1e-9;  // radians
  Array<Array<Complex>> boundaries;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!is_open(mesh, cut_mesh, h)) continue;
    if (island[h / 3] >= ssize(boundaries)) boundaries.resize(island[h / 3] + 1);
    boundaries[island[h / 3]].push_back(position[cut_mesh.copy_of_corner[next(h)]] -
                                        position[cut_mesh.copy_of_corner[h]]);
  }
  Array<std::optional<Complex>> out(*std::max_element(island.begin(), island.end()) + 1);
  for (Index i = 0; i < ssize(boundaries); ++i) {
    const Complex turn = turn_to_axes(boundaries[i], exactly);
    double length = 0, along = 0;
    for (const Complex edge : boundaries[i]) {
      length += std::abs(edge);
      if (std::abs(off_axis(edge * turn)) < exactly) along += std::abs(edge);
    }
    if (along > telling * length) out[i] = std::abs(std::arg(turn)) < exactly ? 1.0 : turn;
  }
  return out;
}

SideOrder sort_by_cost(StraightSides& straight) {
  const auto rank = [](const StraightSide& side) {
    return std::tuple(!side.is_marked, side.is_marked && side.is_bent(), side.is_inside && !side.is_marked,
                      side.bend * side.bend * side.length);
  };
  std::stable_sort(straight.sides.begin(), straight.sides.end(),
                   [&](const StraightSide& a, const StraightSide& b) { return rank(a) < rank(b); });
  SideOrder out{0, 0, 0};
  for (const StraightSide& side : straight.sides) {
    out.straight += side.is_marked && !side.is_bent();
    out.marked += side.is_marked;
    out.border += side.is_marked || !side.is_inside;
  }
  return out;
}

}  // namespace lsgp

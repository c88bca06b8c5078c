// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/feature_lines.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "base/checkpoint.hpp"
#include "creases/features.hpp"

namespace lsgp {

namespace {

// The angle that more than half of the length has exactly; 0 if it is that but for rounding.
std::optional<double> majority(Array<std::pair<double, double>> angle_and_length) {
  constexpr double exactly = 1e-9;  // radians
  std::sort(angle_and_length.begin(), angle_and_length.end());
  double all = 0, same = 0;
  for (const auto& [angle, length] : angle_and_length) all += length;
  for (std::size_t first = 0, end = 0; first < angle_and_length.size(); ++first) {
    const double angle = angle_and_length[first].first;
    for (; end < angle_and_length.size() && angle_and_length[end].first < angle + exactly; ++end) {
      same += angle_and_length[end].second;
    }
    if (same > all / 2) return std::abs(angle) < exactly ? 0 : angle;
    same -= angle_and_length[first].second;
  }
  return std::nullopt;
}

double nearest_quarter_turn(double angle) { return std::round(angle / (M_PI / 2)) * (M_PI / 2); }

class FeatureTracer {
 public:
  FeatureTracer(const CutSurface& surface, const PerHalfedge<char>& feature, const PerVertex<char>& ends,
                const Eigen::VectorXcd& position, LineReading reading)
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        cut_mesh_(surface.cut_mesh),
        feature_(feature),
        ends_(ends),
        position_(position),
        ends_at_junctions_(reading == LineReading::divided && surface.mesh.has_features()),
        are_whole_(reading == LineReading::whole),
        is_traced_(surface.mesh.halfedge_count(), 0) {}

  FeatureLines trace() {
    FeatureLines out;
    for (const bool may_be_closed : {false, true}) {
      for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
        if (!feature_[h] || is_traced_[h] || !(may_be_closed || begins_at(h))) continue;
        add_with_axes(trace_from(h), out);
      }
    }
    return out;
  }

 private:
  static constexpr double line_corner = M_PI / 4;         // the least turning at a corner of a line
  static constexpr double junction_corner = M_PI / 9;     // the same at a junction
  static constexpr double most_off_axis = M_PI * 5 / 18;  // of an edge from the axis of its line
  static constexpr double least_diagonal = 0.6;           // of a line between both axes

  Complex edge(Index h) const {
    return position_[cut_mesh_.copy_of_corner[next(h)]] - position_[cut_mesh_.copy_of_corner[h]];
  }

  bool is_border(Index h) const { return mesh_.twin[h] == none; }

  // The only other feature edge at the target of h, of the same kind, and on the border as well if h is; none if there
  // is none or more, or if lines end there.
  Index following(Index h) const {
    const Index v = mesh_.target(h);
    if (ends_[v] || (mesh_.loop_of_vertex[v] != none && !is_border(h))) return none;
    Index found = is_border(h) && feature_[mesh_.outgoing[v]] ? mesh_.outgoing[v] : none;
    int count = found == none ? 0 : 1;
    mesh_.for_each_outgoing(v, [&](Index g) {
      if (!feature_[g] || g == mesh_.twin[h] || g == found) return;
      found = g;
      ++count;
    });
    if (count != 1 || feature_[found] != feature_[h] || is_border(found) != is_border(h)) return none;
    const bool is_junction = ends_at_junctions_ && mesh_.is_feature_junction[v];
    return std::abs(turning(h, found)) < (is_junction ? junction_corner : line_corner) ? found : none;
  }

  // From h to the feature edge g at its target, in the layout, to the left; 0 for a straight line.
  double turning(Index h, Index g) const {
    double on_left = 0;
    for (Index at = next(h);; at = next(mesh_.twin[at])) {
      on_left += std::arg(-edge(prev(at)) / edge(at));
      if (at == g) break;
    }
    return M_PI - on_left;
  }

  // The border's halfedge before h.
  Index before_on_border(Index h) const {
    while (!is_border(prev(h))) h = mesh_.rotate(h);
    return prev(h);
  }

  bool begins_at(Index h) const {
    if (!is_border(h)) return following(mesh_.twin[h]) == none;
    const Index before = before_on_border(h);
    return !feature_[before] || following(before) != h;
  }

  FeatureLine trace_from(Index first) {
    FeatureLine out;
    out.is_marked = feature_[first] == marked_feature;
    for (Index h = first; h != none && !is_traced_[h]; h = following(h)) {
      is_traced_[h] = 1;
      if (!is_border(h)) is_traced_[mesh_.twin[h]] = 1;
      out.halfedges.push_back(h);
      out.length += geometry_.length[h];
    }
    return out;
  }

  // Adds a line whose edges are near the same axis, or the parts of one that turns away from it. A line between both
  // axes would shear what is around it along either.
  void add_with_axes(const FeatureLine& line, FeatureLines& out) const {
    const Array<double> angle = angles_along(line);
    const Array<double> axis = axes_along(line, angle);
    const std::size_t first = out.straight.size();
    for (Index begin = 0, end = 0; begin < ssize(angle); begin = end) {
      while (end < ssize(angle) && axis[end] == axis[begin]) ++end;
      FeatureLine part{{}, {}, 0, 0, line.is_marked};
      double squares = 0;
      for (Index i = begin; i < end; ++i) {
        const Index h = line.halfedges[i];
        const double off = angle[i] - axis[i];
        const Complex direction = std::polar(1.0, std::arg(edge(h)) - off);
        part.halfedges.push_back(h);
        part.directions.emplace_back(std::round(direction.real()), std::round(direction.imag()));
        part.length += geometry_.length[h];
        squares += geometry_.length[h] * off * off;
      }
      part.bend = std::sqrt(squares / part.length);
      out.straight.push_back(std::move(part));
    }
    if (out.straight.size() == first + 1 && out.straight.back().bend <= least_diagonal) return;
    out.curved.insert(out.curved.end(), line.halfedges.begin(), line.halfedges.end());
    for (std::size_t i = first; i < out.straight.size(); ++i) out.straight[i].comes_last = true;
  }

  // The angles of edges, counted without the quarter turns of cuts.
  Array<double> angles_along(const FeatureLine& line) const {
    Array<double> out;
    for (Index i = 0; i < ssize(line.halfedges); ++i) {
      const Index h = line.halfedges[i];
      out.push_back(i == 0 ? std::arg(edge(h)) : out.back() + turning(line.halfedges[i - 1], h));
    }
    return out;
  }

  // The axis of each edge, as an angle: that of all edges if they are near it. Otherwise an edge far from the axis of
  // those before it is at the end of a bend, and the line has a corner in the middle of the bend.
  Array<double> axes_along(const FeatureLine& line, const Array<double>& angle) const {
    double mean = 0;
    for (Index i = 0; i < ssize(angle); ++i) mean += geometry_.length[line.halfedges[i]] * angle[i] / line.length;
    const auto is_near = [](double of, double axis) { return std::abs(of - axis) < most_off_axis; };
    const double common = nearest_quarter_turn(mean);
    Array<double> out(ssize(angle), common);
    if (are_whole_ || std::all_of(angle.begin(), angle.end(), [&](double each) { return is_near(each, common); }))
      return out;
    out[0] = nearest_quarter_turn(angle[0]);
    for (Index i = 1; i < ssize(angle); ++i) {
      out[i] = is_near(angle[i], out[i - 1]) ? out[i - 1] : nearest_quarter_turn(angle[i]);
      for (Index j = i; j > 0 && out[j] != out[j - 1] && nearest_quarter_turn(angle[j - 1]) == out[j]; --j) {
        out[j - 1] = out[j];
      }
    }
    return out;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const CutMesh& cut_mesh_;
  const PerHalfedge<char>& feature_;
  const PerVertex<char>& ends_;
  const Eigen::VectorXcd& position_;
  const bool ends_at_junctions_, are_whole_;
  PerHalfedge<char> is_traced_;
};

// Lines at a small angle to each other may be nearest to the same axis, which would leave what is between them no area.
// Turns those that bend least by it to the other axis, so that a quarter turn or more is left between lines that are
// beside each other at a vertex.
class CornerOpener {
 public:
  CornerOpener(const CutSurface& surface, const Eigen::VectorXcd& position, Array<FeatureLine>& lines)
      : mesh_(surface.mesh),
        cut_mesh_(surface.cut_mesh),
        position_(position),
        lines_(lines),
        line_of_(mesh_.halfedge_count(), none),
        off_(mesh_.halfedge_count(), 0),
        mean_off_(lines.size(), 0),
        turn_(lines.size(), 0),
        wedges_of_(lines.size()) {
    for (Index k = 0; k < ssize(lines_); ++k) list_edges(k, surface.geometry);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) list_wedges(v);
  }

  void open() {
    while (turn_one()) continue;  // each step leaves less to open
    for (Index k = 0; k < ssize(lines_); ++k) {
      if (turn_[k] == 0) continue;
      FeatureLine& line = lines_[k];
      line.bend = bend_after(k, turn_[k]);
      line.comes_last = true;
      for (Complex& direction : line.directions) direction *= Complex(0, turn_[k]);
    }
  }

 private:
  static constexpr double most_bend = 1.25;   // of a line that is turned, radians
  static constexpr double least_cost = 1e-3;  // of turning a line, relative to its length
  static constexpr double rounding = 1e-6;    // of quarter turns
  static constexpr double operations_a_wedge = 20;

  // Between lines that follow each other counterclockwise around a vertex.
  struct Wedge {
    Index right, left;
    int quarters;  // between the axes as they were
  };

  Complex edge(Index h) const {
    return position_[cut_mesh_.copy_of_corner[next(h)]] - position_[cut_mesh_.copy_of_corner[h]];
  }

  void list_edges(Index k, const Geometry& geometry) {
    const FeatureLine& line = lines_[k];
    for (Index i = 0; i < ssize(line.halfedges); ++i) {
      const Index h = line.halfedges[i];
      const double off = std::arg(edge(h) / line.directions[i]);
      mean_off_[k] += geometry.length[h] * off / line.length;
      for (const Index side : {h, mesh_.twin[h]}) {
        if (side == none) continue;
        line_of_[side] = k;
        off_[side] = off;
      }
    }
  }

  void list_wedges(Index v) {
    Index first = none, last = none;  // halfedges from v
    double between = 0, before_first = 0;
    const auto add = [&](Index right, Index left, double angle) {
      if (line_of_[right] == line_of_[left]) return;
      const double quarters = (angle + off_[right] - off_[left]) / (M_PI / 2);
      if (std::abs(quarters - std::round(quarters)) > rounding) return;  // across a cut that turns by other angles
      const Index wedge = static_cast<Index>(wedges_.size());
      wedges_.push_back({line_of_[right], line_of_[left], static_cast<int>(std::lround(quarters))});
      for (const Index k : {line_of_[right], line_of_[left]}) wedges_of_[k].push_back(wedge);
    };
    const auto pass = [&](Index h) {
      if (line_of_[h] == none) return;
      if (last == none) {
        first = h;
        before_first = between;
      } else {
        add(last, h, between);
      }
      last = h;
      between = 0;
    };
    Index last_side = none;  // of the boundary, toward v
    mesh_.for_each_outgoing(v, [&](Index h) {
      pass(h);
      between += std::arg(-edge(prev(h)) / edge(h));
      last_side = prev(h);
    });
    if (mesh_.loop_of_vertex[v] == none) {
      if (last != first) add(last, first, between + before_first);
    } else if (last != none && line_of_[last_side] != none) {
      add(last, last_side, between);
    }
  }

  double bend_after(Index k, int turn) const {
    const double by = turn * M_PI / 2;
    const double squares = lines_[k].bend * lines_[k].bend - 2 * by * mean_off_[k] + by * by;
    return std::sqrt(std::max(0.0, squares));
  }

  int lack(const Wedge& wedge) const {
    return std::max(0, 1 - (wedge.quarters + turn_[wedge.left] - turn_[wedge.right]));
  }

  // Turns the line that gains most for what it costs, if any does.
  bool turn_one() {
    checkpoint(operations_a_wedge * static_cast<double>(wedges_.size()));
    Index best = none;
    int best_by = 0;
    double most = 0;
    for (Index k = 0; k < ssize(lines_); ++k) {
      const int before = lack_around(k);
      if (before == 0) continue;
      for (const int by : {-1, 1}) {
        if (std::abs(turn_[k] + by) > 1) continue;
        const double bend = bend_after(k, turn_[k] + by), bend_before = bend_after(k, turn_[k]);
        if (bend > most_bend) continue;
        turn_[k] += by;
        const int gain = before - lack_around(k);
        turn_[k] -= by;
        if (gain <= 0) continue;
        const double cost = std::max(least_cost, bend * bend - bend_before * bend_before) * lines_[k].length;
        if (gain / cost <= most * (1 + 1e-9)) continue;
        most = gain / cost;
        best = k;
        best_by = by;
      }
    }
    if (best == none) return false;
    turn_[best] += best_by;
    return true;
  }

  int lack_around(Index k) const {
    int out = 0;
    for (const Index wedge : wedges_of_[k]) out += lack(wedges_[wedge]);
    return out;
  }

  const HalfedgeMesh& mesh_;
  const CutMesh& cut_mesh_;
  const Eigen::VectorXcd& position_;
  Array<FeatureLine>& lines_;
  PerHalfedge<Index> line_of_;
  PerHalfedge<double> off_;  // from its axis, radians
  Array<double> mean_off_;   // of lines
  Array<int> turn_;          // of lines, quarters
  Array<Array<Index>> wedges_of_;
  Array<Wedge> wedges_;
};

}  // namespace

Complex turn_to_features(const CutSurface& surface, const PerHalfedge<char>& feature, const Eigen::VectorXcd& position,
                         double least_common) {
  const char least = *std::max_element(feature.begin(), feature.end());
  Complex sum = 0;
  double length = 0;
  Array<std::pair<double, double>> directions;  // angle to an axis, and length
  for (Index h = 0; h < surface.mesh.halfedge_count(); ++h) {
    if (feature[h] == no_feature || feature[h] < least) continue;
    const Complex edge =
        position[surface.cut_mesh.copy_of_corner[next(h)]] - position[surface.cut_mesh.copy_of_corner[h]];
    sum += std::polar(surface.geometry.length[h], 4 * std::arg(edge));
    length += surface.geometry.length[h];
    directions.emplace_back(std::remainder(std::arg(edge), M_PI / 2), surface.geometry.length[h]);
  }
  if (const std::optional<double> angle = majority(std::move(directions))) return std::polar(1.0, -*angle);
  return std::abs(sum) > least_common * length ? std::polar(1.0, -std::arg(sum) / 4) : 1;
}

FeatureLines trace_features(const CutSurface& surface, const PerHalfedge<char>& feature, const PerVertex<char>& ends,
                            const Eigen::VectorXcd& position, LineReading reading) {
  FeatureLines out = FeatureTracer(surface, feature, ends, position, reading).trace();
  if (reading == LineReading::opened || reading == LineReading::divided)
    CornerOpener(surface, position, out.straight).open();
  const auto rank = [](const FeatureLine& line) {
    return std::tuple(!line.is_marked, line.comes_last, line.bend * line.bend * line.length);
  };
  std::stable_sort(out.straight.begin(), out.straight.end(),
                   [&](const FeatureLine& a, const FeatureLine& b) { return rank(a) < rank(b); });
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/feature_lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "creases/features.hpp"

namespace lsgp {

namespace {

class FeatureTracer {
 public:
  FeatureTracer(const CutSurface& surface, const PerHalfedge<char>& feature, const PerVertex<char>& ends,
                const Eigen::VectorXcd& position)
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        cut_mesh_(surface.cut_mesh),
        feature_(feature),
        ends_(ends),
        position_(position),
        is_traced_(surface.mesh.halfedge_count(), 0) {}

  FeatureLines trace() {
    FeatureLines out;
    for (const bool may_be_closed : {false, true}) {
      for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
        if (!feature_[h] || is_traced_[h] || !(may_be_closed || begins_at(h))) continue;
        FeatureLine line = trace_from(h);
        if (find_axis(line)) {
          out.straight.push_back(std::move(line));
        } else {
          out.curved.insert(out.curved.end(), line.halfedges.begin(), line.halfedges.end());
        }
      }
    }
    return out;
  }

 private:
  static constexpr double line_corner = M_PI / 4;         // the least turning at a corner of a line
  static constexpr double most_off_axis = M_PI * 5 / 18;  // of an edge from the axis of its line

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
    return std::abs(turning(h, found)) < line_corner ? found : none;
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

  // Whether all edges are near the same axis, counted without the quarter turns of cuts.
  bool find_axis(FeatureLine& line) const {
    Array<double> angle;
    double mean = 0;
    for (Index i = 0; i < ssize(line.halfedges); ++i) {
      const Index h = line.halfedges[i];
      angle.push_back(i == 0 ? std::arg(edge(h)) : angle.back() + turning(line.halfedges[i - 1], h));
      mean += geometry_.length[h] * angle.back() / line.length;
    }
    const double axis = std::round(mean / (M_PI / 2)) * (M_PI / 2);
    double squares = 0;
    for (Index i = 0; i < ssize(angle); ++i) {
      const double off = angle[i] - axis;
      if (!(std::abs(off) < most_off_axis)) return false;
      squares += geometry_.length[line.halfedges[i]] * off * off;
      const Complex direction = std::polar(1.0, std::arg(edge(line.halfedges[i])) - off);
      line.directions.emplace_back(std::round(direction.real()), std::round(direction.imag()));
    }
    line.bend = std::sqrt(squares / line.length);
    return true;
  }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const CutMesh& cut_mesh_;
  const PerHalfedge<char>& feature_;
  const PerVertex<char>& ends_;
  const Eigen::VectorXcd& position_;
  PerHalfedge<char> is_traced_;
};

}  // namespace

Complex turn_to_features(const CutSurface& surface, const PerHalfedge<char>& feature,
                         const Eigen::VectorXcd& position) {
  const char least = *std::max_element(feature.begin(), feature.end());
  Complex sum = 0;
  for (Index h = 0; h < surface.mesh.halfedge_count(); ++h) {
    if (feature[h] == no_feature || feature[h] < least) continue;
    const Complex edge =
        position[surface.cut_mesh.copy_of_corner[next(h)]] - position[surface.cut_mesh.copy_of_corner[h]];
    sum += std::polar(surface.geometry.length[h], 4 * std::arg(edge));
  }
  return std::polar(1.0, -std::arg(sum) / 4);
}

FeatureLines trace_features(const CutSurface& surface, const PerHalfedge<char>& feature, const PerVertex<char>& ends,
                            const Eigen::VectorXcd& position) {
  FeatureLines out = FeatureTracer(surface, feature, ends, position).trace();
  const auto rank = [](const FeatureLine& line) {
    return std::pair(!line.is_marked, line.bend * line.bend * line.length);
  };
  std::stable_sort(out.straight.begin(), out.straight.end(),
                   [&](const FeatureLine& a, const FeatureLine& b) { return rank(a) < rank(b); });
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/feature_lines.hpp"

#include <algorithm>
#include <cmath>

namespace lsgp {

namespace {

constexpr double degree = M_PI / 180;
constexpr double corner = 45 * degree;       // the least turning at a corner of a line
constexpr double most_turned = 50 * degree;  // of an edge from the axis of its line

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

  Array<FeatureLine> trace() {
    Array<FeatureLine> out;
    for (const bool may_be_closed : {false, true}) {
      for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
        if (!feature_[h] || is_traced_[h] || !(may_be_closed || begins_at(h))) continue;
        FeatureLine line = trace_from(h);
        if (!line.halfedges.empty()) out.push_back(std::move(line));
      }
    }
    return out;
  }

 private:
  Complex edge(Index h) const {
    return position_[cut_mesh_.copy_of_corner[next(h)]] - position_[cut_mesh_.copy_of_corner[h]];
  }

  // The only other feature edge at the target of h; none if there is none or more, or if lines end there.
  Index following(Index h) const {
    const Index v = mesh_.target(h);
    if (ends_[v] || mesh_.loop_of_vertex[v] != none) return none;
    Index found = none;
    int count = 0;
    mesh_.for_each_outgoing(v, [&](Index g) {
      if (!feature_[g] || g == mesh_.twin[h]) return;
      found = g;
      ++count;
    });
    return count == 1 && std::abs(turning(h, found)) < corner ? found : none;
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

  bool begins_at(Index h) const { return following(mesh_.twin[h]) == none; }

  // Empty if an edge would turn too far.
  FeatureLine trace_from(Index first) {
    FeatureLine out{{}, {}, 0, 0};
    Array<double> angle;  // of every edge, without the quarter turns of cuts
    for (Index h = first; h != none && !is_traced_[h]; h = following(h)) {
      const double to_next =
          out.halfedges.empty() ? std::arg(edge(h)) : angle.back() + turning(out.halfedges.back(), h);
      is_traced_[h] = is_traced_[mesh_.twin[h]] = 1;
      angle.push_back(to_next);
      out.halfedges.push_back(h);
      out.length += geometry_.length[h];
    }
    double mean = 0;
    for (Index i = 0; i < ssize(angle); ++i) mean += geometry_.length[out.halfedges[i]] * angle[i] / out.length;
    const double axis = std::round(mean / (M_PI / 2)) * (M_PI / 2);
    double squares = 0;
    for (Index i = 0; i < ssize(angle); ++i) {
      const double off = angle[i] - axis;
      if (!(std::abs(off) < most_turned)) return {{}, {}, 0, 0};
      squares += geometry_.length[out.halfedges[i]] * off * off;
      const Complex along = edge(out.halfedges[i]);
      const Complex direction = std::polar(1.0, std::arg(along) - off);
      out.directions.emplace_back(std::round(direction.real()), std::round(direction.imag()));
    }
    out.bend = std::sqrt(squares / out.length);
    return out;
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
  Complex sum = 0;
  for (Index h = 0; h < surface.mesh.halfedge_count(); ++h) {
    if (!feature[h]) continue;
    const Complex edge =
        position[surface.cut_mesh.copy_of_corner[next(h)]] - position[surface.cut_mesh.copy_of_corner[h]];
    sum += std::polar(surface.geometry.length[h], 4 * std::arg(edge));
  }
  return std::polar(1.0, -std::arg(sum) / 4);
}

Array<FeatureLine> trace_features(const CutSurface& surface, const PerHalfedge<char>& feature,
                                  const PerVertex<char>& ends, const Eigen::VectorXcd& position) {
  Array<FeatureLine> out = FeatureTracer(surface, feature, ends, position).trace();
  const auto cost = [](const FeatureLine& line) { return line.bend * line.bend * line.length; };
  std::stable_sort(out.begin(), out.end(),
                   [&](const FeatureLine& a, const FeatureLine& b) { return cost(a) < cost(b); });
  return out;
}

}  // namespace lsgp

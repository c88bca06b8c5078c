// SPDX-License-Identifier: GPL-3.0-or-later
#include "creases/opened_tube.hpp"

#include <algorithm>

#include "base/array.hpp"
#include "creases/face_quads.hpp"

namespace lsgp {

namespace {

class QuadPatch {
 public:
  explicit QuadPatch(const MetricMesh& surface)
      : mesh_(surface.mesh),
        geometry_(surface.geometry),
        quads_(find_quads(surface)),
        side_of_(surface.mesh.halfedge_count(), none) {
    for (Index q = 0; q < ssize(quads_); ++q) {
      for (int s = 0; s < 4; ++s) side_of_[element(quads_[q].side, s)] = 4 * q + s;
    }
  }

  bool consists_of_quads() const { return 2 * ssize(quads_) == mesh_.triangle_count(); }

  // The boundary from corner to corner, where one quad has two of its edges; none where there are no four corners.
  std::optional<std::array<Array<Index>, 4>> sides() const;

  // The girths of the rows from one side to the one opposite, if they are all, and both are at the same places.
  std::optional<std::array<double, 2>> girths(const Array<Index>& from, const Array<Index>& to) const;

 private:
  bool are_glued(const Array<Index>& from, const Array<Index>& to) const;
  Index following(Index h) const { return mesh_.outgoing[mesh_.target(h)]; }

  const HalfedgeMesh& mesh_;
  const Geometry& geometry_;
  const Array<Quad> quads_;
  PerHalfedge<Index> side_of_;  // 4 * quad + side, none of diagonals
};

std::optional<std::array<Array<Index>, 4>> QuadPatch::sides() const {
  const Index any = mesh_.outgoing[mesh_.boundary_loops.front().front()];
  const auto ends = [&](Index h) { return side_of_[h] / 4 == side_of_[following(h)] / 4; };
  Index first = any;
  while (!ends(first)) {
    first = following(first);
    if (first == any) return std::nullopt;
  }
  first = following(first);
  std::array<Array<Index>, 4> out;
  std::size_t side = 0;
  for (Index h = first;;) {
    if (side == out.size()) return std::nullopt;
    out[side].push_back(h);
    if (ends(h)) ++side;
    h = following(h);
    if (h == first) break;
  }
  if (side != out.size()) return std::nullopt;
  return out;
}

bool QuadPatch::are_glued(const Array<Index>& from, const Array<Index>& to) const {
  if (from.size() != to.size()) return false;
  const auto same = [&](Index v, Index w) { return mesh_.positions.row(v) == mesh_.positions.row(w); };
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Index here = from[i], there = to[to.size() - 1 - i];
    if (!same(mesh_.origin(here), mesh_.target(there)) || !same(mesh_.target(here), mesh_.origin(there))) return false;
  }
  return true;
}

std::optional<std::array<double, 2>> QuadPatch::girths(const Array<Index>& from, const Array<Index>& to) const {
  if (!are_glued(from, to)) return std::nullopt;
  std::optional<std::array<double, 2>> out;
  const auto add = [&](double girth) {
    if (!out) out = {girth, girth};
    (*out)[0] = std::min((*out)[0], girth);
    (*out)[1] = std::max((*out)[1], girth);
  };
  Index passed = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    double rims[] = {0, 0};
    Index at = side_of_[from[i]], last = none;
    while (at != none && passed < ssize(quads_)) {
      const Index q = at / 4;
      const int s = at % 4;
      ++passed;
      rims[0] += geometry_.length[element(quads_[q].side, (s + 1) % 4)];
      rims[1] += geometry_.length[element(quads_[q].side, (s + 3) % 4)];
      last = element(quads_[q].side, (s + 2) % 4);
      at = mesh_.twin[last] == none ? none : side_of_[mesh_.twin[last]];
    }
    if (last != to[to.size() - 1 - i]) return std::nullopt;
    for (const double girth : rims) add(girth);
  }
  return passed == ssize(quads_) ? out : std::nullopt;
}

}  // namespace

std::optional<std::array<double, 2>> girths_of_opened_tube(const MetricMesh& surface) {
  if (!surface.mesh.is_disk()) return std::nullopt;
  const QuadPatch patch(surface);
  if (!patch.consists_of_quads()) return std::nullopt;
  const auto sides = patch.sides();
  if (!sides) return std::nullopt;
  const auto across = patch.girths((*sides)[0], (*sides)[2]);
  return across ? across : patch.girths((*sides)[1], (*sides)[3]);
}

}  // namespace lsgp

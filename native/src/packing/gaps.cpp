// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/gaps.hpp"

#include <algorithm>
#include <cmath>

#include "plane/aabb_tree.hpp"
#include "plane/predicates.hpp"

namespace lsgp {

namespace {

struct Segments {
  Array<Complex> tail, head;
  Array<Index> owner;

  explicit Segments(const Array<Outline>& outlines) {
    for (Index i = 0; i < ssize(outlines); ++i) {
      outlines[i].for_each_segment([&](Complex a, Complex b) {
        tail.push_back(a);
        head.push_back(b);
        owner.push_back(i);
      });
    }
  }

  // Boxes are wider than the segments by `reach` on each side.
  AabbTree tree(double reach) const {
    Array<Box> boxes;
    for (std::size_t s = 0; s < owner.size(); ++s) {
      const auto [left, right] = std::minmax({tail[s].real(), head[s].real()});
      const auto [bottom, top] = std::minmax({tail[s].imag(), head[s].imag()});
      boxes.push_back({left - reach, right + reach, bottom - reach, top + reach});
    }
    return AabbTree(boxes);
  }
};

bool cross_each_other(Complex a, Complex b, Complex c, Complex d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < 0 && cross(d - c, a - c) * cross(d - c, b - c) < 0;
}

double distance(Complex a, Complex b, Complex c, Complex d) {
  return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b),
                   distance_to_segment(d, a, b)});
}

bool is_inside(Complex point, const Outline& outline) {
  int winding = 0;
  outline.for_each_segment([&](Complex a, Complex b) {
    if ((a.imag() <= point.imag()) == (b.imag() <= point.imag())) return;
    const int side = cross(b - a, point - a) > 0 ? 1 : -1;
    if (b.imag() > a.imag() && side > 0) ++winding;
    if (b.imag() < a.imag() && side < 0) --winding;
  });
  return winding != 0;
}

}  // namespace

std::pair<Index, Index> overlapping_pair(const Array<Outline>& outlines) {
  const Segments all(outlines);
  std::pair<Index, Index> found(-1, -1);
  all.tree(0).any_meeting_pair([&](Index i, Index j) {
    if (all.owner[i] == all.owner[j] || !cross_each_other(all.tail[i], all.head[i], all.tail[j], all.head[j]))
      return false;
    found = std::minmax(all.owner[i], all.owner[j]);
    return true;
  });
  if (found.first >= 0) return found;
  Array<Box> boxes;
  for (const Outline& outline : outlines) boxes.push_back(outline.box());
  AabbTree(boxes).any_meeting_pair([&](Index i, Index j) {
    const bool meets = (!outlines[i].is_empty() && is_inside(outlines[i].points()[0], outlines[j])) ||
                       (!outlines[j].is_empty() && is_inside(outlines[j].points()[0], outlines[i]));
    if (meets) found = {i, j};
    return meets;
  });
  return found;
}

bool keep_gap(const Array<Outline>& outlines, double gap) {
  const Segments all(outlines);
  return !all.tree(gap / 2).any_meeting_pair([&](Index i, Index j) {
    if (all.owner[i] == all.owner[j]) return false;
    const double found = distance(all.tail[i], all.head[i], all.tail[j], all.head[j]);
    return found < gap || found == 0;  // what touches another outline may lie on what it surrounds
  }) && overlapping_pair(outlines).first < 0;
}

bool are_apart(const Outline& one, const Outline& other, double gap) {
  bool is_near = false;
  one.for_each_segment([&](Complex a, Complex b) {
    const double left = std::min(a.real(), b.real()), right = std::max(a.real(), b.real());
    const double bottom = std::min(a.imag(), b.imag()), top = std::max(a.imag(), b.imag());
    other.for_each_segment([&](Complex c, Complex d) {
      const bool is_beyond = std::max(c.real(), d.real()) < left - gap || std::min(c.real(), d.real()) > right + gap ||
                             std::max(c.imag(), d.imag()) < bottom - gap || std::min(c.imag(), d.imag()) > top + gap;
      if (is_near || is_beyond) return;
      is_near = cross_each_other(a, b, c, d) || distance(a, b, c, d) < gap;
    });
  });
  return !is_near && (one.is_empty() || !is_inside(one.points()[0], other)) &&
         (other.is_empty() || !is_inside(other.points()[0], one));
}

}  // namespace lsgp

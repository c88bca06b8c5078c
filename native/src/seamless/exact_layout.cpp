// SPDX-License-Identifier: GPL-3.0-or-later
#include "seamless/exact_layout.hpp"

#include <algorithm>
#include <cmath>

#include "prescription/quantize_curvature.hpp"

namespace lsgp {

namespace {

constexpr Index least_per_flipped = 2;  // triangles: with fewer the layout has collapsed as a whole

// The spacing of binary fractions that float32 represents exactly over the layout's range, with a spare bit for later
// moves by whole cells.
double fraction_for(double largest) { return std::exp2(std::ceil(std::log2(largest + 1)) + 1 - 24); }

Complex round_to(Complex z, double fraction) {
  return {std::round(z.real() / fraction) * fraction, std::round(z.imag() / fraction) * fraction};
}

}  // namespace

ExactLayout::ExactLayout(const SeamlessComponent& component, const PointLattice& lattice, Complex shift,
                         Eigen::VectorXcd& position)
    : mesh_(component.source->mesh), map_(*component.map), lattice_(lattice), shift_(shift), position_(position) {
  for (std::size_t p = 0; p < map_.cut_graph.cuts.size(); ++p) {
    const int q = lattice.rotation_order();
    turns_.push_back((turns_of((*map_.rotation)[static_cast<Eigen::Index>(p)], q) % q + q) % q);
    const Sisters sisters = origin_sisters(mesh_, map_.cut_mesh, map_.cut_graph.cuts[p].halfedges.front());
    translations_.push_back(position[sisters.right] - lattice.unit(turns_.back()) * position[sisters.left]);
  }
}

void ExactLayout::snap() {
  const double fraction = this->fraction();
  for (Complex& translation : translations_) {
    translation = on_lattice(translation) ? lattice_.nearest(translation) : round_to(translation, fraction);
  }
  const PerVertex<char> on_cut = on_cuts(mesh_, map_.cut_graph);
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (!on_cut[v]) {
      if (!lattice_.square()) continue;
      // On a boundary as on a cut, so that the two sides of an open seam stay together.
      position_[v] = mesh_.loop_of_vertex[v] == none ? as_stored(position_[v]) : round_to(position_[v], fraction);
      continue;
    }
    const auto all = sectors(mesh_, map_.cut_graph, map_.cut_mesh, v);
    Complex z = position_[all.front().copy];
    if (is_cone(v) && on_lattice(z - shift_)) {
      z = lattice_.nearest(z - shift_) + shift_;
    } else {
      z = lattice_.square() ? round_to(z, fraction) : as_stored(z);
    }
    for (const Sector& sector : all) {
      if (sector.copy != all.front().copy) z = cross(z, sector.opened_by);
      position_[sector.copy] = z;
    }
  }
}

void ExactLayout::turn_upright(Array<Index> flipped, PerHalfedge<char> features) {
  if (least_per_flipped * ssize(flipped) > mesh_.triangle_count()) return;
  const PerVertex<char> on_cut = on_cuts(mesh_, map_.cut_graph);
  const auto copies = [&](Index v) {
    Array<MovingCopy> out;
    const auto all = sectors(mesh_, map_.cut_graph, map_.cut_mesh, v);
    if (is_cone(v) && on_cut[v] && on_lattice(position_[all.front().copy] - shift_)) return out;
    for (const Sector& sector : all) {
      Complex turn = 1;
      if (!out.empty()) turn = out.back().turn * turn_across(sector.opened_by);
      out.push_back({sector.copy, turn});
    }
    return out;
  };
  RoundingRepair repair(mesh_, map_.cut_mesh, copies, fraction(), position_);
  flipped = repair.repair(std::move(flipped), features);
  release_shorter_edges(flipped, features);
  flipped = repair.repair(std::move(flipped), features);
  repair.repair(std::move(flipped), {});
}

// Needles on creases have edges of these on either side, but the vertex between two of them may leave it.
void ExactLayout::release_shorter_edges(const Array<Index>& triangles, PerHalfedge<char>& features) const {
  for (const Index f : triangles) {
    const auto length = [&](Index h) {
      return std::abs(position_[map_.cut_mesh.copy_of_corner[next(h)]] - position_[map_.cut_mesh.copy_of_corner[h]]);
    };
    const Index first = 3 * f;
    Index longest = first;
    for (const Index h : {first + 1, first + 2}) longest = length(h) > length(longest) ? h : longest;
    for (const Index h : {next(longest), prev(longest)}) {
      features[h] = 0;
      if (mesh_.twin[h] != none) features[mesh_.twin[h]] = 0;
    }
  }
}

double ExactLayout::fraction() const {
  return fraction_for(std::max(position_.real().cwiseAbs().maxCoeff(), position_.imag().cwiseAbs().maxCoeff()));
}

bool ExactLayout::is_cone(Index v) const { return mesh_.loop_of_vertex[v] == none && map_.curvature.at_vertex[v] != 0; }

Array<Index> ExactLayout::find_unreadable() const {
  Array<Index> out;
  for (std::size_t p = 0; p < map_.cut_graph.cuts.size(); ++p) {
    for (const Index h : map_.cut_graph.cuts[p].halfedges) {
      const Sisters tail = origin_sisters(mesh_, map_.cut_mesh, h), head = target_sisters(mesh_, map_.cut_mesh, h);
      const Complex left = as_stored(position_[head.left]) - as_stored(position_[tail.left]);
      const Complex right = as_stored(position_[head.right]) - as_stored(position_[tail.right]);
      const Complex off = right * std::conj(lattice_.unit(turns_[p]) * left);
      if (std::abs(off) > 0 && std::abs(std::arg(off)) < M_PI / lattice_.rotation_order()) continue;
      out.push_back(mesh_.origin(h));
      out.push_back(mesh_.target(h));
    }
  }
  return out;
}

Array<SeamlessCut> ExactLayout::certify(const Component& component) const {
  Array<SeamlessCut> out;
  for (std::size_t p = 0; p < map_.cut_graph.cuts.size(); ++p) {
    const Cut& path = map_.cut_graph.cuts[p];
    SeamlessCut cut{component.source_vertex[path.tail], component.source_vertex[path.head], turns_[p],
                    lattice_.nearest_coordinates(translations_[p])};
    const auto add = [&](const Sisters& sisters) {
      const Complex image =
          lattice_.unit(turns_[p]) * as_stored(position_[sisters.left]) + lattice_.point(cut.translation);
      cut.error = std::max(cut.error, std::abs(as_stored(position_[sisters.right]) - image));
    };
    for (const Index h : path.halfedges) {
      add(origin_sisters(mesh_, map_.cut_mesh, h));
      add(target_sisters(mesh_, map_.cut_mesh, h));
    }
    out.push_back(cut);
  }
  return out;
}

Complex ExactLayout::turn_across(Index h) const {
  const Complex turn = lattice_.unit(turns_[map_.cut_graph.cut_of[h]]);
  return map_.cut_graph.runs_forward[h] ? std::conj(turn) : turn;
}

Complex ExactLayout::cross(Complex z, Index h) const {
  const Complex translation = translations_[map_.cut_graph.cut_of[h]];
  return map_.cut_graph.runs_forward[h] ? turn_across(h) * (z - translation) : turn_across(h) * z + translation;
}

}  // namespace lsgp

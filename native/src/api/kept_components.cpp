// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/kept_components.hpp"

#include <algorithm>
#include <utility>

namespace lsgp {

namespace {

constexpr std::size_t most_splits = 3;  // that are kept: auto-unwrap compares so many maps and divides one of them

// Fields are counted: a further one does not compile before it is compared.
bool is_same_lattice(const Seamless& a, const Seamless& b) {
  const auto& [lattice, tiles, tile_size, parity, whole_features, coarse_grid, cell] = a;
  return lattice == b.lattice && parity == b.parity && coarse_grid == b.coarse_grid && cell == b.cell;
}

// Whether seamless layouts differ only in the size of tiles and in what runs along them, and other ones only in how
// islands fill a square; the number of threads does not matter.
bool has_same_maps(const Options& a, const Options& b) {
  const auto& [prescription, unfold, method, seams, border, loop_turning, seamless, mode, stretch, straighten, repair,
               overlaps, compact, mirrored_cuts, square_share, factorization, threads] = a;
  return prescription == b.prescription && unfold == b.unfold && method == b.method && seams == b.seams &&
         border == b.border && loop_turning == b.loop_turning && seamless.has_value() == b.seamless.has_value() &&
         (seamless ? is_same_lattice(*seamless, *b.seamless) : straighten == b.straighten) && mode == b.mode &&
         stretch == b.stretch && repair == b.repair && overlaps == b.overlaps && mirrored_cuts == b.mirrored_cuts &&
         factorization == b.factorization && (!seamless || (compact == b.compact && square_share == b.square_share));
}

bool is_same(const Cones& a, const Cones& b) { return a.vertices == b.vertices && a.angles == b.angles; }

}  // namespace

void KeptComponents::update(const std::function<Work(Work)>& prepare) {
  try {
    work_ = prepare(std::move(work_));
  } catch (...) {
    kept_.clear();
    splits_.clear();
    work_ = {};
    throw;
  }
  if (work_.generation != kept_of_) {
    kept_.clear();
    splits_.clear();
  }
  kept_of_ = work_.generation;
  kept_.resize(work_.topology.components.size());
}

const Geometry& KeptComponents::geometry_of(std::size_t i, std::vector<Finding>& findings) {
  if (!kept_[i]) {
    auto kept = std::make_unique<Kept>();
    kept->geometry = require_geometry(work_.topology.components[i], kept->found);
    kept_[i] = std::move(kept);
  }
  findings.insert(findings.end(), kept_[i]->found.begin(), kept_[i]->found.end());
  return kept_[i]->geometry;
}

const Mirroring& KeptComponents::mirroring_of(std::size_t i) {
  Kept& kept = *kept_[i];
  if (!kept.mirroring) {
    kept.mirroring = find_mirror_images({work_.topology.components[i].mesh, kept.geometry}, std::nullopt);
  }
  return *kept.mirroring;
}

ComponentSystem& KeptComponents::system_of(std::size_t i, Factorization factorization) {
  Kept& kept = *kept_[i];
  return kept.system.of({work_.topology.components[i].mesh, kept.geometry}, work_.tasks[i].cones, factorization);
}

void KeptComponents::keep_maps_of(const Cones& cones, const Options& options) {
  if (of_maps_ && options.seamless && is_same(of_maps_->cones, cones) && has_same_maps(of_maps_->options, options)) {
    const Options before = std::exchange(of_maps_->options, options);
    if (before.straighten == options.straighten &&
        before.seamless->whole_features == options.seamless->whole_features) {
      return;
    }
    for (auto& kept : kept_) {
      if (kept) kept->alignment.reset();
    }
    return;
  }
  of_maps_ = MapInput{cones, options};
  for (auto& kept : kept_) {
    if (!kept) continue;
    kept->map.reset();
    kept->alignment.reset();
  }
}

void KeptComponents::keep_map(std::size_t i, const ComponentMap& map, const std::vector<Finding>& found) {
  if (keeps_systems_) kept_[i]->map = KeptMap{map, found};
}

PerComponent<std::optional<KeptMap>>& KeptComponents::split_maps_of(const Cones& cones, const Options& options) {
  const auto is_of = [&](const SplitMaps& split) {
    return is_same(split.of.cones, cones) && has_same_maps(split.of.options, options);
  };
  const auto known = std::find_if(splits_.begin(), splits_.end(), is_of);
  if (known != splits_.end()) return known->maps;
  if (splits_.size() == (keeps_systems_ ? most_splits : 1)) splits_.erase(splits_.begin());
  splits_.push_back({{cones, options}, PerComponent<std::optional<KeptMap>>(kept_.size())});
  return splits_.back().maps;
}

void KeptComponents::keep_system(std::size_t i, KeptSystem system) {
  if (keeps_systems_ && system.get() != nullptr) kept_[i]->system = std::move(system);
}

}  // namespace lsgp

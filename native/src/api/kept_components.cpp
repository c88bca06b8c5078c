// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/kept_components.hpp"

#include <utility>

namespace lsgp {

void KeptComponents::update(const std::function<Work(Work)>& prepare) {
  try {
    work_ = prepare(std::move(work_));
  } catch (...) {
    kept_.clear();
    work_ = {};
    throw;
  }
  if (work_.generation != kept_of_) kept_.clear();
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

void KeptComponents::keep_system(std::size_t i, KeptSystem system) {
  if (keeps_systems_ && system.get() != nullptr) kept_[i]->system = std::move(system);
}

}  // namespace lsgp

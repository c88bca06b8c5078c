// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept/kept_components.hpp"

#include <algorithm>
#include <utility>

namespace lsgp {

void KeptComponents::update(const std::function<Work(Work)>& prepare) {
  try {
    work_ = prepare(std::move(work_));
  } catch (...) {
    kept_.clear();
    results_.clear();
    work_ = {};
    throw;
  }
  if (work_.generation == kept_of_ && !kept_.empty()) return;
  kept_of_ = work_.generation;
  const PerComponent<Component>& components = work_.topology.components;
  kept_.clear();
  kept_.resize(components.size());
  results_.clear();
  for (const Component& component : components) results_.push_back(earlier_results(component));
}

std::shared_ptr<ComponentResults> KeptComponents::earlier_results(const Component& component) const {
  for (const KeptComponents* kept = earlier_.get(); kept != nullptr; kept = kept->earlier_.get()) {
    const PerComponent<Component>& components = kept->work_.topology.components;
    // In the order of their first triangles.
    const auto known = std::lower_bound(
        components.begin(), components.end(), component,
        [](const Component& a, const Component& b) { return a.source_triangle.front() < b.source_triangle.front(); });
    if (known != components.end() && is_same(*known, component)) return kept->results_[known - components.begin()];
  }
  return std::make_shared<ComponentResults>();
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
  std::optional<Mirroring>& mirroring = results_[i]->mirroring;
  if (!mirroring) {
    mirroring = find_mirror_images({work_.topology.components[i].mesh, kept_[i]->geometry}, std::nullopt);
  }
  return *mirroring;
}

ComponentSystem& KeptComponents::system_of(std::size_t i, Factorization factorization) {
  Kept& kept = *kept_[i];
  return kept.system.of({work_.topology.components[i].mesh, kept.geometry}, work_.tasks[i].cones, factorization);
}

void KeptComponents::keep_system(std::size_t i, KeptSystem system) {
  if (keeps_ && system.get() != nullptr) kept_[i]->system = std::move(system);
}

}  // namespace lsgp

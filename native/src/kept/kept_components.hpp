// SPDX-License-Identifier: GPL-3.0-or-later
// Data shared by calls on one surface: its components, and of each its geometry, its factored systems and what was
// found on it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/array.hpp"
#include "kept/component_results.hpp"
#include "lsgp/options.hpp"
#include "mesh/mirror.hpp"
#include "pipeline/components.hpp"
#include "prescription/component_system.hpp"

namespace lsgp {

class KeptComponents {
 public:
  // keeps: systems and results, from one call to the next, rather than until each component is done.
  explicit KeptComponents(bool keeps) : keeps_(keeps) {}
  // For a further surface. Components that are the same there and on earlier ones share what is found on them.
  explicit KeptComponents(std::shared_ptr<const KeptComponents> earlier) : keeps_(true), earlier_(std::move(earlier)) {}
  KeptComponents(const KeptComponents&) = delete;
  KeptComponents& operator=(const KeptComponents&) = delete;

  // prepare: makes the work of a call from that of the previous one. Everything below refers to the new work.
  void update(const std::function<Work(Work)>& prepare);
  Work& work() { return work_; }

  // Measured at the first call; appends to the findings.
  const Geometry& geometry_of(std::size_t i, std::vector<Finding>& findings);
  const Geometry& geometry(std::size_t i) const { return kept_[i]->geometry; }  // after that
  const Mirroring& mirroring_of(std::size_t i);

  // The system of the task's cones.
  ComponentSystem& system_of(std::size_t i, Factorization factorization);
  ComponentSystem* system(std::size_t i) { return kept_[i]->system.get(); }  // after that
  bool keeps() const { return keeps_; }
  ComponentResults& results(std::size_t i) { return *results_[i]; }
  // Takes over the system of a component, if there is one.
  void keep_system(std::size_t i, KeptSystem system);
  void release(std::size_t i) {
    if (!keeps_) system(i)->release();
  }

 private:
  struct Kept {
    Geometry geometry;
    std::vector<Finding> found;  // during its construction
    KeptSystem system;
  };

  std::shared_ptr<ComponentResults> earlier_results(const Component& component) const;

  const bool keeps_;
  const std::shared_ptr<const KeptComponents> earlier_;  // of the surface before, or null
  Work work_;
  PerComponent<std::unique_ptr<Kept>> kept_;  // systems refer to the geometry beside them
  PerComponent<std::shared_ptr<ComponentResults>> results_;
  std::int64_t kept_of_ = 0;  // generation of the topology it was made from
};

}  // namespace lsgp

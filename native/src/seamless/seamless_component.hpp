// SPDX-License-Identifier: GPL-3.0-or-later
// The components of a seamless layout.
#pragma once

#include <memory>
#include <numeric>
#include <optional>

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "pipeline/components.hpp"
#include "seamless/feature_alignment.hpp"

namespace lsgp {

// A component's map, with angles that are multiples of the lattice's rotation, and its origin.
struct SeamlessComponent {
  const Component* source;
  ComponentTask* task;
  ComponentMap* map;
  ComponentSystem* system;                     // of the map
  std::optional<FeatureAlignment>* alignment;  // of the map, or empty
  // Cones merged with others, as the caller's vertices, and the system of the remaining ones.
  Array<Index> merged{};
  std::unique_ptr<ComponentSystem> merged_system{};
  std::unique_ptr<std::optional<FeatureAlignment>> merged_alignment{};
};

// Thrown if components fail, so that the others are laid out without them.
struct ComponentsFailed {
  Array<Failure> failures;
};

// Runs step(index) for these components. Throws ComponentsFailed.
template <typename Step>
void for_each_seamless(const Array<SeamlessComponent>& components, const Array<std::size_t>& order, Step step) {
  ComponentsFailed failed;
  for (const std::size_t i : order) {
    try {
      step(i);
    } catch (const Error& error) {
      failed.failures.push_back(failure_of(*components[i].source, error));
    }
  }
  if (!failed.failures.empty()) throw failed;
}

// For all of them.
template <typename Step>
void for_each_seamless(const Array<SeamlessComponent>& components, Step step) {
  Array<std::size_t> order(components.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for_each_seamless(components, order, step);
}

}  // namespace lsgp

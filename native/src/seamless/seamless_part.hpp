// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a seamless layout.
#pragma once

#include <memory>

#include "base/array.hpp"
#include "pipeline/component_map.hpp"
#include "pipeline/components.hpp"

namespace lsgp {

// A component's map, its angles multiples of the lattice's turn, and what it was made from.
struct SeamlessPart {
  const Component* component;
  ComponentTask* task;
  ComponentMap* map;
  ComponentSystem* system;  // of the map
  // Cones given up for others, the caller's vertices, and the system of those that are left.
  Array<Index> merged{};
  std::unique_ptr<ComponentSystem> merged_system{};
};

// Thrown where parts cannot go on, so that the others are laid out without them.
struct PartsFailed {
  Array<Failure> failures;
};

// Runs step(part) for all parts. Throws PartsFailed.
template <typename Step>
void for_each_part(const Array<SeamlessPart>& parts, Step step) {
  PartsFailed failed;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    try {
      step(i);
    } catch (const Error& error) {
      failed.failures.push_back(failure_of(*parts[i].component, error));
    }
  }
  if (!failed.failures.empty()) throw failed;
}

}  // namespace lsgp

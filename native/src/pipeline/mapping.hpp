// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's section 3.2: from a component and its task to its map.
#pragma once

#include <vector>

#include "pipeline/component_map.hpp"

namespace lsgp {

// The map of least defects that the options allow; findings are added to. Throws what the stages throw, in the
// component's own numbering.
// system: of the task's cones.
ComponentMap map_component(ComponentSystem& system, const ComponentTask& task, const Options& options,
                           std::vector<Finding>& findings, ProgressMonitor& monitor);

// The first map of `map_component`, with local repairs only: identical if it has no defects.
ComponentMap attempt_component(ComponentSystem& system, const ComponentTask& task, const Options& options,
                               std::vector<Finding>& findings, ProgressMonitor& monitor);

}  // namespace lsgp

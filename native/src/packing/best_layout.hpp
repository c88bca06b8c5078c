// SPDX-License-Identifier: GPL-3.0-or-later
// The best layout of those that are known: of the one that is given, and of what is found at each effort.
#pragma once

#include <optional>

#include "base/array.hpp"
#include "base/progress_monitor.hpp"
#include "packing/body.hpp"

namespace lsgp {

// No worse than the given one, scaled as far as it goes, if bodies keep their margins there, nor than that of `quick`.
// unit: as of LayoutSearch. side_of_quick: of its layout, if that is known already; then none: no other is better.
// Throws as LayoutSearch::best.
std::optional<PackedLayout> best_layout(const Array<Body>& bodies, const PackingOptions& options, double unit,
                                        std::optional<double> side_of_quick, ProgressMonitor& monitor);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress_monitor.hpp"
#include "division/outline.hpp"
#include "lsgp/lsgp.hpp"
#include "pipeline/validation.hpp"
#include "pipeline/wording.hpp"

namespace lsgp {

VertexPairs costly_outline(const Surface& surface, const Progress& progress) try {
  StageSeconds seconds;
  ProgressMonitor monitor(progress, seconds);
  require_valid(surface);
  VertexPairs out = find_outline(surface);
  monitor.advance(1);
  return out;
} catch (const Error& error) {
  throw in_words(error);
}

}  // namespace lsgp

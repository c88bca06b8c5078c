// SPDX-License-Identifier: GPL-3.0-or-later
// The progress of computations that consist of calls of public functions, each of which tells its own.
#pragma once

#include "lsgp/progress.hpp"

namespace lsgp {

// The progress of one stage, as the share of the whole from begin to end.
Progress share_of(const Progress& progress, double begin, double end);

// Throws CANCELLED.
void tell(const Progress& progress, double done);

// Stages whose number is not known: each takes the same part of what is left.
class ProgressSteps {
 public:
  explicit ProgressSteps(Progress progress);

  // Of the next stage.
  Progress next();

 private:
  Progress progress_;
  double done_ = 0;
};

}  // namespace lsgp

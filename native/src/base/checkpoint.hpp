// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation points for long computations.
#pragma once

#include <functional>

#include "base/silence_watch.hpp"

namespace lsgp {

constexpr double operations_between_visits = 5e7;

// Called by long computations: reports approximate work, in multiplications, since the last call.
void checkpoint(double operations, SourcePlace place = SourcePlace::here());

// During its lifetime, checkpoints of this thread call `visit` every few hundredths of a second; it may throw. It is an
// error of builds that check for it if that takes half a second.
class CheckpointVisitor {
 public:
  explicit CheckpointVisitor(std::function<void()> visit, SourcePlace place = SourcePlace::here());
  ~CheckpointVisitor();
  CheckpointVisitor(const CheckpointVisitor&) = delete;
  CheckpointVisitor& operator=(const CheckpointVisitor&) = delete;

  // Of the time between visits. What calls back in another way tells it.
  SilenceWatch& watch() { return watch_; }

 private:
  friend void checkpoint(double operations, SourcePlace place);

  const std::function<void()> visit_;
  CheckpointVisitor* const around_;
  double operations_ = 0;  // since the last visit
  SilenceWatch watch_;
};

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation points for long computations.
#pragma once

#include <functional>

namespace lsgp {

constexpr double operations_between_visits = 5e7;

// Called by long computations: reports approximate work, in multiplications, since the last call.
void checkpoint(double operations);

// During its lifetime, checkpoints of this thread call `visit` every few hundredths of a second; it may throw.
class CheckpointVisitor {
 public:
  explicit CheckpointVisitor(std::function<void()> visit);
  ~CheckpointVisitor();
  CheckpointVisitor(const CheckpointVisitor&) = delete;
  CheckpointVisitor& operator=(const CheckpointVisitor&) = delete;

 private:
  friend void checkpoint(double operations);

  const std::function<void()> visit_;
  CheckpointVisitor* const around_;
  double operations_ = 0;  // since the last visit
};

}  // namespace lsgp

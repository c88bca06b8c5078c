// SPDX-License-Identifier: GPL-3.0-or-later
// Cancellation points for long computations.
#pragma once

#include <functional>

namespace lsgp {

constexpr double operations_between_visits = 5e7;

// Told by long work of this thread: about so many multiplications have been done.
void checkpoint(double operations);

// While it lives, `visit` is called by the checkpoints of this thread, some hundredths of a second apart; it may throw.
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

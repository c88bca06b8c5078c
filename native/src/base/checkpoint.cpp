// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/checkpoint.hpp"

#include <utility>

namespace lsgp {

namespace {

CheckpointVisitor*& visitor_of_this_thread() {
  thread_local CheckpointVisitor* visitor = nullptr;
  return visitor;
}

}  // namespace

CheckpointVisitor::CheckpointVisitor(std::function<void()> visit)
    : visit_(std::move(visit)), around_(std::exchange(visitor_of_this_thread(), this)) {}

CheckpointVisitor::~CheckpointVisitor() { visitor_of_this_thread() = around_; }

void checkpoint(double operations) {
  CheckpointVisitor* visitor = visitor_of_this_thread();
  if (visitor == nullptr) return;
  visitor->operations_ += operations;
  if (visitor->operations_ < operations_between_visits) return;
  visitor->operations_ = 0;
  visitor->visit_();
}

}  // namespace lsgp

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

CheckpointVisitor::CheckpointVisitor(std::function<void()> visit, SourcePlace place)
    : visit_(std::move(visit)), around_(std::exchange(visitor_of_this_thread(), this)) {
  watch_.restart(place);
}

CheckpointVisitor::~CheckpointVisitor() {
  watch_.pass(SourcePlace::here());
  visitor_of_this_thread() = around_;
}

void checkpoint(double operations, SourcePlace place) {
  CheckpointVisitor* visitor = visitor_of_this_thread();
  if (visitor == nullptr) return;
  visitor->watch_.pass(place);
  visitor->operations_ += operations;
  if (visitor->operations_ < operations_between_visits) return;
  visitor->operations_ = 0;
  const WatchedVisit visit(visitor->watch_, place);
  visitor->visit_();
}

}  // namespace lsgp

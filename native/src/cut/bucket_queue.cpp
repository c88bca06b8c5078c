// SPDX-License-Identifier: GPL-3.0-or-later
#include "cut/bucket_queue.hpp"

#include <algorithm>

namespace lsgp {

void BucketQueue::put(double bucket, const Entry& entry) {
  const auto to = static_cast<int>(bucket);
  Index at = unused_;
  if (at == none) {
    at = static_cast<Index>(links_.size());
    links_.emplace_back();
  } else {
    unused_ = links_[at].next;
  }
  links_[at] = {entry, element(first_, to)};
  element(first_, to) = at;
  filled_ |= std::uint64_t{1} << to;
}

// Sorts the first bucket that has entries.
void BucketQueue::begin_bucket() {
  while (!(filled_ >> begun_ & 1)) ++begun_;
  filled_ &= filled_ - 1;
  sorted_.clear();
  next_ = 0;
  Index at = std::exchange(element(first_, begun_++), none);
  while (at != none) {
    sorted_.push_back(links_[at].entry);
    const Index after = std::exchange(links_[at].next, unused_);
    unused_ = std::exchange(at, after);
  }
  std::sort(sorted_.begin(), sorted_.end());
}

// To the distances of the nearest of the early entries.
void BucketQueue::move_on() {
  start_ = early_.top().first;
  begun_ = 0;
  do {
    put(bucket_of(early_.top().first), early_.top());
    early_.pop();
  } while (!early_.empty() && bucket_of(early_.top().first) < bucket_count);
}

BucketQueue::Entry BucketQueue::pop() {
  if (next_ == sorted_.size() && late_.empty()) {
    if (!filled_) move_on();
    begin_bucket();
  }
  if (late_.empty() || (next_ < sorted_.size() && sorted_[next_] < late_.top())) return sorted_[next_++];
  const Entry out = late_.top();
  late_.pop();
  return out;
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/array.hpp"
#include "base/least_first.hpp"
#include "mesh/topology.hpp"

namespace lsgp {

// Vertices with their distances for searches that go on from the nearest one: the least entry first, while none is
// pushed that is nearer than the last one popped. Distances have buckets (Dial 1969), which are sorted one at a time;
// heaps keep those that come too late or too early for one. A search takes half the time of one with a heap alone, a
// third of which is saved by reading ahead what comes next.
class BucketQueue {
 public:
  using Entry = std::pair<double, Index>;  // finite distance, vertex

  // bucket_width: a fraction of a usual step from vertex to vertex.
  explicit BucketQueue(double bucket_width)
      : buckets_of_(std::isnormal(1 / bucket_width) && bucket_width > 0 ? 1 / bucket_width : 0) {
    first_.fill(none);
  }

  bool empty() const { return next_ == sorted_.size() && late_.empty() && !filled_ && early_.empty(); }
  void push(double distance, Index vertex) {
    const double bucket = bucket_of(distance);
    if (!(bucket < bucket_count)) {
      early_.emplace(distance, vertex);
    } else if (bucket < begun_) {
      late_.emplace(distance, vertex);
    } else {
      put(bucket, {distance, vertex});
    }
  }
  Entry pop();
  // The vertex that is likely to be the `count`th to be popped from now, none where that is not known.
  Index ahead(std::size_t count) const {
    return count <= sorted_.size() - next_ ? sorted_[next_ + count - 1].second : none;
  }

 private:
  static constexpr int bucket_count = 64;
  struct Link {
    Entry entry;
    Index next;
  };

  double bucket_of(double distance) const { return (distance - start_) * buckets_of_; }
  void put(double bucket, const Entry& entry);
  void begin_bucket();
  void move_on();

  double start_ = 0;                       // the distance at which the buckets start
  const double buckets_of_;                // a unit of distance
  int begun_ = 0;                          // buckets that have been sorted
  std::uint64_t filled_ = 0;               // a bit for every bucket with entries
  std::array<Index, bucket_count> first_;  // entry of each bucket in links_
  Array<Link> links_;
  Index unused_ = none;  // the first of the links without an entry
  Array<Entry> sorted_;  // the last bucket begun
  std::size_t next_ = 0;
  LeastFirst<Entry> late_;   // for buckets that have been begun
  LeastFirst<Entry> early_;  // beyond the last bucket
};

}  // namespace lsgp

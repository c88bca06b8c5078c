// SPDX-License-Identifier: GPL-3.0-or-later
// Stopping a choice among maps after some time.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "lsgp/errors.hpp"
#include "lsgp/progress.hpp"

namespace lsgp {

class TimeLimit {
 public:
  // seconds: from now on; none for no limit.
  TimeLimit(std::optional<double> seconds, const Progress& progress);

  // Also stops what it is told to when the time is over.
  const Progress& progress() const { return limited_; }
  // Goes on when the time is over.
  const Progress& unlimited() const { return unlimited_; }

  bool is_over() const { return end_ && Clock::now() > *end_; }

  // Whether it is why something ended with this error.
  bool has_caused(const Error& error) const {
    return stopped_->by_time && !stopped_->by_caller && error.code() == Code::cancelled;
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<Clock::time_point> end_;
  struct Stopped {
    bool by_time = false, by_caller = false;
  };
  std::shared_ptr<Stopped> stopped_;
  Progress unlimited_, limited_;
};

}  // namespace lsgp

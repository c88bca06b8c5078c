// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/time_limit.hpp"

#include <algorithm>

namespace lsgp {

TimeLimit::TimeLimit(std::optional<double> seconds, const Progress& progress)
    : stopped_(std::make_shared<Stopped>()), unlimited_(progress), limited_(progress) {
  constexpr double longest = 1e9;  // of what a clock can tell
  if (!seconds) return;
  const std::chrono::duration<double> length(std::min(*seconds, longest));
  end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(length);
  unlimited_ = [stopped = stopped_, progress](double done) {
    stopped->by_caller = stopped->by_caller || (progress && !progress(done));
    return !stopped->by_caller;
  };
  limited_ = [end = *end_, stopped = stopped_, unlimited = unlimited_](double done) {
    if (!unlimited(done)) return false;
    stopped->by_time = stopped->by_time || Clock::now() > end;
    return !stopped->by_time;
  };
}

}  // namespace lsgp

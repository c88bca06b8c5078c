// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/time_limit.hpp"

#include <algorithm>

namespace lsgp {

TimeLimit::TimeLimit(std::optional<double> seconds, const Progress& progress)
    : has_stopped_(std::make_shared<bool>(false)), limited_(progress) {
  constexpr double longest = 1e9;  // of what a clock can tell
  if (!seconds) return;
  const std::chrono::duration<double> length(std::min(*seconds, longest));
  end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(length);
  limited_ = [end = *end_, has_stopped = has_stopped_, progress](double done) {
    if (progress && !progress(done)) return false;
    *has_stopped = *has_stopped || Clock::now() > end;
    return !*has_stopped;
  };
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress_monitor.hpp"

#include <algorithm>

#include "lsgp/errors.hpp"

namespace lsgp {

void ProgressMonitor::advance(double done, SourcePlace place) {
  const WatchedVisit visit(visitor_.watch(), place);
  if (!progress_) return;
  told_ = std::max(told_, low_ + std::clamp(done, 0.0, 1.0) * (high_ - low_));
  if (!progress_(told_)) throw Error(Code::cancelled, "Stopped as asked; nothing was changed.");
}

void ProgressMonitor::tick(SourcePlace place) {
  constexpr double share = 0.01;
  const double left = std::max(0.0, high_ - std::max(told_, low_));
  advance((std::max(told_, low_) + share * left - low_) / std::max(high_ - low_, 1e-300), place);
}

ProgressMonitor::Interval::Interval(ProgressMonitor& monitor, double begin, double end)
    : monitor_(monitor), low_(monitor.low_), high_(monitor.high_) {
  monitor.low_ = low_ + begin * (high_ - low_);
  monitor.high_ = low_ + end * (high_ - low_);
}

ProgressMonitor::Interval::~Interval() {
  monitor_.low_ = low_;
  monitor_.high_ = high_;
}

ProgressMonitor::Stage::Stage(ProgressMonitor& monitor, const char* name)
    : monitor_(monitor), around_(monitor.innermost_) {
  StageSeconds& seconds = monitor.seconds_;
  const auto is_stage = [&](const auto& entry) { return entry.first == name; };
  place_ = static_cast<std::size_t>(std::find_if(seconds.begin(), seconds.end(), is_stage) - seconds.begin());
  if (place_ == seconds.size()) seconds.emplace_back(name, 0.0);  // here, because a destructor must not throw
  if (around_ != nullptr) around_->stop();
  monitor.innermost_ = this;
  begin_ = std::chrono::steady_clock::now();
}

ProgressMonitor::Stage::~Stage() {
  stop();
  if (around_ != nullptr) around_->begin_ = std::chrono::steady_clock::now();
  monitor_.innermost_ = around_;
}

void ProgressMonitor::Stage::stop() {
  monitor_.seconds_[place_].second += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

}  // namespace lsgp

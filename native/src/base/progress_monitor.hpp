// SPDX-License-Identifier: GPL-3.0-or-later
// Progress and stage timings of a public function while it runs.
#pragma once

#include <chrono>

#include "base/borrowed.hpp"
#include "base/checkpoint.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/stage_seconds.hpp"

namespace lsgp {

class ProgressMonitor {
 public:
  ProgressMonitor(Borrowed<const Progress> progress, StageSeconds& seconds)
      : progress_(progress), seconds_(seconds), visitor_([this] { tick(); }) {}
  ProgressMonitor(const ProgressMonitor&) = delete;
  ProgressMonitor& operator=(const ProgressMonitor&) = delete;

  // done: of the innermost active interval, 0 to 1. Throws CANCELLED.
  void advance(double done, SourcePlace place = SourcePlace::here());

  // For loops of unknown length: advances by a fixed fraction of the remaining interval. Checkpoints call it, too.
  void tick(SourcePlace place = SourcePlace::here());

  // Maps this scope's progress to the interval [begin, end] of the enclosing scope.
  class Interval {
   public:
    Interval(ProgressMonitor& monitor, double begin, double end);
    ~Interval();
    Interval(const Interval&) = delete;
    Interval& operator=(const Interval&) = delete;

   private:
    ProgressMonitor& monitor_;
    const double low_, high_;  // interval of the enclosing one
  };

  // Adds the wall-clock time of its lifetime to a stage, excluding the time of nested stages.
  class Stage {
   public:
    Stage(ProgressMonitor& monitor, const char* name);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

   private:
    void stop();

    ProgressMonitor& monitor_;
    Stage* const around_;
    std::size_t place_;  // in the seconds
    std::chrono::steady_clock::time_point begin_;
  };

 private:
  const Progress& progress_;
  StageSeconds& seconds_;
  double low_ = 0, high_ = 1, told_ = 0;
  Stage* innermost_ = nullptr;
  CheckpointVisitor visitor_;
};

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Progress and stage timings of a running verb.
#pragma once

#include <chrono>

#include "base/checkpoint.hpp"
#include "lsgp/progress.hpp"
#include "lsgp/result.hpp"

namespace lsgp {

class ProgressMonitor {
 public:
  ProgressMonitor(const Progress& progress, StageSeconds& seconds)
      : progress_(progress), seconds_(seconds), visitor_([this] { tick(); }) {}
  ProgressMonitor(const ProgressMonitor&) = delete;
  ProgressMonitor& operator=(const ProgressMonitor&) = delete;

  // done: of the innermost part under way, 0 to 1. Throws CANCELLED.
  void advance(double done);

  // Where nobody knows how much there is to do: a small share of what is left of the part. Long work does it by
  // itself, at its checkpoints.
  void tick();

  // While it lives, what is done is told as what lies between two shares of the part around it.
  class Part {
   public:
    Part(ProgressMonitor& monitor, double begin, double end);
    ~Part();
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

   private:
    ProgressMonitor& monitor_;
    const double low_, high_;  // of the part around it
  };

  // Adds the wall-clock time until its end to a stage; while another one is under way within it, that counts for the
  // other alone.
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
  const CheckpointVisitor visitor_;
};

}  // namespace lsgp

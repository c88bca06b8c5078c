// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/silence_watch.hpp"

#ifdef LSGP_CHECK_CHECKPOINTS

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace lsgp {

namespace {

// Half of what callers are promised.
constexpr double most_seconds = 0.5 * LSGP_CHECK_CHECKPOINTS;
// Reading the CPU time takes as long as the work between many checkpoints; where less time than this has passed, it is
// not read.
constexpr double resolution = 0.005;

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void SilenceWatch::pass(SourcePlace place) {
  const SourcePlace before = last_;
  last_ = place;
  const double time = clock_seconds();
  if (time - looked_ < resolution) return;
  looked_ = time;
  const double now = cpu_seconds();
  if (now - passed_ > longest_.seconds) longest_ = {now - passed_, before, place};
  passed_ = now;
  if (is_reported_ || now - heard_ <= most_seconds) return;
  is_reported_ = true;
  std::fprintf(stderr, "lsgp: %.2f s of CPU time without a visit, %.2f of them between %s:%d and %s:%d\n", now - heard_,
               longest_.seconds, longest_.from.file, longest_.from.line, longest_.to.file, longest_.to.line);
  const char* wanted = std::getenv("LSGP_SILENCE");
  if (wanted == nullptr || std::strcmp(wanted, "report") != 0) std::abort();
}

void SilenceWatch::restart(SourcePlace place) {
  last_ = place;
  heard_ = passed_ = cpu_seconds();
  looked_ = clock_seconds();
  longest_ = {};
  is_reported_ = false;
}

}  // namespace lsgp

#endif

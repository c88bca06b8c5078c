// SPDX-License-Identifier: GPL-3.0-or-later
// A check of builds with LSGP_CHECK_CHECKPOINTS: long computations must let their caller in often enough. The macro is
// by how much the build is slower than a release; without it nothing of this is compiled.
#pragma once

namespace lsgp {

// Where in the source a function is called, as its default argument.
struct SourcePlace {
#ifdef LSGP_CHECK_CHECKPOINTS
  const char* file = "";
  int line = 0;

  static constexpr SourcePlace here(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    return {file, line};
  }
#else
  static constexpr SourcePlace here() { return {}; }
#endif
};

// Measures the CPU time of this thread between visits. Half a second of a release is an error: a message names the two
// checkpoints between which most of it lay, and the process is aborted; with LSGP_SILENCE=report in the environment it
// goes on.
class SilenceWatch {
 public:
#ifdef LSGP_CHECK_CHECKPOINTS
  // A checkpoint was reached, which need not visit.
  void pass(SourcePlace place);

  // A visit ended, or the first one is awaited from now on.
  void restart(SourcePlace place);

 private:
  struct Gap {
    double seconds;
    SourcePlace from, to;
  };

  double heard_ = 0, passed_ = 0;  // CPU time of this thread at the last visit, and at the last checkpoint
  double looked_ = 0;              // by the clock, when that was read
  SourcePlace last_;
  Gap longest_{};
  bool is_reported_ = false;  // since the last visit
#else
  void pass(SourcePlace) {}
  void restart(SourcePlace) {}
#endif
};

// A visit, whose own time does not count.
class WatchedVisit {
 public:
  WatchedVisit(SilenceWatch& watch, SourcePlace place) : watch_(watch), place_(place) { watch_.pass(place_); }
  ~WatchedVisit() { watch_.restart(place_); }
  WatchedVisit(const WatchedVisit&) = delete;
  WatchedVisit& operator=(const WatchedVisit&) = delete;

 private:
  SilenceWatch& watch_;
  const SourcePlace place_;
};

}  // namespace lsgp

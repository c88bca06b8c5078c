// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/silence_watch.hpp"

#ifdef LSGP_CHECK_CHECKPOINTS

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string>

#include "base/checkpoint.hpp"

namespace {

struct Ended {
  int status;
  std::string said;
};

// Runs the work in a process of its own.
template <typename Work>
Ended in_child(const Work& work) {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    std::signal(SIGABRT, SIG_DFL);  // doctest has a handler
    work();
    _exit(0);
  }
  close(ends[1]);
  Ended ended{};
  std::array<char, 512> part{};
  for (ssize_t count = 0; (count = read(ends[0], part.data(), part.size())) > 0;)
    ended.said.append(part.data(), static_cast<std::size_t>(count));
  close(ends[0]);
  REQUIRE(waitpid(child, &ended.status, 0) == child);
  return ended;
}

void work_for(double seconds) {
  const std::clock_t end = std::clock() + static_cast<std::clock_t>(seconds * CLOCKS_PER_SEC);
  while (std::clock() < end) continue;
}

constexpr double limit = 0.5 * LSGP_CHECK_CHECKPOINTS;

}  // namespace

TEST_CASE("a long silence is an error that names the checkpoints before and after it") {
  constexpr int line = __LINE__ + 3;
  const Ended ended = in_child([] {
    const lsgp::CheckpointVisitor visitor([] {});
    lsgp::checkpoint(1);
    work_for(1.2 * limit);
    lsgp::checkpoint(1);
  });
  CHECK(WIFSIGNALED(ended.status));
  for (const int at : {line, line + 2})
    CHECK(ended.said.find("test_silence_watch.cpp:" + std::to_string(at)) != std::string::npos);
}

TEST_CASE("so are many checkpoints none of which visits, and a silent end") {
  const Ended understated = in_child([] {
    const lsgp::CheckpointVisitor visitor([] {});
    for (int i = 0; i < 20; ++i) {
      work_for(0.1 * limit);
      lsgp::checkpoint(1);
    }
  });
  CHECK(WIFSIGNALED(understated.status));
  const Ended unfinished = in_child([] {
    const lsgp::CheckpointVisitor visitor([] {});
    work_for(1.2 * limit);
  });
  CHECK(WIFSIGNALED(unfinished.status));
}

TEST_CASE("what visits often is none, nor is what the caller does meanwhile") {
  const Ended ended = in_child([] {
    const lsgp::CheckpointVisitor visitor([] { work_for(1.2 * limit); });
    for (int i = 0; i < 2; ++i) {
      work_for(0.6 * limit);
      lsgp::checkpoint(lsgp::operations_between_visits);
    }
  });
  CHECK(WIFEXITED(ended.status));
  CHECK(ended.said.empty());
}

#endif

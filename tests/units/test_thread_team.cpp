// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/thread_team.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "base/checkpoint.hpp"
#include "random_matrices.hpp"

namespace {

constexpr int team_sizes[]{1, 2, 3, 8};

// A parent for each but the last few, later than itself.
lsgp::Array<int> random_forest(Random& random, int count) {
  lsgp::Array<int> parent(count, -1);
  for (int task = 0; task + 3 < count; ++task) parent[task] = task + 1 + below(random, std::min(8, count - 1 - task));
  return parent;
}

}  // namespace

TEST_CASE("tasks run once each, after their children") {
  Random random(1);
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    lsgp::ThreadTeam team(threads);
    CHECK(team.size() == threads);
    const lsgp::Array<int> parent = random_forest(random, 500);
    lsgp::Array<int> runs(500, 0), sum(500, 1);  // of the subtree
    std::atomic<int> wrong = 0;
    team.run_forest(parent, [&](int task, int thread) {
      wrong += thread < 0 || thread >= threads;
      ++runs[task];
      for (int child = 0; child < task; ++child) {
        if (parent[child] == task) sum[task] += sum[child];
      }
    });
    CHECK(wrong == 0);
    CHECK(runs == lsgp::Array<int>(500, 1));
    int total = 0;
    for (int task = 0; task < 500; ++task) total += parent[task] == -1 ? sum[task] : 0;
    CHECK(total == 500);
  }
}

TEST_CASE("loops within tasks run every round once") {
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    lsgp::ThreadTeam team(threads);
    const lsgp::Array<int> parent(20, -1);
    lsgp::Array<int> runs(20 * 50, 0);
    team.run_forest(parent, [&](int task, int) { team.run_each(50, [&](int i) { ++runs[50 * task + i]; }); });
    team.run_each(20 * 50, [&](int i) { ++runs[i]; });
    CHECK(runs == lsgp::Array<int>(20 * 50, 2));
  }
}

TEST_CASE("what work throws ends the rest and reaches the caller, after which the team goes on") {
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    lsgp::ThreadTeam team(threads);
    lsgp::Array<int> chain(100, -1);
    std::iota(chain.begin(), chain.end() - 1, 1);
    for (const bool in_loop : {false, true}) {
      std::atomic<int> runs = 0;
      const auto work = [&](int task, int) {
        ++runs;
        if (task != 40) return;
        if (!in_loop) throw std::runtime_error("40");
        team.run_each(30, [](int i) {
          if (i == 7) throw std::runtime_error("40");
        });
      };
      CHECK_THROWS_WITH_AS(team.run_forest(chain, work), "40", std::runtime_error);
      CHECK(runs == 41);
      CHECK_THROWS_WITH_AS(team.run_each(30, [](int) { throw std::runtime_error("each"); }), "each",
                           std::runtime_error);
    }
    std::atomic<int> sum = 0;
    team.run_each(10, [&](int i) { sum += i; });
    CHECK(sum == 45);
  }
}

TEST_CASE("the caller alone visits the checkpoints of all threads, and may stop them") {
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    lsgp::ThreadTeam team(threads);
    const auto caller = std::this_thread::get_id();
    int visits = 0, stop_at = 1000;
    bool elsewhere = false;
    const lsgp::CheckpointVisitor visitor([&] {
      elsewhere = elsewhere || std::this_thread::get_id() != caller;
      if (++visits == stop_at) throw std::runtime_error("stopped");
    });
    const lsgp::Array<int> parent(64, -1);
    std::atomic<int> runs = 0;
    const auto work = [&](int, int) {
      ++runs;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      lsgp::checkpoint(lsgp::operations_between_visits);
    };
    team.run_forest(parent, work);
    CHECK(visits > 0);
    CHECK(visits <= 64);
    stop_at = visits + 1;
    runs = 0;
    CHECK_THROWS_WITH_AS(team.run_forest(parent, work), "stopped", std::runtime_error);
    CHECK(runs < 64);
    CHECK_FALSE(elsewhere);
  }
}

TEST_CASE("who has stopped the work at a checkpoint is not asked again") {
  lsgp::ThreadTeam team(2);
  REQUIRE(team.size() == 2);
  int visits = 0;
  std::atomic<bool> told = false, stopped = false;
  const lsgp::CheckpointVisitor visitor([&] {
    ++visits;
    stopped = true;
    throw std::runtime_error("stopped");
  });
  const auto pass_checkpoint = [&](int i) {  // 0: the caller, 1: the other thread, which ends well after it
    if (i == 0) {
      while (!told) std::this_thread::yield();
      lsgp::checkpoint(lsgp::operations_between_visits);
    } else {
      lsgp::checkpoint(lsgp::operations_between_visits);
      told = true;
      while (!stopped) std::this_thread::yield();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  };
  CHECK_THROWS_WITH_AS(team.run_each(2, pass_checkpoint), "stopped", std::runtime_error);
  CHECK(visits == 1);
}

TEST_CASE("a team ends whose last task ends while the caller visits a checkpoint") {
  const lsgp::CheckpointVisitor visitor([] { std::this_thread::sleep_for(std::chrono::microseconds(50)); });
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    lsgp::ThreadTeam team(threads);
    std::atomic<int> runs = 0;
    for (int round = 0; round < 500; ++round) {
      team.run_forest({-1, -1, -1}, [&](int, int) {
        lsgp::checkpoint(lsgp::operations_between_visits);
        ++runs;
      });
    }
    CHECK(runs == 1500);
  }
}

TEST_CASE("what a loop within a loop throws reaches the caller, after which the team goes on") {
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    lsgp::ThreadTeam team(threads);
    const auto outer = [&](int i) {
      if (i == 5) team.run_each(20, [](int k) { k == 3 ? throw std::runtime_error("within") : void(); });
    };
    CHECK_THROWS_WITH_AS(team.run_each(10, outer), "within", std::runtime_error);
    std::atomic<int> sum = 0;
    team.run_each(10, [&](int) { team.run_each(10, [&](int k) { sum += k; }); });
    CHECK(sum == 450);
  }
}

TEST_CASE("ranges make up the whole, and long ones alone are divided") {
  for (const int threads : team_sizes) {
    CAPTURE(threads);
    const lsgp::ThreadCount count(threads);
    for (const int size : {0, 1, 4096, 32767, 32768, 100001}) {
      CAPTURE(size);
      lsgp::Array<int> visits(size, 0);
      std::atomic<int> ranges = 0;
      lsgp::run_in_ranges(size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        ++ranges;
        for (std::ptrdiff_t i = begin; i < end; ++i) ++visits[i];
      });
      CHECK(visits == lsgp::Array<int>(size, 1));
      CHECK((ranges > 1) == (threads > 1 && size >= 32768));
    }
  }
}

TEST_CASE("a call keeps its team, and other threads have none") {
  const lsgp::ThreadCount count(3);
  lsgp::ThreadTeam& team = lsgp::team_of_this_call();
  CHECK(team.size() == 3);
  CHECK(&lsgp::team_of_this_call() == &team);
  {
    const lsgp::ThreadCount inner(2);
    CHECK(lsgp::team_of_this_call().size() == 2);
  }
  CHECK(&lsgp::team_of_this_call() == &team);
  std::atomic<int> elsewhere = 0, wrong = 0;
  const auto caller = std::this_thread::get_id();
  while (elsewhere == 0) {
    team.run_each(64, [&](int) {
      const bool is_caller = std::this_thread::get_id() == caller;
      elsewhere += !is_caller;
      wrong += lsgp::team_of_this_call().size() != (is_caller ? 3 : 1);
      std::this_thread::yield();
    });
  }
  CHECK(wrong == 0);
}

TEST_CASE("the number of threads is that of the innermost scope, or the default") {
  const int otherwise = lsgp::thread_count();
  CHECK(otherwise >= 1);
  {
    const lsgp::ThreadCount outer(7);
    CHECK(lsgp::thread_count() == 7);
    {
      const lsgp::ThreadCount inner(0);
      CHECK(lsgp::thread_count() == otherwise);
    }
    CHECK(lsgp::thread_count() == 7);
    std::thread([&] { CHECK(lsgp::thread_count() == otherwise); }).join();
  }
  CHECK(lsgp::thread_count() == otherwise);
}

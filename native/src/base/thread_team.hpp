// SPDX-License-Identifier: GPL-3.0-or-later
// Threads for the long work of one call. What is computed must not depend on how many there are: whoever uses them
// divides the work by its size alone, and leaves the order of every sum as it is.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "base/array.hpp"

namespace lsgp {

constexpr int most_threads = 1024;

class ThreadTeam;

// During its lifetime, long work of this thread uses that many threads, itself included; 0: the number in the
// environment variable LSGP_THREADS, or else that of processors.
class ThreadCount {
 public:
  explicit ThreadCount(int count);
  ~ThreadCount();
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  friend ThreadTeam& team_of_this_call();
  friend int thread_count();

  ThreadCount* const around_;
  const int count_;
  std::unique_ptr<ThreadTeam> team_;
};

int thread_count();

// The team of the innermost ThreadCount of this thread, started at the first call and then kept. Without one, as on the
// other threads of a team: this thread alone.
ThreadTeam& team_of_this_call();

// Whether work on so many elements, that takes about as long for each as for a triangle, is worth other threads.
bool is_worth_threads(std::ptrdiff_t count);

// Calls work(begin, end) for ranges that together cover 0 to count - 1, in any order and concurrently; a short range is
// not divided.
void run_in_ranges(std::ptrdiff_t count, const std::function<void(std::ptrdiff_t begin, std::ptrdiff_t end)>& work);

// Calls visit(i) for 0 to count - 1 in such ranges. The calls must not depend on each other.
template <typename Integer, typename Visit>
void for_each_at_once(Integer count, const Visit& visit) {
  run_in_ranges(count, [&visit](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) visit(static_cast<Integer>(i));
  });
}

// The constructing thread and others, which end with the object. The first exception of the work cancels the rest of it
// and is rethrown to the caller. The caller also visits the checkpoints that other threads reach, as soon as it is
// free.
class ThreadTeam {
 public:
  explicit ThreadTeam(int count);  // fewer if the system provides no more
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return 1 + static_cast<int>(others_.size()); }

  // Calls work(task, thread) for every task of a forest after all children of it.  parent: of every task, later than
  // itself, or -1.  thread: 0 to size() - 1, one task at a time.
  void run_forest(const Array<int>& parent, const std::function<void(int task, int thread)>& work);

  // Calls work(i) for 0 to count - 1 in any order and concurrently. Tasks of a forest may call this as well.
  void run_each(int count, const std::function<void(int i)>& work);

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Forest {
    const Array<int>* parent;
    const std::function<void(int, int)>* work;
    Array<int> children;  // (tasks) that are not done
    Array<int> ready;     // a heap, the first task on top
    int left;             // tasks that are not done
    int running = 0;
  };
  struct Loop {
    const std::function<void(int)>* work;
    int count;
    int next = 0, running = 0;
  };

  void serve(int thread);
  bool take_work(Lock& lock, int thread);
  void run_task(Lock& lock, int thread);
  void run_one(Lock& lock, Loop& loop);
  void fail();
  void tell_caller();
  bool visit(Lock& lock);

  const std::thread::id caller_ = std::this_thread::get_id();
  std::mutex mutex_;                  // of all that follows but the threads
  std::condition_variable new_work_;  // for threads without any
  std::condition_variable changed_;   // for threads that wait for others
  Forest* forest_ = nullptr;
  Array<Loop*> loops_;
  std::exception_ptr failure_;
  int visits_ = 0;  // to checkpoints by other threads, not yet made by the caller
  bool is_over_ = false;
  Array<std::thread> others_;
};

}  // namespace lsgp

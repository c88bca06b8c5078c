// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/thread_team.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <utility>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr std::ptrdiff_t range_size = 4096;  // for triangles a tenth of a millisecond, ten times what waking up takes
constexpr std::ptrdiff_t least_ranges = 8;   // threads take time to start

ThreadCount*& innermost_of_this_thread() {
  thread_local ThreadCount* innermost = nullptr;
  return innermost;
}

int default_count() {
  const char* text = std::getenv("LSGP_THREADS");
  const auto given = text == nullptr ? 0 : std::strtol(text, nullptr, 10);
  if (given >= 1 && given <= most_threads) return static_cast<int>(given);
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, static_cast<unsigned>(most_threads)));
}

}  // namespace

ThreadCount::ThreadCount(int count) : around_(std::exchange(innermost_of_this_thread(), this)), count_(count) {}
ThreadCount::~ThreadCount() { innermost_of_this_thread() = around_; }

int thread_count() {
  static const int otherwise = default_count();
  const ThreadCount* innermost = innermost_of_this_thread();
  return innermost == nullptr || innermost->count_ == 0 ? otherwise : innermost->count_;
}

ThreadTeam& team_of_this_call() {
  ThreadCount* innermost = innermost_of_this_thread();
  if (innermost == nullptr) {
    thread_local ThreadTeam alone(1);
    return alone;
  }
  if (!innermost->team_) innermost->team_ = std::make_unique<ThreadTeam>(thread_count());
  return *innermost->team_;
}

bool is_worth_threads(std::ptrdiff_t count) { return count >= range_size * least_ranges && thread_count() > 1; }

void run_in_ranges(std::ptrdiff_t count, const std::function<void(std::ptrdiff_t begin, std::ptrdiff_t end)>& work) {
  const std::ptrdiff_t ranges = count / range_size;  // the last one has the rest
  ThreadTeam* team = is_worth_threads(count) ? &team_of_this_call() : nullptr;
  if (team == nullptr || team->size() == 1) {
    work(0, count);
    return;
  }
  team->run_each(static_cast<int>(ranges),
                 [&](int i) { work(i * range_size, i + 1 == ranges ? count : (i + 1) * range_size); });
}

ThreadTeam::ThreadTeam(int count) {
  try {
    others_.reserve(count - 1);
    for (int thread = 1; thread < count; ++thread) others_.emplace_back([this, thread] { serve(thread); });
  } catch (const std::exception&) {  // those that there are do all of it
  }
}

ThreadTeam::~ThreadTeam() {
  {
    const Lock lock(mutex_);
    is_over_ = true;
  }
  new_work_.notify_all();
  for (std::thread& other : others_) other.join();
}

void ThreadTeam::run_forest(const Array<int>& parent, const std::function<void(int, int)>& work) {
  const int count = static_cast<int>(parent.size());
  if (others_.empty()) {
    for (int task = 0; task < count; ++task) work(task, 0);
    return;
  }
  Forest forest{&parent, &work, Array<int>(count, 0), {}, count};
  forest.ready.reserve(count);
  for (const int above : parent) {
    if (above != -1) ++forest.children[above];
  }
  for (int task = 0; task < count; ++task) {  // ascending, which is a heap
    if (forest.children[task] == 0) forest.ready.push_back(task);
  }
  Lock lock(mutex_);
  forest_ = &forest;
  new_work_.notify_all();
  while (forest.left > 0 && !failure_) {
    if (!visit(lock) && !take_work(lock, 0)) changed_.wait(lock);
  }
  while (forest.running > 0) changed_.wait(lock);
  forest_ = nullptr;
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadTeam::run_each(int count, const std::function<void(int)>& work) {
  if (others_.empty() || count == 1) {
    for (int i = 0; i < count; ++i) work(i);
    return;
  }
  Loop loop{&work, count};
  Lock lock(mutex_);
  loops_.push_back(&loop);
  for (int i = 1; i < std::min(count, size()); ++i) new_work_.notify_one();
  changed_.notify_all();
  while (loop.next < loop.count && !failure_) {
    run_one(lock, loop);
    visit(lock);
  }
  loop.next = loop.count;
  while (loop.running > 0) {
    changed_.wait(lock);
    visit(lock);
  }
  loops_.erase(std::find(loops_.begin(), loops_.end(), &loop));
  if (!failure_) return;
  const bool is_outermost = forest_ == nullptr && loops_.empty();
  const std::exception_ptr failure = is_outermost ? std::exchange(failure_, nullptr) : failure_;
  std::rethrow_exception(failure);
}

// The loop of the other threads.
void ThreadTeam::serve(int thread) {
  CheckpointVisitor visitor([this] { tell_caller(); });
  Lock lock(mutex_);
  while (!is_over_) {
    visitor.watch().restart(SourcePlace::here());  // the caller visits after every piece of work
    if (!take_work(lock, thread)) new_work_.wait(lock);
  }
}

// Returns whether there was any. Loops come first, because a thread waits for them.
bool ThreadTeam::take_work(Lock& lock, int thread) {
  if (failure_) return false;
  const auto loop = std::find_if(loops_.begin(), loops_.end(), [](const Loop* l) { return l->next < l->count; });
  if (loop != loops_.end()) {
    run_one(lock, **loop);
    return true;
  }
  if (forest_ == nullptr || forest_->ready.empty()) return false;
  run_task(lock, thread);
  return true;
}

// Runs the first task that is ready: in the order of tasks, results for parents are short-lived.
void ThreadTeam::run_task(Lock& lock, int thread) {
  Forest& forest = *forest_;
  std::pop_heap(forest.ready.begin(), forest.ready.end(), std::greater<>());
  const int task = forest.ready.back();
  forest.ready.pop_back();
  ++forest.running;
  lock.unlock();
  try {
    (*forest.work)(task, thread);
    lock.lock();
  } catch (...) {
    lock.lock();
    fail();
  }
  --forest.running;
  --forest.left;
  const int above = (*forest.parent)[task];
  if (above != -1 && --forest.children[above] == 0) {
    forest.ready.push_back(above);
    std::push_heap(forest.ready.begin(), forest.ready.end(), std::greater<>());
    new_work_.notify_one();
  }
  changed_.notify_all();
}

void ThreadTeam::run_one(Lock& lock, Loop& loop) {
  const int i = loop.next++;
  ++loop.running;
  lock.unlock();
  try {
    (*loop.work)(i);
    lock.lock();
  } catch (...) {
    lock.lock();
    fail();
  }
  if (--loop.running == 0 && loop.next == loop.count) changed_.notify_all();
}

// In the handler of an exception: the first one counts, the others may follow from it.
void ThreadTeam::fail() {
  if (!failure_) failure_ = std::current_exception();
  changed_.notify_all();
}

// The checkpoints of the other threads.
void ThreadTeam::tell_caller() {
  const Lock lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
  ++visits_;
  changed_.notify_all();
}

// Makes the pending visits of the other threads on the caller's thread; false if there are none, or after a failure,
// since a visitor that has thrown is not called again. The lock is released meanwhile, so anything may have changed.
bool ThreadTeam::visit(Lock& lock) {
  if (visits_ == 0 || failure_ || std::this_thread::get_id() != caller_) return false;
  const int visits = std::exchange(visits_, 0);
  lock.unlock();
  try {
    checkpoint(visits * operations_between_visits);
    lock.lock();
  } catch (...) {
    lock.lock();
    fail();
  }
  return true;
}

}  // namespace lsgp

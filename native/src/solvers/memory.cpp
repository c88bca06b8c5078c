// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/memory.hpp"

#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>

#include "lsgp/errors.hpp"
#include "text.hpp"

namespace lsgp {

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

// The number after a word of a file, or its first one where no word is given; `otherwise` where there is none.
double number_in(const char* path, const std::string& word, double otherwise) {
  std::ifstream file(path);
  std::string read;
  while (!word.empty() && file >> read && read != word) {
  }
  double number = 0;
  return file >> number ? number : otherwise;
}

double left_on_the_machine() {
  const auto kilobytes = [](const char* word, double otherwise) {
    return 1024 * number_in("/proc/meminfo", word, otherwise);
  };
  return kilobytes("MemAvailable:", no_limit) + kilobytes("SwapFree:", 0);
}

// Files that were read lately count as used, but make room.
double left_in_the_container() {
  const double most = number_in("/sys/fs/cgroup/memory.max", "", no_limit);
  const double used = number_in("/sys/fs/cgroup/memory.current", "", 0);
  return most - used + number_in("/sys/fs/cgroup/memory.stat", "inactive_file", 0);
}

double left_to_the_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_limit;
  const double pages = number_in("/proc/self/statm", "", 0);
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

void require_memory(std::size_t bytes) {
  constexpr std::size_t small = 16 << 20;  // not worth reading files for
  if (bytes < small) return;
  const double needed = static_cast<double>(bytes);
  const double left = std::min({left_on_the_machine(), left_in_the_container(), left_to_the_process()});
  if (needed <= left) return;
  constexpr double megabyte = 1e6;
  throw Error(Code::out_of_memory, concat("This surface needs ", std::ceil(needed / megabyte), " MB of memory, and ",
                                          std::max(0.0, std::floor(left / megabyte)),
                                          " MB are left. Unwrap fewer faces at once, or close other programs."));
}

void prefer_huge_pages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t page = 1 << 21;
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + page - 1) / page * page, last = (address + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

}  // namespace lsgp

#else

namespace lsgp {

void require_memory(std::size_t) {}
void prefer_huge_pages(void*, std::size_t) {}

}  // namespace lsgp

#endif

namespace lsgp {

// glibc gives freed memory back beyond twice the largest block that was freed so far, of those up to 32 MB (mallopt(3),
// M_MMAP_THRESHOLD).  A block of that size, which is never touched, costs nothing.
void keep_freed_memory() {
#ifdef __GLIBC__
  static const bool is_kept = [] {
    void* volatile block = std::malloc((std::size_t(32) << 20) - 8192);  // volatile: compilers leave such pairs out
    std::free(block);
    return true;
  }();
  static_cast<void>(is_kept);
#endif
}

}  // namespace lsgp

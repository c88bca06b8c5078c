// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#if defined(__linux__)
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <string>
#elif defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX  // windows.h would make macros of std::min and std::max
#endif
#include <windows.h>
// After it:
#include <psapi.h>
#elif defined(__APPLE__)
#include <mach/mach.h>
#include <sys/sysctl.h>

#include <cstdint>
#endif

namespace lsgp {

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

#if defined(__linux__)

// The number that follows a word in a file, or the first number if no word is given; `otherwise` if there is none.
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

// The page cache of inactive files counts as used but is reclaimable.
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

#elif defined(_WIN32)

// The system's remaining commit limit: memory and paging files together.
double left_on_the_machine() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof(status);
  return GlobalMemoryStatusEx(&status) ? static_cast<double>(status.ullAvailPageFile) : no_limit;
}

// Containers and batch systems put processes into jobs, which may limit the memory of each and of all together.
JOBOBJECT_EXTENDED_LIMIT_INFORMATION job_limits() {
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
  if (!QueryInformationJobObject(nullptr, JobObjectExtendedLimitInformation, &limits, sizeof(limits), nullptr)) {
    limits.BasicLimitInformation.LimitFlags = 0;  // in no job
  }
  return limits;
}

double used_by_the_process() {
  PROCESS_MEMORY_COUNTERS counters{};
  counters.cb = sizeof(counters);
  return K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters))
             ? static_cast<double>(counters.PagefileUsage)
             : 0;
}

// The memory used by the job's other processes is unknown.
double left_in_the_container() {
  const JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = job_limits();
  if ((limits.BasicLimitInformation.LimitFlags & JOB_OBJECT_LIMIT_JOB_MEMORY) == 0) return no_limit;
  return static_cast<double>(limits.JobMemoryLimit) - used_by_the_process();
}

double left_to_the_process() {
  const JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = job_limits();
  if ((limits.BasicLimitInformation.LimitFlags & JOB_OBJECT_LIMIT_PROCESS_MEMORY) == 0) return no_limit;
  return static_cast<double>(limits.ProcessMemoryLimit) - used_by_the_process();
}

#elif defined(__APPLE__)

// Everything but wired memory can be compressed or swapped out.
double left_on_the_machine() {
  std::uint64_t size = 0;
  std::size_t length = sizeof(size);
  if (sysctlbyname("hw.memsize", &size, &length, nullptr, 0) != 0) return no_limit;
  vm_statistics64_data_t statistics{};
  mach_msg_type_number_t count = HOST_VM_INFO64_COUNT;
  const mach_port_t host = mach_host_self();
  vm_size_t page = 0;
  const bool is_known =
      host_page_size(host, &page) == KERN_SUCCESS &&
      host_statistics64(host, HOST_VM_INFO64, reinterpret_cast<host_info64_t>(&statistics), &count) == KERN_SUCCESS;
  mach_port_deallocate(mach_task_self(), host);
  const double wired = is_known ? static_cast<double>(statistics.wire_count) * static_cast<double>(page) : 0;
  task_vm_info_data_t own{};
  mach_msg_type_number_t own_count = TASK_VM_INFO_COUNT;
  const bool is_own_known =
      task_info(mach_task_self(), TASK_VM_INFO, reinterpret_cast<task_info_t>(&own), &own_count) == KERN_SUCCESS;
  return static_cast<double>(size) - wired - (is_own_known ? static_cast<double>(own.phys_footprint) : 0);
}

double left_in_the_container() { return no_limit; }  // there are none
double left_to_the_process() { return no_limit; }    // its own limit is not enforced

#else

double left_on_the_machine() { return no_limit; }
double left_in_the_container() { return no_limit; }
double left_to_the_process() { return no_limit; }

#endif

}  // namespace

double memory_left() { return std::min({left_on_the_machine(), left_in_the_container(), left_to_the_process()}); }

void require_memory(double bytes, GrowsWith grows_with) {
  constexpr double small = 16 << 20;  // not worth a query
  if (bytes < small) return;
  const double left = memory_left();
  if (!(bytes <= left)) throw MemoryShortage(bytes, left, grows_with);
}

#if defined(__linux__)

void prefer_huge_pages(void* begin, std::size_t bytes) {
  constexpr std::uintptr_t page = 1 << 21;
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + page - 1) / page * page, last = (address + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

#else

void prefer_huge_pages(void*, std::size_t) {}

#endif

}  // namespace lsgp

namespace lsgp {

// glibc returns free memory to the system above twice the size of the largest block freed so far, up to 32 MB
// (mallopt(3), M_MMAP_THRESHOLD). Allocating and freeing such a block without touching it costs nothing.
void keep_freed_memory() {
#ifdef __GLIBC__
  static const bool is_kept = [] {
    void* volatile block = std::malloc((std::size_t(32) << 20) - 8192);  // volatile: compilers elide such pairs
    std::free(block);
    return true;
  }();
  static_cast<void>(is_kept);
#endif
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Memory checks before large allocations, and paging hints.
#pragma once

#include <cstddef>

#include "lsgp/errors.hpp"

namespace lsgp {

// What else than the size of the input an amount of memory grows with.
enum class GrowsWith { input, conditions, quads };  // conditions: columns of dense matrices

// OUT_OF_MEMORY, in bytes.
class MemoryShortage : public Error {
 public:
  MemoryShortage(double needed, double left, GrowsWith grows_with)
      : Error(Code::out_of_memory, "There is not enough memory."), needed(needed), left(left), grows_with(grows_with) {}
  double needed, left;
  GrowsWith grows_with;
};

// Bytes that the process can still allocate.
double memory_left();

// Throws MemoryShortage before the allocation if the process cannot get that many more bytes. Linux overcommits and
// kills the process when the memory is used; other systems swap until they come to a standstill.
void require_memory(double bytes, GrowsWith grows_with = GrowsWith::input);

// Bytes of a matrix of doubles.
inline void require_matrix_memory(double rows, double columns, GrowsWith grows_with = GrowsWith::input) {
  require_memory(rows * columns * sizeof(double), grows_with);
}

// Requests huge pages for newly allocated memory, if it is large enough and the system has them: the first access to
// every small page costs a microsecond.
void prefer_huge_pages(void* begin, std::size_t bytes);

// Makes the process keep up to 64 MB of freed memory, so that the next map need not get it page by page again.
void keep_freed_memory();

}  // namespace lsgp

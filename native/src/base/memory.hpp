// SPDX-License-Identifier: GPL-3.0-or-later
// Memory checks before large allocations, and paging hints.
#pragma once

#include <cstddef>

namespace lsgp {

// The remedy to suggest if memory does not suffice.
constexpr const char* fewer_faces = "Unwrap fewer faces at once, or close other programs.";
constexpr const char* fewer_cones = "Use fewer cones, unwrap fewer faces at once, or close other programs.";

// Bytes that the process can still allocate.
double memory_left();

// Throws OUT_OF_MEMORY before the allocation if the process cannot get that many more bytes. Linux overcommits and
// kills the process when the memory is used; other systems swap until they come to a standstill.
void require_memory(double bytes, const char* remedy = fewer_faces);

// Bytes of a matrix of doubles.
inline void require_matrix_memory(double rows, double columns, const char* remedy = fewer_faces) {
  require_memory(rows * columns * sizeof(double), remedy);
}

// Requests huge pages for newly allocated memory, if it is large enough and the system has them: the first access to
// every small page costs a microsecond.
void prefer_huge_pages(void* begin, std::size_t bytes);

// Makes the process keep up to 64 MB of freed memory, so that the next map need not get it page by page again.
void keep_freed_memory();

}  // namespace lsgp

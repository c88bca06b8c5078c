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

// Throws OUT_OF_MEMORY where the process cannot have that much more, bytes, before anything is spent on it. Linux
// grants what it does not have and ends the process once it is used; others come to a standstill while they make room
// on the disk.
void require_memory(double bytes, const char* remedy = fewer_faces);

// Of a matrix of numbers.
inline void require_matrix_memory(double rows, double columns, const char* remedy = fewer_faces) {
  require_memory(rows * columns * sizeof(double), remedy);
}

// Asks for huge pages behind fresh memory, where it is large enough and the system has them: every small page costs a
// microsecond when it is touched first.
void prefer_huge_pages(void* begin, std::size_t bytes);

// Lets the process keep memory that is freed, up to 64 MB, so that the next map need not be given it page by page.
void keep_freed_memory();

}  // namespace lsgp

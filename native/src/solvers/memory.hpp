// SPDX-License-Identifier: GPL-3.0-or-later
// What large matrices ask of the system.
#pragma once

#include <cstddef>

namespace lsgp {

// Throws OUT_OF_MEMORY where the process cannot have that much more.  Linux grants what it does not have and ends the
// process once it is used; other systems refuse, or make room on the disk.
void require_memory(std::size_t bytes);

// Asks for huge pages behind fresh memory, where it is large enough and the system has them: every small page costs a
// microsecond when it is touched first.
void prefer_huge_pages(void* begin, std::size_t bytes);

// Lets the process keep memory that is freed, up to 64 MB, so that the next map need not be given it page by page.
void keep_freed_memory();

}  // namespace lsgp

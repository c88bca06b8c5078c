// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

namespace lsgp {

// Asks for huge pages behind fresh memory, where it is large enough and the system has them: every small page costs a
// microsecond when it is touched first.
void prefer_huge_pages(void* begin, std::size_t bytes);

}  // namespace lsgp

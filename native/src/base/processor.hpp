// SPDX-License-Identifier: GPL-3.0-or-later
// What the processor that the library runs on has.
#pragma once

namespace lsgp {

// Whether code for AVX2 and FMA runs on it.
bool has_avx2();

}  // namespace lsgp

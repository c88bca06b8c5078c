// SPDX-License-Identifier: GPL-3.0-or-later
// The innermost loop of comparing rasters, for every processor and for newer ones.
#pragma once

#include <cstdint>

#include "base/array.hpp"

namespace lsgp {

// Kernels count bits of eight in a byte, which holds those of so many words.
constexpr int most_words_at_once = 255 / 8;

// The bits that are set both in `a` and in the words that begin `shift` bits, fewer than 64, into those of `low` and go
// on in those of `high`: (count) words each, at most `most_words_at_once`.
using SharedBitsOfWords = int (*)(const std::uint64_t* a, const std::uint64_t* low, const std::uint64_t* high,
                                  int shift, int count);

// Those that this processor can run, the fastest one first. Their results are the same.
Array<SharedBitsOfWords> kernels_of_shared_bits();

}  // namespace lsgp

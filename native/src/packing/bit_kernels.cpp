// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/bit_kernels.hpp"

#include "base/processor.hpp"
#include "packing/bit_rows.hpp"

#ifdef LSGP_AVX2
#include <immintrin.h>
// Microsoft's compiler knows these instructions everywhere.
#if defined(_MSC_VER) && !defined(__clang__)
#define LSGP_FOR_AVX2
#else
#define LSGP_FOR_AVX2 __attribute__((target("avx2")))
#endif
#endif

namespace lsgp {

namespace {

using Word = std::uint64_t;

Word shifted(Word low, Word high, int shift) { return low >> shift | high << 1 << (BitRows::word_bits - 1 - shift); }

int on_any_processor(const Word* a, const Word* low, const Word* high, int shift, int count) {
  constexpr Word even_bytes = 0x00ff00ff00ff00ff, ones = 0x0001000100010001;
  Word sums = 0;
  for (int i = 0; i < count; ++i) sums += bits_of_bytes(a[i] & shifted(low[i], high[i], shift));
  sums = (sums & even_bytes) + (sums >> 8 & even_bytes);
  return static_cast<int>(sums * ones >> 48);
}

#ifdef LSGP_AVX2
LSGP_FOR_AVX2 __m256i four(const Word* words) { return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words)); }

// Four words at once; the bits of each half of a byte are looked up in a table (Mula, Kurz and Lemire 2018).
LSGP_FOR_AVX2 int with_avx2(const Word* a, const Word* low, const Word* high, int shift, int count) {
  const __m256i bits = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                        0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m256i halves = _mm256_set1_epi8(0x0f);
  const __m128i right = _mm_cvtsi32_si128(shift), left = _mm_cvtsi32_si128(BitRows::word_bits - shift);
  __m256i sums = _mm256_setzero_si256();
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const __m256i other =
        _mm256_or_si256(_mm256_srl_epi64(four(low + i), right), _mm256_sll_epi64(four(high + i), left));
    const __m256i both = _mm256_and_si256(four(a + i), other);
    const __m256i lower = _mm256_shuffle_epi8(bits, _mm256_and_si256(both, halves));
    const __m256i upper = _mm256_shuffle_epi8(bits, _mm256_and_si256(_mm256_srli_epi16(both, 4), halves));
    sums = _mm256_add_epi8(sums, _mm256_add_epi8(lower, upper));
  }
  Word each[4];
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(each), _mm256_sad_epu8(sums, _mm256_setzero_si256()));
  const auto whole = static_cast<int>(each[0] + each[1] + each[2] + each[3]);
  return whole + on_any_processor(a + i, low + i, high + i, shift, count - i);
}
#endif

}  // namespace

Array<SharedBitsOfWords> kernels_of_shared_bits() {
#ifdef LSGP_AVX2
  if (has_avx2()) return {with_avx2, on_any_processor};
#endif
  return {on_any_processor};
}

}  // namespace lsgp

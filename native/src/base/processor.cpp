// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/processor.hpp"

#if defined(LSGP_AVX2) && defined(_MSC_VER)
#include <intrin.h>
#endif

namespace lsgp {

#if !defined(LSGP_AVX2)
bool has_avx2() { return false; }
#elif defined(_MSC_VER)
namespace {

bool is_set(unsigned long long bits, int bit) { return ((bits >> bit) & 1) != 0; }

}  // namespace

// As in Intel's manual: the instructions exist, and the system saves their registers on context switches.
bool has_avx2() {
  int leaf[4];  // EAX, EBX, ECX, EDX
  __cpuid(leaf, 0);
  if (leaf[0] < 7) return false;
  __cpuid(leaf, 1);
  const auto features = static_cast<unsigned>(leaf[2]);
  const bool has_fma = is_set(features, 12), has_xgetbv = is_set(features, 27), has_avx = is_set(features, 28);
  if (!has_fma || !has_xgetbv || !has_avx) return false;
  const unsigned long long kept = _xgetbv(0);
  __cpuidex(leaf, 7, 0);
  return is_set(kept, 1) && is_set(kept, 2) && is_set(static_cast<unsigned>(leaf[1]), 5);
}
#else
bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#endif

}  // namespace lsgp

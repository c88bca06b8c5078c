// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/dense_kernels.hpp"

#include <complex>

#include "base/processor.hpp"

namespace lsgp {

namespace baseline {
extern const DenseKernels<double> real_kernels;
extern const DenseKernels<std::complex<double>> complex_kernels;
}  // namespace baseline

#ifdef LSGP_AVX2
namespace avx2 {
extern const DenseKernels<double> real_kernels;
extern const DenseKernels<std::complex<double>> complex_kernels;
}  // namespace avx2

template <>
const DenseKernels<double>& dense_kernels() {
  static const DenseKernels<double>& kernels = has_avx2() ? avx2::real_kernels : baseline::real_kernels;
  return kernels;
}

template <>
const DenseKernels<std::complex<double>>& dense_kernels() {
  static const DenseKernels<std::complex<double>>& kernels =
      has_avx2() ? avx2::complex_kernels : baseline::complex_kernels;
  return kernels;
}
#else
template <>
const DenseKernels<double>& dense_kernels() {
  return baseline::real_kernels;
}

template <>
const DenseKernels<std::complex<double>>& dense_kernels() {
  return baseline::complex_kernels;
}
#endif

}  // namespace lsgp

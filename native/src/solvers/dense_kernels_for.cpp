// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once for every instruction set: LSGP_INSTRUCTIONS is the namespace that its code lives in.  Eigen is renamed
// alike, or the linker might take what was compiled for one machine to run on another.
#include <Eigen/Cholesky>
#include <cmath>
#include <complex>

#include "solvers/dense_kernels.hpp"

namespace lsgp::LSGP_INSTRUCTIONS {

namespace {

template <typename Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <typename Scalar>
using Block = Eigen::Map<Dense<Scalar>, 0, Eigen::OuterStride<>>;

// Up to here plain loops are faster than kernels that pack their operands.
constexpr int narrow_columns = 8;
constexpr int short_below = 24;

inline double conjugate(double x) { return x; }
inline std::complex<double> conjugate(const std::complex<double>& x) { return {x.real(), -x.imag()}; }
inline double real_part(double x) { return x; }
inline double real_part(const std::complex<double>& x) { return x.real(); }

// out (count) -= sum over columns of factor * column, four columns at a time.
template <typename Scalar>
inline void subtract_columns(Scalar* __restrict out, int count, const Scalar* columns, long stride,
                             const Scalar* factors, long factor_stride, int column_count) {
  int k = 0;
  for (; k + 4 <= column_count; k += 4) {
    const Scalar* __restrict a = columns + k * stride;
    const Scalar* __restrict b = a + stride, * __restrict c = b + stride, * __restrict d = c + stride;
    const Scalar fa = conjugate(factors[k * factor_stride]), fb = conjugate(factors[(k + 1) * factor_stride]),
                 fc = conjugate(factors[(k + 2) * factor_stride]), fd = conjugate(factors[(k + 3) * factor_stride]);
    for (int i = 0; i < count; ++i) out[i] -= fa * a[i] + fb * b[i] + fc * c[i] + fd * d[i];
  }
  for (; k < column_count; ++k) {
    const Scalar* __restrict a = columns + k * stride;
    const Scalar fa = conjugate(factors[k * factor_stride]);
    for (int i = 0; i < count; ++i) out[i] -= fa * a[i];
  }
}

// Column by column, each in terms of those before it.
template <typename Scalar>
bool factor_narrow(Scalar* panel, int rows, int columns) {
  for (int j = 0; j < columns; ++j) {
    Scalar* column = panel + static_cast<long>(j) * rows;
    subtract_columns(column + j, rows - j, panel + j, static_cast<long>(rows), panel + j, static_cast<long>(rows), j);
    const double pivot = real_part(column[j]);
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot), inverse = 1 / root;
    column[j] = root;
    for (int i = j + 1; i < rows; ++i) column[i] *= inverse;
  }
  return true;
}

template <typename Scalar>
bool factor_wide(Scalar* panel, int rows, int columns) {
  Block<Scalar> square(panel, columns, columns, Eigen::OuterStride<>(rows));
  Eigen::LLT<Eigen::Ref<Dense<Scalar>>> factor(square);
  if (factor.info() != Eigen::Success || !(square.diagonal().real().array() > 0).all()) return false;
  Block<Scalar> below(panel + columns, rows - columns, columns, Eigen::OuterStride<>(rows));
  square.template triangularView<Eigen::Lower>().adjoint().template solveInPlace<Eigen::OnTheRight>(below);
  return true;
}

template <typename Scalar>
bool eliminate(const Front<Scalar>& front, Scalar* outer) {
  const int rows = front.columns + front.below, free = front.below - front.retained;
  const bool narrow = front.columns <= narrow_columns;
  if (!(narrow ? factor_narrow(front.panel, rows, front.columns) : factor_wide(front.panel, rows, front.columns))) {
    return false;
  }
  if (front.below == 0) return true;
  const Scalar* below = front.panel + front.columns;
  const long stride = rows;
  if (narrow || front.below <= short_below) {
    for (int c = 0; c < free; ++c) {
      Scalar* column = front.update + static_cast<long>(c) * front.below;
      subtract_columns(column + c, front.below - c, below + c, stride, below + c, stride, front.columns);
    }
    for (int c = 0; c < front.retained; ++c) {
      Scalar* column = outer + static_cast<long>(c) * front.retained;
      for (int i = c; i < front.retained; ++i) column[i] = 0;
      const Scalar* at = below + free + c;
      subtract_columns(column + c, front.retained - c, at, stride, at, stride, front.columns);
    }
    return true;
  }
  const Block<Scalar> all(front.panel + front.columns, front.below, front.columns, Eigen::OuterStride<>(rows));
  if (free > 0) {
    Block<Scalar> update(front.update, front.below, free, Eigen::OuterStride<>(front.below));
    Block<Scalar> square(front.update, free, free, Eigen::OuterStride<>(front.below));
    square.template selfadjointView<Eigen::Lower>().rankUpdate(all.topRows(free), Scalar(-1));
    if (front.retained > 0) {
      update.bottomRows(front.retained).noalias() -= all.bottomRows(front.retained) * all.topRows(free).adjoint();
    }
  }
  if (front.retained > 0) {
    Block<Scalar> product(outer, front.retained, front.retained, Eigen::OuterStride<>(front.retained));
    product.template triangularView<Eigen::Lower>().setZero();
    product.template selfadjointView<Eigen::Lower>().rankUpdate(all.bottomRows(front.retained), Scalar(-1));
  }
  return true;
}

// Columns are taken several at a time, so that what they act on is read and written once for all of them.
constexpr int columns_at_once = 4;

template <typename Scalar, int width, int group>
void forward_group(const Front<Scalar>& front, int first, Scalar* __restrict own, Scalar* __restrict others) {
  const long rows = front.columns + front.below;
  const Scalar* __restrict column[group];
  Scalar x[group][width];
  for (int g = 0; g < group; ++g) {
    const int j = first + g;
    column[g] = front.panel + j * rows;
    const double inverse = 1 / real_part(column[g][j]);
    for (int w = 0; w < width; ++w) {
      Scalar value = own[j * width + w];
      for (int k = 0; k < g; ++k) value -= column[k][j] * x[k][w];
      own[j * width + w] = x[g][w] = value * inverse;
    }
  }
  for (int i = first + group; i < front.columns; ++i) {
    for (int g = 0; g < group; ++g) {
      for (int w = 0; w < width; ++w) own[i * width + w] -= column[g][i] * x[g][w];
    }
  }
  for (int g = 0; g < group; ++g) column[g] += front.columns;
  for (int i = 0; i < front.below; ++i) {
    Scalar sum[width];
    for (int w = 0; w < width; ++w) sum[w] = others[i * width + w];
    for (int g = 0; g < group; ++g) {
      for (int w = 0; w < width; ++w) sum[w] += column[g][i] * x[g][w];
    }
    for (int w = 0; w < width; ++w) others[i * width + w] = sum[w];
  }
}

template <typename Scalar, int width>
void substitute_forward_rows(const Front<Scalar>& front, Scalar* own, Scalar* others) {
  for (int i = 0; i < front.below * width; ++i) others[i] = 0;
  int j = 0;
  for (; j + columns_at_once <= front.columns; j += columns_at_once) {
    forward_group<Scalar, width, columns_at_once>(front, j, own, others);
  }
  for (; j < front.columns; ++j) forward_group<Scalar, width, 1>(front, j, own, others);
}

template <typename Scalar, int width, int group>
void backward_group(const Front<Scalar>& front, int first, Scalar* __restrict own, const Scalar* __restrict others) {
  const long rows = front.columns + front.below;
  const Scalar* __restrict column[group];
  Scalar x[group][width];
  for (int g = 0; g < group; ++g) {
    column[g] = front.panel + (first + g) * rows;
    for (int w = 0; w < width; ++w) x[g][w] = own[(first + g) * width + w];
  }
  for (int i = first + group; i < front.columns; ++i) {
    for (int g = 0; g < group; ++g) {
      const Scalar factor = conjugate(column[g][i]);
      for (int w = 0; w < width; ++w) x[g][w] -= factor * own[i * width + w];
    }
  }
  for (int i = 0; i < front.below; ++i) {
    for (int g = 0; g < group; ++g) {
      const Scalar factor = conjugate(column[g][front.columns + i]);
      for (int w = 0; w < width; ++w) x[g][w] -= factor * others[i * width + w];
    }
  }
  for (int g = group; g-- > 0;) {
    const double inverse = 1 / real_part(column[g][first + g]);
    for (int w = 0; w < width; ++w) {
      for (int k = g + 1; k < group; ++k) x[g][w] -= conjugate(column[g][first + k]) * x[k][w];
      own[(first + g) * width + w] = x[g][w] *= inverse;
    }
  }
}

template <typename Scalar, int width>
void substitute_backward_rows(const Front<Scalar>& front, Scalar* own, const Scalar* others) {
  int j = front.columns;
  for (; j % columns_at_once != 0; --j) backward_group<Scalar, width, 1>(front, j - 1, own, others);
  for (; j > 0; j -= columns_at_once) {
    backward_group<Scalar, width, columns_at_once>(front, j - columns_at_once, own, others);
  }
}

template <typename Scalar>
void substitute_forward(const Front<Scalar>& front, int width, Scalar* own, Scalar* others) {
  switch (width) {
    case 1: return substitute_forward_rows<Scalar, 1>(front, own, others);
    case 2: return substitute_forward_rows<Scalar, 2>(front, own, others);
    default: return substitute_forward_rows<Scalar, 8>(front, own, others);
  }
}

template <typename Scalar>
void substitute_backward(const Front<Scalar>& front, int width, Scalar* own, const Scalar* others) {
  switch (width) {
    case 1: return substitute_backward_rows<Scalar, 1>(front, own, others);
    case 2: return substitute_backward_rows<Scalar, 2>(front, own, others);
    default: return substitute_backward_rows<Scalar, 8>(front, own, others);
  }
}

template <typename Scalar>
void add_gram(const Scalar* matrix, int rows, int count, Scalar* sum) {
  const Eigen::Map<const Dense<Scalar>> a(matrix, rows, count);
  Eigen::Map<Dense<Scalar>>(sum, count, count).template selfadjointView<Eigen::Lower>().rankUpdate(a.adjoint());
}

template <typename Scalar>
constexpr DenseKernels<Scalar> table{&eliminate<Scalar>, &substitute_forward<Scalar>, &substitute_backward<Scalar>,
                                     &add_gram<Scalar>};

}  // namespace

extern const DenseKernels<double> real_kernels = table<double>;
extern const DenseKernels<std::complex<double>> complex_kernels = table<std::complex<double>>;

}  // namespace lsgp::LSGP_INSTRUCTIONS

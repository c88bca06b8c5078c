// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once for every instruction set: LSGP_INSTRUCTIONS is the namespace that its code lives in.  Eigen is renamed
// alike, or the linker might take what was compiled for one machine to run on another.
#include <Eigen/Cholesky>
#include <cmath>
#include <complex>

#include "solvers/front_kernels.hpp"

namespace lsgp::LSGP_INSTRUCTIONS {

namespace {

template <typename Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <typename Scalar>
using Block = Eigen::Map<Dense<Scalar>, 0, Eigen::OuterStride<>>;
template <typename Scalar>
using Column = Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;
template <typename Scalar>
using ConstColumn = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;

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

template <typename Scalar, int width>
void substitute_forward_rows(const Front<Scalar>& front, Scalar* __restrict own, Scalar* __restrict others) {
  const int rows = front.columns + front.below;
  for (int i = 0; i < front.below * width; ++i) others[i] = 0;
  for (int j = 0; j < front.columns; ++j) {
    const Scalar* __restrict column = front.panel + static_cast<long>(j) * rows;
    const double inverse = 1 / real_part(column[j]);
    Scalar x[width];
    for (int w = 0; w < width; ++w) x[w] = own[j * width + w] *= inverse;
    for (int i = j + 1; i < front.columns; ++i) {
      for (int w = 0; w < width; ++w) own[i * width + w] -= column[i] * x[w];
    }
    const Scalar* __restrict below = column + front.columns;
    for (int i = 0; i < front.below; ++i) {
      for (int w = 0; w < width; ++w) others[i * width + w] += below[i] * x[w];
    }
  }
}

template <typename Scalar, int width>
void substitute_backward_rows(const Front<Scalar>& front, Scalar* __restrict own, const Scalar* __restrict others) {
  const int rows = front.columns + front.below;
  for (int j = front.columns; j-- > 0;) {
    const Scalar* __restrict column = front.panel + static_cast<long>(j) * rows;
    const double inverse = 1 / real_part(column[j]);
    if constexpr (width == 1) {
      const int inner = front.columns - j - 1;
      Scalar sum = own[j];
      if (front.below > 0) {
        sum -= ConstColumn<Scalar>(column + front.columns, front.below).dot(ConstColumn<Scalar>(others, front.below));
      }
      if (inner > 0) sum -= ConstColumn<Scalar>(column + j + 1, inner).dot(ConstColumn<Scalar>(own + j + 1, inner));
      own[j] = sum * inverse;
    } else {
      Scalar x[width];
      for (int w = 0; w < width; ++w) x[w] = own[j * width + w];
      for (int i = j + 1; i < front.columns; ++i) {
        const Scalar factor = conjugate(column[i]);
        for (int w = 0; w < width; ++w) x[w] -= factor * own[i * width + w];
      }
      const Scalar* __restrict below = column + front.columns;
      for (int i = 0; i < front.below; ++i) {
        const Scalar factor = conjugate(below[i]);
        for (int w = 0; w < width; ++w) x[w] -= factor * others[i * width + w];
      }
      for (int w = 0; w < width; ++w) own[j * width + w] = x[w] * inverse;
    }
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
constexpr FrontKernels<Scalar> table{&eliminate<Scalar>, &substitute_forward<Scalar>, &substitute_backward<Scalar>};

}  // namespace

extern const FrontKernels<double> real_kernels = table<double>;
extern const FrontKernels<std::complex<double>> complex_kernels = table<std::complex<double>>;

}  // namespace lsgp::LSGP_INSTRUCTIONS

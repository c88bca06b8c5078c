// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once for every instruction set: LSGP_INSTRUCTIONS is the namespace of its code. The build renames Eigen's
// namespace likewise (-DEigen=Eigen_avx2), since inline functions of one name that several files define are linked
// once: code for a newer instruction set would run on machines without it. The renaming does not depend on the version
// of Eigen: the preprocessor replaces the identifier, never the path in #include <Eigen/...>, and this file shares no
// Eigen types with others. If a new version of Eigen prevents it, this file does not compile. With Eigen 3.4 and 5.0
// optimized objects have no inline functions outside the renamed namespace: `nm -C` lists none as W.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <type_traits>

#include "solvers/dense_kernels.hpp"

#ifdef EIGEN_CPUID
#error "Eigen would divide products by the caches of the machine it runs on: define EIGEN_NO_CPUID everywhere."
#endif

namespace lsgp::LSGP_INSTRUCTIONS {

namespace {

template <typename Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <typename Scalar>
using Block = Eigen::Map<Dense<Scalar>, 0, Eigen::OuterStride<>>;
template <typename Scalar>
using ConstBlock = Eigen::Map<const Dense<Scalar>, 0, Eigen::OuterStride<>>;
template <typename Scalar>
using Column = Eigen::Map<
    std::conditional_t<std::is_const_v<Scalar>, const Eigen::Matrix<std::remove_const_t<Scalar>, Eigen::Dynamic, 1>,
                       Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>>;

// Below these sizes plain loops are faster than kernels that pack their operands.
constexpr int narrow_columns = 16;
constexpr int short_below = 48;

inline double conjugate(double x) { return x; }
inline std::complex<double> conjugate(const std::complex<double>& x) { return {x.real(), -x.imag()}; }
inline double real_part(double x) { return x; }
inline double real_part(const std::complex<double>& x) { return x.real(); }

// Kernels of more than five parameters take their operands one by one, as in the BLAS: with structs the compiler
// generates code that rounds differently.

// out (count) -= sum over columns of factor * column, four columns at a time.
template <typename Scalar>
// NOLINTNEXTLINE(readability-function-size)
inline void subtract_columns(Scalar* __restrict out, int count, const Scalar* columns, std::ptrdiff_t stride,
                             const Scalar* factors, std::ptrdiff_t factor_stride, int column_count) {
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
    Scalar* column = panel + static_cast<std::ptrdiff_t>(j) * rows;
    subtract_columns(column + j, rows - j, panel + j, rows, panel + j, rows, j);
    const double pivot = real_part(column[j]);
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot), inverse = 1 / root;
    column[j] = root;
    for (int i = j + 1; i < rows; ++i) column[i] *= inverse;
  }
  return true;
}

template <typename Scalar>
bool factor_square(Scalar* square, int size, std::ptrdiff_t stride) {
  Block<Scalar> block(square, size, size, Eigen::OuterStride<>(stride));
  for (int k = 0; k < size; ++k) {
    const int below = size - k - 1;
    const auto row = block.row(k).head(k);
    auto column = block.col(k).tail(below);
    double pivot = real_part(block(k, k));
    if (k > 0) pivot -= row.squaredNorm();
    if (!(pivot > 0)) return false;
    const double root = std::sqrt(pivot);
    block(k, k) = root;
    if (k > 0 && below > 0) column.noalias() -= block.bottomLeftCorner(below, k) * row.adjoint();
    column /= root;
  }
  return true;
}

template <typename Scalar>
void divide_rows(const Scalar* factor, int size, Scalar* block, int rows, std::ptrdiff_t stride) {
  Block<Scalar> out(block, rows, size, Eigen::OuterStride<>(stride));
  const ConstBlock<Scalar> square(factor, size, size, Eigen::OuterStride<>(stride));
  square.template triangularView<Eigen::Lower>().adjoint().template solveInPlace<Eigen::OnTheRight>(out);
}

template <typename Scalar>
// NOLINTNEXTLINE(readability-function-size)
void subtract_product(const Scalar* left, int rows, const Scalar* right, int columns, int depth, std::ptrdiff_t stride,
                      Scalar* out, std::ptrdiff_t out_stride) {
  const Eigen::OuterStride<> between(stride);
  Block<Scalar>(out, rows, columns, Eigen::OuterStride<>(out_stride)).noalias() -=
      ConstBlock<Scalar>(left, rows, depth, between) * ConstBlock<Scalar>(right, columns, depth, between).adjoint();
}

template <typename Scalar>
// NOLINTNEXTLINE(readability-function-size)
void subtract_square(const Scalar* left, int rows, int depth, std::ptrdiff_t stride, Scalar* out,
                     std::ptrdiff_t out_stride) {
  Block<Scalar> square(out, rows, rows, Eigen::OuterStride<>(out_stride));
  square.template selfadjointView<Eigen::Lower>().rankUpdate(
      ConstBlock<Scalar>(left, rows, depth, Eigen::OuterStride<>(stride)), Scalar(-1));
}

// Block by block; Eigen::LLT would also compute a norm.
template <typename Scalar>
bool factor_wide(Scalar* panel, int rows, int columns) {
  constexpr int small = 32, least = 8, most = 128, step = 16;
  const int width = columns < small ? columns : std::clamp(columns / 8 / step * step, least, most);
  for (int k = 0; k < columns; k += width) {
    const int size = std::min(width, columns - k), below = columns - k - size;
    Scalar* square = panel + static_cast<std::ptrdiff_t>(k) * (rows + 1);
    if (!factor_square(square, size, rows)) return false;
    if (below == 0) break;
    divide_rows(square, size, square + size, below, rows);
    subtract_square(square + size, below, size, rows, square + static_cast<std::ptrdiff_t>(size) * (rows + 1), rows);
  }
  divide_rows(panel, columns, panel + columns, rows - columns, rows);
  return true;
}

inline bool has_plain_update(int columns, int below) { return columns <= narrow_columns || below <= short_below; }

template <typename Scalar>
bool eliminate(const Front<Scalar>& front) {
  const int rows = front.columns + front.below, free = front.below - front.retained;
  const bool narrow = front.columns <= narrow_columns;
  if (!(narrow ? factor_narrow(front.panel, rows, front.columns) : factor_wide(front.panel, rows, front.columns))) {
    return false;
  }
  const Scalar* below = front.panel + front.columns;
  const std::ptrdiff_t stride = rows;
  if (has_plain_update(front.columns, front.below)) {
    for (int c = 0; c < free; ++c) {
      Scalar* column = front.update + static_cast<std::ptrdiff_t>(c) * front.below;
      subtract_columns(column + c, front.below - c, below + c, stride, below + c, stride, front.columns);
    }
  } else if (free > 0) {
    subtract_square(below, free, front.columns, stride, front.update, front.below);
    if (front.retained > 0) {
      subtract_product(below + free, front.retained, below, free, front.columns, stride, front.update + free,
                       front.below);
    }
  }
  return true;
}

template <typename Scalar>
void subtract_outer(const Front<Scalar>& front, Scalar* outer) {
  const std::ptrdiff_t stride = front.columns + front.below;
  const Scalar* retained = front.panel + stride - front.retained;
  for (int c = 0; c < front.retained; ++c) {
    Scalar* column = outer + static_cast<std::ptrdiff_t>(c) * front.retained;
    for (int i = c; i < front.retained; ++i) column[i] = 0;
  }
  if (!has_plain_update(front.columns, front.below)) {
    return subtract_square(retained, front.retained, front.columns, stride, outer, front.retained);
  }
  for (int c = 0; c < front.retained; ++c) {
    Scalar* column = outer + static_cast<std::ptrdiff_t>(c) * front.retained;
    const Scalar* at = retained + c;
    subtract_columns(column + c, front.retained - c, at, stride, at, stride, front.columns);
  }
}

// One number of each right-hand side.
template <typename Scalar, int width>
using Sides = Eigen::Array<Scalar, width, 1>;
template <typename Scalar, int width>
inline Eigen::Map<Sides<Scalar, width>> sides(Scalar* first, int row) {
  return Eigen::Map<Sides<Scalar, width>>(first + static_cast<std::ptrdiff_t>(row) * width);
}
template <typename Scalar, int width>
inline Eigen::Map<const Sides<Scalar, width>> sides(const Scalar* first, int row) {
  return Eigen::Map<const Sides<Scalar, width>>(first + static_cast<std::ptrdiff_t>(row) * width);
}

// Columns are taken four at a time, so that their operand is read and written once for all four, and in separate
// variables, so that they stay in registers.
template <typename Scalar, int width>
void forward_four(const Front<Scalar>& front, int j, Scalar* own, Scalar* others) {
  const std::ptrdiff_t rows = front.columns + front.below;
  const Scalar *a = front.panel + j * rows, *b = a + rows, *c = b + rows, *d = c + rows;
  using Values = Sides<Scalar, width>;
  const Values x = sides<Scalar, width>(own, j) * (1 / real_part(a[j]));
  const Values y = (sides<Scalar, width>(own, j + 1) - a[j + 1] * x) * (1 / real_part(b[j + 1]));
  const Values z = (sides<Scalar, width>(own, j + 2) - a[j + 2] * x - b[j + 2] * y) * (1 / real_part(c[j + 2]));
  const Values w =
      (sides<Scalar, width>(own, j + 3) - a[j + 3] * x - b[j + 3] * y - c[j + 3] * z) * (1 / real_part(d[j + 3]));
  sides<Scalar, width>(own, j) = x;
  sides<Scalar, width>(own, j + 1) = y;
  sides<Scalar, width>(own, j + 2) = z;
  sides<Scalar, width>(own, j + 3) = w;
  for (int i = j + 4; i < front.columns; ++i) {
    sides<Scalar, width>(own, i) -= a[i] * x + b[i] * y + c[i] * z + d[i] * w;
  }
  a += front.columns;
  b += front.columns;
  c += front.columns;
  d += front.columns;
  for (int i = 0; i < front.below; ++i) {
    sides<Scalar, width>(others, i) += a[i] * x + b[i] * y + c[i] * z + d[i] * w;
  }
}

template <typename Scalar, int width>
void forward_one(const Front<Scalar>& front, int j, Scalar* own, Scalar* others) {
  const Scalar* a = front.panel + static_cast<std::ptrdiff_t>(j) * (front.columns + front.below);
  const Sides<Scalar, width> x = sides<Scalar, width>(own, j) * (1 / real_part(a[j]));
  sides<Scalar, width>(own, j) = x;
  for (int i = j + 1; i < front.columns; ++i) sides<Scalar, width>(own, i) -= a[i] * x;
  for (int i = 0; i < front.below; ++i) sides<Scalar, width>(others, i) += a[front.columns + i] * x;
}

template <typename Scalar, int width>
void substitute_forward_rows(const Front<Scalar>& front, Scalar* own, Scalar* others) {
  for (int i = 0; i < front.below * width; ++i) others[i] = 0;
  int j = 0;
  for (; j + 4 <= front.columns; j += 4) forward_four<Scalar, width>(front, j, own, others);
  for (; j < front.columns; ++j) forward_one<Scalar, width>(front, j, own, others);
}

template <typename Scalar, int width>
void backward_four(const Front<Scalar>& front, int j, Scalar* own, const Scalar* others) {
  const std::ptrdiff_t rows = front.columns + front.below;
  const Scalar *a = front.panel + j * rows, *b = a + rows, *c = b + rows, *d = c + rows;
  using Values = Sides<Scalar, width>;
  Values x = sides<Scalar, width>(own, j), y = sides<Scalar, width>(own, j + 1), z = sides<Scalar, width>(own, j + 2),
         w = sides<Scalar, width>(own, j + 3);
  const auto subtract = [&](std::ptrdiff_t row, const Values& known) {
    x -= conjugate(a[row]) * known;
    y -= conjugate(b[row]) * known;
    z -= conjugate(c[row]) * known;
    w -= conjugate(d[row]) * known;
  };
  for (int i = j + 4; i < front.columns; ++i) subtract(i, sides<Scalar, width>(own, i));
  for (int i = 0; i < front.below; ++i) subtract(front.columns + i, sides<Scalar, width>(others, i));
  w *= 1 / real_part(d[j + 3]);
  z = (z - conjugate(c[j + 3]) * w) * (1 / real_part(c[j + 2]));
  y = (y - conjugate(b[j + 3]) * w - conjugate(b[j + 2]) * z) * (1 / real_part(b[j + 1]));
  x = (x - conjugate(a[j + 3]) * w - conjugate(a[j + 2]) * z - conjugate(a[j + 1]) * y) * (1 / real_part(a[j]));
  sides<Scalar, width>(own, j) = x;
  sides<Scalar, width>(own, j + 1) = y;
  sides<Scalar, width>(own, j + 2) = z;
  sides<Scalar, width>(own, j + 3) = w;
}

template <typename Scalar, int width>
void backward_one(const Front<Scalar>& front, int j, Scalar* own, const Scalar* others) {
  const Scalar* a = front.panel + static_cast<std::ptrdiff_t>(j) * (front.columns + front.below);
  Sides<Scalar, width> x = sides<Scalar, width>(own, j);
  for (int i = j + 1; i < front.columns; ++i) x -= conjugate(a[i]) * sides<Scalar, width>(own, i);
  for (int i = 0; i < front.below; ++i) x -= conjugate(a[front.columns + i]) * sides<Scalar, width>(others, i);
  sides<Scalar, width>(own, j) = x * (1 / real_part(a[j]));
}

template <typename Scalar, int width>
void substitute_backward_rows(const Front<Scalar>& front, Scalar* own, const Scalar* others) {
  int j = front.columns;
  for (; j % 4 != 0; --j) backward_one<Scalar, width>(front, j - 1, own, others);
  for (; j > 0; j -= 4) backward_four<Scalar, width>(front, j - 4, own, others);
}

// A single right-hand side: except on small fronts, products with a few columns at a time are faster than these loops,
// three times as fast for complex numbers.
constexpr int least_rows_of_products = 24, columns_of_products = 8;

template <typename Scalar>
void substitute_forward_single(const Front<Scalar>& front, Scalar* own, Scalar* others) {
  const std::ptrdiff_t rows = front.columns + front.below;
  const Eigen::OuterStride<> stride(rows);
  Column<Scalar> below(others, front.below);
  below.setZero();
  for (int begin = 0; begin < front.columns; begin += columns_of_products) {
    const int end = std::min(begin + columns_of_products, front.columns);
    for (int j = begin; j < end; ++j) {
      const Scalar* column = front.panel + j * rows;
      own[j] *= 1 / real_part(column[j]);
      for (int i = j + 1; i < end; ++i) own[i] -= column[i] * own[j];
    }
    const Scalar* panel = front.panel + begin * rows;
    const int count = end - begin, left = front.columns - end;
    const Column<const Scalar> x(own + begin, count);
    Column<Scalar>(own + end, left).noalias() -= ConstBlock<Scalar>(panel + end, left, count, stride) * x;
    below.noalias() += ConstBlock<Scalar>(panel + front.columns, front.below, count, stride) * x;
  }
}

template <typename Scalar>
void substitute_backward_single(const Front<Scalar>& front, Scalar* own, const Scalar* others) {
  const std::ptrdiff_t rows = front.columns + front.below;
  const Eigen::OuterStride<> stride(rows);
  const Column<const Scalar> below(others, front.below);
  const int last = (front.columns - 1) / columns_of_products * columns_of_products;
  for (int begin = last; begin >= 0; begin -= columns_of_products) {
    const int end = std::min(begin + columns_of_products, front.columns);
    const Scalar* panel = front.panel + begin * rows;
    const int count = end - begin, left = front.columns - end;
    Column<Scalar> x(own + begin, count);
    x.noalias() -=
        ConstBlock<Scalar>(panel + end, left, count, stride).adjoint() * Column<const Scalar>(own + end, left);
    x.noalias() -= ConstBlock<Scalar>(panel + front.columns, front.below, count, stride).adjoint() * below;
    for (int j = end - 1; j >= begin; --j) {
      const Scalar* column = front.panel + j * rows;
      for (int i = j + 1; i < end; ++i) own[j] -= conjugate(column[i]) * own[i];
      own[j] *= 1 / real_part(column[j]);
    }
  }
}

template <typename Scalar>
bool is_small(const Front<Scalar>& front) {
  return front.columns + front.below < least_rows_of_products;
}

template <typename Scalar>
void substitute_forward(const Front<Scalar>& front, int width, Scalar* own, Scalar* others) {
  switch (width) {
    case 1:
      return is_small(front) ? substitute_forward_rows<Scalar, 1>(front, own, others)
                             : substitute_forward_single(front, own, others);
    case 2: return substitute_forward_rows<Scalar, 2>(front, own, others);
    default: return substitute_forward_rows<Scalar, 8>(front, own, others);
  }
}

template <typename Scalar>
void substitute_backward(const Front<Scalar>& front, int width, Scalar* own, const Scalar* others) {
  switch (width) {
    case 1:
      return is_small(front) ? substitute_backward_rows<Scalar, 1>(front, own, others)
                             : substitute_backward_single(front, own, others);
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
constexpr DenseKernels<Scalar> table{
    &eliminate<Scalar>,          &subtract_outer<Scalar>,      &factor_square<Scalar>,
    &divide_rows<Scalar>,        &subtract_product<Scalar>,    &subtract_square<Scalar>,
    &substitute_forward<Scalar>, &substitute_backward<Scalar>, &add_gram<Scalar>};

}  // namespace

extern const DenseKernels<double> real_kernels = table<double>;
extern const DenseKernels<std::complex<double>> complex_kernels = table<std::complex<double>>;

}  // namespace lsgp::LSGP_INSTRUCTIONS

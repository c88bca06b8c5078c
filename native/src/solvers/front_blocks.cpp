// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/front_blocks.hpp"

#include <algorithm>
#include <complex>
#include <cstddef>
#include <utility>

#include "base/checkpoint.hpp"

namespace lsgp {

namespace {

constexpr int least_columns = 64;
constexpr double least_work = 2e7;  // multiplications: some milliseconds

// Rows or columns of a block: a multiple of what kernels take at once, so that each number is computed as in one block.
constexpr int block_size = 192;

// A number of rows in blocks of at least `block_size`, the last of which has the rest.
struct Blocks {
  explicit Blocks(int rows) : rows(rows), count(std::max(1, rows / block_size)) {}
  int begin(int block) const { return block * block_size; }
  int size(int block) const { return (block + 1 < count ? begin(block + 1) : rows) - begin(block); }

  const int rows;
  const int count;
};

// The columns that Eigen's factorization takes at once.
int columns_at_once(int columns) { return std::clamp(columns / 8 / 16 * 16, 8, 128); }

template <typename Scalar>
class FrontBlocks {
 public:
  FrontBlocks(const Front<Scalar>& front, ThreadTeam& team)
      : front_(front), team_(team), kernels_(dense_kernels<Scalar>()), stride_(front.columns + front.below) {}

  bool factor() {
    const int step = columns_at_once(front_.columns);
    for (int begin = 0, count = 0; begin < front_.columns; begin += count) {
      count = std::min(step, front_.columns - begin);
      Scalar* corner = at(begin, begin);
      if (!kernels_.factor_square(corner, count, stride_)) return false;
      const int end = begin + count;
      divide_rows(corner, count, at(end, begin), front_.columns - end);
      subtract_square(at(end, begin), front_.columns - end, count, at(end, end), stride_);
    }
    divide_rows(front_.panel, front_.columns, at(front_.columns, 0), front_.below);
    return true;
  }

  void update() {
    const int free = front_.below - front_.retained;
    const Scalar* below = at(front_.columns, 0);
    subtract_square(below, free, front_.columns, front_.update, front_.below);
    subtract_product(below + free, front_.retained, below, free, front_.update + free);
  }

  void subtract_outer(Scalar* outer) {
    for (int c = 0; c < front_.retained; ++c) {
      Scalar* column = outer + static_cast<std::ptrdiff_t>(c) * front_.retained;
      std::fill(column + c, column + front_.retained, Scalar(0));
    }
    const Scalar* retained = at(front_.columns + front_.below - front_.retained, 0);
    subtract_square(retained, front_.retained, front_.columns, outer, front_.retained);
  }

 private:
  Scalar* at(int row, int column) const { return front_.panel + row + column * stride_; }

  void divide_rows(const Scalar* factor, int size, Scalar* rows, int count) {
    if (count == 0) return;
    const Blocks blocks(count);
    team_.run_each(blocks.count, [&](int i) {
      kernels_.divide_rows(factor, size, rows + blocks.begin(i), blocks.size(i), stride_);
      checkpoint(static_cast<double>(size) * size * blocks.size(i) / 2);
    });
  }

  void subtract_square(const Scalar* left, int rows, int depth, Scalar* out, std::ptrdiff_t out_stride) {
    if (rows == 0) return;
    const Blocks blocks(rows);
    Array<std::pair<int, int>> places;
    for (int c = 0; c < blocks.count; ++c) {
      for (int r = c; r < blocks.count; ++r) places.emplace_back(r, c);
    }
    team_.run_each(static_cast<int>(places.size()), [&](int i) {
      const auto [r, c] = places[i];
      const Scalar *upper = left + blocks.begin(c), *lower = left + blocks.begin(r);
      Scalar* to = out + blocks.begin(r) + blocks.begin(c) * out_stride;
      if (r == c) {
        kernels_.subtract_square(lower, blocks.size(r), depth, stride_, to, out_stride);
      } else {
        kernels_.subtract_product(lower, blocks.size(r), upper, blocks.size(c), depth, stride_, to, out_stride);
      }
      checkpoint(static_cast<double>(depth) * blocks.size(r) * blocks.size(c));
    });
  }

  // Into the update.
  void subtract_product(const Scalar* left, int rows, const Scalar* right, int columns, Scalar* out) {
    if (rows == 0 || columns == 0) return;
    const Blocks lower(rows), upper(columns);
    team_.run_each(lower.count * upper.count, [&](int i) {
      const int r = i % lower.count, c = i / lower.count;
      kernels_.subtract_product(left + lower.begin(r), lower.size(r), right + upper.begin(c), upper.size(c),
                                front_.columns, stride_,
                                out + lower.begin(r) + upper.begin(c) * std::ptrdiff_t{front_.below}, front_.below);
      checkpoint(static_cast<double>(front_.columns) * lower.size(r) * upper.size(c));
    });
  }

  const Front<Scalar>& front_;
  ThreadTeam& team_;
  const DenseKernels<Scalar>& kernels_;
  const std::ptrdiff_t stride_;
};

}  // namespace

template <typename Scalar>
bool has_blocks(const Front<Scalar>& front) {
  const double rows = front.columns + front.below;
  return front.columns >= least_columns && front.columns * rows * rows >= least_work;
}

template <typename Scalar>
bool eliminate_by_blocks(const Front<Scalar>& front, ThreadTeam& team) {
  FrontBlocks<Scalar> blocks(front, team);
  if (!blocks.factor()) return false;
  blocks.update();
  return true;
}

template <typename Scalar>
void subtract_outer_by_blocks(const Front<Scalar>& front, Scalar* outer, ThreadTeam& team) {
  FrontBlocks<Scalar>(front, team).subtract_outer(outer);
}

template bool has_blocks(const Front<double>&);
template bool has_blocks(const Front<std::complex<double>>&);
template bool eliminate_by_blocks(const Front<double>&, ThreadTeam&);
template bool eliminate_by_blocks(const Front<std::complex<double>>&, ThreadTeam&);
template void subtract_outer_by_blocks(const Front<double>&, double*, ThreadTeam&);
template void subtract_outer_by_blocks(const Front<std::complex<double>>&, std::complex<double>*, ThreadTeam&);

}  // namespace lsgp

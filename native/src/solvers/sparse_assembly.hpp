// SPDX-License-Identifier: GPL-3.0-or-later
// The lower triangle of a symmetric or Hermitian matrix from its entries in any order.
#pragma once

#include <Eigen/SparseCore>

#include "base/array.hpp"
#include "base/checkpoint.hpp"

namespace lsgp {

template <typename Scalar>
class LowerAssembly {
 public:
  explicit LowerAssembly(int size, std::size_t expected_entries = 0) : size_(size) {
    entries_.reserve(expected_entries);
  }

  // Adds to entry (row, column); the entry's mirror image is implied. Entries above the diagonal are mirrored.
  void add(int row, int column, const Scalar& value) {
    if (row >= column)
      entries_.push_back({row, column, value});
    else
      entries_.push_back({column, row, Eigen::numext::conj(value)});
  }

  // Two counting sorts, by row and then by column, leave every column in order of its rows; equal entries are added.
  // slot: if given, receives the index of every entry among the matrix's values, in the order in which they were added.
  Eigen::SparseMatrix<Scalar> build(Array<int>* slot = nullptr) const {
    const Array<int> by_row = sorted({}, [](const Entry& entry) { return entry.row; });
    const Array<int> by_column = sorted(by_row, [](const Entry& entry) { return entry.column; });
    checkpoint(operations_an_entry * static_cast<double>(entries_.size()));
    Eigen::SparseMatrix<Scalar> matrix(size_, size_);
    matrix.resizeNonZeros(static_cast<Eigen::Index>(entries_.size()));
    int* outer = matrix.outerIndexPtr();
    int filled = 0, column = -1;
    if (slot != nullptr) slot->resize(entries_.size());
    for (const int i : by_column) {
      const Entry& entry = entries_[i];
      while (column < entry.column) outer[++column] = filled;
      if (filled > outer[column] && matrix.innerIndexPtr()[filled - 1] == entry.row) {
        matrix.valuePtr()[filled - 1] += entry.value;
      } else {
        matrix.innerIndexPtr()[filled] = entry.row;
        matrix.valuePtr()[filled++] = entry.value;
      }
      if (slot != nullptr) (*slot)[i] = filled - 1;
    }
    while (column < size_) outer[++column] = filled;
    matrix.resizeNonZeros(filled);
    return matrix;
  }

 private:
  static constexpr double operations_an_entry = 10;  // of a pass over them

  struct Entry {
    int row, column;
    Scalar value;
  };

  template <typename Key>
  Array<int> sorted(const Array<int>& order, Key key) const {
    const int count = static_cast<int>(entries_.size());
    checkpoint(operations_an_entry * count);
    Array<int> cursor(size_ + 1, 0), out(count);
    for (const Entry& entry : entries_) ++cursor[key(entry) + 1];
    for (int i = 0; i < size_; ++i) cursor[i + 1] += cursor[i];
    for (int i = 0; i < count; ++i) {
      const int at = order.empty() ? i : order[i];
      out[cursor[key(entries_[at])]++] = at;
    }
    return out;
  }

  int size_;
  Array<Entry> entries_;
};

// A matrix that is assembled repeatedly from entries at the same positions in the same order.
template <typename Scalar>
class RepeatedAssembly {
 public:
  explicit RepeatedAssembly(int size) : size_(size) {}

  // fill(add) calls add(row, column, value) as for LowerAssembly.
  template <typename Fill>
  const Eigen::SparseMatrix<Scalar>& build(Fill fill) {
    if (slot_.empty()) {
      LowerAssembly<Scalar> assembly(size_);
      fill([&](int row, int column, const Scalar& value) { assembly.add(row, column, value); });
      matrix_ = assembly.build(&slot_);
      return matrix_;
    }
    matrix_.coeffs().setZero();
    std::size_t i = 0;
    fill([&](int row, int column, const Scalar& value) {
      matrix_.valuePtr()[slot_[i++]] += row >= column ? value : Eigen::numext::conj(value);
    });
    return matrix_;
  }

 private:
  int size_;
  Eigen::SparseMatrix<Scalar> matrix_;
  Array<int> slot_;
};

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Counts factorizations and back-substitutions.
#pragma once

#include "lsgp/linear_algebra.hpp"

namespace lsgp {

// Counts the operations of this thread on sparse matrices during its lifetime, without those of nested counters.
class LinearAlgebraCounter {
 public:
  LinearAlgebraCounter();
  ~LinearAlgebraCounter();
  LinearAlgebraCounter(const LinearAlgebraCounter&) = delete;
  LinearAlgebraCounter& operator=(const LinearAlgebraCounter&) = delete;
  LinearAlgebra counted() const;

 private:
  LinearAlgebra around_;
};

// Adds to the innermost counter of this thread.
void count_factorization();
void count_back_substitutions(int sides);

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Counts factorizations and back-substitutions.
#pragma once

#include "lsgp/result.hpp"

namespace lsgp {

// Counts what this thread does with sparse matrices while it lives, but for what another counter inside it counts.
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

// Adds to what the innermost counter of this thread counts.
void count_factorization();
void count_back_substitutions(int sides);

}  // namespace lsgp

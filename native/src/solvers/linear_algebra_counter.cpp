// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/linear_algebra_counter.hpp"

#include <utility>

namespace lsgp {

namespace {

LinearAlgebra& count_of_this_thread() {
  thread_local LinearAlgebra count;
  return count;
}

}  // namespace

LinearAlgebraCounter::LinearAlgebraCounter() : around_(std::exchange(count_of_this_thread(), {})) {}
LinearAlgebraCounter::~LinearAlgebraCounter() { count_of_this_thread() = around_; }
LinearAlgebra LinearAlgebraCounter::counted() const { return count_of_this_thread(); }

void count_factorization() { ++count_of_this_thread().factorizations; }
void count_back_substitutions(int sides) { count_of_this_thread().back_substitutions += sides; }

}  // namespace lsgp

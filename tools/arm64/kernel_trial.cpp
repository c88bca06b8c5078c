// SPDX-License-Identifier: GPL-3.0-or-later
// Calls one dense kernel a number of times: kernel_trial KERNEL real|complex TIMES. LSGP_INSTRUCTIONS is the namespace
// of the kernels, as in dense_kernels_for.cpp; count_instructions.py counts what is executed.
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "solvers/dense_kernels.hpp"

namespace lsgp::LSGP_INSTRUCTIONS {
extern const DenseKernels<double> real_kernels;
extern const DenseKernels<std::complex<double>> complex_kernels;
}  // namespace lsgp::LSGP_INSTRUCTIONS

namespace {

constexpr int columns = 64, below = 192, rows = columns + below;

template <typename Scalar>
bool run(const lsgp::DenseKernels<Scalar>& kernels, const std::string& kernel, int times) {
  // The leading columns of a positive definite matrix.
  std::vector<Scalar> start(static_cast<std::size_t>(rows) * columns, Scalar(0.01));
  for (int j = 0; j < columns; ++j) start[static_cast<std::size_t>(j) * (rows + 1)] = 4.0;
  std::vector<Scalar> panel(start), update(static_cast<std::size_t>(below) * below);
  const lsgp::Front<Scalar> front{panel.data(), columns, below, 0, update.data()};
  bool is_good = kernels.eliminate(front);
  std::vector<Scalar> own(columns, Scalar(1)), others(below, Scalar(1));
  for (int i = 0; i < times; ++i) {
    if (kernel == "eliminate") {
      panel = start;
      is_good = kernels.eliminate(front) && is_good;
    } else if (kernel == "substitute_forward") {
      kernels.substitute_forward(front, 1, own.data(), others.data());
    } else if (kernel == "substitute_backward") {
      kernels.substitute_backward(front, 1, own.data(), others.data());
    } else if (kernel == "add_gram") {
      kernels.add_gram(panel.data(), rows, columns, update.data());
    } else {
      return false;
    }
  }
  return is_good && std::isfinite(std::abs(own[0])) && std::isfinite(std::abs(update[0]));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const std::string kernel = arguments[1], numbers = arguments[2];
  const int times = std::atoi(arguments[3]);
  using namespace lsgp::LSGP_INSTRUCTIONS;
  return (numbers == "real" ? run(real_kernels, kernel, times) : run(complex_kernels, kernel, times)) ? 0 : 1;
}

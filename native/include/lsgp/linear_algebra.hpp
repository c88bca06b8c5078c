// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace lsgp {

// The linear algebra of a call.
struct LinearAlgebra {
  int factorizations = 0;      // of sparse matrices
  int back_substitutions = 0;  // with their factors, one per right-hand side
};

}  // namespace lsgp

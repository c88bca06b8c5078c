// SPDX-License-Identifier: GPL-3.0-or-later
#include "solvers/failure.hpp"

#include "lsgp/errors.hpp"

namespace lsgp {

void throw_unsolvable() {
  throw Error(Code::solver_failed,
              "A linear system could not be factored: the surface has triangles too thin or too large to compute with. "
              "Clean the mesh (merge by distance, dissolve degenerate faces) and try again.");
}

}  // namespace lsgp

// SPDX-License-Identifier: GPL-3.0-or-later
// Fronts by blocks, on several threads. The blocks depend on the front's size alone.
#pragma once

#include "base/thread_team.hpp"
#include "solvers/dense_kernels.hpp"

namespace lsgp {

// Whether it is large enough for that.
template <typename Scalar>
bool has_blocks(const Front<Scalar>& front);

// As the kernels of these names do, of a front that has blocks. Checkpoints besides.
template <typename Scalar>
bool eliminate_by_blocks(const Front<Scalar>& front, ThreadTeam& team);
template <typename Scalar>
void subtract_outer_by_blocks(const Front<Scalar>& front, Scalar* outer, ThreadTeam& team);

}  // namespace lsgp

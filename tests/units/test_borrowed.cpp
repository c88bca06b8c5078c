// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/borrowed.hpp"

#include <doctest/doctest.h>

#include <type_traits>

#include "base/progress_monitor.hpp"
#include "mesh/point_tree.hpp"
#include "systems/cut_factor.hpp"

// What would end before the object that refers to it is refused.
static_assert(std::is_constructible_v<lsgp::PointTree, const lsgp::Positions&>);
static_assert(!std::is_constructible_v<lsgp::PointTree, lsgp::Positions>);
static_assert(std::is_constructible_v<lsgp::CutFactor, const lsgp::MetricMesh&, const lsgp::CutGraph&>);
static_assert(!std::is_constructible_v<lsgp::CutFactor, const lsgp::MetricMesh&, lsgp::CutGraph>);
static_assert(std::is_constructible_v<lsgp::ProgressMonitor, const lsgp::Progress&, lsgp::StageSeconds&>);
static_assert(!std::is_constructible_v<lsgp::ProgressMonitor, lsgp::Progress, lsgp::StageSeconds&>);

TEST_CASE("a borrowed object is referred to, not copied") {
  int lent = 1;
  const lsgp::Borrowed<const int> borrowed(lent);
  lent = 2;
  const int& kept = borrowed;
  CHECK(&kept == &lent);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Core>

TEST_CASE("products are divided alike on every processor") {
  CHECK(Eigen::l1CacheSize() == Eigen::internal::defaultL1CacheSize);
  CHECK(Eigen::l2CacheSize() == Eigen::internal::defaultL2CacheSize);
  CHECK(Eigen::l3CacheSize() == Eigen::internal::defaultL3CacheSize);
}

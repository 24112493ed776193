// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/distribution.h"

#include <gtest/gtest.h>

namespace lidar::tools {
namespace {

TEST(Distribution, TakesTheNearestRank) {
  Distribution d;
  for (const int i : {5, 1, 4, 2, 3}) d.Add(i);
  EXPECT_EQ(d.Percentile(0), 1);
  EXPECT_EQ(d.Percentile(20), 1);
  EXPECT_EQ(d.Percentile(21), 2);
  EXPECT_EQ(d.Percentile(50), 3);
  EXPECT_EQ(d.Percentile(95), 5);
  EXPECT_EQ(d.Max(), 5);
}

TEST(Distribution, OfNothingIsZero) { EXPECT_EQ(Distribution().Percentile(95), 0); }

}  // namespace
}  // namespace lidar::tools

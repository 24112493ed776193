// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/base/allowance.h"

#include <gtest/gtest.h>

namespace lidar {
namespace {

using std::chrono::milliseconds;

int Taken(Allowance* allowance, Time now) {
  int taken = 0;
  while (taken < 100 && allowance->Take(now)) ++taken;
  return taken;
}

TEST(Allowance, IsUsedUpAndComesBackOneByOne) {
  Allowance allowance(3, milliseconds(1'000));
  const Time start{milliseconds(5'000)};
  EXPECT_EQ(Taken(&allowance, start), 3);
  EXPECT_EQ(Taken(&allowance, start + milliseconds(999)), 0);
  EXPECT_EQ(Taken(&allowance, start + milliseconds(1'000)), 1);
  EXPECT_EQ(Taken(&allowance, start + milliseconds(1'999)), 0);
  EXPECT_EQ(Taken(&allowance, start + milliseconds(3'500)), 2) << "parts of a period are kept";
  EXPECT_EQ(Taken(&allowance, start + milliseconds(4'000)), 1);
}

TEST(Allowance, IsNeverMoreThanWhatThereWasAtFirst) {
  Allowance allowance(3, milliseconds(1));
  EXPECT_TRUE(allowance.Take(Time{}));
  EXPECT_EQ(Taken(&allowance, Time::max()), 3);
}

TEST(Allowance, DoesNotComeBackWhereTimeStandsStillOrGoesBack) {
  Allowance allowance(2, milliseconds(1'000));
  EXPECT_EQ(Taken(&allowance, Time{milliseconds(5'000)}), 2);
  EXPECT_FALSE(allowance.Take(Time{milliseconds(5'000)}));
  EXPECT_FALSE(allowance.Take(Time{}));
}

TEST(Allowance, KeepsAReserveForOthers) {
  Allowance allowance(5, milliseconds(1'000));
  const Time start{milliseconds(5'000)};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(allowance.Take(start, 2));
  EXPECT_FALSE(allowance.Take(start, 2));
  EXPECT_EQ(Taken(&allowance, start), 2);
  EXPECT_FALSE(allowance.Take(start + milliseconds(2'000), 2));
  EXPECT_TRUE(allowance.Take(start + milliseconds(3'000), 2));
}

}  // namespace
}  // namespace lidar

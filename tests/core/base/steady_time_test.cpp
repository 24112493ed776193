// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that a clock that is set back does not move the time back.
#include "src/base/steady_time.h"

#include <gtest/gtest.h>

namespace lidar {
namespace {

using namespace std::chrono_literals;

TEST(SteadyTime, GoesOnWhereTheClockOfItsCallerIsSetBack) {
  constexpr Time kStart{100s};
  SteadyTime clock;
  EXPECT_EQ(clock.From(kStart), kStart);
  EXPECT_EQ(clock.From(kStart - 1s), kStart - 1s) << "another thread's";
  EXPECT_EQ(clock.From(kStart - 2s), kStart - 2s);
  EXPECT_EQ(clock.From(kStart - 2001ms), kStart);
  EXPECT_EQ(clock.From(kStart - 2s), kStart + 1ms);
  EXPECT_EQ(clock.Peek(kStart), kStart + 2001ms);
  EXPECT_EQ(clock.ToCaller(kStart), kStart - 2001ms);
  EXPECT_EQ(clock.ToCaller(Time::max()), Time::max());
  EXPECT_EQ(clock.From(kStart - 60s), kStart + 1ms) << "set back again";
  EXPECT_EQ(clock.From(kStart - 59s), kStart + 1001ms);
}

}  // namespace
}  // namespace lidar

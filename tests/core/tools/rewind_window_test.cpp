// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/rewind_window.h"

#include <gtest/gtest.h>

namespace lidar::worker {
namespace {

constexpr std::uint64_t kMs = 1'000'000;

/// A window that goes back one second. The tests add ten messages per second.
class Rewind : public ::testing::Test {
 protected:
  void Add(std::uint64_t stored_ms, std::optional<std::uint64_t> captured_ms) {
    if (captured_ms) *captured_ms *= kMs;
    window_.Add({++number_, stored_ms * kMs, captured_ms});
  }
  std::uint64_t Back() const { return number_ - window_.first(); }

  RewindWindow window_{std::chrono::seconds(1)};
  std::uint64_t number_ = 0;
};

TEST_F(Rewind, GoesBackAsLongAsItIs) {
  for (std::uint64_t ms = 0; ms < 10'000; ms += 100) Add(ms, 5'000 + ms);
  EXPECT_EQ(Back(), 10U);
  for (std::uint64_t ms = 10'000; ms < 20'000; ms += 100) Add(ms, std::nullopt);
  EXPECT_EQ(Back(), 10U);
}

TEST_F(Rewind, GoesByCaptureTimesBeyondAPauseOfTheServer) {
  for (std::uint64_t ms = 0; ms < 5'000; ms += 100) Add(ms, ms);
  for (std::uint64_t ms = 5'000; ms < 5'500; ms += 100) Add(20'000, ms);
  EXPECT_EQ(Back(), 10U) << "half of them were stored 15 s before";
  for (std::uint64_t ms = 5'500; ms < 20'000; ms += 100) Add(20'000, ms);
  Add(21'200, 20'000);
  EXPECT_EQ(Back(), 10U);
}

TEST_F(Rewind, IsBoundedWhereTheRobotsClockStands) {
  for (std::uint64_t ms = 0; ms < 1'000'000; ms += 100) Add(ms, 7);
  EXPECT_EQ(Back(), 610U);
}

TEST_F(Rewind, HoldsSoManyMessagesOnly) {
  for (int i = 0; i < 70'000; ++i) Add(7, 7);
  EXPECT_EQ(Back(), 65'535U);
}

TEST_F(Rewind, GoesByStorageTimesWhereTheRobotsClockGoesBack) {
  for (std::uint64_t ms = 0; ms < 10'000; ms += 100) Add(ms, 90'000'000 - ms);
  EXPECT_EQ(Back(), 10U);
}

TEST_F(Rewind, BeginsAnewWhereANumberComesAgain) {
  for (std::uint64_t ms = 0; ms < 500; ms += 100) Add(ms, ms);
  --number_;
  Add(500, 500);
  EXPECT_EQ(Back(), 0U);
}

TEST_F(Rewind, BeginsAnewWhereTheNumbersGoBack) {
  number_ = 1'000;
  for (std::uint64_t ms = 0; ms < 500; ms += 100) Add(ms, ms);
  number_ = 6;
  Add(500, 500);
  EXPECT_EQ(Back(), 0U);
  Add(600, 600);
  EXPECT_EQ(Back(), 1U);
}

}  // namespace
}  // namespace lidar::worker

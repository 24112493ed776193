// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests when lidar-edge considers a robot gone, and when it shuts a robot out.
#include "src/tools/apps/edge/robot_watch.h"

#include <gtest/gtest.h>

namespace lidar::edge {
namespace {

constexpr std::uint64_t kMegabit = 125'000;

/// A robot that sends data in a session. The watch notes the bytes of the session once per second.
class Robot {
 public:
  explicit Robot(double max_mbps) : watch(max_mbps) {}
  void Send(double mbps, int seconds) {
    for (int i = 0; i < seconds; ++i) {
      bytes_ += static_cast<std::uint64_t>(mbps * kMegabit);
      now_ += std::chrono::seconds(1);
      watch.Note(now_, bytes_);
    }
  }
  void BeginSession() {
    bytes_ = 0;
    watch.Begin();
  }
  RobotWatch watch;

 private:
  Time now_ = Time{} + std::chrono::hours(1);
  std::uint64_t bytes_ = 0;
};

TEST(RobotWatch, TakesARobotForGoneAfterTenSecondsWithoutAByte) {
  Robot robot(0);
  robot.Send(0, 60);
  EXPECT_FALSE(robot.watch.is_there());
  EXPECT_FALSE(robot.watch.IsGone()) << "it never came";
  robot.Send(1, 30);
  EXPECT_TRUE(robot.watch.is_there());
  robot.Send(0, 10);
  EXPECT_FALSE(robot.watch.IsGone());
  robot.Send(0, 1);
  EXPECT_TRUE(robot.watch.IsGone());
  robot.BeginSession();
  EXPECT_FALSE(robot.watch.IsGone());
  robot.Send(0, 1);
  EXPECT_FALSE(robot.watch.is_there());
  robot.Send(1, 1);
  EXPECT_TRUE(robot.watch.is_there() && !robot.watch.IsGone());
}

TEST(RobotWatch, ShutsOutARobotThatIsThreeSecondsAheadUntilItIsNot) {
  Robot robot(2);
  robot.Send(2, 100);
  EXPECT_EQ(robot.watch.ToShutOut(), Duration{});
  // Each count adds the data of 1.5 s, but only one second passes until the next count.
  robot.Send(3, 4);
  EXPECT_EQ(robot.watch.ToShutOut(), Duration{});
  robot.Send(3, 1);
  EXPECT_EQ(robot.watch.ToShutOut(), std::chrono::milliseconds(3'500));
  robot.BeginSession();
  robot.Send(0, 2);
  robot.Send(5, 1);
  EXPECT_EQ(robot.watch.ToShutOut(), Duration{});
  robot.Send(2.5, 1);
  EXPECT_EQ(robot.watch.ToShutOut(), std::chrono::milliseconds(3'250)) << "it is ahead as before";
}

TEST(RobotWatch, SavesNothingOfASilence) {
  Robot robot(2);
  robot.Send(2, 1);
  robot.Send(0, 100);
  robot.Send(6.5, 1);
  EXPECT_EQ(robot.watch.ToShutOut(), std::chrono::milliseconds(3'250));
}

TEST(RobotWatch, ShutsOutNobodyWithoutALimit) {
  Robot robot(0);
  robot.Send(1'000, 100);
  EXPECT_EQ(robot.watch.ToShutOut(), Duration{});
}

}  // namespace
}  // namespace lidar::edge

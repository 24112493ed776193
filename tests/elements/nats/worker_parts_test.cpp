// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the parts of lidar-worker that need no server.
#include <gtest/gtest.h>

#include "src/tools/apps/worker/fleet_watch.h"
#include "src/tools/apps/worker/lease_store.h"
#include "src/tools/apps/worker/robot_pipeline.h"

namespace lidar::test {
namespace {

using worker::ParseAnswer;

TEST(LeaseStore, ReadsWhatTheServerAnswers) {
  EXPECT_EQ(ParseAnswer(R"({"stream":"KV_x","seq":17})")->revision, 17U);
  const auto refused = ParseAnswer(
      R"({"error":{"code":400,"err_code":10071,"description":"wrong last sequence: 5"},"seq":0})");
  EXPECT_FALSE(refused->revision);
  EXPECT_EQ(refused->newest, 5U);
  EXPECT_FALSE(ParseAnswer(R"({"error":{"code":503,"err_code":10008}})")->newest);
  EXPECT_FALSE(ParseAnswer(R"({"error":{"err_code":10077,"description":"more than 5"}})")->newest);
  for (const char* text : {"", "x", "[]", "{}", R"({"seq":-1})", R"({"seq":"1"})"})
    EXPECT_FALSE(ParseAnswer(text)) << text;
  EXPECT_FALSE(ParseAnswer(R"({"error":7})")->revision);
  EXPECT_FALSE(ParseAnswer(R"({"error":{"err_code":10071,"description":7}})")->newest);
}

TEST(FleetWatch, KnowsRobotsByTheirSubjects) {
  worker::FleetSettings settings;
  settings.patterns = {"r?", "s1.front"};
  EXPECT_EQ(RobotOf(settings, "fleet.r1.lidar.front"), "r1.front");
  EXPECT_EQ(RobotOf(settings, "fleet.r1.odometry.front"), "");
  EXPECT_EQ(RobotOf(settings, "other.r1.lidar.front"), "");
  EXPECT_TRUE(IsWanted(settings, "r1.front"));
  EXPECT_TRUE(IsWanted(settings, "s1.front"));
  for (const char* name : {"", "r1", "r11.front", "s1.rear", "r1.", ".front", "r1.a.b", "r1.*"})
    EXPECT_FALSE(IsWanted(settings, name)) << name;
}

TEST(FleetWatch, FollowsSomeSensorsOfARobotAndEachOtherRobot) {
  std::set<std::string> all = {"r6.front", "r8.front"};
  for (int i = 0; i < 65'000; ++i) all.insert("r7.s" + std::to_string(i));
  const auto kept = worker::WithinBounds(all);
  EXPECT_EQ(kept.size(), worker::kMostSensors + 2);
  EXPECT_EQ(kept.count("r6.front") + kept.count("r8.front"), 2U);
  all.clear();
  for (int i = 0; i < 65'000; ++i) all.insert("r" + std::to_string(i) + ".front");
  EXPECT_EQ(worker::WithinBounds(all).size(), worker::kMostRobots);
  const auto last = std::next(all.begin(), worker::kMostRobots - 1);
  const std::string rear = last->substr(0, last->find('.')) + ".rear";
  all.insert(rear);
  EXPECT_EQ(worker::WithinBounds(all).count(rear), 1U) << "of the last robot";
}

TEST(RobotPipeline, RefusesWhatItHasNot) {
  worker::PipelineSettings settings;
  const std::pair<std::string, std::string> wrong[] = {
      {"voxel-sise", "1"}, {"voxel-size", "abc"}, {"voxel-size", "500"}};
  for (const auto& property : wrong) {
    settings.odometry = {property};
    EXPECT_THROW(worker::RobotPipeline(settings, "r1.front", 0, std::nullopt), std::runtime_error)
        << property.second;
  }
  settings.odometry.clear();
  settings.decoder = "nosuchdecoder";
  EXPECT_THROW(worker::RobotPipeline(settings, "r1.front", 0, std::nullopt), std::runtime_error);
  settings.decoder = "fakesrc";
  EXPECT_THROW(worker::RobotPipeline(settings, "r1.front", 0, std::nullopt), std::runtime_error);
}

}  // namespace
}  // namespace lidar::test

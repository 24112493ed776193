// SPDX-License-Identifier: LGPL-2.1-or-later
// lidar-worker: robots that change hands.
#include <cmath>

#include "ext/nats/connection.h"
#include "ext/nats/jetstream.h"
#include "src/tools/worker/fleet_watch.h"
#include "src/tools/worker/lease_record.h"
#include "src/tools/worker/lease_store.h"
#include "src/tools/worker/robot_pipeline.h"
#include "tests/elements/nats/worker_process.h"

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

TEST(RobotPipeline, RefusesWhatItHasNot) {
  worker::PipelineSettings settings;
  settings.odometry = {{"voxel-sise", "1"}};
  EXPECT_THROW(worker::RobotPipeline(settings, "r1.front", 0, std::nullopt), std::runtime_error);
  settings.odometry.clear();
  settings.decoder = "nosuchdecoder";
  EXPECT_THROW(worker::RobotPipeline(settings, "r1.front", 0, std::nullopt), std::runtime_error);
  settings.decoder = "fakesrc";
  EXPECT_THROW(worker::RobotPipeline(settings, "r1.front", 0, std::nullopt), std::runtime_error);
}

class LidarWorker : public NatsTest {
 protected:
  void SetUp() override {
    NatsTest::SetUp();
    if (!IsSkipped()) server_.Start();
  }
  std::unique_ptr<NatsPipeline> Robot() {
    auto robot = std::make_unique<NatsPipeline>(
        DrivingRobot() + "! natssink name=n subject=fleet.r1.lidar.front jetstream=fleet" + At());
    robot->Play();
    return robot;
  }
  /// The lease is long, as the machine may be busy.
  std::unique_ptr<WorkerProcess> Worker() {
    return std::make_unique<WorkerProcess>(
        std::vector<std::string>{"r*", "--url", server_.url(), "--lease", "2000"});
  }
  /// Makes the bucket where there is none, and hands it to `use`.
  void WithBucket(const std::function<void(kvStore*)>& use) {
    std::string why;
    nats::ConnectionSettings settings;
    settings.url = server_.url();
    const auto connection = nats::Connection::Open(settings, nullptr, &why);
    ASSERT_TRUE(connection) << why;
    const auto js = nats::OpenJetStream(connection->get());
    kvConfig config;
    kvConfig_Init(&config);
    config.Bucket = "lidar-workers";
    kvStore* store = nullptr;
    if (js_KeyValue(&store, js.get(), config.Bucket) != NATS_OK) {
      ASSERT_EQ(js_CreateKeyValue(&store, js.get(), &config), NATS_OK);
    }
    use(store);
    kvStore_Destroy(store);
  }
  void PutRecord(const std::string& text) {
    WithBucket([&](kvStore* store) {
      EXPECT_EQ(kvStore_PutString(nullptr, store, "r1.front", text.c_str()), NATS_OK);
      EXPECT_EQ(kvStore_PutString(nullptr, store, "no.robot.this", "x"), NATS_OK);
    });
  }
  std::string Record() {
    std::string text;
    WithBucket([&](kvStore* store) {
      kvEntry* entry = nullptr;
      if (kvStore_Get(&entry, store, "r1.front") == NATS_OK) text = kvEntry_ValueString(entry);
      kvEntry_Destroy(entry);
    });
    return text;
  }
};

TEST_F(LidarWorker, GoesOnWhereOneThatIsKilledWas) {
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  consumer.Play();
  const auto robot = Robot();
  auto first = Worker();
  ASSERT_TRUE(consumer.WaitForBuffers(15));
  EXPECT_NE(first->Taken("r1.front").find("from now on"), std::string::npos);
  auto second = Worker();
  // By then it has seen that there is somebody.
  const std::size_t before = consumer.count();
  ASSERT_TRUE(consumer.WaitForBuffers(before + 20));
  EXPECT_EQ(second->Taken("r1.front"), "");
  first->Kill();
  ASSERT_TRUE(Eventually([&] { return !second->Taken("r1.front").empty(); }));
  EXPECT_NE(second->Taken("r1.front").find(", after "), std::string::npos);
  const std::size_t taken = consumer.count();
  ASSERT_TRUE(consumer.WaitForBuffers(taken + 10));
  const auto poses = consumer.buffers();
  EXPECT_LT(LargestJump(poses), 1.5) << "neither back to the origin nor past what it missed";
  EXPECT_GT(DistanceOf(poses.back()), 10);
  // It leaves its robot to others at once.
  EXPECT_EQ(second->Stop(), 0);
  const auto record = worker::ParseLeaseRecord(Record());
  ASSERT_TRUE(record && record->progress);
  EXPECT_EQ(record->worker, "");
  EXPECT_GT(record->progress->pose[0], 10);
}

TEST_F(LidarWorker, GivesUpWithoutAServerAndGoesOnWithIt) {
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  consumer.Play();
  const auto robot = Robot();
  auto worker = Worker();
  ASSERT_TRUE(consumer.WaitForBuffers(15));
  server_.Kill();
  ASSERT_TRUE(Eventually([&] { return worker->Said("r1.front: given up"); }));
  server_.Restart();
  ASSERT_TRUE(Eventually([&] { return worker->Robots().count("r1.front") > 0; }));
  const std::size_t before = consumer.count();
  ASSERT_TRUE(consumer.WaitForBuffers(before + 10));
  EXPECT_GT(DistanceOf(consumer.buffers().back()), 10);
}

TEST_F(LidarWorker, GoesOnFromThePoseAloneInAnotherStream) {
  worker::Progress progress;
  progress.pose = {500, 0, 0, 0, 0, 0, 1};
  progress.scan = progress.from = 1'000'000'000;
  PutRecord(worker::ToJson({"", std::chrono::seconds(1), progress}));
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  consumer.Play();
  const auto robot = Robot();
  const auto worker = Worker();
  ASSERT_TRUE(consumer.WaitForBuffers(5));
  EXPECT_NEAR(DistanceOf(consumer.buffers().front()), 500, 3);
}

TEST_F(LidarWorker, BeginsAnewWhereTheRecordIsDamaged) {
  PutRecord("{\"worker\":7");
  const auto robot = Robot();
  auto worker = Worker();
  ASSERT_TRUE(Eventually([&] { return !worker->Taken("r1.front").empty(); }));
  EXPECT_EQ(worker->Taken("r1.front"), "r1.front: taken, from now on");
}

}  // namespace
}  // namespace lidar::test

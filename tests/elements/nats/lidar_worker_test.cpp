// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidar-worker in which a robot passes from one worker to another.
#include <gst/base/gstbasetransform.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "ext/nats/connection.h"
#include "ext/nats/jetstream.h"
#include "src/tools/apps/worker/fleet_watch.h"
#include "src/tools/apps/worker/lease_record.h"
#include "src/tools/apps/worker/lease_store.h"
#include "src/tools/apps/worker/robot_pipeline.h"
#include "src/tools/apps/worker/worker.h"
#include "src/tools/common/event_loop.h"
#include "tests/elements/nats/http_get.h"
#include "tests/elements/nats/nats_client.h"
#include "tests/elements/nats/worker_process.h"

namespace lidar::test {
namespace {

/// State of the decoder `slowdecoder`, whose start waits while `hold` is true.
struct Slowness {
  std::atomic<bool> hold{false};
  std::atomic<int> held{0};  // number of starts that have waited so far
  std::atomic<bool> gave_up{false};
  std::atomic<bool> fails{false};  // if true, the start fails after `hold` has become false
} slowness;

struct SlowDecoder {
  GstBaseTransform parent;
};
struct SlowDecoderClass {
  GstBaseTransformClass parent_class;
};
GType slow_decoder_get_type();
G_DEFINE_TYPE(SlowDecoder, slow_decoder, GST_TYPE_BASE_TRANSFORM)

void slow_decoder_init(SlowDecoder*) {}
void slow_decoder_class_init(SlowDecoderClass* klass) {
  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_set_static_metadata(element, "slow", "Test", "slow to start", "-");
  for (const auto& [name, direction] : {std::pair{"src", GST_PAD_SRC}, {"sink", GST_PAD_SINK}})
    gst_element_class_add_pad_template(
        element, gst_pad_template_new(name, direction, GST_PAD_ALWAYS, GST_CAPS_ANY));
  GST_BASE_TRANSFORM_CLASS(klass)->start = [](GstBaseTransform* self) -> gboolean {
    if (!slowness.hold) return TRUE;
    ++slowness.held;
    if (!Eventually([] { return !slowness.hold; })) slowness.gave_up = true;
    if (slowness.fails) GST_ELEMENT_ERROR(self, LIBRARY, INIT, ("It fails."), (nullptr));
    return !slowness.fails;
  };
}

using std::chrono::milliseconds;

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
  /// Starts a worker. The default lease is long, because a busy machine may delay the worker's
  /// renewal.
  std::unique_ptr<WorkerProcess> Worker(int lease_ms = 2000) {
    return std::make_unique<WorkerProcess>(std::vector<std::string>{
        "r*", "--url", server_.url(), "--lease", std::to_string(lease_ms)});
  }
  void WithJetStream(const std::function<void(jsCtx*)>& use) {
    use(NatsClient(server_.url()).js());
  }
  /// Calls `use` with the key-value bucket of the workers. Makes the bucket if it is missing.
  void WithBucket(const std::function<void(kvStore*)>& use) {
    WithJetStream([&](jsCtx* js) {
      kvConfig config;
      kvConfig_Init(&config);
      config.Bucket = "lidar-workers";
      kvStore* store = nullptr;
      if (js_KeyValue(&store, js, config.Bucket) != NATS_OK) {
        ASSERT_EQ(js_CreateKeyValue(&store, js, &config), NATS_OK);
      }
      use(store);
      kvStore_Destroy(store);
    });
  }
  void PutRecord(const std::string& text) {
    WithBucket([&](kvStore* store) {
      EXPECT_EQ(kvStore_PutString(nullptr, store, "r1.front", text.c_str()), NATS_OK);
      EXPECT_EQ(kvStore_PutString(nullptr, store, "no.robot.this", "x"), NATS_OK);
    });
  }
  struct Stored {
    std::string text;
    std::uint64_t revision = 0;
  };
  Stored Newest(const std::string& robot) {
    Stored stored;
    WithBucket([&](kvStore* store) {
      kvEntry* entry = nullptr;
      if (kvStore_Get(&entry, store, robot.c_str()) == NATS_OK)
        stored = {kvEntry_ValueString(entry), kvEntry_Revision(entry)};
      kvEntry_Destroy(entry);
    });
    return stored;
  }
  nats::StreamInfoPtr InfoOf(const char* stream) {
    nats::StreamInfoPtr info;
    WithJetStream([&](jsCtx* js) {
      jsStreamInfo* raw = nullptr;
      EXPECT_EQ(js_GetStreamInfo(&raw, js, stream, nullptr, nullptr), NATS_OK);
      info.reset(raw);
    });
    return info;
  }
  std::uint64_t CreationOf(const char* stream) {
    return static_cast<std::uint64_t>(InfoOf(stream)->Created);
  }
  std::uint64_t LastOf(const char* stream) { return InfoOf(stream)->State.LastSeq; }
  std::string Record() { return Newest("r1.front").text; }
  /// Expects that the worker did not use the velocity of the record. The robot drives at 10 m/s,
  /// and the velocity of the record is very different.
  void ExpectNoVelocityOfTheRecord(NatsPipeline* consumer) {
    ASSERT_TRUE(consumer->WaitForBuffers(10));
    EXPECT_LT(LargestJump(consumer->buffers()), 5);
    std::optional<worker::LeaseRecord> record;
    ASSERT_TRUE(Eventually([&] {
      record = worker::ParseLeaseRecord(Record());
      return record && record->progress && record->progress->time > 0;
    })) << "it is the worker's own";
    const auto none = std::array<double, 6>{};
    EXPECT_GT(record->progress->velocity.value_or(none)[0], -50);
  }
};

TEST_F(LidarWorker, GoesOnWhereOneThatIsKilledWas) {
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  Listen(server_, &consumer);
  const auto robot = Robot();
  constexpr int kLongLease = 10'000;  // longer than several pauses of a process on a busy machine
  auto first = Worker(kLongLease);
  ASSERT_TRUE(consumer.WaitForBuffers(15));
  EXPECT_NE(first->Taken("r1.front").find("from now on"), std::string::npos);
  auto second = Worker(kLongLease);
  // While the consumer receives 20 more poses, the second worker has time to see that the robot is
  // taken.
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
  // The worker gives up its robot when it stops, so that another worker can take the robot at once.
  EXPECT_EQ(second->Stop(), 0);
  std::optional<worker::LeaseRecord> record;
  EXPECT_TRUE(Eventually(
      [&] { return (record = worker::ParseLeaseRecord(Record())) && record->worker.empty(); }));
  ASSERT_TRUE(record && record->progress);
  EXPECT_GT(record->progress->pose[0], 10);
  ASSERT_TRUE(record->progress->velocity);
  EXPECT_NEAR(record->progress->velocity->at(0), 10, 3);
}

TEST_F(LidarWorker, GivesUpWithoutAServerAndGoesOnWithIt) {
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  Listen(server_, &consumer);
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

TEST_F(LidarWorker, WaitsForAServerThatTakesItsConnectionAndIsSilent) {
  server_.Freeze();
  auto worker = Worker();
  NatsPipeline other("natssrc name=n" + At() + "! fakesink name=see");
  other.Play();
  // When this warning is posted, the worker's first attempt to connect has also failed.
  EXPECT_NE(other.WaitForWarning("No NATS server answers"), "");
  server_.Thaw();
  const auto robot = Robot();
  EXPECT_TRUE(Eventually([&] { return !worker->Taken("r1.front").empty(); }));
}

/// A proxy without a server behind it: it accepts connections and closes them at once.
class LoneProxy {
 public:
  LoneProxy() {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* raw = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(listener_.get(), raw, size), 0);
    EXPECT_EQ(listen(listener_.get(), 16), 0);
    EXPECT_EQ(getsockname(listener_.get(), raw, &size), 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] {
      while (tools::FileDescriptor(accept(listener_.get(), nullptr, nullptr))) ++taken_;
    });
  }
  ~LoneProxy() {
    shutdown(listener_.get(), SHUT_RDWR);
    thread_.join();
  }
  LoneProxy(const LoneProxy&) = delete;
  LoneProxy& operator=(const LoneProxy&) = delete;

  std::string url() const { return "nats://127.0.0.1:" + std::to_string(port_); }
  int taken() const { return taken_; }

 private:
  const tools::FileDescriptor listener_{socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  int port_ = 0;
  std::atomic<int> taken_{0};
  std::thread thread_;
};

TEST_F(LidarWorker, PausesWhereAProxyClosesItsConnections) {
  const LoneProxy proxy;
  WorkerProcess worker({"r1", "--url", proxy.url()});
  ASSERT_TRUE(Eventually([&] { return proxy.taken() > 0; }));
  const Time end = tools::Now() + std::chrono::seconds(3);
  ASSERT_TRUE(Eventually([&] { return tools::Now() > end; }));
  EXPECT_LT(proxy.taken(), 60);
  EXPECT_EQ(worker.Stop(), 0);
}

TEST_F(LidarWorker, StopsWithinASecondWhereTheServerHangs) {
  const auto robot = Robot();
  const auto stop_s = [&](bool hangs) {
    auto worker = Worker();
    EXPECT_TRUE(Eventually([&] { return !worker->Taken("r1.front").empty(); }));
    if (hangs) server_.Freeze();
    const Time begin = tools::Now();
    EXPECT_EQ(worker->Stop(), 0);
    const double took_s = Seconds(tools::Now() - begin);
    if (hangs) server_.Thaw();
    return took_s;
  };
  // A busy machine may delay the worker. Therefore the shortest of three times is compared with the
  // longest time that the worker needs with a server that answers.
  double shortest_s = 1e9;
  double without_s = 0;
  for (int i = 0; i < 3 && shortest_s >= 1 + without_s; ++i) {
    shortest_s = std::min(shortest_s, stop_s(true));
    if (shortest_s >= 1) without_s = std::max(without_s, stop_s(false));
  }
  EXPECT_LT(shortest_s, 1 + without_s);
}

TEST_F(LidarWorker, GoesOnFromThePoseAloneInAnotherStream) {
  worker::Progress progress;
  progress.pose = {500, 0, 0, 0, 0, 0, 1};
  progress.velocity = {-300, 0, 0, 0, 0, 0};
  progress.scan = progress.from = 1'000'000'000;
  PutRecord(worker::ToJson({"", std::chrono::seconds(1), progress}));
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  Listen(server_, &consumer);
  const auto robot = Robot();
  const auto worker = Worker();
  ASSERT_TRUE(consumer.WaitForBuffers(5));
  EXPECT_NEAR(DistanceOf(consumer.buffers().front()), 500, 3);
  ExpectNoVelocityOfTheRecord(&consumer);
}

TEST_F(LidarWorker, GoesOnFromThePoseAloneWhereTheRecordIsAheadOfTheStream) {
  const auto robot = Robot();
  ASSERT_TRUE(Eventually([&] { return robot->stat("messages-acknowledged") > 0; }));
  worker::Progress progress;
  progress.pose = {500, 0, 0, 0, 0, 0, 1};
  progress.velocity = {-300, 0, 0, 0, 0, 0};
  progress.stream = CreationOf("fleet");
  progress.scan = progress.from = 1'000'000'000;
  PutRecord(worker::ToJson({"", std::chrono::seconds(1), progress}));
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  Listen(server_, &consumer);
  const auto worker = Worker();
  ASSERT_TRUE(consumer.WaitForBuffers(5));
  EXPECT_NEAR(DistanceOf(consumer.buffers().front()), 500, 3);
  EXPECT_TRUE(Eventually([&] {
    const auto record = worker::ParseLeaseRecord(Record());
    return record && record->progress && record->progress->stream == progress.stream &&
           record->progress->scan < progress.scan;
  })) << "the next worker is spared it";
  ExpectNoVelocityOfTheRecord(&consumer);
}

TEST_F(LidarWorker, ForgetsTheVelocityWhereTheScanIsGone) {
  const auto robot = Robot();
  ASSERT_TRUE(Eventually([&] { return robot->stat("messages-acknowledged") > 20; }));
  worker::Progress progress;
  progress.pose = {500, 0, 0, 0, 0, 0, 1};
  progress.velocity = {-300, 0, 0, 0, 0, 0};
  progress.stream = CreationOf("fleet");
  progress.scan = progress.from = 1;
  WithJetStream([](jsCtx* js) {
    jsOptions options;
    jsOptions_Init(&options);
    options.Stream.Purge.Sequence = 17;
    EXPECT_EQ(js_PurgeStream(js, "fleet", &options, nullptr), NATS_OK);
  });
  PutRecord(worker::ToJson({"", std::chrono::seconds(1), progress}));
  NatsPipeline consumer("natssrc name=n subject=fleet.r1.odometry.front" + At() +
                        "! fakesink name=see sync=false");
  Listen(server_, &consumer);
  const auto worker = Worker();
  ExpectNoVelocityOfTheRecord(&consumer);
}

TEST_F(LidarWorker, KnowsWhereToReadFromThoughTheServerHadAPause) {
  NatsPipeline sender(
      "lidartestsrc model=os0-32 mode=512x10 speed=10 num-buffers=176 ! lidarenc effort=0" + kSee +
      "! natssink name=n sync=false subject=fleet.r1.lidar.front jetstream=fleet" + At());
  sender.HoldFrom(160);
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= 160; }));
  worker::PipelineSettings settings;
  settings.connection.url = server_.url();
  settings.rewind = milliseconds(300);
  // No message is stored in this time.
  std::this_thread::sleep_for(settings.rewind + milliseconds(100));
  const std::uint64_t before = LastOf("fleet");
  sender.Hold(false);
  EXPECT_EQ(sender.WaitForEnd(), "");
  worker::Progress begin;
  begin.pose = {0, 0, 0, 0, 0, 0, 1};
  begin.stream = CreationOf("fleet");
  const auto numbers = NatsClient(server_.url()).NumbersOf("fleet", "fleet.r1.lidar.front");
  ASSERT_FALSE(numbers.empty());
  begin.scan = begin.from = numbers.front();
  worker::RobotPipeline pipeline(settings, "r1.front", begin.stream, begin);
  pipeline.SetEnd(Time::max());
  pipeline.Play();
  ASSERT_TRUE(Eventually([&] {
    const auto progress = pipeline.progress();
    return progress && progress->scan > before;
  }));
  EXPECT_LT(pipeline.progress()->from, before) << "0.3 s before the scan, by the sensor's clock";
  EXPECT_GT(pipeline.progress()->from, before / 2);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(pipeline.Poll(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "it has the scan of the record";
}

/// The worker must skip an incomplete first scan, because the next scan would match a map of half a
/// scan badly.
TEST_F(LidarWorker, BeginsItsMapWithAWholeScan) {
  NatsPipeline sender(
      "lidartestsrc model=os0-32 mode=512x10 speed=10 slices-per-scan=4 num-buffers=40 ! lidarenc "
      "effort=0" +
      kSee + "! natssink name=n sync=false subject=fleet.r1.lidar.front jetstream=fleet" + At());
  sender.HoldFrom(36);  // blocks the four slices of the last scan
  sender.Play();
  ASSERT_TRUE(Eventually([&] { return sender.stat("messages-acknowledged") >= 36; }));
  const std::uint64_t before = LastOf("fleet");
  sender.Hold(false);
  EXPECT_EQ(sender.WaitForEnd(), "");
  WithJetStream([](jsCtx* js) {
    jsOptions options;
    jsOptions_Init(&options);
    options.Stream.Purge.Subject = "fleet.r1.lidar.front";
    options.Stream.Purge.Sequence = 4;  // removes the caps and two slices
    EXPECT_EQ(js_PurgeStream(js, "fleet", &options, nullptr), NATS_OK);
  });
  worker::PipelineSettings settings;
  settings.connection.url = server_.url();
  worker::Progress begin;
  begin.pose = {0, 0, 0, 0, 0, 0, 1};
  begin.stream = CreationOf("fleet");
  begin.scan = begin.from = 1;
  worker::RobotPipeline pipeline(settings, "r1.front", begin.stream, begin);
  pipeline.SetEnd(Time::max());
  pipeline.Play();
  ASSERT_TRUE(Eventually([&] {
    const auto progress = pipeline.progress();
    return progress && progress->scan > before;
  }));
  fleet::Exposition exposition;
  nlohmann::json report;
  pipeline.AddStats("", &exposition, &report);
  EXPECT_EQ(report["lidarodometry"]["scans"], 9) << "of ten, of which the first is not whole";
}

/// The stream contains only one scan.
TEST_F(LidarWorker, HandsOnTheVelocityOfTheRecordUnlessTheScanOfItsPoseIsMissing) {
  NatsPipeline sender(
      "lidartestsrc model=os0-32 mode=512x10 speed=10 slices-per-scan=1 num-buffers=1 ! lidarenc "
      "effort=0" +
      kSee + "! natssink name=n sync=false subject=fleet.r1.lidar.front jetstream=fleet" +
      kPatientDrain + At());
  sender.Play();
  ASSERT_EQ(sender.WaitForEnd(), "");
  const std::uint64_t scan = LastOf("fleet");
  const Kept scanned = sender.buffers().at(0);
  worker::Progress begin;
  begin.pose = {5, 0, 0, 0, 0, 0, 1};
  begin.velocity = {10, 0, 0, 0, 0, 0.25};
  begin.time = scanned.capture_time - 2 * GST_SECOND;
  begin.stream = CreationOf("fleet");
  worker::PipelineSettings settings;
  settings.connection.url = server_.url();
  for (const bool is_missing : {false, true}) {
    begin.scan = begin.from = is_missing ? scan - 1 : scan;
    worker::RobotPipeline pipeline(settings, "r1.front", begin.stream, begin);
    pipeline.SetEnd(Time::max());
    pipeline.Play();
    ASSERT_TRUE(Eventually([&] { return pipeline.progress().has_value(); }));
    const worker::Progress progress = *pipeline.progress();
    EXPECT_EQ(progress.velocity, is_missing ? std::nullopt : begin.velocity);
    EXPECT_EQ(progress.pose[0], 5);
    EXPECT_EQ(progress.time, scanned.capture_time + scanned.duration / 2);
    EXPECT_EQ(progress.scan, scan);
    EXPECT_EQ(progress.from, scan);
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(pipeline.Poll(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              is_missing ? "r1.front: the scan of its last pose cannot be decoded; its poses lack "
                           "the motion of 2.00 s\n"
                         : "");
  }
}

TEST_F(LidarWorker, PrintsNoControlCharactersOfARecord) {
  PutRecord(worker::ToJson({"a\x1b[2J\nr2.front: taken", milliseconds(300), std::nullopt}));
  const auto robot = Robot();
  const auto worker = Worker();
  ASSERT_TRUE(Eventually([&] { return !worker->Taken("r1.front").empty(); }));
  EXPECT_EQ(worker->Taken("r1.front"),
            "r1.front: taken, from now on, after a\\x1b[2J\\x0ar2.front: taken");
}

TEST_F(LidarWorker, TellsOfItsRobots) {
  const auto robot = Robot();
  WorkerProcess worker({"r*", "--url", server_.url(), "--lease", "2000", "--interval", "0.2",
                        "--http-port", "0", "--odometry", "voxel-size=5"});
  const NatsClient client(server_.url());
  auto reports = client.Subscribe("fleet.*.worker.*");
  const auto counts_poses = [&] {
    natsMsg* raw_report = nullptr;
    if (natsSubscription_NextMsg(&raw_report, reports.get(), 1'000) != NATS_OK) return false;
    const nats::MessagePtr message(raw_report);
    EXPECT_STREQ(natsMsg_GetSubject(raw_report), "fleet.r1.worker.front");
    const auto report = nlohmann::json::parse(natsMsg_GetData(raw_report));
    EXPECT_GT(report["time"], gint64{1'600'000'000} * 1'000'000'000) << "[ns]";
    if (report["robot"] != "r1" || report["natssink"]["messages"] <= 3) return false;
    EXPECT_GT(report["lidarodometry"]["map-voxels"], 0);
    EXPECT_LT(report["lidarodometry"]["map-voxels"], 400)
        << "they have the size that was asked for";
    return true;
  };
  EXPECT_TRUE(Eventually(counts_poses));
  std::string address;
  ASSERT_TRUE(Eventually([&] {
    for (const std::string& line : worker.lines())
      if (line.rfind("metrics http://", 0) == 0) address = line.substr(15, line.rfind('/') - 15);
    return !address.empty();
  }));
  EXPECT_TRUE(Eventually([&] {
    const auto answer = HttpGet(address, "/metrics");
    return answer && answer->find("\nlidar_worker_robots 1\n") != std::string::npos &&
           answer->find("\nlidar_natssink_messages{robot=\"r1\",sensor=\"front\"} ") !=
               std::string::npos;
  }));
  reports.reset();
  EXPECT_EQ(worker.Stop(), 0);
}

/// A worker that runs in this process, and two robots whose pipelines start slowly.
class SlowRobots : public LidarWorker {
 protected:
  void SetUp() override {
    LidarWorker::SetUp();
    if (IsSkipped()) return;
    gst_element_register(nullptr, "slowdecoder", GST_RANK_NONE, slow_decoder_get_type());
    for (const char* robot : {"r1", "r2"})
      PublishSlices(2,
                    " jetstream=fleet subject=fleet." + std::string(robot) + ".lidar.front" + At());
    worker::WorkerSettings settings;
    settings.lease.worker = "me";
    settings.lease.lease = std::chrono::seconds(12);  // long, because the machine may be busy
    settings.fleet.patterns = {"r*"};
    settings.pipeline.connection.url = server_.url();
    settings.pipeline.decoder = "slowdecoder";
    worker_ = std::make_unique<worker::Worker>(settings);
    slowness.held = 0;
    slowness.gave_up = slowness.fails = false;
    slowness.hold = true;
  }
  void TearDown() override {
    slowness.hold = false;
    worker_.reset();
  }
  /// Runs steps of the worker until `holds` returns true. Returns false if that takes too long.
  bool WorksUntil(const std::function<bool()>& holds) {
    return Eventually([&] {
      worker_->Step();
      return holds();
    });
  }
  /// Returns four digits: the worker's current robots, robots taken so far, robots given up, and
  /// failures.
  std::string Figures() const {
    fleet::Exposition exposition;
    fleet::Reporter::Reports reports;
    worker_->Tell(&exposition, &reports);
    const std::string text = exposition.text();
    std::string found;
    for (const char* name : {"robots", "robots_taken", "robots_given_up", "failures"}) {
      const std::string line = std::string("\nlidar_worker_") + name + " ";
      const auto at = text.find(line);
      found += at == text.npos ? '?' : text[at + line.size()];
    }
    return found;
  }

  std::unique_ptr<worker::Worker> worker_;
};

TEST_F(SlowRobots, KeepTheirLeasesAndThoseOfOthers) {
  ASSERT_TRUE(WorksUntil([] { return slowness.held == 2; }));
  const Stored first = Newest("r1.front");
  const Stored second = Newest("r2.front");
  ASSERT_TRUE(WorksUntil([&] {
    return Newest("r1.front").revision > first.revision + 2 &&
           Newest("r2.front").revision > second.revision + 2;
  }));
  EXPECT_EQ(slowness.held, 2) << "neither was lost and taken again";
  EXPECT_FALSE(slowness.gave_up);
}

TEST_F(SlowRobots, AreHandedOverThoughTheyDoNotStop) {
  ASSERT_TRUE(WorksUntil([] { return slowness.held == 2; }));
  testing::internal::CaptureStderr();
  worker_->HandOver();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_FALSE(slowness.gave_up) << "it did not wait for them";
  for (const std::string robot : {"r1.front", "r2.front"}) {
    EXPECT_NE(said.find(robot + ": its pipeline does not stop in time"), std::string::npos) << said;
    // The server may store the record a little later than the worker prints its line.
    EXPECT_TRUE(Eventually([&] {
      const auto record = worker::ParseLeaseRecord(Newest(robot).text);
      return record && record->worker.empty();
    })) << robot;
  }
}

TEST_F(SlowRobots, AreCountedAsTheyAreTakenAndFail) {
  ASSERT_TRUE(WorksUntil([] { return slowness.held == 2; }));
  EXPECT_EQ(Figures(), "2200");
  slowness.fails = true;
  slowness.hold = false;
  EXPECT_TRUE(WorksUntil([&] { return Figures() == "0222"; })) << Figures();
}

TEST_F(SlowRobots, WhosePipelinesCannotBeMadeAreGivenUp) {
  GstRegistry* registry = gst_registry_get();
  GstPluginFeature* decoder = gst_registry_lookup_feature(registry, "slowdecoder");
  gst_registry_remove_feature(registry, decoder);
  EXPECT_TRUE(WorksUntil([&] { return Figures() == "0222"; })) << Figures();
  gst_registry_add_feature(registry, decoder);
  gst_object_unref(decoder);
}

/// The numbers of entries begin at 1 again if the watch makes its consumer anew.
TEST_F(LidarWorker, SeesAllRecordsAgainWhereItAsksForThem) {
  std::string why;
  nats::ConnectionSettings settings;
  settings.url = server_.url();
  const auto connection = nats::Connection::Open(settings, nullptr, &why);
  ASSERT_TRUE(connection) << why;
  PutRecord("none");  // makes the bucket; otherwise the watch would do it at the same time
  worker::FleetSettings fleet;
  fleet.patterns = {"r*"};
  worker::FleetWatch watch(connection.get(), fleet);
  const auto sees = [&](const std::string& text) {
    return Eventually([&] {
      const auto entries = watch.Take().entries;
      return std::any_of(entries.begin(), entries.end(),
                         [&](const auto& e) { return e.robot == "r1.front" && e.text == text; });
    });
  };
  for (const std::string text : {"first", "second", "third"}) {
    PutRecord(text);
    ASSERT_TRUE(sees(text));
    watch.Renew();
    ASSERT_TRUE(sees(text)) << "again";
  }
}

worker::WorkerSettings SettingsOf(const std::string& url) {
  worker::WorkerSettings settings;
  settings.lease.worker = "me";
  settings.fleet.patterns = {"r*"};
  settings.pipeline.connection.url = url;
  return settings;
}

/// Calls `works` repeatedly until it has written `text` to stderr.
::testing::AssertionResult Warns(const std::function<void()>& works, const std::string& text) {
  std::string said;
  const bool warned = Eventually([&] {
    ::testing::internal::CaptureStderr();
    works();
    said += ::testing::internal::GetCapturedStderr();
    return said.find(text) != std::string::npos;
  });
  return (warned ? ::testing::AssertionSuccess() : ::testing::AssertionFailure()) << said;
}

TEST_F(LidarWorker, SaysThatThereIsNoStreamAndThatARobotHasTooManySensors) {
  worker::WorkerSettings settings = SettingsOf(server_.url());
  settings.lease.most = 1;
  worker::Worker worker(settings);
  const auto works = [&] { worker.Step(); };
  EXPECT_TRUE(Warns(works, "there is no stream fleet yet\n"));
  WithJetStream([](jsCtx* js) {
    std::string why;
    ASSERT_TRUE(nats::EnsureStream(js, {"fleet", {}, 0, 1, ""}, {"fleet.>"}, &why)) << why;
    for (std::size_t i = 0; i < worker::kMostSensors + 3; ++i) {
      const std::string subject = "fleet.r1.lidar.s" + std::to_string(i);
      EXPECT_EQ(js_Publish(nullptr, js, subject.c_str(), "x", 1, nullptr, nullptr), NATS_OK);
    }
  });
  EXPECT_TRUE(Warns(works,
                    "sensors are left out: a robot may have 16, and a worker follows 4096 "
                    "robots\n"));
  // The list may have been made while only some of the sensors had a message.
  EXPECT_TRUE(Eventually([&] {
    worker.Step();
    fleet::Exposition exposition;
    fleet::Reporter::Reports reports;
    worker.Tell(&exposition, &reports);
    return exposition.text().find("\nlidar_worker_sensors_left_out 3\n") != std::string::npos;
  }));
}

/// The worker looks for its bucket and for robots every second, but it reports a lasting problem
/// only once.
TEST_F(LidarWorker, SaysOnceWhatTroublesItForALongTime) {
  server_.Start({"-js=false"});
  worker::Worker worker(SettingsOf(server_.url()));
  const gint64 late = g_get_monotonic_time() + 4 * G_USEC_PER_SEC;
  std::string said;
  EXPECT_TRUE(Eventually([&] {
    ::testing::internal::CaptureStderr();
    worker.Step();
    said += ::testing::internal::GetCapturedStderr();
    return g_get_monotonic_time() > late && said.find("bucket") != said.npos &&
           said.find("the stream") != said.npos;
  }));
  // A request that is not answered in time is another problem.
  std::map<std::string, std::string> last;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);)
    EXPECT_NE(std::exchange(last[line.substr(0, line.find(':'))], line), line) << said;
  EXPECT_EQ(last.size(), 2U) << "of the bucket and of the stream: " << said;
}

TEST_F(LidarWorker, PrintsTheWarningsOfARobotsPipeline) {
  WithJetStream([](jsCtx* js) {
    std::string why;
    ASSERT_TRUE(nats::EnsureStream(js, {"fleet", {}, 0, 1, ""}, {"fleet.>"}, &why)) << why;
    EXPECT_EQ(js_Publish(nullptr, js, "fleet.r1.lidar.front", "x", 1, nullptr, nullptr), NATS_OK);
  });
  worker::Progress begin;
  begin.pose = {0, 0, 0, 0, 0, 0, 1};
  begin.stream = CreationOf("fleet");
  begin.scan = begin.from = 1;
  worker::RobotPipeline pipeline(SettingsOf(server_.url()).pipeline, "r1.front", begin.stream,
                                 begin);
  pipeline.Play();
  EXPECT_TRUE(Warns([&] { EXPECT_EQ(pipeline.Poll(), ""); },
                    "r1.front: natssrc: A message is damaged or not from natssink. Such messages "
                    "are dropped and counted.\n"));
}

TEST_F(LidarWorker, EndsWithTheReasonForWhichAServerRefusesIt) {
  server_.Start({"--auth", "other"});
  worker::Worker worker(SettingsOf(server_.url("nats", "s3cret@")));
  std::string why;
  EXPECT_TRUE(Eventually([&] {
    try {
      worker.Step();
    } catch (const std::runtime_error& e) {
      why = e.what();
    }
    return !why.empty();
  }));
  EXPECT_EQ(why, "the NATS server refused the connection: Authorization Violation");
}

TEST_F(LidarWorker, MakesABucketAnewThatWasDeletedAndWritesToIt) {
  const auto robot = Robot();
  const auto worker = Worker();
  ASSERT_TRUE(Eventually([&] { return !worker->Taken("r1.front").empty(); }));
  const NatsClient client(server_.url());
  const char* const kBucket = "KV_lidar-workers";
  ASSERT_EQ(js_DeleteStream(client.js(), kBucket, nullptr, nullptr), NATS_OK);
  ASSERT_TRUE(Eventually([&] {
    jsStreamInfo* raw = nullptr;
    js_GetStreamInfo(&raw, client.js(), kBucket, nullptr, nullptr);
    const nats::StreamInfoPtr info(raw);
    return info && info->State.Msgs > 0;
  }));
  const auto record = worker::ParseLeaseRecord(Record());
  ASSERT_TRUE(record);
  EXPECT_NE(record->worker, "");
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

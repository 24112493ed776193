// SPDX-License-Identifier: LGPL-2.1-or-later
// Kills the workers and the servers of a fleet, one after another. The fleet has a cluster of three
// nats-servers, robots that drive, and workers that process the robots' slices. This program is run
// by hand because it takes minutes (docs/results/fleet.md).
#include <future>
#include <map>
#include <tuple>

#include "tests/elements/nats/nats_cluster.h"
#include "tests/elements/nats/worker_process.h"

namespace lidar::test {
namespace {

using SteadyClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kWorkers = 3;
constexpr int kRobots = 4;
constexpr int kWorkerKills = 10;

double SecondsSince(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

class Robot {
 public:
  Robot(int i, const std::string& url)
      : name_("r" + std::to_string(i) + ".front"),
        subject_("fleet.r" + std::to_string(i)),
        url_(" url=" + url + " "),
        sender_(DrivingRobot() + "! natssink name=n jetstream=fleet replicas=3 subject=" +
                subject_ + ".lidar.front drain-timeout=30000000000" + url_),
        poses_("natssrc name=n subject=" + subject_ + ".odometry.front" + url_ +
               "! fakesink name=see sync=false") {
    poses_.Play();
    sender_.Play();
  }
  const std::string& name() const { return name_; }
  std::size_t poses() const { return poses_.count(); }
  std::vector<Kept> LivePoses() const { return poses_.buffers(); }
  NatsPipeline& sender() { return sender_; }

  std::vector<Kept> Replay(const std::string& stream, const std::string& kind) const {
    NatsPipeline player("natssrc name=n eos-at-end=true start-time=0 jetstream=" + stream +
                        " subject=" + subject_ + "." + kind + ".front" + url_ +
                        "! fakesink name=see sync=false");
    player.Play();
    EXPECT_EQ(player.WaitForEnd(), "");
    return player.buffers();
  }

 private:
  const std::string name_;
  const std::string subject_;
  const std::string url_;
  NatsPipeline sender_;
  NatsPipeline poses_;
};

/// Returns how many of `sent` are not in `stored`. The order does not matter, because it may change
/// when a stream loses its leader.
std::size_t Missing(const std::vector<Kept>& sent, const std::vector<Kept>& stored) {
  std::set<std::string> there;
  for (const Kept& kept : stored) there.insert(kept.bytes);
  return static_cast<std::size_t>(std::count_if(
      sent.begin(), sent.end(), [&](const Kept& kept) { return there.count(kept.bytes) == 0; }));
}

/// Returns how many of `stored` were captured earlier than a slice that is before them.
std::size_t OutOfOrder(const std::vector<Kept>& stored) {
  GstClockTime newest = 0;
  return static_cast<std::size_t>(std::count_if(stored.begin(), stored.end(), [&](const Kept& k) {
    const bool late = k.capture_time < newest;
    newest = std::max(newest, k.capture_time);
    return late;
  }));
}

class FleetCluster : public NatsTest {
 protected:
  void SetUp() override {
    NatsTest::SetUp();
    if (IsSkipped()) return;
    cluster_.Start();
    // This stream stores all poses that workers publish, so the test can count the poses.
    const nats::StreamSettings poses{"poses", std::chrono::hours(1), 0, 3, {}};
    std::string why;
    ASSERT_TRUE(WaitFor([&] {
      return nats::EnsureStream(cluster_.js(), poses, {"fleet.*.odometry.>"}, &why);
    })) << why;
    for (int i = 0; i < kRobots; ++i) robots_.push_back(std::make_unique<Robot>(i, cluster_.url()));
    for (std::size_t i = 0; i < kWorkers; ++i) workers_.push_back(NewWorker());
    ASSERT_TRUE(WaitFor([this] { return AllOwned(); }));
    ASSERT_TRUE(WaitFor([this] {
      return std::all_of(robots_.begin(), robots_.end(), [](auto& r) { return r->poses() > 20; });
    }));
    std::printf("%d robots, of which the workers have", kRobots);
    for (auto& worker : workers_) std::printf(" %zu", worker->Robots().size());
    std::printf("\n");
  }
  std::unique_ptr<WorkerProcess> NewWorker() {
    return std::make_unique<WorkerProcess>(std::vector<std::string>{
        "*", "--url", cluster_.url(), "--replicas", "3", "--max-robots", "3"});
  }
  bool AllOwned() {
    std::size_t owned = 0;
    for (auto& worker : workers_) owned += worker->Robots().size();
    return owned == kRobots;
  }
  /// Returns the time until each of the streams has a leader that answers [s].
  double TimeToLeaders() {
    const auto begin = SteadyClock::now();
    jsOptions options;
    jsOptions_Init(&options);
    options.Wait = 100;
    for (const char* stream : {"fleet", "KV_lidar-workers"})
      EXPECT_TRUE(WaitFor([&] {
        jsStreamInfo* raw = nullptr;
        const natsStatus s = js_GetStreamInfo(&raw, cluster_.js(), stream, &options, nullptr);
        const nats::StreamInfoPtr info(raw);
        return s == NATS_OK;
      }));
    return SecondsSince(begin);
  }
  /// Returns, for each of the robots `names`, the time until its new worker has published a pose
  /// [s].
  std::map<std::string, double> TimesToPoses(const std::set<std::string>& names) {
    const auto begin = SteadyClock::now();
    // Waits until the last poses of the old worker have arrived, because they must not count.
    std::this_thread::sleep_for(milliseconds(100));
    std::map<std::string, std::size_t> before;
    for (const auto& robot : robots_) before[robot->name()] = robot->poses();
    std::map<std::string, double> times;
    EXPECT_TRUE(WaitFor([&] {
      for (const auto& robot : robots_)
        if (names.count(robot->name()) > 0 && robot->poses() > before[robot->name()])
          times.try_emplace(robot->name(), SecondsSince(begin));
      return times.size() == names.size();
    }));
    return times;
  }
  void TearDown() override {
    if (!HasFailure()) return;
    for (auto& worker : workers_)
      for (const std::string& line : worker->lines()) std::printf("%s\n", line.c_str());
  }
  void KillWorkers();
  void KillServers();
  void CountAll();

  Cluster cluster_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<std::unique_ptr<WorkerProcess>> workers_;
};

void FleetCluster::KillWorkers() {
  std::vector<double> times;
  for (int kill = 0; kill < kWorkerKills; ++kill) {
    const auto victim = std::max_element(workers_.begin(), workers_.end(), [](auto& a, auto& b) {
      return a->Robots().size() < b->Robots().size();
    });
    const std::set<std::string> orphans = (*victim)->Robots();
    (*victim)->Kill();
    for (const auto& [name, time] : TimesToPoses(orphans)) times.push_back(time);
    *victim = NewWorker();
    ASSERT_TRUE(WaitFor([this] { return AllOwned(); }));
    std::this_thread::sleep_for(milliseconds(1500));  // by then the new worker can take robots over
  }
  std::sort(times.begin(), times.end());
  ASSERT_FALSE(times.empty());
  std::printf(
      "worker killed, until its robots have poses: %zu times, %.2f to %.2f s, median %.2f s\n",
      times.size(), times.front(), times.back(), times[times.size() / 2]);
}

void FleetCluster::KillServers() {
  for (std::size_t i = 0; i < kServers; ++i) {
    std::map<std::string, std::string> leaders;
    ASSERT_TRUE(WaitFor([&] {
      for (const char* stream : {"fleet", "KV_lidar-workers", "poses"})
        if ((leaders[stream] = cluster_.LeaderOf(stream)).empty()) return false;
      return true;
    })) << "copies are complete";
    std::string led;
    for (const auto& [stream, leader] : leaders)
      if (leader == Cluster::Name(i)) led += " " + stream;
    std::set<std::string> all;
    for (const auto& robot : robots_) all.insert(robot->name());
    cluster_.server(i).Kill();
    auto leaders_back = std::async(std::launch::async, [this] { return TimeToLeaders(); });
    double longest = 0;
    for (const auto& [name, time] : TimesToPoses(all)) longest = std::max(longest, time);
    ASSERT_TRUE(WaitFor([this] { return AllOwned(); }));
    std::printf(
        "server killed that led%s: slices and leases have leaders after %.2f s, every robot has "
        "poses again after %.2f s\n",
        led.empty() ? " nothing" : led.c_str(), leaders_back.get(), longest);
    std::this_thread::sleep_for(milliseconds(3000));
    cluster_.server(i).Restart();
  }
}

void FleetCluster::CountAll() {
  for (const auto& robot : robots_) {
    const std::string robot_name = robot->name().substr(0, robot->name().find('.'));
    robot->sender().SendEos();
    EXPECT_EQ(robot->sender().WaitForEnd(), "");
    const auto sent = robot->sender().buffers();
    EXPECT_EQ(robot->sender().stat("messages-dropped"), 0U);
    EXPECT_EQ(robot->sender().stat("messages-acknowledged"), sent.size());
    // A server that was just restarted may not have all messages yet, so a replay from it may be
    // incomplete.
    std::vector<Kept> stored;
    EXPECT_TRUE(WaitFor([&] {
      stored = robot->Replay("fleet", "lidar");
      return Missing(sent, stored) == 0;
    }));
    const GstClockTime last = sent.back().capture_time;
    std::vector<Kept> poses;
    EXPECT_TRUE(WaitFor([&] {
      poses = robot->Replay("poses", "odometry");
      return !poses.empty() && poses.back().capture_time + 200 * GST_MSECOND > last;
    }));
    // Workers do not wait for acknowledgements of their poses. Therefore the stream lacks the poses
    // that were published while it had no leader.
    for (const Kept& live : robot->LivePoses()) poses.push_back(live);
    std::stable_sort(poses.begin(), poses.end(), [](const Kept& a, const Kept& b) {
      return std::tie(a.capture_time, a.bytes) < std::tie(b.capture_time, b.bytes);
    });
    poses.erase(std::unique(poses.begin(), poses.end(),
                            [](const Kept& a, const Kept& b) {
                              return a.capture_time == b.capture_time && a.bytes == b.bytes;
                            }),
                poses.end());
    std::set<guint> scans;
    for (const Kept& kept : sent)
      if (!poses.empty() && kept.capture_time + 60 * GST_MSECOND > poses.front().capture_time)
        scans.insert(kept.slice.scan_id);
    std::set<GstClockTime> times;
    for (const Kept& pose : poses) times.insert(pose.capture_time);
    std::printf(
        "%s: %zu slices sent, acknowledged and kept, %zu out of order; %zu scans, %zu with a pose, "
        "%zu poses twice; "
        "largest jump %.2f m in %.0f m, behind by %.2f m, in one go by %.2f m\n",
        robot->name().c_str(), sent.size(), OutOfOrder(stored), scans.size(), times.size(),
        poses.size() - times.size(), LargestJump(poses),
        poses.empty() ? 0 : DistanceOf(poses.back()), BehindBy(poses),
        BehindBy(PosesInOneGo(robot_name, cluster_.url())));
    EXPECT_LT(LargestJump(poses), 3);
  }
}

TEST_F(FleetCluster, GoesOnWhereWorkersAreKilled) {
  KillWorkers();
  CountAll();
}

TEST_F(FleetCluster, GoesOnWhereServersAreKilled) {
  KillServers();
  CountAll();
}

}  // namespace
}  // namespace lidar::test

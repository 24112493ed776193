// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a whole fleet for minutes and kills parts of it: robots with SCReAM, lidar-edge, a cluster
// of three nats-servers, and workers. The books tell what happened to every slice. This program is
// run by hand, by fleet_endurance.sh.
#include <array>
#include <functional>
#include <random>
#include <set>

#include "ext/nats/message.h"
#include "tests/elements/nats/fleet_processes.h"
#include "tests/elements/nats/fleet_robots.h"
#include "tests/elements/nats/nats_cluster.h"
#include "tests/elements/nats/process_figures.h"
#include "tests/elements/nats/worker_process.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kEnduringWorkers = 2;
constexpr double kSamplePause = 0.2;  // between two reads of the edge's reports [s]
constexpr double kReportAge = 1;      // an edge reports each slice within this time [s]
constexpr double kMemoryPause = 60;

struct EnduranceOptions {
  static double Number(const char* name, double otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::atof(text) : otherwise;
  }
  std::size_t robots = static_cast<std::size_t>(Number("FLEET_ROBOTS", 20));
  std::size_t slam = static_cast<std::size_t>(Number("FLEET_SLAM", 4));
  double seconds = Number("FLEET_MINUTES", 10) * 60;
  double kill_every = Number("FLEET_KILL_EVERY", 15);  // [s]; 0: nothing is killed
  unsigned seed = static_cast<unsigned>(Number("FLEET_SEED", 1));
};

struct StoredStream {
  std::map<std::string, std::vector<StoredSlice>> of;  // by robot
  std::map<std::uint64_t, StoredSlice> by_sequence;
};

class FleetEndurance : public NatsTest {
 protected:
  void SetUp() override;
  void Run();
  void KillSomething();
  void KillServer(std::size_t i);
  bool ClusterIsWhole();
  void RestartDue();
  void Settle();
  void CountSlices();
  void CountPoses();
  StoredStream ReadStream();
  std::unique_ptr<WorkerProcess> NewWorker() {
    return std::make_unique<WorkerProcess>(
        std::vector<std::string>{"s*", "--url", cluster_.url(), "--replicas", "3"});
  }
  double Elapsed() const { return WallTime() - begin_; }
  void Say(const std::string& what) const {
    std::printf("%6.1f s: %s\n", Elapsed(), what.c_str());
    std::fflush(stdout);
  }
  void TellMemory();
  void TellOfWorkers();

  const EnduranceOptions options_{};
  std::mt19937 random_{options_.seed};
  Cluster cluster_;
  std::unique_ptr<AckWitness> witness_;
  std::unique_ptr<EdgeProcess> edge_;
  std::unique_ptr<Robots> robots_;
  std::vector<std::unique_ptr<NatsPipeline>> poses_;  // of the robots with a worker
  std::vector<std::set<guint>> stored_scans_;         // of each robot, when the run has ended
  std::vector<std::unique_ptr<WorkerProcess>> workers_;
  // For each worker, the number of its lines that were printed.
  std::map<pid_t, std::size_t> lines_told_;
  struct Down {
    double until;
    std::function<void()> restart;
  };
  std::vector<Down> down_;
  std::array<int, 3> kills_{};  // numbers of killed servers, edges and workers
  double begin_ = 0;
};

void FleetEndurance::SetUp() {
  NatsTest::SetUp();
  if (IsSkipped()) return;
  setvbuf(stdout, nullptr, _IOLBF, 0);  // prints each line at once, because a run may take an hour
  cluster_.Start();
  witness_ = std::make_unique<AckWitness>(cluster_.url(), "fleet");
  const std::vector<int> ports = FreePorts(options_.robots);
  std::vector<std::string> names;
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < options_.robots; ++i) {
    names.push_back((i < options_.slam ? "s" : "r") + std::to_string(i));
    list.push_back({{"name", names[i]}, {"port", ports[i]}, {"sensor", "front"}});
  }
  edge_ = std::make_unique<EdgeProcess>(nlohmann::json{{"nats",
                                                        {{"url", cluster_.url()},
                                                         {"jetstream", "fleet"},
                                                         {"replicas", kServers},
                                                         {"max-age", 0}}},
                                                       {"robots", list}},
                                        server_.folder());
  ASSERT_TRUE(edge_->Start());
  robots_ = std::make_unique<Robots>(names, ports);
  for (std::size_t i = 0; i < std::min(options_.slam, options_.robots); ++i) {
    poses_.push_back(std::make_unique<NatsPipeline>("natssrc name=n subject=fleet." + names[i] +
                                                    ".odometry.front url=" + cluster_.url() +
                                                    " ! fakesink name=see sync=false"));
    poses_.back()->Play();
  }
  begin_ = WallTime();
  robots_->Play();
  if (!poses_.empty())
    for (std::size_t i = 0; i < kEnduringWorkers; ++i) workers_.push_back(NewWorker());
  ASSERT_TRUE(WaitFor([this] {
    return std::all_of(poses_.begin(), poses_.end(), [](auto& p) { return p->count() > 20; });
  }));
}

void FleetEndurance::TellMemory() {
  std::string line = "RSS [MB] and processor time [s]:";
  const auto add = [&line](const std::string& name, pid_t pid) {
    char text[80];
    std::snprintf(text, sizeof text, " %s %.1f %.0f |", name.c_str(), MegabytesOf(pid), CpuOf(pid));
    line += pid > 0 ? text : " " + name + " away |";
  };
  add("edge", edge_->pid());
  for (std::size_t i = 0; i < kServers; ++i) add(Cluster::Name(i), cluster_.server(i).pid());
  for (std::size_t i = 0; i < workers_.size(); ++i)
    add("worker-" + std::to_string(i), workers_[i]->pid());
  Say(line);
}

void FleetEndurance::TellOfWorkers() {
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    const std::vector<std::string>& lines = workers_[i]->lines();
    for (std::size_t& told = lines_told_[workers_[i]->pid()]; told < lines.size(); ++told)
      Say("worker-" + std::to_string(i) + ": " + lines[told]);
  }
}

bool FleetEndurance::ClusterIsWhole() {
  return !cluster_.LeaderOf("fleet").empty() &&
         (workers_.empty() || !cluster_.LeaderOf("KV_lidar-workers").empty());
}

void FleetEndurance::KillServer(std::size_t i) {
  cluster_.server(i).Kill();
  Say(Cluster::Name(i) + " killed");
  down_.push_back({WallTime() + std::uniform_real_distribution<>(1, 5)(random_), [this, i] {
                     cluster_.server(i).Restart();
                     Say(Cluster::Name(i) + " is back");
                   }});
  ++kills_[0];
}

void FleetEndurance::KillSomething() {
  std::uniform_real_distribution<> pause(0.5, 3);
  const std::size_t part = random_() % (workers_.empty() ? 2 : 3);
  const std::size_t which = random_();
  if (part == 0) {
    // A server may be killed only if the other two run and have all messages.
    if (ClusterIsWhole())
      KillServer(which % kServers);
    else
      Say("the cluster is not whole yet; no server is killed");
  } else if (part == 1 && edge_->is_up()) {
    edge_->Kill();
    Say("edge killed");
    ++kills_[1];
    down_.push_back({WallTime() + pause(random_), [this] {
                       EXPECT_TRUE(edge_->Start());
                       Say("edge is back");
                     }});
  } else if (part == 2) {
    auto& worker = workers_[which % workers_.size()];
    if (worker->is_killed()) return;
    worker->Kill();
    TellOfWorkers();
    Say("worker killed that had " + std::to_string(worker->Robots().size()) + " robots");
    ++kills_[2];
    down_.push_back({WallTime() + pause(random_), [this, &worker] { worker = NewWorker(); }});
  }
}

void FleetEndurance::RestartDue() {
  const double now = WallTime();
  for (std::size_t i = 0; i < down_.size();) {
    if (now < down_[i].until) {
      ++i;
      continue;
    }
    const auto restart = std::move(down_[i].restart);
    down_.erase(down_.begin() + static_cast<std::ptrdiff_t>(i));
    restart();
  }
}

void FleetEndurance::Run() {
  std::uniform_real_distribution<> spread(0.5, 1.5);
  double kill_at = WallTime() + options_.kill_every;
  double sample_at = 0;
  double memory_at = 0;
  while (Elapsed() < options_.seconds) {
    std::this_thread::sleep_for(milliseconds(20));
    const double now = WallTime();
    if (now >= sample_at) {
      sample_at = now + kSamplePause;
      edge_->Sample();
      TellOfWorkers();
    }
    if (now >= memory_at) {
      memory_at = now + kMemoryPause;
      TellMemory();
    }
    RestartDue();
    if (options_.kill_every <= 0 || now < kill_at) continue;
    kill_at = now + options_.kill_every * spread(random_);
    // Reads the edge's reports first, so that the last report is recent if the edge is killed now.
    edge_->Sample();
    KillSomething();
  }
  TellMemory();
}

/// Waits until all parts run again, all slices have arrived, and the edge has reported these
/// slices.
void FleetEndurance::Settle() {
  ASSERT_TRUE(WaitFor([this] {
    RestartDue();
    edge_->Sample();
    return down_.empty() && ClusterIsWhole();
  }));
  std::this_thread::sleep_for(std::chrono::seconds(3));
  edge_->Sample();
  robots_->Hold();
  std::this_thread::sleep_for(std::chrono::seconds(2));
  EXPECT_TRUE(WaitFor([this] {
    edge_->Sample();
    return edge_->WaitingNow() == 0;
  }));
  Say("all is sent; servers were killed " + std::to_string(kills_[0]) + " times, the edge " +
      std::to_string(kills_[1]) + ", workers " + std::to_string(kills_[2]));
}

StoredStream FleetEndurance::ReadStream() {
  StoredStream stream;
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Stream = "fleet";
  options.Ordered = true;
  options.Config.DeliverPolicy = js_DeliverAll;
  natsSubscription* raw_subscription = nullptr;
  EXPECT_TRUE(WaitFor([&] {
    return js_SubscribeSync(&raw_subscription, cluster_.js(), "fleet.*.lidar.front", nullptr,
                            &options, nullptr) == NATS_OK;
  }));
  const nats::SubscriptionPtr subscription(raw_subscription);
  for (bool more = raw_subscription != nullptr; more;) {
    natsMsg* raw = nullptr;
    const natsStatus status = natsSubscription_NextMsg(&raw, raw_subscription, 10'000);
    const nats::MessagePtr message(raw);
    jsMsgMetaData* raw_meta = nullptr;
    if (status != NATS_OK || natsMsg_GetMetaData(&raw_meta, raw) != NATS_OK) {
      ADD_FAILURE() << "the stream cannot be read: " << natsStatus_GetText(status);
      break;
    }
    const nats::MetaDataPtr meta(raw_meta);
    more = meta->NumPending > 0;
    const auto read = nats::Read(raw);
    if (!read) {
      ADD_FAILURE() << "the stream has a damaged message";
      continue;
    }
    const Kept kept = Keep(read->buffer.get());
    const StoredSlice slice{kept.slice.scan_id,
                            kept.slice.slice_index,
                            static_cast<double>(meta->Timestamp) * 1e-9,
                            std::hash<std::string>()(kept.bytes),
                            read->place.run,
                            read->place.number};
    const std::string subject = natsMsg_GetSubject(raw);  // fleet.<robot>.lidar.front
    const auto robot = subject.find('.') + 1;
    stream.of[subject.substr(robot, subject.find('.', robot) - robot)].push_back(slice);
    stream.by_sequence[meta->Sequence.Stream] = slice;
  }
  return stream;
}

void FleetEndurance::CountSlices() {
  const StoredStream stream = ReadStream();
  witness_->End();
  RobotBooks all;
  std::printf("%s\n", TitleOfBooks().c_str());
  std::vector<std::string> gaps;
  for (std::size_t i = 0; i < robots_->names().size(); ++i) {
    const std::string& name = robots_->names()[i];
    const auto stored = stream.of.find(name);
    const RobotBooks books = MakeBooks(
        robots_->SentBy(i), stored == stream.of.end() ? std::vector<StoredSlice>() : stored->second,
        edge_->SessionsOf(name), edge_->lives(), kReportAge);
    std::printf("%s\n", LineOfBooks(name, books).c_str());
    EXPECT_TRUE(books.Balanced()) << name;
    for (const std::string& gap : books.gaps) gaps.push_back(name + ": " + gap);
    all += books;
    stored_scans_.emplace_back();
    if (stored != stream.of.end())
      for (const StoredSlice& slice : stored->second) stored_scans_.back().insert(slice.scan);
  }
  std::printf("%s\n", LineOfBooks("all", all).c_str());
  for (const std::string& gap : gaps) std::printf("%s\n", gap.c_str());
  const std::size_t gone = witness_->CountGone(stream.by_sequence);
  std::printf("%zu acknowledgements were seen on their way, of which %zu are of what is gone\n",
              witness_->seen(), gone);
  std::printf("%s\n", robots_->SenderLosses().c_str());
  EXPECT_EQ(gone, 0U);
}

/// Counts the poses that each receiver lacks. Poses are not acknowledged, so only a receiver can
/// notice that some are missing.
void FleetEndurance::CountPoses() {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const auto& scans = robots_->ScansOf(i);
    const GstClockTime last = scans.rbegin()->second;
    EXPECT_TRUE(WaitFor([&] {
      const std::vector<Kept> poses = poses_[i]->buffers();
      return !poses.empty() && poses.back().capture_time + 300 * GST_MSECOND > last;
    }));
    const std::vector<Kept> poses = poses_[i]->buffers();
    if (poses.empty()) continue;
    std::set<GstClockTime> times;
    for (const Kept& pose : poses) times.insert(pose.capture_time);
    std::size_t wanted = 0;
    std::size_t missing = 0;
    for (auto scan = scans.begin(); scan != scans.end() && std::next(scan) != scans.end(); ++scan) {
      const GstClockTime end = std::next(scan)->second;
      if (end <= *times.begin() || stored_scans_[i].count(scan->first) == 0) continue;
      ++wanted;
      const auto pose = times.lower_bound(scan->second);
      if (pose == times.end() || *pose >= end) ++missing;
    }
    const guint64 counted = poses_[i]->stat("messages-lost");
    std::printf("%s: %zu scans in the stream, %zu without a pose, %" G_GUINT64_FORMAT
                " poses counted as lost by natssrc, %zu twice; largest jump %.2f m, behind by "
                "%.2f m, in one go by %.2f m\n",
                robots_->names()[i].c_str(), wanted, missing, counted, poses.size() - times.size(),
                LargestJump(poses), BehindBy(poses),
                BehindBy(PosesInOneGo(robots_->names()[i], cluster_.url())));
    EXPECT_LE(missing, counted + 1) << "the last scan has a pose when the next one begins";
  }
}

TEST_F(FleetEndurance, LosesNothingThatWasAcknowledged) {
  Run();
  Settle();
  CountSlices();
  CountPoses();
}

}  // namespace
}  // namespace lidar::test

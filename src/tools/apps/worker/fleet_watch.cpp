// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/fleet_watch.h"

#include <glib.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include "ext/nats/jetstream.h"
#include "src/tools/apps/worker/lease_store.h"
#include "src/tools/common/event_loop.h"

namespace lidar::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPoll{50};
constexpr milliseconds kRenewInterval{200};
constexpr milliseconds kListInterval{1'000};
// The least pause after a list, as a multiple of the time that the list took.
constexpr int kListPause = 5;
constexpr std::int64_t kHeartbeatNs = 500'000'000;
constexpr int kMaxValueSize = 4'096;
constexpr const char* kSeparator = ".lidar.";

using KeyValuePtr = std::unique_ptr<kvStore, decltype(&kvStore_Destroy)>;

}  // namespace

bool IsWanted(const FleetSettings& settings, const std::string& name) {
  const auto dot = name.find('.');
  if (dot == name.npos) return false;
  const std::string robot = name.substr(0, dot);
  const std::string sensor = name.substr(dot + 1);
  for (const std::string& word : {robot, sensor})
    if (word.empty() || !nats::CheckName(word).empty()) return false;
  return std::any_of(settings.patterns.begin(), settings.patterns.end(), [&](const auto& pattern) {
    return g_pattern_match_simple(pattern.c_str(), robot.c_str()) != FALSE ||
           g_pattern_match_simple(pattern.c_str(), name.c_str()) != FALSE;
  });
}

std::set<std::string> WithinBounds(const std::set<std::string>& all) {
  std::map<std::string, std::size_t> sensors;  // number of sensors of each robot
  std::set<std::string> kept;
  for (const std::string& name : all) {
    const std::string robot = name.substr(0, name.find('.'));
    if (sensors.size() == kMostRobots && sensors.count(robot) == 0) continue;
    if (++sensors[robot] <= kMostSensors) kept.insert(name);
  }
  return kept;
}

std::string RobotOf(const FleetSettings& settings, const std::string& subject) {
  const std::string begin = settings.prefix + ".";
  if (subject.compare(0, begin.size(), begin) != 0) return "";
  const auto at = subject.find(kSeparator, begin.size());
  if (at == subject.npos) return "";
  return subject.substr(begin.size(), at - begin.size()) + "." +
         subject.substr(at + std::string(kSeparator).size());
}

FleetWatch::FleetWatch(nats::Connection* connection, const FleetSettings& settings)
    : connection_(connection),
      settings_(settings),
      js_(nats::OpenJetStream(connection->get())),
      thread_([this] { Run(); }) {}

FleetWatch::~FleetWatch() {
  stopping_ = true;
  thread_.join();
}

FleetWatch::News FleetWatch::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

void FleetWatch::Tell(std::string* last, const std::string& trouble) {
  if (std::exchange(*last, trouble) == trouble || trouble.empty()) return;
  const std::lock_guard lock(mutex_);
  news_.troubles.push_back(trouble);
}

void FleetWatch::Run() {
  while (!stopping_) Step();
  entries_.reset();
  nats_ReleaseThreadMemory();
}

natsStatus FleetWatch::MakeBucket() {
  kvStore* raw = nullptr;
  natsStatus s = js_KeyValue(&raw, js_.get(), settings_.bucket.c_str());
  if (s == NATS_NOT_FOUND) {
    kvConfig config;
    kvConfig_Init(&config);
    config.Bucket = settings_.bucket.c_str();
    config.Description = "which lidar-worker has which robot, and how far it is";
    config.MaxValueSize = kMaxValueSize;
    config.Replicas = settings_.replicas;
    s = js_CreateKeyValue(&raw, js_.get(), &config);
  }
  const KeyValuePtr store(raw, kvStore_Destroy);
  return s;
}

/// Subscribes to the entries of the bucket. A consumer ends with its server, so each reconnect
/// needs a new subscription.
natsStatus FleetWatch::Subscribe() {
  entries_.reset();
  last_number_ = 0;
  natsStatus s = MakeBucket();
  if (s != NATS_OK) return s;
  const std::string stream = "KV_" + settings_.bucket;
  jsSubOptions options;
  jsSubOptions_Init(&options);
  options.Stream = stream.c_str();
  options.Config.AckPolicy = js_AckNone;
  options.Config.DeliverPolicy = js_DeliverLastPerSubject;
  options.Config.FlowControl = true;
  options.Config.Heartbeat = kHeartbeatNs;
  options.Config.MemoryStorage = true;
  options.Config.Replicas = 1;
  natsSubscription* raw = nullptr;
  s = js_SubscribeSync(&raw, js_.get(), LeaseStore::Subject(settings_.bucket, ">").c_str(), nullptr,
                       &options, nullptr);
  entries_ = nats::SubscriptionPtr(raw, {connection_->get()});
  return s;
}

void FleetWatch::Step() {
  const nats::ConnectionState state = connection_->state();
  const auto now = steady_clock::now();
  if (!js_ || !state.connected()) {
    std::this_thread::sleep_for(kPoll);
    return;
  }
  stale_ = renew_.exchange(false) || stale_ || state.connections != connections_ ||
           state.missed_heartbeats != missed_heartbeats_;
  if (stale_ && now >= renew_at_) {
    renew_at_ = now + kRenewInterval;
    const natsStatus s = Subscribe();
    stale_ = s != NATS_OK;
    Tell(&bucket_trouble_,
         stale_ ? "the bucket " + settings_.bucket + " cannot be used: " + nats::ErrorText(s) : "");
    connections_ = state.connections;
    missed_heartbeats_ = state.missed_heartbeats;
  }
  if (now >= list_at_) {
    ListRobots();
    // The destructor has to wait if a list is under way. This is rare, because the pause between
    // lists grows with the time that a list takes.
    const auto took = steady_clock::now() - now;
    list_at_ = now + std::max<steady_clock::duration>(kListInterval, kListPause * took);
  }
  if (!entries_) {
    std::this_thread::sleep_for(kPoll);
    return;
  }
  natsMsg* raw = nullptr;
  const natsStatus s = natsSubscription_NextMsg(&raw, entries_.get(), kPoll.count());
  const nats::MessagePtr message(raw);
  if (s == NATS_OK)
    TakeEntry(raw);
  else if (s != NATS_TIMEOUT)
    stale_ = true;
}

void FleetWatch::TakeEntry(natsMsg* message) {
  jsMsgMetaData* raw = nullptr;
  if (natsMsg_GetMetaData(&raw, message) != NATS_OK) return;
  const nats::MetaDataPtr meta(raw);
  if (meta->Sequence.Consumer != ++last_number_) {
    stale_ = true;
    return;
  }
  const std::string subject = natsMsg_GetSubject(message);
  const std::string begin = LeaseStore::Subject(settings_.bucket, "");
  if (subject.compare(0, begin.size(), begin) != 0) return;
  Entry entry{subject.substr(begin.size()), meta->Sequence.Stream, ""};
  if (!IsWanted(settings_, entry.robot)) return;
  const int size = natsMsg_GetDataLength(message);
  if (size > 0) entry.text.assign(natsMsg_GetData(message), static_cast<std::size_t>(size));
  const std::lock_guard lock(mutex_);
  news_.entries.push_back(std::move(entry));
}

void FleetWatch::ListRobots() {
  const std::string filter = settings_.prefix + ".*.lidar.*";
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = nats::kRequestTimeoutMs;
  options.Stream.Info.SubjectsFilter = filter.c_str();
  const Time asked_at = tools::Now();
  jsStreamInfo* raw = nullptr;
  const natsStatus s =
      js_GetStreamInfo(&raw, js_.get(), settings_.stream.c_str(), &options, nullptr);
  const nats::StreamInfoPtr info(raw);
  if (s != NATS_OK)
    return Tell(&stream_trouble_,
                s == NATS_NOT_FOUND
                    ? "there is no stream " + settings_.stream + " yet"
                    : "the stream " + settings_.stream + " cannot be read: " + nats::ErrorText(s));
  std::set<std::string> all;
  const jsStreamStateSubjects* subjects = info->State.Subjects;
  for (int i = 0; subjects != nullptr && i < subjects->Count; ++i) {
    const std::string robot = RobotOf(settings_, subjects->List[i].Subject);
    if (IsWanted(settings_, robot)) all.insert(robot);
  }
  auto robots = WithinBounds(all);
  const std::size_t left_out = all.size() - robots.size();
  Tell(&stream_trouble_,
       left_out > 0 ? "sensors are left out: a robot may have " + std::to_string(kMostSensors) +
                          ", and a worker follows " + std::to_string(kMostRobots) + " robots"
                    : "");
  const std::lock_guard lock(mutex_);
  news_.robots = std::move(robots);
  news_.left_out = left_out;
  news_.stream = static_cast<std::uint64_t>(info->Created);
  news_.first = info->State.FirstSeq;
  news_.last = info->State.LastSeq;
  news_.asked_at = asked_at;
}

}  // namespace lidar::worker

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/worker/lease_table.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

namespace lidar::worker {
namespace {

constexpr int kRenewals = 4;  // number of writes during one lease
/// Other workers wait for 1 + 1 / kMargin times the duration of the lease, because their clocks may
/// be faster than the owner's. The rates of steady clocks differ by far less than 1 / kMargin.
constexpr int kMargin = 20;
/// A worker whose places are all in use waits for this share of a lease before it takes a free
/// robot. A worker with fewer robots waits less, so that it takes the robot first.
constexpr double kHesitation = 0.3;
/// A sensor that makes no progress for this time gives up its place if another sensor waits for
/// one.
constexpr Duration kIdleSensor = std::chrono::seconds(30);

/// Returns the robot of an entry. The name of an entry is "robot" or "robot.sensor".
std::string NameOf(const std::string& entry) { return entry.substr(0, entry.find('.')); }

}  // namespace

LeaseTable::Robot* LeaseTable::FindPending(std::uint64_t ticket) {
  for (auto& [name, robot] : robots_)
    if (robot.pending && robot.pending->ticket == ticket) return &robot;
  return nullptr;
}

void LeaseTable::SetRobots(const std::set<std::string>& robots, Time now) {
  for (auto at = robots_.begin(); at != robots_.end();) {
    Robot& robot = at->second;
    robot.wanted = robots.count(at->first) > 0;
    // A robot with an entry is kept even if it is not wanted, because the bucket sends each entry
    // only once.
    const bool is_known = robot.revision > 0 || robot.doubted_since || robot.held || robot.pending;
    at = robot.wanted || is_known ? std::next(at) : robots_.erase(at);
  }
  for (const std::string& name : robots) {
    const auto [at, is_new] = robots_.try_emplace(name);
    at->second.wanted = true;
    // Waits before the first try, because the bucket may still send the robot's entry, which may be
    // another worker's lease.
    if (is_new) at->second.not_before = now + settings_.lease / kRenewals;
  }
}

/// Sets the time from which workers other than the owner may take the robot. The robot's entry was
/// seen just now.
void LeaseTable::NoteFree(Robot* robot, bool damaged, Time now) const {
  const LeaseRecord& record = robot->record;
  const bool nobody = !damaged && (record.worker.empty() || record.worker == settings_.worker);
  const Duration lease = damaged ? settings_.lease : record.lease;
  robot->free_at = nobody ? now : now + lease + lease / kMargin;
}

void LeaseTable::OnEntry(const std::string& name, std::uint64_t revision,
                         const std::optional<LeaseRecord>& record, Time now) {
  Robot& robot = robots_[name];
  if (revision < robot.revision && !robot.doubted_since) return;
  robot.doubted_since.reset();
  if (revision == robot.revision) return;
  robot.revision = revision;
  const auto progress = robot.record.progress;
  robot.record = record.value_or(LeaseRecord());
  // The entry may be this worker's own write whose answer has not arrived. Then the progress in
  // `robot` is newer than the progress in the entry.
  const bool ours = record && record->worker == settings_.worker;
  if (ours && robot.held) robot.record.progress = progress;
  if (!ours) robot.held = false;
  NoteFree(&robot, !record.has_value(), now);
}

void LeaseTable::OnStored(std::uint64_t ticket, std::uint64_t revision, Time now) {
  Robot* robot = FindPending(ticket);
  if (robot == nullptr) return;
  const Time sent_at = robot->pending->sent_at;
  robot->pending.reset();
  if (revision < robot->revision && !robot->doubted_since) return;  // a newer write has replaced it
  robot->revision = revision;
  robot->doubted_since.reset();
  if (ending_) return;
  robot->record.worker = settings_.worker;
  robot->record.lease = settings_.lease;
  NoteFree(robot, false, now);
  robot->held = true;
  robot->until = sent_at + settings_.lease;
  robot->renew_at = sent_at + settings_.lease / kRenewals;
}

void LeaseTable::OnRefused(std::uint64_t ticket, std::optional<std::uint64_t> newest, Time now) {
  Robot* robot = FindPending(ticket);
  if (robot == nullptr) return;
  robot->pending.reset();
  // Waits until the store sends the robot's entry, which may be an earlier write of this worker.
  robot->not_before = robot->renew_at = now + settings_.lease / kRenewals;
  if (!robot->doubted_since) robot->doubted_since = now;
  if (newest != 0U) return;
  robot->revision = 0;
  // If the bucket is new, the owner wrote its lease to the old bucket, and this lease may still be
  // valid.
  const Duration lease = std::max(robot->record.lease, settings_.lease);
  robot->free_at = IsHeld(*robot, now) ? now : now + lease + lease / kMargin;
}

void LeaseTable::SetProgress(const std::string& name, const Progress& progress) {
  const auto found = robots_.find(name);
  if (found == robots_.end() || !found->second.held) return;
  const auto& before = found->second.record.progress;
  found->second.moved = found->second.moved || !before || before->scan != progress.scan;
  found->second.record.progress = progress;
}

void LeaseTable::Drop(const std::string& name, Duration pause, Time now) {
  const auto found = robots_.find(name);
  if (found == robots_.end()) return;
  found->second.held = false;
  found->second.pending.reset();  // an answer must not renew the lease any more
  found->second.not_before = now + pause;
}

void LeaseTable::LeaveToOthers(const std::string& name, Duration least, Time now) {
  // Other workers wait for one lease after the last write of this worker. This worker waits for two
  // leases, so that another worker takes the robot first.
  Drop(name, std::max(least, 2 * settings_.lease), now);
}

void LeaseTable::Expire(Time now) {
  for (auto& [name, robot] : robots_) {
    if (!robot.wanted) robot.pending.reset();
    if (now >= robot.until || !robot.wanted) robot.held = false;
    if (robot.pending && now - robot.pending->sent_at > settings_.lease / 2) robot.pending.reset();
  }
}

std::map<std::string, std::size_t> LeaseTable::Places() const {
  std::map<std::string, std::size_t> places;
  for (const auto& [name, robot] : robots_)
    if (robot.held) ++places[NameOf(name)];
  return places;
}

LeaseTable::Robots::iterator LeaseTable::Choose(const std::map<std::string, std::size_t>& places,
                                                std::size_t held, Time now) {
  const auto hesitation =
      FromSeconds(kHesitation * Seconds(settings_.lease) * static_cast<double>(held) /
                  static_cast<double>(settings_.most));
  auto best = robots_.end();
  // Prefers the robots with the fewest places, and among these the robots with the fewest tries.
  // Each worker orders the remaining robots differently, so that two workers seldom choose the same
  // one.
  std::tuple<std::size_t, std::uint64_t, std::size_t> best_rank;
  for (auto at = robots_.begin(); at != robots_.end(); ++at) {
    const Robot& robot = at->second;
    const bool free =
        robot.wanted && !robot.held && now >= robot.not_before && now >= robot.free_at + hesitation;
    if (!free) continue;
    const auto has = places.find(NameOf(at->first));
    const std::tuple rank(has == places.end() ? 0 : has->second, robot.tries,
                          std::hash<std::string>()(settings_.worker + "/" + at->first));
    if (best != robots_.end() && rank >= best_rank) continue;
    best = at;
    best_rank = rank;
  }
  return best;
}

bool LeaseTable::MakeRoom(const std::map<std::string, std::size_t>& places,
                          const std::string& waiting, Time now) {
  const auto places_of = [&](const std::string& name) {
    const auto has = places.find(NameOf(name));
    return has == places.end() ? std::size_t{0} : has->second;
  };
  auto worst = robots_.end();
  for (auto at = robots_.begin(); at != robots_.end(); ++at) {
    if (!at->second.held) continue;
    const auto rank = std::make_pair(places_of(at->first), now - at->second.moved_at);
    if (worst == robots_.end() ||
        rank > std::make_pair(places_of(worst->first), now - worst->second.moved_at))
      worst = at;
  }
  if (worst == robots_.end()) return false;
  // A robot gives up a place only if it then still has at least as many places as the robot
  // `waiting`. Otherwise the two robots would exchange the place for ever.
  const bool unfair = places_of(worst->first) >= places_of(waiting) + 2;
  const auto idle = std::find_if(robots_.begin(), robots_.end(), [&](const auto& item) {
    return item.second.held && now - item.second.moved_at > kIdleSensor;
  });
  if (!unfair && idle == robots_.end()) return false;
  LeaveToOthers(unfair ? worst->first : idle->first, Duration{}, now);
  return true;
}

LeaseTable::Robots::iterator LeaseTable::Next(Time now) {
  std::size_t held = 0;
  for (auto& [name, robot] : robots_) {
    if (!robot.held && robot.pending) return robots_.end();  // one new robot at a time
    if (robot.held) ++held;
    if (std::exchange(robot.moved, false)) robot.moved_at = now;
  }
  const auto places = Places();
  const auto chosen = Choose(places, held, now);
  if (chosen == robots_.end() || held < settings_.most) return chosen;
  return MakeRoom(places, chosen->first, now) ? chosen : robots_.end();
}

LeaseTable::Write LeaseTable::Send(const std::string& name, Robot* robot, const std::string& worker,
                                   Time now) {
  robot->pending = Pending{next_ticket_++, now};
  const LeaseRecord record{worker, settings_.lease, robot->record.progress};
  return {robot->pending->ticket, name, robot->revision, ToJson(record)};
}

std::vector<LeaseTable::Write> LeaseTable::Poll(Time now) {
  Expire(now);
  std::vector<Write> writes;
  if (ending_) return writes;
  for (auto& [name, robot] : robots_)
    if (robot.held && !robot.pending && now >= robot.renew_at)
      writes.push_back(Send(name, &robot, settings_.worker, now));
  const auto chosen = Next(now);
  if (chosen != robots_.end()) {
    ++chosen->second.tries;
    chosen->second.moved = true;
    chosen->second.last_worker = chosen->second.record.worker;
    writes.push_back(Send(chosen->first, &chosen->second, settings_.worker, now));
  }
  return writes;
}

std::vector<LeaseTable::Write> LeaseTable::HandOver(Time now) {
  ending_ = true;
  std::vector<Write> writes;
  for (auto& [name, robot] : robots_) {
    robot.pending.reset();
    if (IsHeld(robot, now)) writes.push_back(Send(name, &robot, "", now));
    robot.held = false;
  }
  return writes;
}

std::map<std::string, LeaseTable::Held> LeaseTable::HeldAt(Time now) const {
  std::map<std::string, Held> held;
  for (const auto& [name, robot] : robots_)
    if (IsHeld(robot, now) && robot.wanted)
      held[name] = {robot.until, robot.last_worker, robot.record.progress};
  return held;
}

bool LeaseTable::MissesEntries(Time now) {
  bool misses = false;
  for (auto& [name, robot] : robots_) {
    if (!robot.doubted_since || now - *robot.doubted_since < settings_.lease / 2) continue;
    robot.doubted_since = now;
    misses = true;
  }
  return misses;
}

std::size_t LeaseTable::unanswered() const {
  return static_cast<std::size_t>(std::count_if(
      robots_.begin(), robots_.end(), [](const auto& item) { return item.second.pending; }));
}

}  // namespace lidar::worker

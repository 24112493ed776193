// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides which robots are ours: entries of the key-value store and answers in, writes out.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/tools/apps/worker/lease_record.h"

namespace lidar::worker {

struct LeaseSettings {
  std::string worker;  // a name that no other process has, nor will have
  Duration lease = std::chrono::seconds(1);
  std::size_t most = 8;  // robots at a time
};

/// Leases by revisions alone. A write names the revision that it replaces, and the store refuses it
/// if that is not the newest. An owner has a robot for `lease` from when it *sent* the write that
/// was stored last. Another worker waits for longer than that, from when it *saw* that write, and
/// then replaces exactly that one. So no two have a robot at once, and the clocks of machines and
/// servers need not agree: each span of time is measured by one steady clock. Deterministic; for
/// one thread.
///
/// An entry is a sensor, "r7" or "r7.front", and a publisher can make up any number of sensors of
/// its robot. So robots share the places of a worker evenly, whatever their sensors are; a sensor
/// that makes no progress leaves its place to one that waits.
class LeaseTable {
 public:
  struct Write {
    std::uint64_t ticket;  // comes back with the answer
    std::string robot;
    std::uint64_t replaces;  // revision; 0: there is none
    std::string text;
  };
  struct Held {
    Time until{};             // the lease is over then, if it is not renewed
    std::string last_worker;  // the last owner; may be empty
    std::optional<Progress> progress;
  };

  explicit LeaseTable(const LeaseSettings& settings) : settings_(settings) {}

  /// Sets the robots of the fleet.
  void SetRobots(const std::set<std::string>& robots, Time now);
  /// Notes the store's entry of a robot; without a record the entry is damaged.
  void OnEntry(const std::string& robot, std::uint64_t revision,
               const std::optional<LeaseRecord>& record, Time now);
  void OnStored(std::uint64_t ticket, std::uint64_t revision, Time now);
  /// The store refused a write; `newest` is the revision that it has instead, if it said so.
  void OnRefused(std::uint64_t ticket, std::optional<std::uint64_t> newest, Time now);

  /// Sets the progress for the next renewal.
  void SetProgress(const std::string& robot, const Progress& progress);
  /// Gives up a robot; it is not taken again for `pause`.
  void Drop(const std::string& robot, Duration pause, Time now);
  /// Gives up a robot that fails here: any other worker takes it before we try again, which we do
  /// after `least` or later.
  void LeaveToOthers(const std::string& robot, Duration least, Time now);
  /// Ends leases that are over, and gives what to write now.
  std::vector<Write> Poll(Time now);
  /// Gives up all robots at once, in favour of the waiting workers. Takes no robot any more.
  std::vector<Write> HandOver(Time now);

  /// The robots of this worker at `now`, whether or not a renewal is in time.
  std::map<std::string, Held> HeldAt(Time now) const;
  /// Returns true if expected entries of others do not come, so that all are to be read again.
  bool MissesEntries(Time now);
  /// Writes that have no answer yet.
  std::size_t unanswered() const;

 private:
  struct Pending {
    std::uint64_t ticket;
    Time sent_at;
  };
  struct Robot {
    bool wanted = false;
    bool held = false;
    std::uint64_t revision = 0;  // of the newest known entry; 0: unknown
    // When a write was refused: the store may have another entry, even of a lower revision.
    std::optional<Time> doubted_since;
    LeaseRecord record;  // in that entry
    Time free_at{};      // the lease of its owner ends
    Time not_before{};   // no try is made
    Time until{};        // while it is held
    Time renew_at{};
    std::string last_worker;
    std::optional<Pending> pending;
    Time moved_at{};  // when it was taken, or progressed last
    bool moved = false;
    std::uint64_t tries = 0;  // how often we took it
  };
  using Robots = std::map<std::string, Robot>;

  Robot* FindPending(std::uint64_t ticket);
  bool IsHeld(const Robot& robot, Time now) const { return robot.held && now < robot.until; }
  void NoteFree(Robot* robot, bool damaged, Time now) const;
  void Expire(Time now);
  /// How many places each robot has, by its name.
  std::map<std::string, std::size_t> Places() const;
  /// The robot to take now, where there is room; end() for none.
  Robots::iterator Choose(const std::map<std::string, std::size_t>& places, std::size_t held,
                          Time now);
  /// Gives up a place that `waiting` has more right to.
  bool MakeRoom(const std::map<std::string, std::size_t>& places, const std::string& waiting,
                Time now);
  Robots::iterator Next(Time now);
  Write Send(const std::string& name, Robot* robot, const std::string& worker, Time now);

  const LeaseSettings settings_;
  Robots robots_;
  std::uint64_t next_ticket_ = 1;
  bool ending_ = false;
};

}  // namespace lidar::worker

// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides which robots are ours: takes entries and answers of the key-value store, returns writes.
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
  std::string worker;  // a name that no other process ever has
  Duration lease = std::chrono::seconds(1);
  std::size_t most = 8;  // robots at a time
};

/// Leases by revisions alone. A write names the revision that it replaces, and the store refuses it
/// if that is not the newest. An owner has a robot for `lease` from when it *sent* the last stored
/// write. Another worker waits longer than that from when it *saw* that write, and then replaces
/// exactly that write. So no two workers have a robot at once, and the clocks of machines and
/// servers need not agree: each span of time is measured by one steady clock. Deterministic; for
/// one thread.
///
/// An entry stands for a sensor, "r7" or "r7.front", and a publisher can invent any number of
/// sensors of its robot. So robots share the `most` places of a worker evenly, however many sensors
/// they have. A sensor without progress gives its place to a waiting one.
class LeaseTable {
 public:
  struct Write {
    std::uint64_t ticket;  // returned with the answer
    std::string robot;
    std::uint64_t replaces;  // revision; 0: there is no entry
    std::string text;
  };
  struct Held {
    Time until{};             // end of the lease without a renewal
    std::string last_worker;  // the last owner; may be empty
    std::optional<Progress> progress;
  };

  explicit LeaseTable(const LeaseSettings& settings) : settings_(settings) {}

  /// Sets the robots of the fleet.
  void SetRobots(const std::set<std::string>& robots, Time now);
  /// Notes the store's entry of a robot. A missing record means that the entry is damaged.
  void OnEntry(const std::string& robot, std::uint64_t revision,
               const std::optional<LeaseRecord>& record, Time now);
  void OnStored(std::uint64_t ticket, std::uint64_t revision, Time now);
  /// The store refused a write. `newest` is the entry's present revision, if known.
  void OnRefused(std::uint64_t ticket, std::optional<std::uint64_t> newest, Time now);

  /// Sets the progress for the next renewal.
  void SetProgress(const std::string& robot, const Progress& progress);
  /// Gives up a robot, and does not take it again for `pause`.
  void Drop(const std::string& robot, Duration pause, Time now);
  /// Gives up a robot that fails here. Another worker may take it; this one tries again after
  /// `least`.
  void LeaveToOthers(const std::string& robot, Duration least, Time now);
  /// Ends leases that are over, and returns the writes to send now.
  std::vector<Write> Poll(Time now);
  /// Returns writes that free all robots at once. No robot is taken after that.
  std::vector<Write> HandOver(Time now);

  /// Returns the robots whose leases are valid at `now`: not those whose renewal is late.
  std::map<std::string, Held> HeldAt(Time now) const;
  /// Returns true if expected entries are missing. Then all must be read again.
  bool MissesEntries(Time now);
  /// Number of writes without an answer yet.
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
    // Time of a refused write. The store's entry then has another revision, maybe a lower one.
    std::optional<Time> doubted_since;
    LeaseRecord record;  // the record of that entry
    Time free_at{};      // end of the owner's lease
    Time not_before{};   // no try before this time
    Time until{};        // end of our lease
    Time renew_at{};
    std::string last_worker;
    std::optional<Pending> pending;
    Time moved_at{};  // time of taking or last progress
    bool moved = false;
    std::uint64_t tries = 0;  // number of times we took it
  };
  using Robots = std::map<std::string, Robot>;

  Robot* FindPending(std::uint64_t ticket);
  bool IsHeld(const Robot& robot, Time now) const { return robot.held && now < robot.until; }
  void NoteFree(Robot* robot, bool damaged, Time now) const;
  void Expire(Time now);
  /// Returns the number of places by robot.
  std::map<std::string, std::size_t> Places() const;
  /// Returns the robot to take now if there is room; end() for none.
  Robots::iterator Choose(const std::map<std::string, std::size_t>& places, std::size_t held,
                          Time now);
  /// Gives up a place for which `waiting` has a better claim.
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

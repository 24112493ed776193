// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides which robots this worker leases. Reads the entries and answers of the key-value store,
// and returns the writes to send to it.
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
  std::string worker;  // name of this process, which no other process ever has
  Duration lease = std::chrono::seconds(1);
  std::size_t most = 8;  // greatest number of robots at a time
};

/// Leases robots by means of the revisions in the store. Each write names the revision that it
/// replaces, and the store refuses the write if this revision is not the newest. A worker has a
/// robot for the time `lease` after it *sent* its last stored write. Another worker waits longer
/// than `lease` after it *saw* that write, and then replaces exactly that write. So two workers
/// never have the same robot at once. The clocks of machines and servers need not agree, because
/// each duration is measured by a single steady clock. Deterministic. Only one thread may use it.
///
/// Each entry belongs to a sensor, "r7" or "r7.front". A worker has `most` places, and each sensor
/// needs one. A publisher can invent any number of sensors of its robot, so the robots share the
/// places evenly, however many sensors they have. A sensor without progress gives up its place if
/// another sensor waits for one.
class LeaseTable {
 public:
  struct Write {
    std::uint64_t ticket;  // the answer to this write has the same ticket
    std::string robot;
    std::uint64_t replaces;  // revision that the write replaces; 0: there is no entry
    std::string text;
  };
  struct Held {
    Time until{};             // end of the lease if it is not renewed
    std::string last_worker;  // the last owner; may be empty
    std::optional<Progress> progress;
  };

  explicit LeaseTable(const LeaseSettings& settings) : settings_(settings) {}

  /// Sets the robots of the fleet.
  void SetRobots(const std::set<std::string>& robots, Time now);
  /// Notes the entry that the store has for a robot. If `record` is missing, the entry is damaged.
  void OnEntry(const std::string& robot, std::uint64_t revision,
               const std::optional<LeaseRecord>& record, Time now);
  void OnStored(std::uint64_t ticket, std::uint64_t revision, Time now);
  /// Notes that the store refused a write. `newest` is the present revision of the entry, if known.
  void OnRefused(std::uint64_t ticket, std::optional<std::uint64_t> newest, Time now);

  /// Sets the progress that the next renewal of the lease will write.
  void SetProgress(const std::string& robot, const Progress& progress);
  /// Gives up a robot, and does not try to lease it again before `pause` has passed.
  void Drop(const std::string& robot, Duration pause, Time now);
  /// Gives up a robot whose pipeline fails, so that another worker may lease it. This worker tries
  /// again after twice the duration of a lease, or after `least` if `least` is longer.
  void LeaveToOthers(const std::string& robot, Duration least, Time now);
  /// Ends the leases that have expired, and returns the writes to send now.
  std::vector<Write> Poll(Time now);
  /// Returns writes that free all robots at once. After this call, no robot is leased any more.
  std::vector<Write> HandOver(Time now);

  /// Returns the robots whose leases are valid at `now`. A lease whose renewal is late is not
  /// valid.
  std::map<std::string, Held> HeldAt(Time now) const;
  /// Returns true if an expected entry has not arrived in time. Then all entries must be read
  /// again.
  bool MissesEntries(Time now);
  /// Returns the number of writes that have no answer yet.
  std::size_t unanswered() const;

 private:
  struct Pending {
    std::uint64_t ticket;
    Time sent_at;
  };
  struct Robot {
    bool wanted = false;
    bool held = false;
    std::uint64_t revision = 0;  // newest known revision of the entry; 0: unknown
    // The time at which a write was refused. The revision of the entry in the store then differs
    // from `revision`, and may be lower.
    std::optional<Time> doubted_since;
    LeaseRecord record;  // content of the entry with this revision
    Time free_at{};      // end of the owner's lease
    Time not_before{};   // this worker does not try to lease the robot earlier
    Time until{};        // end of this worker's lease
    Time renew_at{};
    std::string last_worker;
    std::optional<Pending> pending;
    Time moved_at{};  // time of the last progress, or of the lease's begin
    bool moved = false;
    std::uint64_t tries = 0;  // how often this worker tried to lease the robot
  };
  using Robots = std::map<std::string, Robot>;

  Robot* FindPending(std::uint64_t ticket);
  bool IsHeld(const Robot& robot, Time now) const { return robot.held && now < robot.until; }
  void NoteFree(Robot* robot, bool damaged, Time now) const;
  void Expire(Time now);
  /// Returns the number of leased sensors for each robot.
  std::map<std::string, std::size_t> Places() const;
  /// Returns the robot that this worker should lease next if it has a free place. Returns end() if
  /// there is no such robot.
  Robots::iterator Choose(const std::map<std::string, std::size_t>& places, std::size_t held,
                          Time now);
  /// Gives up a place if `waiting` has a better claim to it. Returns false if all places are kept.
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

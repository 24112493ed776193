// SPDX-License-Identifier: LGPL-2.1-or-later
// The sessions of one robot, one after another. A session ends when the robot says goodbye, is
// silent, or exceeds its limit, and after an error. After an excess or an error, there is a pause
// before the next session.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "gst/common/refs.h"
#include "src/base/backoff.h"
#include "src/tools/apps/edge/edge_config.h"
#include "src/tools/apps/edge/robot_watch.h"
#include "src/tools/apps/fleet/exposition.h"

namespace lidar::edge {

class Session {
 public:
  /// `socket` is the robot's socket on the common port, or NULL. Throws std::runtime_error if an
  /// element is missing or a setting is wrong.
  Session(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket);
  ~Session() { End(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Begins or ends a session if that is due. Must be called by the same thread as Finish().
  void Poll(Time now);
  /// Completes the files, and then ends the session.
  void Finish(Time now);

  const RobotConfig& robot() const { return robot_; }
  GstElement* pipeline() const { return pipeline_.get(); }
  /// Adds the robot's figures to `exposition`, and returns them as JSON. May be called from any
  /// thread. Does not wait for a server or a disk.
  nlohmann::json Tell(fleet::Exposition* exposition) const;

 private:
  enum class State { kWaiting, kReceiving, kResting };
  /// The state of the robot's session, and counts of events in all its sessions.
  struct Account {
    State state = State::kWaiting;
    std::uint64_t sessions = 0;
    std::uint64_t failures = 0;
    std::uint64_t penalties = 0;
    std::uint64_t record_failures = 0;
    std::string last_error;
  };

  void Begin(Time now);
  void End();
  /// Ends the session, and begins the next one after `pause`. Prints `why`.
  void Rest(Time now, Duration pause, const std::string& why);
  void Record(Time now);
  bool ReadBus(Time now);
  bool NoteError(Time now, GstMessage* message);
  void NoteRecordFailure(Time now, const std::string& why);
  void Watch(Time now);
  guint64 BytesReceived() const;
  Account account() const;
  template <class Change>
  void Update(Change change);
  void Say(const std::string& what) const;

  const RobotConfig& robot_;
  GSocket* const socket_;
  const gst::ElementPtr pipeline_;

  // Used by Poll() and Finish() only.
  State state_ = State::kResting;
  Time begin_at_{};  // end of the pause between two sessions
  Time began_at_{};
  std::optional<Time> watch_at_;  // time of the next Watch()
  RobotWatch robot_watch_;
  bool recording_ = false;
  Time record_at_{};  // time at which a recorder was added or will be added
  Backoff failures_;
  Backoff record_failures_;

  mutable std::mutex mutex_;  // guards account_
  Account account_;
};

}  // namespace lidar::edge

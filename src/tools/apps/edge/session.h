// SPDX-License-Identifier: LGPL-2.1-or-later
// The sessions of a robot, one after another: each ends with the robot's goodbye, silence, excess
// or an error, and the next one begins after a pause.
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

  /// Begins or ends a session if that is due. One thread calls this and Finish().
  void Poll(Time now);
  /// Ends the session once its files are complete.
  void Finish(Time now);

  const RobotConfig& robot() const { return robot_; }
  GstElement* pipeline() const { return pipeline_.get(); }
  /// Adds the robot's figures to `exposition`, and returns them as a report. May be called from any
  /// thread. Waits for no server and no disk.
  nlohmann::json Tell(fleet::Exposition* exposition) const;

 private:
  enum class State { kWaiting, kReceiving, kResting };
  /// The figures of the robot.
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
  /// Shuts the robot out for `pause`.
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
  Time begin_at_{};  // end of a rest
  Time began_at_{};
  std::optional<Time> watch_at_;  // time of the next Watch()
  RobotWatch robot_watch_;
  bool recording_ = false;
  Time record_at_{};  // when recording began or will begin
  Backoff failures_;
  Backoff record_failures_;

  mutable std::mutex mutex_;  // guards what follows
  Account account_;
};

}  // namespace lidar::edge

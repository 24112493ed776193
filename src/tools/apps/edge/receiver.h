// SPDX-License-Identifier: LGPL-2.1-or-later
// A robot's receiver: a pipeline and a thread of its own, so that its failures harm no other.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <condition_variable>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <thread>

#include "gst/common/refs.h"
#include "src/base/backoff.h"
#include "src/tools/apps/edge/edge_config.h"
#include "src/tools/apps/edge/robot_watch.h"
#include "src/tools/apps/fleet/exposition.h"

namespace lidar::edge {

class Receiver {
 public:
  /// `socket`: the robot's own on the common port, or NULL. Throws std::runtime_error if an element
  /// is missing or a setting is wrong.
  Receiver(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket);
  /// Ends the session, and waits for it.
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Ends the session once its files are complete. Does not wait.
  void AskToEnd();

  const RobotConfig& robot() const { return robot_; }
  /// Adds its figures to `exposition`, and returns them as a report. From any thread; waits for no
  /// server and no disk.
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

  void Run();
  void Poll(Time now);
  void Begin(Time now);
  void End();
  void Finish();
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

  // Used by the thread only.
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
  std::condition_variable wake_;
  bool ending_ = false;
  Account account_;

  std::thread thread_;
};

}  // namespace lidar::edge

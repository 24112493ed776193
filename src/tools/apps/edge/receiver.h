// SPDX-License-Identifier: LGPL-2.1-or-later
// A robot's receiver: its sessions on a thread of their own, so that its failures harm no other
// robot.
#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>

#include "src/tools/apps/edge/session.h"

namespace lidar::edge {

class Receiver {
 public:
  /// Passes its arguments to Session, and throws as Session does.
  Receiver(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket);
  /// Ends the session, and waits for it.
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Ends the session once its files are complete. Does not wait.
  void AskToEnd();

  const Session& session() const { return session_; }

 private:
  void Run();

  Session session_;
  std::mutex mutex_;  // guards `ending_`
  std::condition_variable wake_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace lidar::edge

// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs the sessions of one robot on a thread of their own, so that a failure of this robot does not
// affect the other robots.
#pragma once
#include <condition_variable>
#include <mutex>
#include <thread>

#include "src/tools/apps/edge/session.h"

namespace lidar::edge {

class Receiver {
 public:
  /// Passes its arguments to Session, and throws what the constructor of Session throws.
  Receiver(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket);
  /// Ends the session, and waits for the thread.
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// Asks the thread to complete the files and to end the session. Does not wait.
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

// SPDX-License-Identifier: LGPL-2.1-or-later
// Two network namespaces, of a robot and of an edge, with Ethernet links between them.
#pragma once
#include <string>

namespace lidar::test {

class Networks {
 public:
  /// Creates the namespaces. Returns false if the user may not create any, or if iproute2 is
  /// missing.
  bool Create();
  ~Networks();

  /// Moves the calling thread into the robot's or the edge's namespace. Threads that it starts
  /// later are in the same namespace.
  void EnterRobot() const;
  void EnterEdge() const;
  /// Makes Ethernet link `n`. The robot's interface rN gets the address 10.9.N.`host`, and the
  /// edge's interface eN gets 10.9.N.1.
  void Connect(int n, int host = 2) const;
  void Disconnect(int n) const;
  /// Runs a command in the robot's namespace. The test fails if the command fails.
  void Robot(const std::string& command) const;

 private:
  int robot_ = -1;
  int edge_ = -1;
  int before_ = -1;
};

}  // namespace lidar::test

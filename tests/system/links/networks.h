// SPDX-License-Identifier: LGPL-2.1-or-later
// A robot and an edge in network namespaces of their own, with Ethernets between them.
#pragma once
#include <string>

namespace lidar::test {

class Networks {
 public:
  /// Returns false if the user may not make networks, or iproute2 is missing.
  bool Create();
  ~Networks();

  /// The calling thread, and threads that it starts, are in this network from now on.
  void EnterRobot() const;
  void EnterEdge() const;
  /// Makes Ethernet `n`: the robot's interface rN has 10.9.N.`host`, the edge's eN has 10.9.N.1.
  void Connect(int n, int host = 2) const;
  void Disconnect(int n) const;
  /// Runs a command in the robot's network. The test fails if the command fails.
  void Robot(const std::string& command) const;

 private:
  int robot_ = -1;
  int edge_ = -1;
  int before_ = -1;
};

}  // namespace lidar::test

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/system/links/networks.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>

namespace lidar::test {
namespace {

const char* const kOwn = "/proc/thread-self/ns/net";

int NewNetwork() {
  if (unshare(CLONE_NEWNET) != 0 || std::system("ip link set lo up 2>/dev/null") != 0) return -1;
  return open(kOwn, O_RDONLY | O_CLOEXEC);
}

}  // namespace

bool Networks::Create() {
  before_ = open(kOwn, O_RDONLY | O_CLOEXEC);
  edge_ = NewNetwork();
  robot_ = edge_ < 0 ? -1 : NewNetwork();
  return robot_ >= 0;
}

Networks::~Networks() {
  if (before_ >= 0) {
    EXPECT_EQ(setns(before_, CLONE_NEWNET), 0);
  }
  for (const int fd : {robot_, edge_, before_})
    if (fd >= 0) close(fd);
}

void Networks::EnterRobot() const { EXPECT_EQ(setns(robot_, CLONE_NEWNET), 0); }
void Networks::EnterEdge() const { EXPECT_EQ(setns(edge_, CLONE_NEWNET), 0); }

void Networks::Robot(const std::string& command) const {
  EnterRobot();
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

void Networks::Connect(int n, int host) const {
  const std::string i = std::to_string(n);
  const std::string edge = "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(edge_);
  Robot("ip link add r" + i + " type veth peer name e" + i + " && ip link set e" + i + " netns " +
        edge + " && ip addr add 10.9." + i + "." + std::to_string(host) + "/24 dev r" + i +
        " && ip link set r" + i + " up");
  EnterEdge();
  const std::string command =
      "ip addr add 10.9." + i + ".1/24 dev e" + i + " && ip link set e" + i + " up";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  Robot("until ip link show r" + i + " | grep -q LOWER_UP; do sleep 0.01; done");
}

void Networks::Disconnect(int n) const { Robot("ip link del r" + std::to_string(n)); }

}  // namespace lidar::test

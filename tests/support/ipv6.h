// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks whether this machine has IPv6. Tests need to know that before they use the loopback
// address of IPv6.
#pragma once
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace lidar::test {

inline bool HasIpv6() {
  const int fd = socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  sockaddr_in6 local{};
  local.sin6_family = AF_INET6;
  local.sin6_addr = in6addr_loopback;
  const bool bound = bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local) == 0;
  close(fd);
  return bound;
}

}  // namespace lidar::test

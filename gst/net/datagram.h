// SPDX-License-Identifier: LGPL-2.1-or-later
// The kernel's additions to datagrams of all UDP sockets: ECN bits and the time of arrival.
#pragma once
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <optional>
#include <string>

#include "src/base/time.h"

namespace lidar::net {

/// A socket address as the kernel takes it.
struct NativeAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  bool valid() const { return length != 0; }
  /// Returns true for an IPv4 address, also for one that is mapped into IPv6.
  bool IsIpv4() const;
  bool operator==(const NativeAddress& o) const;
  bool operator!=(const NativeAddress& o) const { return !(*this == o); }
};

/// The kernel's additions to a datagram.
struct DatagramInfo {
  std::uint8_t tos = 0;             // DSCP and ECN
  std::optional<Duration> arrival;  // since the Unix epoch
  std::optional<std::uint32_t>
      overflow;  // datagrams that found the buffer full, since the socket opened
};

/// Asks the kernel for all of DatagramInfo with each datagram.
void AskForInfo(int fd);
DatagramInfo ReadInfo(msghdr* received);

/// Space for the control messages that SetControl() writes.
struct SendControl {
  alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(int)) + CMSG_SPACE(sizeof(in6_pktinfo))] = {};
};
/// Makes `message`, whose destination is `to`, leave with `tos` through the interface with the
/// index `interface` (0: by the routes). Needs no privileges. `control` must live until the message
/// is sent.
void SetControl(std::uint8_t tos, const NativeAddress& to, unsigned interface, SendControl* control,
                msghdr* message);

/// Index of the interface `name` in the socket's network namespace; 0 if there is none.
unsigned InterfaceIndex(int fd, const std::string& name);

/// Makes multicast leave through the interface of that name. Returns false with errno set on
/// failure.
bool SendMulticastFrom(int fd, const std::string& interface);

/// Asks for a receive buffer of `bytes` (0: keeps the buffer). Returns the size that the kernel
/// grants, or 0 on failure.
unsigned SetReceiveBuffer(int fd, unsigned bytes);

}  // namespace lidar::net

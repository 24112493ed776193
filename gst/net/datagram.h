// SPDX-License-Identifier: LGPL-2.1-or-later
// The data that the kernel attaches to datagrams of UDP sockets: ECN bits and the time of arrival.
#pragma once
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <optional>
#include <string>

#include "src/base/time.h"

namespace lidar::net {

/// A socket address in the form that the kernel uses.
struct NativeAddress {
  sockaddr_storage storage{};
  socklen_t length = 0;

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  bool valid() const { return length != 0; }
  /// Returns true for an IPv4 address, even if it is mapped into IPv6.
  bool IsIpv4() const;
  bool operator==(const NativeAddress& o) const;
  bool operator!=(const NativeAddress& o) const { return !(*this == o); }
};

/// The data that the kernel attaches to a datagram.
struct DatagramInfo {
  std::uint8_t tos = 0;             // DSCP and ECN
  std::optional<Duration> arrival;  // since the Unix epoch
  std::optional<std::uint32_t>
      overflow;  // datagrams dropped because the buffer was full, since the socket was opened
};

/// Makes the kernel attach all of DatagramInfo to each datagram.
void AskForInfo(int fd);
DatagramInfo ReadInfo(msghdr* received);

/// Space for the control messages that SetControl() writes.
struct SendControl {
  alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(int)) + CMSG_SPACE(sizeof(in6_pktinfo))] = {};
};
/// Sets the control messages of `message`, which is sent to the address `to`. The kernel then sends
/// the message with the IP header field `tos`. If `interface` is an index of an interface, the
/// message leaves by this interface; if it is 0, the routing table decides. Needs no privileges.
/// `control` must live until the message is sent.
void SetControl(std::uint8_t tos, const NativeAddress& to, unsigned interface, SendControl* control,
                msghdr* message);

/// Returns the index of the interface `name` in the network namespace of the socket, or 0 if there
/// is none.
unsigned InterfaceIndex(int fd, const std::string& name);

/// Makes the socket send multicast through the interface of that name. On failure, sets errno and
/// returns false.
bool SendMulticastFrom(int fd, const std::string& interface);

/// Requests a receive buffer of `bytes`, or keeps the buffer if `bytes` is 0. Returns the size that
/// the kernel grants, or 0 on failure.
unsigned SetReceiveBuffer(int fd, unsigned bytes);

}  // namespace lidar::net

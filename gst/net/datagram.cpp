// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/net/datagram.h"

#include <net/if.h>
#include <sys/ioctl.h>

#include <cstring>
#include <ctime>

namespace lidar::net {
namespace {

template <class T>
T Payload(cmsghdr* c) {
  T value{};
  std::memcpy(&value, CMSG_DATA(c), sizeof value);
  return value;
}

void Enable(int fd, int level, int name) {
  const int on = 1;
  // An option of the other address family fails, which does no harm.
  if (setsockopt(fd, level, name, &on, sizeof on) != 0) return;
}

/// Writes a control message after the `used` bytes of earlier messages. Returns the new number of
/// used bytes.
template <class Value>
std::size_t Append(SendControl* control, std::size_t used, int level, int type,
                   const Value& value) {
  auto* c = reinterpret_cast<cmsghdr*>(control->bytes + used);
  c->cmsg_level = level;
  c->cmsg_type = type;
  c->cmsg_len = CMSG_LEN(sizeof value);
  std::memcpy(CMSG_DATA(c), &value, sizeof value);
  return used + CMSG_SPACE(sizeof value);
}

}  // namespace

bool NativeAddress::IsIpv4() const {
  if (storage.ss_family != AF_INET6) return storage.ss_family == AF_INET;
  sockaddr_in6 v6{};
  std::memcpy(&v6, &storage, sizeof v6);
  return IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr);
}

bool NativeAddress::operator==(const NativeAddress& o) const {
  return length == o.length && std::memcmp(&storage, &o.storage, length) == 0;
}

void AskForInfo(int fd) {
  Enable(fd, IPPROTO_IP, IP_RECVTOS);
  Enable(fd, IPPROTO_IPV6, IPV6_RECVTCLASS);
  Enable(fd, SOL_SOCKET, SO_TIMESTAMPNS);
  Enable(fd, SOL_SOCKET, SO_RXQ_OVFL);
}

DatagramInfo ReadInfo(msghdr* received) {
  DatagramInfo info;
  for (cmsghdr* c = CMSG_FIRSTHDR(received); c != nullptr; c = CMSG_NXTHDR(received, c)) {
    if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_TOS) {
      info.tos = Payload<std::uint8_t>(c);  // IP_TOS has one byte, unlike IPV6_TCLASS
    } else if (c->cmsg_level == IPPROTO_IPV6 && c->cmsg_type == IPV6_TCLASS) {
      info.tos = static_cast<std::uint8_t>(Payload<int>(c));
    } else if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SCM_TIMESTAMPNS) {
      const auto t = Payload<timespec>(c);
      info.arrival = std::chrono::seconds{t.tv_sec} + std::chrono::nanoseconds{t.tv_nsec};
    } else if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
      info.overflow = Payload<std::uint32_t>(c);
    }
  }
  return info;
}

void SetControl(std::uint8_t tos, const NativeAddress& to, unsigned interface, SendControl* control,
                msghdr* message) {
  *control = {};
  // A datagram to an IPv4 address that is mapped into IPv6 is sent by the IPv4 stack, which reads
  // only IPv4 options.
  const bool v4 = to.IsIpv4();
  const int level = v4 ? IPPROTO_IP : IPPROTO_IPV6;
  const int value = tos;
  std::size_t used = Append(control, 0, level, v4 ? IP_TOS : IPV6_TCLASS, value);
  if (interface != 0 && v4) {
    in_pktinfo info{};
    info.ipi_ifindex = static_cast<int>(interface);
    used = Append(control, used, level, IP_PKTINFO, info);
  } else if (interface != 0) {
    in6_pktinfo info{};
    info.ipi6_ifindex = interface;
    used = Append(control, used, level, IPV6_PKTINFO, info);
  }
  message->msg_control = control->bytes;
  message->msg_controllen = used;
}

unsigned InterfaceIndex(int fd, const std::string& name) {
  ifreq request{};
  if (name.size() >= sizeof request.ifr_name) return 0;
  std::memcpy(request.ifr_name, name.c_str(), name.size());
  return ioctl(fd, SIOCGIFINDEX, &request) == 0 ? static_cast<unsigned>(request.ifr_ifindex) : 0;
}

bool SendMulticastFrom(int fd, const std::string& interface) {
  const int index = static_cast<int>(if_nametoindex(interface.c_str()));
  if (index == 0) return false;
  sockaddr_storage local{};
  socklen_t length = sizeof local;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&local), &length) != 0) return false;
  ip_mreqn v4{};
  v4.imr_ifindex = index;
  // An IPv6 socket may also send to IPv4 groups, for which the kernel uses the IPv4 option.
  const int v4_result = setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &v4, sizeof v4);
  return (local.ss_family == AF_INET6
              ? setsockopt(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF, &index, sizeof index)
              : v4_result) == 0;
}

unsigned SetReceiveBuffer(int fd, unsigned bytes) {
  const int size = static_cast<int>(bytes);
  // SO_RCVBUFFORCE needs CAP_NET_ADMIN.
  if (bytes > 0 && setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &size, sizeof size) != 0 &&
      setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof size) != 0) {
    return 0;
  }
  int granted = 0;
  socklen_t length = sizeof granted;
  if (getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &granted, &length) != 0) return 0;
  return static_cast<unsigned>(granted / 2);  // the kernel doubles the size for its own bookkeeping
}

}  // namespace lidar::net

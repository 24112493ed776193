// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/common/udp_socket.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netdb.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace lidar::tools {
namespace {

constexpr std::size_t kMaxDatagram = 65536;
constexpr int kSocketBuffer = 4 << 20;  // a burst of scans fits
constexpr std::size_t kControlSize = 256;

[[noreturn]] void Fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

void SetFlag(int fd, int level, int option) {
  const int on = 1;
  if (setsockopt(fd, level, option, &on, sizeof on) != 0) Fail("cannot set a socket option");
}

/// The value of a control message that may be one byte (IPv4) or an int (IPv6).
std::uint8_t TosOf(const cmsghdr* c) {
  if (c->cmsg_len >= CMSG_LEN(sizeof(int))) {
    int value = 0;
    std::memcpy(&value, CMSG_DATA(c), sizeof value);
    return static_cast<std::uint8_t>(value);
  }
  return *CMSG_DATA(c);
}

void ReadControl(msghdr* message, Datagram* datagram) {
  for (cmsghdr* c = CMSG_FIRSTHDR(message); c != nullptr; c = CMSG_NXTHDR(message, c)) {
    if ((c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_TOS) ||
        (c->cmsg_level == IPPROTO_IPV6 && c->cmsg_type == IPV6_TCLASS)) {
      datagram->tos = TosOf(c);
    } else if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_TIMESTAMPNS) {
      timespec t{};
      std::memcpy(&t, CMSG_DATA(c), sizeof t);
      datagram->kernel_time = std::chrono::seconds{t.tv_sec} + std::chrono::nanoseconds{t.tv_nsec};
    }
  }
}

struct HostPort {
  std::string host;
  std::string port;
};

HostPort Split(const std::string& text, const std::string& default_host) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos) return {default_host, text};
  std::string host = text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  return {host.empty() ? default_host : host, text.substr(colon + 1)};
}

}  // namespace

bool Address::IsIpv4() const {
  if (storage.ss_family == AF_INET) return true;
  const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&storage);
  return storage.ss_family == AF_INET6 && IN6_IS_ADDR_V4MAPPED(&v6->sin6_addr);
}

std::string Address::ToString() const {
  char host[NI_MAXHOST] = "";
  char port[NI_MAXSERV] = "";
  getnameinfo(reinterpret_cast<const sockaddr*>(&storage), length, host, sizeof host, port,
              sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
  const bool brackets = storage.ss_family == AF_INET6;
  return (brackets ? "[" : "") + std::string(host) + (brackets ? "]:" : ":") + port;
}

bool operator==(const Address& a, const Address& b) {
  return a.length == b.length && std::memcmp(&a.storage, &b.storage, a.length) == 0;
}

Address ResolveAddress(const std::string& text, const std::string& default_host) {
  const HostPort parts = Split(text, default_host);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(parts.host.c_str(), parts.port.c_str(), &hints, &found);
  if (status != 0)
    throw std::runtime_error("cannot resolve '" + text + "': " + gai_strerror(status) +
                             " (expected HOST:PORT)");
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  Address address;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  address.length = found->ai_addrlen;
  return address;
}

UdpSocket::UdpSocket(int family)
    : fd_(socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (!fd_) Fail("cannot open a UDP socket");
  SetFlag(fd(), IPPROTO_IP, IP_RECVTOS);
  if (family == AF_INET6) SetFlag(fd(), IPPROTO_IPV6, IPV6_RECVTCLASS);
  SetFlag(fd(), SOL_SOCKET, SO_TIMESTAMPNS);
  // The kernel may grant less; that costs packets only in bursts.
  setsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &kSocketBuffer, sizeof kSocketBuffer);
  setsockopt(fd(), SOL_SOCKET, SO_SNDBUF, &kSocketBuffer, sizeof kSocketBuffer);
}

UdpSocket UdpSocket::Bind(const Address& local) {
  UdpSocket s(local.storage.ss_family);
  if (bind(s.fd(), reinterpret_cast<const sockaddr*>(&local.storage), local.length) != 0)
    Fail("cannot listen on " + local.ToString());
  return s;
}

UdpSocket UdpSocket::Connect(const Address& remote) {
  UdpSocket s(remote.storage.ss_family);
  if (connect(s.fd(), reinterpret_cast<const sockaddr*>(&remote.storage), remote.length) != 0)
    Fail("cannot reach " + remote.ToString());
  s.peer_ = remote;
  return s;
}

void UdpSocket::SendMulticastFrom(const std::string& interface) {
  const int index = static_cast<int>(if_nametoindex(interface.c_str()));
  if (index == 0) Fail("there is no interface " + interface);
  ip_mreqn v4{};
  v4.imr_ifindex = index;
  sockaddr_storage local{};
  socklen_t length = sizeof local;
  getsockname(fd(), reinterpret_cast<sockaddr*>(&local), &length);
  // The option for IPv4 is accepted on a socket of IPv6, where it does nothing.
  const int failed = local.ss_family == AF_INET6
                         ? setsockopt(fd(), IPPROTO_IPV6, IPV6_MULTICAST_IF, &index, sizeof index)
                         : setsockopt(fd(), IPPROTO_IP, IP_MULTICAST_IF, &v4, sizeof v4);
  if (failed != 0) Fail("cannot send multicast from " + interface);
}

int UdpSocket::LocalPort() const {
  sockaddr_storage local{};
  socklen_t length = sizeof local;
  getsockname(fd(), reinterpret_cast<sockaddr*>(&local), &length);
  const auto* v4 = reinterpret_cast<const sockaddr_in*>(&local);
  const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&local);
  return ntohs(local.ss_family == AF_INET6 ? v6->sin6_port : v4->sin_port);
}

void UdpSocket::ReceiveAll(const std::function<void(const Datagram&)>& handler) {
  std::uint8_t payload[kMaxDatagram];
  alignas(cmsghdr) char control[kControlSize];
  while (true) {
    Address from;
    iovec part{payload, sizeof payload};
    msghdr message{};
    message.msg_name = &from.storage;
    message.msg_namelen = sizeof from.storage;
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t size = recvmsg(fd(), &message, 0);
    // A connected socket reports the peer's "port unreachable" here: nothing was received.
    if (size < 0 && (errno == ECONNREFUSED || errno == EINTR)) continue;
    if (size < 0) return;
    from.length = message.msg_namelen;
    Datagram datagram{{payload, static_cast<std::size_t>(size)}, &from};
    ReadControl(&message, &datagram);
    handler(datagram);
  }
}

bool UdpSocket::Send(ByteView payload, std::uint8_t tos, const Address* to) {
  const bool v4 = (to != nullptr ? *to : peer_).IsIpv4();
  iovec part{const_cast<std::uint8_t*>(payload.data), payload.size};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr message{};
  if (to != nullptr) {
    message.msg_name = const_cast<sockaddr_storage*>(&to->storage);
    message.msg_namelen = to->length;
  }
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* c = CMSG_FIRSTHDR(&message);
  c->cmsg_level = v4 ? IPPROTO_IP : IPPROTO_IPV6;
  c->cmsg_type = v4 ? IP_TOS : IPV6_TCLASS;
  c->cmsg_len = CMSG_LEN(sizeof(int));
  const int value = tos;
  std::memcpy(CMSG_DATA(c), &value, sizeof value);
  ssize_t sent = 0;
  do {
    sent = sendmsg(fd(), &message, MSG_NOSIGNAL);
    // ECONNREFUSED belongs to an earlier packet; the call sent nothing and may be repeated once.
  } while (sent < 0 && errno == EINTR);
  if (sent < 0 && errno == ECONNREFUSED) sent = sendmsg(fd(), &message, MSG_NOSIGNAL);
  return sent >= 0;
}

}  // namespace lidar::tools

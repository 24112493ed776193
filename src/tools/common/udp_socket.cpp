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
constexpr int kSocketBuffer = 4 << 20;  // large enough for a burst of several scans
constexpr std::size_t kControlSize = 256;

[[noreturn]] void Fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

}  // namespace

HostPort Split(const std::string& text, const std::string& default_host) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos) return {default_host, text};
  std::string host = text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  return {host.empty() ? default_host : host, text.substr(colon + 1)};
}

std::string ToString(const Address& address) {
  char host[NI_MAXHOST] = "";
  char port[NI_MAXSERV] = "";
  getnameinfo(address.get(), address.length, host, sizeof host, port, sizeof port,
              NI_NUMERICHOST | NI_NUMERICSERV);
  const bool brackets = address.storage.ss_family == AF_INET6;
  return (brackets ? "[" : "") + std::string(host) + (brackets ? "]:" : ":") + port;
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
  net::AskForInfo(fd());
  // The kernel may grant a smaller buffer. A smaller buffer loses packets only in bursts.
  net::SetReceiveBuffer(fd(), kSocketBuffer);
  setsockopt(fd(), SOL_SOCKET, SO_SNDBUF, &kSocketBuffer, sizeof kSocketBuffer);
}

UdpSocket UdpSocket::Bind(const Address& local) {
  UdpSocket s(local.storage.ss_family);
  if (bind(s.fd(), local.get(), local.length) != 0) Fail("cannot listen on " + ToString(local));
  return s;
}

UdpSocket UdpSocket::Connect(const Address& remote) {
  UdpSocket s(remote.storage.ss_family);
  if (connect(s.fd(), remote.get(), remote.length) != 0) Fail("cannot reach " + ToString(remote));
  s.peer_ = remote;
  return s;
}

void UdpSocket::SendMulticastFrom(const std::string& interface) {
  if (!net::SendMulticastFrom(fd(), interface)) Fail("cannot send multicast from " + interface);
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
    // recvmsg() on a connected socket may return the error "port unreachable" for an earlier
    // packet.
    if (size < 0 && (errno == ECONNREFUSED || errno == EINTR)) continue;
    if (size < 0) return;
    from.length = message.msg_namelen;
    const net::DatagramInfo info = net::ReadInfo(&message);
    handler({{payload, static_cast<std::size_t>(size)},
             &from,
             info.tos,
             info.arrival.value_or(Duration{0})});
  }
}

bool UdpSocket::Send(ByteView payload, std::uint8_t tos, const Address* to) {
  iovec part{const_cast<std::uint8_t*>(payload.data), payload.size};
  net::SendControl control;
  msghdr message{};
  if (to != nullptr) {
    message.msg_name = const_cast<sockaddr_storage*>(&to->storage);
    message.msg_namelen = to->length;
  }
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  net::SetControl(tos, to != nullptr ? *to : peer_, 0, &control, &message);
  ssize_t sent = 0;
  do {
    sent = sendmsg(fd(), &message, MSG_NOSIGNAL);
    // ECONNREFUSED is the answer to an earlier packet. As nothing was sent, the call is repeated
    // once.
  } while (sent < 0 && errno == EINTR);
  if (sent < 0 && errno == ECONNREFUSED) sent = sendmsg(fd(), &message, MSG_NOSIGNAL);
  return sent >= 0;
}

}  // namespace lidar::tools

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/apps/edge/shared_port.h"

#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "src/tools/common/file_descriptor.h"

namespace lidar::edge {
namespace {

using Program = std::vector<sock_filter>;

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

sock_filter Step(unsigned code, std::uint32_t k, std::uint8_t yes = 0, std::uint8_t no = 0) {
  return {static_cast<std::uint16_t>(code), yes, no, k};
}

/// Makes a BPF program that returns the number of the socket for a datagram. The program returns 0
/// if the SSRC is in none of the ranges, and also if the datagram is too short to have an SSRC.
Program ChooseBySsrc(const std::vector<SsrcRange>& ranges) {
  // RTCP packets have the types 192 to 223 (RFC 5761). Their SSRC is at byte 4, while the SSRC of
  // RTP packets is at byte 8.
  Program p = {Step(BPF_LD | BPF_B | BPF_ABS, 1),
               Step(BPF_JMP | BPF_JGE | BPF_K, 192, 0, 3),
               Step(BPF_JMP | BPF_JGE | BPF_K, 224, 2, 0),
               Step(BPF_LD | BPF_W | BPF_ABS, 4),
               Step(BPF_JMP | BPF_JA, 1),
               Step(BPF_LD | BPF_W | BPF_ABS, 8)};
  std::uint32_t number = 0;
  for (const SsrcRange& range : ranges) {
    p.push_back(Step(BPF_JMP | BPF_JGE | BPF_K, range.first, 0, 2));
    p.push_back(Step(BPF_JMP | BPF_JGT | BPF_K, range.last, 1, 0));
    p.push_back(Step(BPF_RET | BPF_K, ++number));
  }
  p.push_back(Step(BPF_RET | BPF_K, 0));
  return p;
}

bool Attach(int fd, int option, Program program) {
  const sock_fprog p{static_cast<unsigned short>(program.size()), program.data()};
  return setsockopt(fd, SOL_SOCKET, option, &p, sizeof p) == 0;
}

struct Address {
  sockaddr_storage storage{};
  socklen_t length = 0;
};

/// Resolves a local address. An empty name means all addresses. These are the IPv6 and IPv4
/// addresses if the machine has IPv6, and otherwise only the IPv4 addresses.
Address Resolve(const std::string& name, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  hints.ai_socktype = SOCK_DGRAM;
  const int probe = name.empty() ? socket(AF_INET6, SOCK_DGRAM, 0) : -1;
  if (name.empty()) hints.ai_family = probe >= 0 ? AF_INET6 : AF_INET;
  if (probe >= 0) close(probe);
  addrinfo* found = nullptr;
  const int error = getaddrinfo(name.empty() ? nullptr : name.c_str(), std::to_string(port).c_str(),
                                &hints, &found);
  if (error != 0) Fail("address " + name + ": " + gai_strerror(error));
  Address address;
  address.length = found->ai_addrlen;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  freeaddrinfo(found);
  return address;
}

/// Opens a socket and binds it to `address`. If `shared` is true, other sockets of this user may
/// bind to the address, too. An IPv6 socket also receives IPv4.
tools::FileDescriptor OpenSocket(const Address& address, bool shared) {
  tools::FileDescriptor fd(
      socket(address.storage.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  const int off = 0;
  if (fd && address.storage.ss_family == AF_INET6)
    setsockopt(fd.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  const bool may_bind =
      fd && (!shared || setsockopt(fd.get(), SOL_SOCKET, SO_REUSEPORT, &on, sizeof on) == 0);
  if (may_bind &&
      bind(fd.get(), reinterpret_cast<const sockaddr*>(&address.storage), address.length) == 0)
    return fd;
  Fail(std::string("cannot open the shared port: ") + std::strerror(errno));
}

const Program kNothing = {Step(BPF_RET | BPF_K, 0)};

}  // namespace

SharedPort::SharedPort(const std::string& address, std::uint16_t port,
                       const std::vector<SsrcRange>& ranges) {
  const Address local = Resolve(address, port);
  // Checks that the port is free. If another process used the port, the kernel would deliver some
  // of the robots' datagrams to that process.
  OpenSocket(local, false).Reset();
  for (std::size_t i = 0; i <= ranges.size(); ++i) {
    tools::FileDescriptor owner = OpenSocket(local, true);
    GSocket* socket = g_socket_new_from_fd(owner.get(), nullptr);
    if (socket == nullptr) Fail("cannot use a socket of the shared port");
    sockets_.emplace_back(socket);
    const int fd = owner.Release();
    // The filter drops all datagrams until the robot's session begins.
    if (!Attach(fd, SO_ATTACH_FILTER, kNothing))
      Fail("cannot set a packet filter on the shared port");
    if (i == 0 && !Attach(fd, SO_ATTACH_REUSEPORT_CBPF, ChooseBySsrc(ranges)))
      Fail(std::string("cannot set the filter that separates ") + std::to_string(ranges.size()) +
           " robots on the shared port: " + std::strerror(errno) + " (raise net.core.optmem_max)");
  }
}

std::uint32_t SharedPort::strays() const {
  std::uint32_t info[SK_MEMINFO_VARS] = {};
  socklen_t length = sizeof info;
  getsockopt(g_socket_get_fd(sockets_.front().get()), SOL_SOCKET, SO_MEMINFO, info, &length);
  return info[SK_MEMINFO_DROPS];
}

void ShutSocket(GSocket* socket, bool shut) {
  const int fd = g_socket_get_fd(socket);
  if (shut) {
    Attach(fd, SO_ATTACH_FILTER, kNothing);
    return;
  }
  char ignored[1];
  while (recv(fd, ignored, sizeof ignored, MSG_DONTWAIT) >= 0) continue;
  const int unused = 0;
  setsockopt(fd, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof unused);
}

}  // namespace lidar::edge

// SPDX-License-Identifier: LGPL-2.1-or-later
// UDP sockets: opening, addresses, and a file descriptor that wakes a thread waiting in poll().
#pragma once
#include <gio/gio.h>

#include <memory>
#include <string>

#include "gst/net/datagram.h"

namespace lidar::gst {

using net::NativeAddress;

struct GObjectUnref {
  void operator()(gpointer p) const {
    if (p != nullptr) g_object_unref(p);
  }
};
using SocketPtr = std::unique_ptr<GSocket, GObjectUnref>;
using SocketAddressPtr = std::unique_ptr<GSocketAddress, GObjectUnref>;
/// Another reference to `address`, which may be NULL.
inline SocketAddressPtr RefAddress(GSocketAddress* address) {
  return SocketAddressPtr(address != nullptr ? G_SOCKET_ADDRESS(g_object_ref(address)) : nullptr);
}

/// Returns the address for a socket of `family`: an IPv4 address becomes a mapped one on an IPv6
/// socket. Returns an invalid address if `address` does not fit the family.
NativeAddress ToNative(GSocketAddress* address, GSocketFamily family);
/// Returns the address, a mapped address as IPv4; NULL for an unknown family. Transfer full.
GSocketAddress* FromNative(const NativeAddress& address);

/// Compares as the network does: an IPv4 address equals its mapped form. NULL equals only NULL.
bool SameAddress(GSocketAddress* a, GSocketAddress* b);
/// Compares without the port.
bool SameHost(GSocketAddress* a, GSocketAddress* b);

/// Returns the host, without the brackets of an IPv6 literal.
std::string WithoutBrackets(const std::string& host);

/// Looks up `host`, a name or a literal with or without brackets; may block. Transfer full, or
/// NULL.
GSocketAddress* ResolveUdpAddress(const std::string& host, guint port, GError** error);

/// Returns the host as ResolveUdpAddress() reads it, with the interface of a link-local address.
std::string HostOf(GSocketAddress* address);

struct UdpBind {
  std::string address;  // empty: every address, of both families if the machine has them
  guint port = 0;       // 0: any free one
  GSocketFamily family = G_SOCKET_FAMILY_INVALID;  // with an empty address: only this family
  bool reuse = false;                              // several sockets on one port, for multicast
};
/// A bound non-blocking socket; transfer full, or NULL.
GSocket* OpenUdpSocket(const UdpBind& bind, GError** error);

/// Joins `group` on the interface of that name (empty: the kernel's choice). The socket gets no
/// other groups, which the kernel would give it if other programs joined them.
bool JoinMulticast(GSocket* socket, const std::string& group, const std::string& interface,
                   GError** error);
/// "host:port" for messages and logs.
std::string AddressToString(GSocketAddress* address);

/// Wakes poll() in another thread until Clear().
class WakeFd {
 public:
  WakeFd();
  ~WakeFd();
  WakeFd(const WakeFd&) = delete;
  WakeFd& operator=(const WakeFd&) = delete;
  void Wake();
  void Clear();
  /// Readable until Clear(), for threads that wait for several descriptors.
  int fd() const { return fd_; }

  enum class Outcome { kReady, kWoken, kTimeout, kError };
  /// Waits for `events` (poll's) on `fd`; a negative timeout waits for ever.
  Outcome Wait(int fd, short events, gint64 timeout_ns) const;

 private:
  int fd_;
};

}  // namespace lidar::gst

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
/// Returns a new reference to `address`, which may be NULL.
inline SocketAddressPtr RefAddress(GSocketAddress* address) {
  return SocketAddressPtr(address != nullptr ? G_SOCKET_ADDRESS(g_object_ref(address)) : nullptr);
}

/// Converts `address` for a socket of `family`. An IPv4 address is mapped into IPv6 if `family` is
/// IPv6. Returns an invalid address if `address` cannot be used with `family`.
NativeAddress ToNative(GSocketAddress* address, GSocketFamily family);
/// Converts `address`. An IPv4 address that is mapped into IPv6 becomes an IPv4 address. Returns
/// NULL for an unknown family. The caller owns the result.
GSocketAddress* FromNative(const NativeAddress& address);

/// Returns true if the two addresses are the same for the network: an IPv4 address equals its
/// mapped form. NULL equals only NULL.
bool SameAddress(GSocketAddress* a, GSocketAddress* b);
/// Returns true if the two addresses are the same except for the port.
bool SameHost(GSocketAddress* a, GSocketAddress* b);

/// Returns `host` without the brackets that surround an IPv6 literal.
std::string WithoutBrackets(const std::string& host);

/// Resolves `host`, which is a name, or a literal with or without brackets. May block. Returns NULL
/// on failure. The caller owns the result.
GSocketAddress* ResolveUdpAddress(const std::string& host, guint port, GError** error);

/// Returns the host in the form that ResolveUdpAddress() reads, including the interface of a
/// link-local address.
std::string HostOf(GSocketAddress* address);

struct UdpBind {
  std::string address;  // empty: every address, of both families if the machine has them
  guint port = 0;       // 0: any free one
  GSocketFamily family = G_SOCKET_FAMILY_INVALID;  // with an empty address: only this family
  bool reuse = false;                              // several sockets on one port, for multicast
};
/// Returns a bound, non-blocking socket, or NULL on failure. The caller owns the socket.
GSocket* OpenUdpSocket(const UdpBind& bind, GError** error);

/// Joins `group` on the interface of that name or, if it is empty, on an interface that the kernel
/// chooses. The socket receives no other groups. Without this limit, the kernel would also deliver
/// groups that other programs have joined.
bool JoinMulticast(GSocket* socket, const std::string& group, const std::string& interface,
                   GError** error);
/// Returns "host:port", for messages and logs.
std::string AddressToString(GSocketAddress* address);

/// An event that wakes a thread from poll(), and remains set until Clear().
class WakeFd {
 public:
  WakeFd();
  ~WakeFd();
  WakeFd(const WakeFd&) = delete;
  WakeFd& operator=(const WakeFd&) = delete;
  void Wake();
  void Clear();
  /// Returns a descriptor that is readable from Wake() until Clear(), for threads that wait for
  /// several descriptors.
  int fd() const { return fd_; }

  enum class Outcome { kReady, kWoken, kTimeout, kError };
  /// Waits for `events`, which are the events of poll(), on `fd`. A negative timeout waits for
  /// ever.
  Outcome Wait(int fd, short events, gint64 timeout_ns) const;

 private:
  int fd_;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/net/udp_socket.h"

#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>

namespace lidar::gst {
namespace {

using InetAddressPtr = std::unique_ptr<GInetAddress, GObjectUnref>;

/// Returns true if the machine has a route to `address`. Sends no packet.
bool HasRouteTo(GInetAddress* address) {
  const SocketPtr socket(g_socket_new(g_inet_address_get_family(address), G_SOCKET_TYPE_DATAGRAM,
                                      G_SOCKET_PROTOCOL_UDP, nullptr));
  const SocketAddressPtr there(g_inet_socket_address_new(address, 9));  // any port will do
  return socket && g_socket_connect(socket.get(), there.get(), nullptr, nullptr) != FALSE;
}

/// Returns the first address of `host` to which there is a route, or else the first address.
/// Without this check, localhost would be ::1 even on a machine without IPv6, because GLib lists
/// ::1 before 127.0.0.1.
GInetAddress* Resolve(const std::string& host, GError** error) {
  if (GInetAddress* literal = g_inet_address_new_from_string(host.c_str())) return literal;
  std::unique_ptr<GResolver, GObjectUnref> resolver(g_resolver_get_default());
  GList* found = g_resolver_lookup_by_name(resolver.get(), host.c_str(), nullptr, error);
  if (found == nullptr) return nullptr;
  GList* best = found;
  while (best != nullptr && !HasRouteTo(G_INET_ADDRESS(best->data))) best = best->next;
  auto* address = G_INET_ADDRESS(g_object_ref(best != nullptr ? best->data : found->data));
  g_resolver_free_addresses(found);
  return address;
}

/// Resolves `host`, and keeps the interface of a link-local address (fe80::1%eth0), which a
/// GInetAddress cannot store.
SocketAddressPtr ResolveWithPort(const std::string& host, guint port, GError** error) {
  if (GSocketAddress* literal = g_inet_socket_address_new_from_string(host.c_str(), port))
    return SocketAddressPtr(literal);
  const InetAddressPtr found(Resolve(host, error));
  if (!found) return nullptr;
  return SocketAddressPtr(g_inet_socket_address_new(found.get(), static_cast<guint16>(port)));
}

GSocket* BoundSocket(GSocketAddress* local, const UdpBind& bind, GError** error) {
  SocketPtr socket(g_socket_new(g_socket_address_get_family(local), G_SOCKET_TYPE_DATAGRAM,
                                G_SOCKET_PROTOCOL_UDP, error));
  if (!socket) return nullptr;
  g_socket_set_blocking(socket.get(), FALSE);
  if (!g_socket_bind(socket.get(), local, bind.reuse, error)) return nullptr;
  return socket.release();
}

SocketAddressPtr Any(GSocketFamily family, guint port) {
  const InetAddressPtr any(g_inet_address_new_any(family));
  return SocketAddressPtr(g_inet_socket_address_new(any.get(), static_cast<guint16>(port)));
}

/// Makes the socket ignore multicast groups that only other programs have joined.
void OnlyJoinedGroups(GSocket* socket) {
  const int off = 0;
  const int fd = g_socket_get_fd(socket);
  const bool v6 = g_socket_get_family(socket) == G_SOCKET_FAMILY_IPV6;
  const int failed = v6 ? setsockopt(fd, IPPROTO_IPV6, IPV6_MULTICAST_ALL, &off, sizeof off)
                        : setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof off);
  // An old kernel does not have this option for IPv6, so a failure is ignored.
  if (failed != 0) return;
}

}  // namespace

NativeAddress ToNative(GSocketAddress* address, GSocketFamily family) {
  NativeAddress native;
  const GSocketFamily own = g_socket_address_get_family(address);
  const gssize size = g_socket_address_get_native_size(address);
  if (size <= 0 || static_cast<gsize>(size) > sizeof native.storage) return native;
  if (!g_socket_address_to_native(address, &native.storage, sizeof native.storage, nullptr))
    return native;
  if (own == family) {
    native.length = static_cast<socklen_t>(size);
  } else if (own == G_SOCKET_FAMILY_IPV4 && family == G_SOCKET_FAMILY_IPV6) {
    sockaddr_in v4{};
    std::memcpy(&v4, &native.storage, sizeof v4);
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = v4.sin_port;
    v6.sin6_addr.s6_addr[10] = v6.sin6_addr.s6_addr[11] = 0xff;
    std::memcpy(&v6.sin6_addr.s6_addr[12], &v4.sin_addr, 4);
    native.storage = {};
    std::memcpy(&native.storage, &v6, sizeof v6);
    native.length = sizeof v6;
  }
  return native;
}

GSocketAddress* FromNative(const NativeAddress& address) {
  // GLib takes a pointer to non-const, but only reads from it.
  sockaddr_storage copy = address.storage;
  return g_socket_address_new_from_native(&copy, address.length);
}

bool SameAddress(GSocketAddress* a, GSocketAddress* b) {
  if (a == b) return true;
  return a != nullptr && b != nullptr &&
         ToNative(a, G_SOCKET_FAMILY_IPV6) == ToNative(b, G_SOCKET_FAMILY_IPV6);
}

bool SameHost(GSocketAddress* a, GSocketAddress* b) {
  if (a == nullptr || b == nullptr) return a == b;
  NativeAddress hosts[] = {ToNative(a, G_SOCKET_FAMILY_IPV6), ToNative(b, G_SOCKET_FAMILY_IPV6)};
  for (NativeAddress& host : hosts) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &host.storage, sizeof v6);
    v6.sin6_port = 0;
    std::memcpy(&host.storage, &v6, sizeof v6);
  }
  return hosts[0].valid() && hosts[0] == hosts[1];
}

std::string WithoutBrackets(const std::string& host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    return host.substr(1, host.size() - 2);
  return host;
}

GSocketAddress* ResolveUdpAddress(const std::string& host, guint port, GError** error) {
  return ResolveWithPort(WithoutBrackets(host), port, error).release();
}

std::string HostOf(GSocketAddress* address) {
  auto* inet = G_INET_SOCKET_ADDRESS(address);
  gchar* text = g_inet_address_to_string(g_inet_socket_address_get_address(inet));
  std::string host(text);
  g_free(text);
  if (g_socket_address_get_family(address) != G_SOCKET_FAMILY_IPV6) return host;
  const guint32 interface = g_inet_socket_address_get_scope_id(inet);
  return interface == 0 ? host : host + "%" + std::to_string(interface);
}

GSocket* OpenUdpSocket(const UdpBind& bind, GError** error) {
  if (!bind.address.empty()) {
    const auto address = ResolveWithPort(WithoutBrackets(bind.address), bind.port, error);
    return address ? BoundSocket(address.get(), bind, error) : nullptr;
  }
  if (bind.family != G_SOCKET_FAMILY_IPV4) {
    const SocketAddressPtr any = Any(G_SOCKET_FAMILY_IPV6, bind.port);
    const bool may_fall_back = bind.family == G_SOCKET_FAMILY_INVALID;
    GError* v6_error = nullptr;
    if (GSocket* socket = BoundSocket(any.get(), bind, &v6_error)) return socket;
    const bool taken = g_error_matches(v6_error, G_IO_ERROR, G_IO_ERROR_ADDRESS_IN_USE);
    if (!may_fall_back || taken) {
      g_propagate_error(error, v6_error);
      return nullptr;
    }
    g_error_free(v6_error);  // a machine without IPv6
  }
  return BoundSocket(Any(G_SOCKET_FAMILY_IPV4, bind.port).get(), bind, error);
}

bool JoinMulticast(GSocket* socket, const std::string& group, const std::string& interface,
                   GError** error) {
  const InetAddressPtr address(Resolve(WithoutBrackets(group), error));
  if (!address) return false;
  if (!g_inet_address_get_is_multicast(address.get())) {
    g_set_error(error, G_IO_ERROR, G_IO_ERROR_INVALID_ARGUMENT, "\"%s\" is not a multicast group",
                group.c_str());
    return false;
  }
  // The interface must exist, because GLib would otherwise let the kernel choose one.
  if (!interface.empty() && if_nametoindex(interface.c_str()) == 0) {
    g_set_error(error, G_IO_ERROR, G_IO_ERROR_NOT_FOUND, "there is no network interface \"%s\"",
                interface.c_str());
    return false;
  }
  OnlyJoinedGroups(socket);
  return g_socket_join_multicast_group(socket, address.get(), FALSE,
                                       interface.empty() ? nullptr : interface.c_str(),
                                       error) != FALSE;
}

std::string AddressToString(GSocketAddress* address) {
  if (address == nullptr) return "(none)";
  gchar* text = g_socket_connectable_to_string(G_SOCKET_CONNECTABLE(address));
  std::string result(text);
  g_free(text);
  return result;
}

WakeFd::WakeFd() : fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

WakeFd::~WakeFd() {
  if (fd_ >= 0) close(fd_);
}

void WakeFd::Wake() {
  // The write fails only if the counter is full, and then the thread is woken, too.
  if (eventfd_write(fd_, 1) != 0) return;
}

void WakeFd::Clear() {
  eventfd_t ignored = 0;
  if (eventfd_read(fd_, &ignored) != 0) return;  // was not woken
}

WakeFd::Outcome WakeFd::Wait(int fd, short events, gint64 timeout_ns) const {
  pollfd fds[2] = {{fd_, POLLIN, 0}, {fd, events, 0}};
  timespec timeout{static_cast<time_t>(timeout_ns / 1'000'000'000),
                   static_cast<long>(timeout_ns % 1'000'000'000)};
  const int ready = ppoll(fds, 2, timeout_ns < 0 ? nullptr : &timeout, nullptr);
  if (ready < 0) return errno == EINTR ? Outcome::kReady : Outcome::kError;
  if (fds[0].revents != 0) return Outcome::kWoken;
  return ready == 0 ? Outcome::kTimeout : Outcome::kReady;
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Ports for programs and elements that take theirs as an option.
#pragma once
#include <gio/gio.h>

#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <vector>

namespace lidar::test {

/// Returns a port that is free now, below those that the kernel assigns.
inline std::uint16_t FreePort(GSocketType type = G_SOCKET_TYPE_DATAGRAM) {
  using Object = std::unique_ptr<void, decltype(&g_object_unref)>;
  std::random_device random;
  std::uniform_int_distribution<guint> ports(10000, 32767);
  while (true) {
    const auto port = static_cast<std::uint16_t>(ports(random));
    const Object address(g_inet_socket_address_new_from_string("0.0.0.0", port), g_object_unref);
    const Object socket(
        g_socket_new(G_SOCKET_FAMILY_IPV4, type, G_SOCKET_PROTOCOL_DEFAULT, nullptr),
        g_object_unref);
    if (g_socket_bind(G_SOCKET(socket.get()), G_SOCKET_ADDRESS(address.get()), FALSE, nullptr))
      return port;
  }
}
inline std::uint16_t FreeTcpPort() { return FreePort(G_SOCKET_TYPE_STREAM); }

/// Returns different UDP ports.
inline std::vector<int> FreePorts(std::size_t count) {
  std::set<int> ports;
  while (ports.size() < count) ports.insert(FreePort());
  return {ports.begin(), ports.end()};
}

}  // namespace lidar::test

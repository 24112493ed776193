// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds free ports for programs and elements that have an option for their port.
#pragma once
#include <gio/gio.h>

#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lidar::test {

/// Returns a port that is free now and lies below the ports that the kernel assigns by itself.
/// Until this process ends, neither FreePort() nor ports.py returns the same port again, in any
/// process.
inline std::uint16_t FreePort(GSocketType type = G_SOCKET_TYPE_DATAGRAM) {
  using Object = std::unique_ptr<void, decltype(&g_object_unref)>;
  static std::vector<Object> claims;
  std::random_device random;
  std::uniform_int_distribution<guint> ports(10000, 32767);
  while (true) {
    const auto port = static_cast<std::uint16_t>(ports(random));
    const auto bound = [](GSocketFamily family, GSocketType kind, GSocketAddress* address) {
      Object socket(g_socket_new(family, kind, G_SOCKET_PROTOCOL_DEFAULT, nullptr), g_object_unref);
      if (!g_socket_bind(G_SOCKET(socket.get()), address, FALSE, nullptr)) socket.reset();
      g_object_unref(address);
      return socket;
    };
    const std::string name = "lidar-test-port-" + std::to_string(port);
    Object claim = bound(
        G_SOCKET_FAMILY_UNIX, G_SOCKET_TYPE_DATAGRAM,
        g_unix_socket_address_new_with_type(name.c_str(), -1, G_UNIX_SOCKET_ADDRESS_ABSTRACT));
    if (!claim ||
        !bound(G_SOCKET_FAMILY_IPV4, type, g_inet_socket_address_new_from_string("0.0.0.0", port)))
      continue;
    claims.push_back(std::move(claim));
    return port;
  }
}
inline std::uint16_t FreeTcpPort() { return FreePort(G_SOCKET_TYPE_STREAM); }

/// Returns `count` different UDP ports that are free.
inline std::vector<int> FreePorts(std::size_t count) {
  std::set<int> ports;
  while (ports.size() < count) ports.insert(FreePort());
  return {ports.begin(), ports.end()};
}

}  // namespace lidar::test

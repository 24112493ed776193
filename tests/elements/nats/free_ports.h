// SPDX-License-Identifier: LGPL-2.1-or-later
// Ports of the loopback interface that nobody has.
#pragma once
#include <gio/gio.h>

#include <vector>

namespace lidar::test {

/// UDP ports that are free, for the moment. No two are the same, as all are bound at once.
inline std::vector<int> FreePorts(std::size_t count) {
  std::vector<GSocket*> sockets;
  std::vector<int> ports;
  GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
  while (ports.size() < count) {
    sockets.push_back(
        g_socket_new(G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_DATAGRAM, G_SOCKET_PROTOCOL_UDP, nullptr));
    g_socket_bind(sockets.back(), any, FALSE, nullptr);
    GSocketAddress* bound = g_socket_get_local_address(sockets.back(), nullptr);
    ports.push_back(g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound)));
    g_object_unref(bound);
  }
  g_object_unref(any);
  for (GSocket* socket : sockets) g_object_unref(socket);
  return ports;
}
inline int FreePort() { return FreePorts(1)[0]; }

/// A TCP port that is free, for the moment.
inline int FreeTcpPort() {
  GSocketListener* listener = g_socket_listener_new();
  const int port = g_socket_listener_add_any_inet_port(listener, nullptr, nullptr);
  g_socket_listener_close(listener);
  g_object_unref(listener);
  return port;
}

}  // namespace lidar::test

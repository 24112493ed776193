// SPDX-License-Identifier: LGPL-2.1-or-later
// A UDP port for many robots: each has its own socket, and the kernel puts datagrams into the
// socket of their SSRC. So a flooding robot fills only its own socket.
#pragma once
#include <gio/gio.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/tools/apps/edge/edge_config.h"

namespace lidar::edge {

class SharedPort {
 public:
  /// Opens a socket for each of `ranges`, which must not overlap. Throws std::runtime_error.
  SharedPort(const std::string& address, std::uint16_t port, const std::vector<SsrcRange>& ranges);

  GSocket* socket(std::size_t index) const { return sockets_.at(index + 1).get(); }
  /// Number of datagrams that were dropped because no robot has their SSRC.
  std::uint32_t strays() const;

 private:
  struct Unref {
    void operator()(GSocket* socket) const { g_object_unref(socket); }
  };
  // Sockets in the order of binding, by which the kernel numbers them. The first receives the
  // datagrams whose SSRC no robot has.
  std::vector<std::unique_ptr<GSocket, Unref>> sockets_;
};

/// Shuts or opens the socket. A shut socket drops new datagrams, and opening drops queued ones.
void ShutSocket(GSocket* socket, bool shut);

}  // namespace lidar::edge

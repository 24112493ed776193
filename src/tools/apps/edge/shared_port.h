// SPDX-License-Identifier: LGPL-2.1-or-later
// A UDP port that many robots share. Each robot has its own socket, and the kernel puts each
// datagram into the socket of the datagram's SSRC. So a robot that floods the port fills only its
// own socket.
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
  /// Opens a socket for each of `ranges`, which must not overlap. Throws std::runtime_error if a
  /// socket cannot be opened.
  SharedPort(const std::string& address, std::uint16_t port, const std::vector<SsrcRange>& ranges);

  GSocket* socket(std::size_t index) const { return sockets_.at(index + 1).get(); }
  /// Returns the number of datagrams that were dropped because no robot has their SSRC.
  std::uint32_t strays() const;

 private:
  struct Unref {
    void operator()(GSocket* socket) const { g_object_unref(socket); }
  };
  // The sockets in the order in which they were bound, because the kernel numbers them in this
  // order. The first socket receives the datagrams whose SSRC no robot has.
  std::vector<std::unique_ptr<GSocket, Unref>> sockets_;
};

/// Shuts or opens the socket. A shut socket drops new datagrams. Opening the socket also drops the
/// datagrams that are still queued in it.
void ShutSocket(GSocket* socket, bool shut);

}  // namespace lidar::edge

// SPDX-License-Identifier: LGPL-2.1-or-later
// A UDP port for many robots: each has a socket of its own there, and the kernel puts a datagram
// into the socket of its SSRC. So a robot that floods fills its own socket only.
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
  /// A socket for each of `ranges`, which do not overlap. Throws std::runtime_error.
  SharedPort(const std::string& address, std::uint16_t port, const std::vector<SsrcRange>& ranges);

  GSocket* socket(std::size_t index) const { return sockets_.at(index + 1).get(); }
  /// Datagrams that were dropped, as they are of no robot's SSRC.
  std::uint32_t strays() const;

 private:
  struct Unref {
    void operator()(GSocket* socket) const { g_object_unref(socket); }
  };
  // Sockets in the order in which they were bound, which is their number in the kernel. The first
  // is for strays.
  std::vector<std::unique_ptr<GSocket, Unref>> sockets_;
};

/// A shut socket drops what comes in, and its queue.
void ShutSocket(GSocket* socket, bool shut);

}  // namespace lidar::edge

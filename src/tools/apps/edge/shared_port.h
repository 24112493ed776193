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
  /// A socket for each of `ranges`, which do not overlap. Throws std::runtime_error.
  SharedPort(const std::string& address, std::uint16_t port, const std::vector<SsrcRange>& ranges);

  GSocket* socket(std::size_t index) const { return sockets_.at(index + 1).get(); }
  /// Number of dropped datagrams, which have no robot's SSRC.
  std::uint32_t strays() const;

 private:
  struct Unref {
    void operator()(GSocket* socket) const { g_object_unref(socket); }
  };
  // Sockets in the order of binding, by which the kernel numbers them. The first takes datagrams of
  // no robot.
  std::vector<std::unique_ptr<GSocket, Unref>> sockets_;
};

/// A shut socket drops its queue and new datagrams.
void ShutSocket(GSocket* socket, bool shut);

}  // namespace lidar::edge

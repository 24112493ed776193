// SPDX-License-Identifier: LGPL-2.1-or-later
// Tracks the address from which the peer's feedback comes. If the address changes, the packets may
// take a new network path.
#pragma once
#include <gio/gio.h>

#include <memory>

#include "gst/net/udp_socket.h"
#include "src/base/time.h"

namespace lidar::gst {

class FeedbackPeer {
 public:
  /// Feedback from a new address moves the peer to this address only after the old address has been
  /// silent for this time.
  static constexpr Duration kOldPeerSilence = std::chrono::milliseconds(500);

  /// Call it with the source address of each accepted report; `from` may be NULL. Returns true if
  /// the peer has moved to a new address.
  bool OnFeedback(Time now, GSocketAddress* from) {
    if (from == nullptr) return false;
    if (peer_ && SameAddress(from, peer_.get())) {
      last_ = now;
      return false;
    }
    const bool known = peer_ != nullptr;
    const Duration silence = now - last_;  // negative if the clock was set back
    if (known && silence >= Duration{0} && silence < kOldPeerSilence) return false;
    peer_.reset(G_SOCKET_ADDRESS(g_object_ref(from)));
    last_ = now;
    return known;
  }

 private:
  std::unique_ptr<GSocketAddress, GObjectUnref> peer_;
  Time last_{};
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The address from which the peer's feedback comes. A new address means a new path.
#pragma once
#include <gio/gio.h>

#include <memory>

#include "gst/net/udp_socket.h"
#include "src/base/time.h"

namespace lidar::gst {

class FeedbackPeer {
 public:
  /// A new address becomes the peer's when the old one has been silent for this time.
  static constexpr Duration kOldPeerSilence = std::chrono::milliseconds(500);

  /// Takes the source of accepted feedback, which may be NULL. Returns true if the peer has moved.
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

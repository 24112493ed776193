// SPDX-License-Identifier: LGPL-2.1-or-later
// Tells an encoder which of its slices a receiver has, where the sender behind rtplidarpay says
// which packets it has.
#pragma once
#include <gst/gst.h>

#include <mutex>

#include "src/rtp/delivery.h"

namespace lidar::gst {

class Receipts {
 public:
  /// Watches the packets that leave by `src`; for as long as the pad lives.
  void Watch(GstPad* src);
  /// What the encoder is to hear, in place of `event`; null: nothing. False for other events.
  bool OnEvent(GstEvent* event, GstEvent** upstream);

 private:
  void OnBuffer(GstBuffer* buffer);

  std::mutex mutex_;
  rtp::Delivery delivery_;
};

}  // namespace lidar::gst

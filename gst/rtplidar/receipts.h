// SPDX-License-Identifier: LGPL-2.1-or-later
// Turns events about packets that a receiver has into events about slices, for the encoder.
#pragma once
#include <gst/gst.h>

#include <mutex>

#include "src/rtp/delivery.h"

namespace lidar::gst {

class Receipts {
 public:
  /// Watches the packets that leave by `src`; for as long as the pad lives.
  void Watch(GstPad* src);
  /// Gives the event for the encoder in place of `event`, or null for no event. Returns false for
  /// other events.
  bool OnEvent(GstEvent* event, GstEvent** upstream);

 private:
  void OnBuffer(GstBuffer* buffer);

  std::mutex mutex_;
  rtp::Delivery delivery_;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts events about packets that a receiver has to events about slices, for the encoder.
#pragma once
#include <gst/gst.h>

#include <mutex>

#include "src/rtp/delivery.h"

namespace lidar::gst {

class Receipts {
 public:
  /// Watches the packets that leave by `src`. This object must outlive the pad.
  void Watch(GstPad* src);
  /// Sets `upstream` to the event that goes to the encoder in place of `event`. Returns false, and
  /// sets null, if `event` is not about received packets.
  bool OnEvent(GstEvent* event, GstEvent** upstream);

 private:
  void OnBuffer(GstBuffer* buffer);

  std::mutex mutex_;
  rtp::Delivery delivery_;
};

}  // namespace lidar::gst

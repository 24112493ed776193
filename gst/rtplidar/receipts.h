// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts events about packets that a receiver has received to events about slices, which the
// encoder needs.
#pragma once
#include <gst/gst.h>

#include <mutex>

#include "src/rtp/delivery.h"

namespace lidar::gst {

class Receipts {
 public:
  /// Observes the packets that are pushed by the pad `src`. This object must outlive the pad.
  void Watch(GstPad* src);
  /// If `event` is about received packets, returns true and sets `upstream` to the event that is
  /// sent to the encoder instead. Otherwise returns false and sets `upstream` to null.
  bool OnEvent(GstEvent* event, GstEvent** upstream);

 private:
  void OnBuffer(GstBuffer* buffer);

  std::mutex mutex_;
  rtp::Delivery delivery_;
};

}  // namespace lidar::gst

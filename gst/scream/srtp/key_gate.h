// SPDX-License-Identifier: LGPL-2.1-or-later
// Holds back media packets at their pads until there is an SRTP key.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "gst/common/refs.h"

namespace lidar::gst {

/// While the gate is shut, packets of live sources are dropped and counted. Other sources wait
/// until the gate opens, or until they are flushed or stopped.
class KeyGate {
 public:
  /// Blocks the packets of `pad` until Open(). Does nothing if the gate is already open.
  static void Guard(const std::shared_ptr<KeyGate>& gate, GstPad* pad);
  void Open();
  bool is_open() const { return is_open_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  GstPadProbeReturn OnPackets(GstPad* pad, GstPadProbeInfo* info);

  std::atomic<bool> is_open_{false};
  std::atomic<std::uint64_t> dropped_{0};  // packets
  std::mutex mutex_;                       // guards guarded_
  std::vector<std::pair<PadPtr, gulong>> guarded_;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the last refused caps, so that an element posts one error although GStreamer offers them
// again with each buffer.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"

namespace lidar::gst {

/// Used by the streaming thread.
class RefusedCaps {
 public:
  /// Notes refused caps. Returns true if they differ from the last ones.
  bool Note(GstCaps* caps) {
    if (last_ && gst_caps_is_equal(last_.get(), caps)) return false;
    last_.reset(gst_caps_ref(caps));
    return true;
  }
  bool noted() const { return last_ != nullptr; }
  /// Call it for accepted caps, and between runs.
  void Reset() { last_.reset(); }

 private:
  CapsPtr last_;
};

}  // namespace lidar::gst

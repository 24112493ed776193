// SPDX-License-Identifier: LGPL-2.1-or-later
// Remembers the caps that an element refused last. GStreamer offers refused caps again with each
// buffer, but the element posts only one error.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"

namespace lidar::gst {

/// Must be used by the streaming thread only.
class RefusedCaps {
 public:
  /// Notes that `caps` were refused. Returns true if they differ from the caps that were refused
  /// last.
  bool Note(GstCaps* caps) {
    if (last_ && gst_caps_is_equal(last_.get(), caps)) return false;
    last_.reset(gst_caps_ref(caps));
    return true;
  }
  bool noted() const { return last_ != nullptr; }
  /// Forgets the caps. Must be called when caps are accepted, and when the element stops.
  void Reset() { last_.reset(); }

 private:
  CapsPtr last_;
};

}  // namespace lidar::gst

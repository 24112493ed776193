// SPDX-License-Identifier: LGPL-2.1-or-later
// GStreamer offers caps that were refused again with each buffer: one error is enough.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"

namespace lidar::gst {

/// Used by the streaming thread.
class RefusedCaps {
 public:
  /// True where `caps` are not those that were refused last; they are from now on.
  bool Note(GstCaps* caps) {
    if (last_ && gst_caps_is_equal(last_.get(), caps)) return false;
    last_.reset(gst_caps_ref(caps));
    return true;
  }
  bool noted() const { return last_ != nullptr; }
  void Reset() { last_.reset(); }

 private:
  CapsPtr last_;
};

}  // namespace lidar::gst

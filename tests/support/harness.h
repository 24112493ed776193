// SPDX-License-Identifier: LGPL-2.1-or-later
// An owner of a GstHarness, and functions that several tests need.
#pragma once
#include <gst/check/gstharness.h>

#include <memory>

#include "gst/common/refs.h"

namespace lidar::test {

struct HarnessFree {
  void operator()(GstHarness* h) const { gst_harness_teardown(h); }
};
using Harness = std::unique_ptr<GstHarness, HarnessFree>;

/// Sets a harness to PLAYING. gst_harness_play() aborts if its element has already posted an error.
inline void SetPlaying(GstHarness* h) {
  const GstStateChangeReturn change = gst_element_set_state(h->element, GST_STATE_PLAYING);
  g_assert_cmpint(change, !=, GST_STATE_CHANGE_FAILURE);
}

/// Returns a segment event. The segment begins at 0.
inline GstEvent* NewSegment(GstFormat format = GST_FORMAT_TIME) {
  GstSegment segment;
  gst_segment_init(&segment, format);
  return gst_event_new_segment(&segment);
}

/// Flushes the element as a seek does, and begins a new segment at 0.
inline void Flush(GstHarness* h) {
  gst_harness_push_event(h, gst_event_new_flush_start());
  gst_harness_push_event(h, gst_event_new_flush_stop(TRUE));
  gst_harness_push_event(h, NewSegment());
}

}  // namespace lidar::test

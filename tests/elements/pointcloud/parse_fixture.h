// SPDX-License-Identifier: LGPL-2.1-or-later
// A fixture with a pointcloudparse after a source of bytes.
#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "gst/lidar/cloud_info.h"
#include "tests/support/element_bus.h"
#include "tests/support/harness.h"

namespace lidar::gst {

inline constexpr const char* kKitti =
    "application/x-pointcloud2,height=1,point-step=16,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\",framerate=10/1";

inline BufferPtr Bytes(gsize size, guint8 value = 7) {
  BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, value, size);
  return buffer;
}

class Parse : public ::testing::Test {
 protected:
  /// Starts the element. The source outputs bytes, as a file does.
  void Start(const std::string& caps, const char* element = "pointcloudparse") {
    h_.reset(gst_harness_new_parse(element));
    gst_harness_play(h_.get());
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("test"));
    const CapsPtr parsed(gst_caps_from_string(caps.c_str()));
    gst_pad_push_event(h_->srcpad, gst_event_new_caps(parsed.get()));
    PushSegment(GST_FORMAT_BYTES);
  }
  void PushSegment(GstFormat format) { gst_pad_push_event(h_->srcpad, test::NewSegment(format)); }
  GstFlowReturn Push(BufferPtr buffer) { return gst_pad_push(h_->srcpad, buffer.release()); }
  BufferPtr Pull() { return BufferPtr(gst_harness_pull(h_.get())); }
  guint Width() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    return CloudInfo::FromCaps(caps.get())->width;
  }
  std::string ErrorText(GstMessageType type) { return test::ElementBus(h_->element).Text(type); }
  void WatchMessages() { bus_.emplace(h_->element); }

  test::Harness h_;
  std::optional<test::ElementBus> bus_;
};

}  // namespace lidar::gst

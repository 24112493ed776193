// SPDX-License-Identifier: LGPL-2.1-or-later
// The pads and events by which a stock element is used like a function.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <utility>

#include "gst/common/refs.h"

namespace lidar::gst {

/// A sink pad that passes the buffers of `element` to a function. It drops events, because the
/// stream in which the buffers continue has its own events.
class Relay {
 public:
  using Take = std::function<void(BufferPtr)>;
  Relay(GstElement* element, const char* source, Take take) : take_(std::move(take)) {
    gst_pad_set_element_private(pad_.get(), this);
    gst_pad_set_chain_function(pad_.get(), [](GstPad* pad, GstObject*, GstBuffer* buffer) {
      static_cast<Relay*>(gst_pad_get_element_private(pad))->take_(BufferPtr(buffer));
      return GST_FLOW_OK;
    });
    gst_pad_set_event_function(pad_.get(), [](GstPad*, GstObject*, GstEvent* event) -> gboolean {
      gst_event_unref(event);
      return TRUE;
    });
    GST_PAD_SET_ACCEPT_TEMPLATE(pad_.get());  // the caps differ from key to key
    gst_pad_set_active(pad_.get(), TRUE);
    const PadPtr from(gst_element_get_static_pad(element, source));
    gst_pad_link(from.get(), pad_.get());
  }
  ~Relay() { gst_pad_set_active(pad_.get(), FALSE); }
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

 private:
  Take take_;
  PadPtr pad_{GST_PAD(gst_object_ref_sink(gst_pad_new("relay", GST_PAD_SINK)))};
};

/// Sends to `sink` the events that must precede buffers, unless they were sent before.
inline void BeginStream(GstPad* sink, const char* caps) {
  if (gst_pad_has_current_caps(sink)) return;
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  const CapsPtr owner(gst_caps_new_empty_simple(caps));
  gst_pad_send_event(sink, gst_event_new_stream_start("srtp"));
  gst_pad_send_event(sink, gst_event_new_caps(owner.get()));
  gst_pad_send_event(sink, gst_event_new_segment(&segment));
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The common parts of encoders and decoders: their two pads, and messages with statistics.
#pragma once
#include <optional>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/refs.h"
#include "src/base/time.h"

namespace lidar::gst {

class CoderPads {
 public:
  /// Adds the pads. Must be called in constructed(), because the pad templates belong to the
  /// subclass.
  void Create(GObject* element, GstPadChainFunction chain, GstPadEventFunction sink_event) {
    sink_ = AddPad(element, "sink");
    gst_pad_set_chain_function(sink_, chain);
    gst_pad_set_event_function(sink_, sink_event);
    src_ = AddPad(element, "src");
    gst_pad_use_fixed_caps(src_);
  }
  GstPad* sink() const { return sink_; }
  GstPad* src() const { return src_; }

  /// Sets whether the next output buffer gets the flag DISCONT.
  void set_discont(bool discont) { discont_ = discont; }

  GstFlowReturn Push(BufferPtr output, GstBuffer* input) {
    CopyMetadata(output.get(), input);
    if (std::exchange(discont_, false)) GST_BUFFER_FLAG_SET(output.get(), GST_BUFFER_FLAG_DISCONT);
    return gst_pad_push(src_, output.release());
  }

  /// Pushes no output for `input`. Sends a GAP event instead, so that downstream does not wait.
  GstFlowReturn LeaveOut(GstBuffer* input) {
    discont_ = true;
    // A GAP event before the first caps would have no meaning for downstream.
    if (GST_BUFFER_PTS_IS_VALID(input) && gst_pad_has_current_caps(src_))
      gst_pad_push_event(src_,
                         gst_event_new_gap(GST_BUFFER_PTS(input), GST_BUFFER_DURATION(input)));
    return GST_FLOW_OK;
  }

 private:
  GstPad* sink_ = nullptr;
  GstPad* src_ = nullptr;
  bool discont_ = false;
};

/// Resets the stream of a coder when it changes to READY. It is called after the pads have been
/// deactivated.
template <class Coder, class Class>
void EndStream(Coder* coder, const Class* klass) {
  coder->state->stream = {};
  coder->state->pads.set_discont(false);
  if (klass->reset != nullptr) klass->reset(coder);
}

/// Posts statistics as element messages at an interval.
class MessageTimer {
 public:
  /// Posts `stats` if `interval` has passed since the last message. The first interval starts at
  /// the first call. If `interval` is 0, never posts.
  void Post(GstElement* element, Duration interval, StructurePtr (*stats)(GObject*)) {
    const gint64 now_us = g_get_monotonic_time();
    if (!last_us_) last_us_ = now_us;
    if (interval <= Duration{} || now_us - *last_us_ < interval.count() / 1000) return;
    last_us_ = now_us;
    gst_element_post_message(
        element, gst_message_new_element(GST_OBJECT(element), stats(G_OBJECT(element)).release()));
  }

 private:
  std::optional<gint64> last_us_;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Common parts of encoders and decoders: their two pads, and statistics at an interval.
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
  /// Call it from constructed(), because the subclass has the pad templates.
  void Create(GObject* element, GstPadChainFunction chain, GstPadEventFunction sink_event) {
    sink_ = AddPad(element, "sink");
    gst_pad_set_chain_function(sink_, chain);
    gst_pad_set_event_function(sink_, sink_event);
    src_ = AddPad(element, "src");
    gst_pad_use_fixed_caps(src_);
  }
  GstPad* sink() const { return sink_; }
  GstPad* src() const { return src_; }

  /// Call it with true if the next buffer does not continue the last one.
  void set_discont(bool discont) { discont_ = discont; }

  GstFlowReturn Push(BufferPtr output, GstBuffer* input) {
    CopyMetadata(output.get(), input);
    if (std::exchange(discont_, false)) GST_BUFFER_FLAG_SET(output.get(), GST_BUFFER_FLAG_DISCONT);
    return gst_pad_push(src_, output.release());
  }

  /// Sends a gap, so that downstream does not wait for an output of `input`.
  GstFlowReturn LeaveOut(GstBuffer* input) {
    discont_ = true;
    // A gap before the first caps means nothing downstream.
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

/// Resets the stream of a coder on its way to READY. The base class calls it once its pads are
/// inactive.
template <class Coder, class Class>
void EndStream(Coder* coder, const Class* klass) {
  coder->state->stream = {};
  coder->state->pads.set_discont(false);
  if (klass->reset != nullptr) klass->reset(coder);
}

/// Posts statistics as element messages.
class MessageTimer {
 public:
  /// Posts `stats` if `interval` (0: never) has passed since the last post, or since the first call
  /// if there was no post.
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

// SPDX-License-Identifier: LGPL-2.1-or-later
// The two pads of a coder, as encoders and decoders use them.
#pragma once
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/refs.h"

namespace lidar::gst {

class CoderPads {
 public:
  /// For constructed(): the pad templates are the subclass's.
  void Create(GObject* element, GstPadChainFunction chain, GstPadEventFunction sink_event) {
    sink_ = AddPad(element, "sink");
    gst_pad_set_chain_function(sink_, chain);
    gst_pad_set_event_function(sink_, sink_event);
    src_ = AddPad(element, "src");
    gst_pad_use_fixed_caps(src_);
  }
  GstPad* sink() const { return sink_; }
  GstPad* src() const { return src_; }

  /// The next buffer does not go on where the last one ended.
  void set_discont(bool discont) { discont_ = discont; }

  GstFlowReturn Push(BufferPtr output, GstBuffer* input) {
    CopyMetadata(output.get(), input);
    if (std::exchange(discont_, false)) GST_BUFFER_FLAG_SET(output.get(), GST_BUFFER_FLAG_DISCONT);
    return gst_pad_push(src_, output.release());
  }

  /// Nothing comes of `input`: downstream should not wait for it.
  GstFlowReturn LeaveOut(GstBuffer* input) {
    discont_ = true;
    // Before the first caps nobody downstream knows what the gap is in.
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

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The pads of an mcapsrc, one per topic, and their common state.
#pragma once
#include <gst/base/gstflowcombiner.h>
#include <gst/gst.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ext/mcap/played_stream.h"
#include "src/mcap/playback.h"

namespace lidar::gst {

/// The pads of an mcapsrc. Other threads may use them only while the streaming thread is paused.
/// The destructor removes the pads from the element.
class StreamGroup {
 public:
  /// A function that returns a new, inactive pad without a parent.
  using NewPad = std::function<GstPad*(const std::string& name)>;
  StreamGroup(GstElement* element, NewPad new_pad, const GstSegment& segment);
  ~StreamGroup();
  StreamGroup(const StreamGroup&) = delete;
  StreamGroup& operator=(const StreamGroup&) = delete;

  const GstSegment& segment() const { return common_.segment; }
  guint32 seqnum() const { return common_.seqnum; }
  bool empty() const { return streams_.empty(); }
  bool has_pads() const;

  /// Adds the pads whose caps are known before the first buffer. If `topic` is not empty, adds only
  /// the pad of `topic`.
  void ShowKnown(const mcap::Playback& playback, const std::string& topic);
  /// Announces, once, that no more pads will be added.
  void EndPads();
  /// The buffer of a message, and the stream of its pad. There is no buffer if the message is
  /// damaged, if its caps are unknown, or if there are more topics than pads.
  struct Played {
    PlayedStream* stream = nullptr;
    BufferPtr buffer;
  };
  Played Read(const mcap::Playback::Item& item, GstClockTime pts);
  /// Pushes the buffer. Returns the combined flow return of all pads.
  GstFlowReturn Push(Played played);
  /// Begins a new segment in all streams after a seek.
  void Restart(const GstSegment& segment, guint32 seqnum);
  /// Sends `event` on all pads.
  void End(GstEvent* event);

 private:
  PlayedStream* StreamOf(const std::string& topic);
  /// The largest number of pads. Each topic needs a pad, and perhaps a thread downstream.
  static constexpr std::size_t kMaxStreams = 256;

  struct FreeCombiner {
    void operator()(GstFlowCombiner* p) const { gst_flow_combiner_free(p); }
  };
  GstElement* const element_;
  const NewPad new_pad_;
  PlaybackGroup common_;
  std::vector<std::unique_ptr<PlayedStream>> streams_;
  std::unique_ptr<GstFlowCombiner, FreeCombiner> flows_{gst_flow_combiner_new()};
  bool told_no_more_pads_ = false;
};

}  // namespace lidar::gst

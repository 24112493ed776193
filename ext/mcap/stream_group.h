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

/// Used by the streaming thread, or while that thread is paused. The destructor removes the pads.
class StreamGroup {
 public:
  /// Returns a new, inactive pad without a parent.
  using NewPad = std::function<GstPad*(const std::string& name)>;
  StreamGroup(GstElement* element, NewPad new_pad, const GstSegment& segment);
  ~StreamGroup();
  StreamGroup(const StreamGroup&) = delete;
  StreamGroup& operator=(const StreamGroup&) = delete;

  const GstSegment& segment() const { return common_.segment; }
  guint32 seqnum() const { return common_.seqnum; }
  bool empty() const { return streams_.empty(); }
  bool has_pads() const;

  /// Adds the pads whose caps are known before the first buffer: the pad of `topic`, or all if
  /// `topic` is empty.
  void ShowKnown(const mcap::Playback& playback, const std::string& topic);
  /// Announces once that no more pads come.
  void EndPads();
  /// A message and the stream of its pad. There is no buffer if the message is damaged, if its caps
  /// are not known, or if there are more topics than pads.
  struct Played {
    PlayedStream* stream = nullptr;
    BufferPtr buffer;
  };
  Played Read(const mcap::Playback::Item& item, GstClockTime pts);
  /// Returns the combined flow of all pads.
  GstFlowReturn Push(Played played);
  /// Begins a new segment after a seek of the source.
  void Restart(const GstSegment& segment, guint32 seqnum);
  /// Sends `event` on all pads.
  void End(GstEvent* event);

 private:
  PlayedStream* StreamOf(const std::string& topic);
  /// Each topic costs a pad, and perhaps a thread downstream.
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

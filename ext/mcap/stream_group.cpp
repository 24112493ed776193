// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/stream_group.h"

#include <algorithm>
#include <utility>

namespace lidar::gst {

StreamGroup::StreamGroup(GstElement* element, NewPad new_pad, const GstSegment& segment)
    : element_(element),
      new_pad_(std::move(new_pad)),
      common_{gst_util_group_id_next(), segment, GST_SEQNUM_INVALID} {}

StreamGroup::~StreamGroup() {
  for (const auto& stream : streams_) {
    if (stream->is_added()) gst_element_remove_pad(element_, stream->pad());
    gst_object_unref(stream->pad());
  }
}

bool StreamGroup::has_pads() const {
  return std::any_of(streams_.begin(), streams_.end(),
                     [](const auto& stream) { return stream->is_added(); });
}

/// Returns the stream of `topic`, and creates it if necessary. Returns null if there are too many
/// streams.
PlayedStream* StreamGroup::StreamOf(const std::string& topic) {
  for (const auto& stream : streams_)
    if (stream->topic() == topic) return stream.get();
  if (streams_.size() == kMaxStreams) return nullptr;
  GstPad* pad = new_pad_("src_" + std::to_string(streams_.size()));
  gst_object_ref_sink(pad);
  streams_.push_back(std::make_unique<PlayedStream>(element_, pad, topic));
  gst_flow_combiner_add_pad(flows_.get(), pad);
  return streams_.back().get();
}

void StreamGroup::ShowKnown(const mcap::Playback& playback, const std::string& topic) {
  bool all = true;
  for (const auto& [schema, channel] : playback.topics()) {
    if (!topic.empty() && topic != channel.topic) continue;
    if (!MessageReader::Make(schema, channel)) continue;
    PlayedStream* stream = StreamOf(channel.topic);
    if (stream == nullptr) break;
    all = stream->Follow(schema, channel) && stream->Prepare(common_) && all;
  }
  if (all) EndPads();
}

void StreamGroup::EndPads() {
  if (!std::exchange(told_no_more_pads_, true)) gst_element_no_more_pads(element_);
}

StreamGroup::Played StreamGroup::Read(const mcap::Playback::Item& item, GstClockTime pts) {
  Played played{StreamOf(item.channel->topic), nullptr};
  if (played.stream != nullptr && played.stream->Follow(*item.schema, *item.channel))
    played.buffer = played.stream->Read(item.message.data, pts);
  if (played.buffer && !played.stream->Prepare(common_)) played.buffer.reset();
  return played;
}

GstFlowReturn StreamGroup::Push(Played played) {
  for (const auto& other : streams_)
    if (other.get() != played.stream) other->FillUpTo(GST_BUFFER_PTS(played.buffer.get()), common_);
  return gst_flow_combiner_update_pad_flow(flows_.get(), played.stream->pad(),
                                           played.stream->Push(std::move(played.buffer)));
}

void StreamGroup::Restart(const GstSegment& segment, guint32 seqnum) {
  common_.segment = segment;
  common_.seqnum = seqnum;
  for (const auto& stream : streams_) stream->Restart(segment.position);
  gst_flow_combiner_reset(flows_.get());
}

void StreamGroup::End(GstEvent* event) {
  const EventPtr owner(event);
  for (const auto& stream : streams_) stream->End(common_, gst_event_copy(event));
}

}  // namespace lidar::gst

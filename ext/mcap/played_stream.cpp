// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/played_stream.h"

namespace lidar::gst {
namespace {

/// A stream that is silent for longer than this gets a gap event, so that sinks do not wait for its
/// data.
constexpr GstClockTime kLongestSilence = 500 * GST_MSECOND;

GstEvent* WithSeqnum(const PlaybackGroup& group, GstEvent* event) {
  if (group.seqnum != GST_SEQNUM_INVALID) gst_event_set_seqnum(event, group.seqnum);
  return event;
}

}  // namespace

bool PlayedStream::Follow(const mcap::Schema& schema, const mcap::Channel& channel) {
  // Keeps the reader if possible. Each file has channels of its own, but usually with the same
  // content as in other files.
  if (reader_ && schema_ == schema.name && metadata_ == channel.metadata) return true;
  auto reader = MessageReader::Make(schema, channel);
  if (!reader) return false;
  reader_ = std::move(reader);
  schema_ = schema.name;
  metadata_ = channel.metadata;
  return true;
}

void PlayedStream::PushStreamStart(const PlaybackGroup& group) {
  gst_pad_set_active(pad_, TRUE);
  const StringPtr id(gst_pad_create_stream_id(pad_, element_, topic_.c_str()));
  GstEvent* event = gst_event_new_stream_start(id.get());
  gst_event_set_group_id(event, group.group_id);
  gst_pad_push_event(pad_, WithSeqnum(group, event));
}

/// Pushes the events before the pad is added, so that a handler of pad-added finds them on the pad.
bool PlayedStream::Prepare(const PlaybackGroup& group) {
  GstCaps* caps = reader_->caps();
  if (caps == nullptr) return false;
  if (!added_) PushStreamStart(group);
  if (!pushed_caps_ || !gst_caps_is_equal(pushed_caps_.get(), caps)) {
    pushed_caps_.reset(gst_caps_ref(caps));
    gst_pad_push_event(pad_, WithSeqnum(group, gst_event_new_caps(caps)));
  }
  if (std::exchange(needs_segment_, false))
    gst_pad_push_event(pad_, WithSeqnum(group, gst_event_new_segment(&group.segment)));
  if (!std::exchange(added_, true)) gst_element_add_pad(element_, pad_);
  return true;
}

BufferPtr PlayedStream::Read(ByteView message, GstClockTime pts) {
  BufferPtr buffer = reader_->Read(message);
  if (!buffer) {
    discont_ = true;
    return nullptr;
  }
  GST_BUFFER_PTS(buffer.get()) = pts;
  if (std::exchange(discont_, false)) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
  return buffer;
}

GstFlowReturn PlayedStream::Push(BufferPtr buffer) {
  last_ = GST_BUFFER_PTS(buffer.get());
  if (GST_BUFFER_DURATION_IS_VALID(buffer.get())) last_ += GST_BUFFER_DURATION(buffer.get());
  return gst_pad_push(pad_, buffer.release());
}

void PlayedStream::FillUpTo(GstClockTime time, const PlaybackGroup& group) {
  if (!added_ || time < last_ || time - last_ < kLongestSilence || !Prepare(group)) return;
  gst_pad_push_event(pad_, gst_event_new_gap(last_, time - last_));
  last_ = time;
}

void PlayedStream::End(const PlaybackGroup& group, GstEvent* event) {
  if (added_)
    gst_pad_push_event(pad_, WithSeqnum(group, event));
  else
    gst_event_unref(event);
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/stream_merger.h"

namespace lidar::gst {
namespace {

/// Creates a STREAM_START event with a new random stream id.
EventPtr NewStart() {
  const StringPtr id(g_strdup_printf("screamtx/%08x%08x", g_random_int(), g_random_int()));
  return EventPtr(gst_event_new_stream_start(id.get()));
}

}  // namespace

/// Removes the event at the head of the queue and returns it. If the stream has no STREAM_START
/// before this event, returns a new STREAM_START instead.
EventPtr StreamMerger::TakeEvent(TxStream* stream) const {
  const GstEventType type = GST_EVENT_TYPE(stream->queue.front().event.get());
  if (type != GST_EVENT_STREAM_START && type != GST_EVENT_EOS && !sent_start_) return NewStart();
  EventPtr event = std::move(stream->queue.front().event);
  stream->queue.pop_front();
  if (type == GST_EVENT_SEGMENT) gst_event_copy_segment(event.get(), &stream->leaving_segment);
  return event;
}

EventPtr StreamMerger::NextEvent(const Streams& streams) {
  for (const auto& stream : streams) {
    while (!stream->queue.empty() && stream->queue.front().event) {
      EventPtr event = TakeEvent(stream.get());
      // EOS is skipped here. The pacing task sends one EOS when all streams have ended.
      if (GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS) continue;
      const bool merged = streams.size() > 1;
      if (merged && !Suits(*stream, streams, event.get())) continue;
      NoteSent(merged, &event);
      return event;
    }
  }
  return nullptr;
}

bool StreamMerger::Suits(const TxStream& stream, const Streams& streams, GstEvent* event) const {
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      return !sent_start_;
    case GST_EVENT_SEGMENT:
      return segment_due_;
    case GST_EVENT_CAPS:
      return !merged_caps_;
    default:
      return &stream == streams.front().get();
  }
}

void StreamMerger::NoteSent(bool merged, EventPtr* event) {
  switch (GST_EVENT_TYPE(event->get())) {
    case GST_EVENT_STREAM_START:
      sent_start_ = true;
      break;
    case GST_EVENT_SEGMENT:
      gst_event_copy_segment(event->get(), &segment_);
      segment_due_ = false;
      break;
    case GST_EVENT_CAPS:
      merged_caps_ = merged;
      if (!merged) break;
      event->reset(
          gst_event_new_caps(CapsPtr(gst_caps_new_empty_simple("application/x-rtp")).get()));
      break;
    default:
      break;
  }
}

/// Converts the buffer's times to the segment of the output, which may be the segment of a stream
/// that was removed.
BufferPtr StreamMerger::ToOutput(const TxStream& stream, BufferPtr buffer) const {
  const GstSegment& segment = stream.leaving_segment;
  if (segment.format != GST_FORMAT_TIME || gst_segment_is_equal(&segment, &segment_)) return buffer;
  GstBuffer* out = gst_buffer_make_writable(buffer.release());
  for (GstClockTime* t : {&GST_BUFFER_PTS(out), &GST_BUFFER_DTS(out)}) {
    if (!GST_CLOCK_TIME_IS_VALID(*t)) continue;
    const GstClockTime running = gst_segment_to_running_time(&segment, GST_FORMAT_TIME, *t);
    *t = gst_segment_position_from_running_time(&segment_, GST_FORMAT_TIME, running);
  }
  return BufferPtr(out);
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// What enters screamtx: RTP and events on the sink pads, RTCP on rtcp_sink.
#include "gst/common/buffer_map.h"
#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

bool IsLive(GstPad* pad) {
  const QueryPtr query(gst_query_new_latency());
  gboolean live = TRUE;
  // Who cannot say is taken for live, and never held back.
  if (gst_pad_peer_query(pad, query.get()))
    gst_query_parse_latency(query.get(), &live, nullptr, nullptr);
  return live != FALSE;
}

/// The time at which input that is not live may enter: as if a live source had made it.
GstClockTime EntryTime(GstLidarScreamTx* self, const TxStream& stream, GstBuffer* buffer) {
  const GstClockTime pts = GST_BUFFER_PTS(buffer);
  if (!GST_CLOCK_TIME_IS_VALID(pts) || stream.segment.format != GST_FORMAT_TIME)
    return GST_CLOCK_TIME_NONE;
  const GstClockTime running = gst_segment_to_running_time(&stream.segment, GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(running)) return GST_CLOCK_TIME_NONE;
  return running + gst_element_get_base_time(GST_ELEMENT(self));
}

/// Waits for the pipeline's clock; returns at once where there is none or we do not play.
void WaitForEntry(GstLidarScreamTx* self, TxStream& stream, GstBuffer* buffer) {
  TxState& state = *self->state;
  const GstClockTime entry = EntryTime(self, stream, buffer);
  GstClock* clock = gst_element_get_clock(GST_ELEMENT(self));
  if (clock != nullptr && GST_CLOCK_TIME_IS_VALID(entry)) {
    GstClockID id = gst_clock_new_single_shot_id(clock, entry);
    TxLock lock(state.mutex);
    const bool wait = state.running && state.playing && !stream.flushing;
    stream.entry_wait = id;
    lock.unlock();
    if (wait) gst_clock_id_wait(id, nullptr);
    lock.lock();
    stream.entry_wait = nullptr;
    lock.unlock();
    gst_clock_id_unref(id);
  }
  if (clock != nullptr) gst_object_unref(clock);
}

/// Takes one packet into the queue; with the lock held.
void Enqueue(TxState& state, TxStream& stream, BufferPtr buffer, Time now) {
  const auto header = ReadRtpHeader(buffer.get());
  if (!header) {
    ++stream.counters.malformed;
    return;
  }
  const gsize size = gst_buffer_get_size(buffer.get());
  TxItem item;
  item.header = *header;
  item.size = DataSize::Bytes(static_cast<std::int64_t>(size)) + state.settings.packet_overhead;
  item.queued = now;
  item.buffer = std::move(buffer);
  if (!stream.ssrc) stream.ssrc = header->ssrc;
  if (!stream.payload_type) stream.payload_type = header->payload_type;
  const bool media = *stream.ssrc == header->ssrc && *stream.payload_type == header->payload_type;
  stream.overhead.Add(media ? size - header->header_size : 0, item.size);
  state.controller->OnQueued(now, stream.id,
                             {header->ssrc, item.size, header->marker, header->timestamp});
  stream.queue.push_back(std::move(item));
  ++stream.counters.packets_queued;
}

/// Waits until there is room for input that is not live. Before we play there is room for what a
/// sink needs to preroll.
void WaitForRoom(TxState& state, TxStream& stream) {
  TxLock lock(state.mutex);
  const Duration limit = state.settings.max_queue_delay();
  state.room.wait(lock, [&] {
    if (!state.running || stream.flushing || state.flow != GST_FLOW_OK) return true;
    if (!state.playing) return stream.queue.empty();
    return stream.HeadAge(TxNow(state)) < limit;
  });
}

/// What the chain function is to return before it may queue; with the lock held.
GstFlowReturn Gate(const TxState& state, const TxStream& stream) {
  if (!state.running || stream.flushing) return GST_FLOW_FLUSHING;
  if (stream.eos) return GST_FLOW_EOS;
  return state.flow;
}

/// Asks upstream once a stream.
bool KnownLive(TxState& state, TxStream& stream, GstPad* pad) {
  {
    TxLock lock(state.mutex);
    if (stream.live) return *stream.live;
  }
  const bool live = IsLive(pad);
  TxLock lock(state.mutex);
  stream.live = live;
  return live;
}

template <class Take>
GstFlowReturn Queue(GstLidarScreamTx* self, GstPad* pad, GstBuffer* first, Take take) {
  TxState& state = *self->state;
  TxStream& stream = *PadStream(pad);
  if (!KnownLive(state, stream, pad)) {
    WaitForRoom(state, stream);
    WaitForEntry(self, stream, first);
  }
  TxLock lock(state.mutex);
  const GstFlowReturn flow = Gate(state, stream);
  if (flow != GST_FLOW_OK) return flow;
  take(state, stream, TxNow(state));
  // A task that waits for its pace looks at the queue soon enough.
  if (!state.waits_for_pace) WakePacer(state);
  return GST_FLOW_OK;
}

bool Push(TxStream& stream, GstEvent* event) {
  TxItem item;
  item.event.reset(event);
  stream.queue.push_back(std::move(item));
  return true;
}

void OnCaps(GstLidarScreamTx* self, GstPad* pad, TxStream& stream, GstEvent* event) {
  TxState& state = *self->state;
  GstCaps* caps = nullptr;
  gst_event_parse_caps(event, &caps);
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  guint ssrc = 0;
  gint payload = 0;
  EventPtr start;
  {
    TxLock lock(state.mutex);
    if (gst_structure_get_uint(s, "ssrc", &ssrc)) stream.ssrc = ssrc;
    if (gst_structure_get_int(s, "payload", &payload))
      stream.payload_type = static_cast<guint8>(payload);
    stream.is_video = g_strcmp0(gst_structure_get_string(s, "media"), "video") == 0;
    if (!stream.has_caps && state.controller) {
      stream.has_caps = true;
      const Time now = TxNow(state);
      start.reset(TargetEvent(state, stream, now, "start"));
      stream.notifier.Reset();
      stream.notifier.ShouldNotify(now, state.controller->target_bitrate(stream.id));
    }
    Push(stream, gst_event_ref(event));
    WakePacer(state);
  }
  if (start) gst_pad_push_event(pad, start.release());
}

void OnFlushStart(GstLidarScreamTx* self, TxStream& stream) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  stream.flushing = true;
  if (stream.entry_wait != nullptr) gst_clock_id_unschedule(stream.entry_wait);
  if (state.controller) ClearQueue(state, stream, TxNow(state));
  state.room.notify_all();
}

void OnFlushStop(GstLidarScreamTx* self, TxStream& stream) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (state.controller) ClearQueue(state, stream, TxNow(state));
  stream.flushing = false;
  stream.eos = false;
  gst_segment_init(&stream.segment, GST_FORMAT_TIME);
  state.eos_deadline.reset();
  state.eos_sent = false;
  state.flow = GST_FLOW_OK;
}

/// A flush of the only stream goes on downstream; one of several stays with its own.
gboolean HandleFlush(GstLidarScreamTx* self, TxStream& stream, GstEvent* event) {
  TxState& state = *self->state;
  const bool start = GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_START;
  bool alone = false;
  {
    TxLock lock(state.mutex);
    alone = state.streams.size() == 1;
  }
  if (start) OnFlushStart(self, stream);
  if (!alone) {
    if (!start) OnFlushStop(self, stream);
    gst_event_unref(event);
    return TRUE;
  }
  const gboolean done = gst_pad_push_event(self->src, event);
  if (start) {
    {
      TxLock lock(state.mutex);
      state.flow = GST_FLOW_FLUSHING;
      WakePacer(state);
    }
    gst_pad_pause_task(self->src);
  } else {
    OnFlushStop(self, stream);
    gst_pad_start_task(self->src, TxPace, self, nullptr);
  }
  return done;
}

void Remember(TxState& state, TxStream& stream, GstEvent* event) {
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      stream.live.reset();
      break;
    case GST_EVENT_SEGMENT:
      gst_event_copy_segment(event, &stream.segment);
      break;
    case GST_EVENT_EOS:
      stream.eos = true;
      break;
    case GST_EVENT_CUSTOM_DOWNSTREAM_STICKY: {
      GstLidarBitrateBounds bounds{};
      if (!gst_lidar_event_parse_bitrate_bounds(event, &bounds)) break;
      stream.bounds = bounds;
      if (state.controller) Configure(state, stream);
      break;
    }
    default:
      break;
  }
}

/// Hands one CCFB packet to the controller; false where it is not for us.
bool Feed(GstLidarScreamTx* self, ByteView packet, GSocketAddress* from) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (!state.controller || !state.running) return true;
  const auto feedback = state.parser.Parse(packet);
  if (!feedback) {
    ++state.malformed_rtcp;
    return false;
  }
  const Time now = TxNow(state);
  const auto result = state.controller->OnFeedback(now, *feedback);
  if (result == scream::FeedbackResult::kNotOurs) return false;
  if (result == scream::FeedbackResult::kAccepted && state.feedback_peer.OnFeedback(now, from)) {
    GST_INFO_OBJECT(self, "feedback comes from a new address: a new path");
    state.controller->OnRouteChange(now);
  }
  WakePacer(state);
  return true;
}

}  // namespace

GstFlowReturn TxChain(GstPad* pad, GstObject* parent, GstBuffer* buffer) {
  BufferPtr owner(buffer);
  return Queue(GST_LIDAR_SCREAM_TX(parent), pad, buffer,
               [&](TxState& state, TxStream& stream, Time now) {
                 Enqueue(state, stream, std::move(owner), now);
               });
}

GstFlowReturn TxChainList(GstPad* pad, GstObject* parent, GstBufferList* list) {
  const BufferListPtr owner(list);
  const guint n = gst_buffer_list_length(list);
  if (n == 0) return GST_FLOW_OK;
  return Queue(GST_LIDAR_SCREAM_TX(parent), pad, gst_buffer_list_get(list, 0),
               [&](TxState& state, TxStream& stream, Time now) {
                 for (guint i = 0; i < n; ++i)
                   Enqueue(state, stream, BufferPtr(gst_buffer_ref(gst_buffer_list_get(list, i))),
                           now);
               });
}

gboolean TxSinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_SCREAM_TX(parent);
  TxState& state = *self->state;
  TxStream& stream = *PadStream(pad);
  const GstEventType type = GST_EVENT_TYPE(event);
  if (type == GST_EVENT_FLUSH_START || type == GST_EVENT_FLUSH_STOP)
    return HandleFlush(self, stream, event);
  if (!GST_EVENT_IS_SERIALIZED(event)) return gst_pad_push_event(self->src, event);
  if (type == GST_EVENT_CAPS) {
    OnCaps(self, pad, stream, event);
    gst_event_unref(event);
    return TRUE;
  }
  TxLock lock(state.mutex);
  if (!state.running || stream.flushing) {
    gst_event_unref(event);
    return FALSE;
  }
  Remember(state, stream, event);
  Push(stream, event);
  WakePacer(state);
  return TRUE;
}

GstFlowReturn TxRtcpChain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_SCREAM_TX(parent);
  BufferPtr owner(buffer);
  std::vector<std::uint8_t> rest;
  {
    const BufferMap map(buffer, GST_MAP_READ);
    if (!map) return GST_FLOW_OK;
    const auto packets = scream::SplitRtcp(map.view());
    if (packets.empty()) rest.assign(map.view().begin(), map.view().end());
    for (const ByteView packet : packets)
      if (!scream::IsCcfb(packet) || !Feed(self, packet, SourceOf(buffer)))
        rest.insert(rest.end(), packet.begin(), packet.end());
  }
  if (rest.empty() || !gst_pad_is_linked(self->rtcp_src)) return GST_FLOW_OK;
  if (rest.size() != gst_buffer_get_size(buffer)) {
    GstBuffer* part = gst_buffer_new_allocate(nullptr, rest.size(), nullptr);
    gst_buffer_fill(part, 0, rest.data(), rest.size());
    gst_buffer_copy_into(part, buffer, GST_BUFFER_COPY_METADATA, 0, static_cast<gsize>(-1));
    owner.reset(part);
  }
  return gst_pad_push(self->rtcp_src, owner.release());
}

}  // namespace lidar::gst

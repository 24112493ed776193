// SPDX-License-Identifier: LGPL-2.1-or-later
// The input of screamtx on its sink pads: RTP and events.
#include <utility>

#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

bool IsLive(GstPad* pad) {
  const QueryPtr query(gst_query_new_latency());
  gboolean live = TRUE;
  // If upstream does not answer, it counts as live, and its packets are never delayed.
  if (gst_pad_peer_query(pad, query.get()))
    gst_query_parse_latency(query.get(), &live, nullptr, nullptr);
  return live != FALSE;
}

/// Returns the id of the packet's scan, or nothing if the payloader has not attached it.
std::optional<std::uint32_t> ScanOf(GstBuffer* buffer) {
  GstLidarSlice slice;
  if (!gst_lidar_buffer_get_slice(buffer, &slice)) return std::nullopt;
  return slice.scan_id;
}

/// Adds a packet to the queue. The caller holds the lock.
void Enqueue(TxState& state, TxStream& stream, BufferPtr buffer, Time now) {
  const auto header = ReadRtpHeader(buffer.get());
  if (!header) {
    ++stream.counters.malformed;
    GST_DEBUG_OBJECT(stream.pad, "dropping what is no RTP");
    return;
  }
  const gsize size = gst_buffer_get_size(buffer.get());
  const auto scan = ScanOf(buffer.get());
  TxItem item;
  item.header = *header;
  item.size = DataSize::Bytes(static_cast<std::int64_t>(size)) + state.settings.packet_overhead;
  item.queued = now;
  item.buffer = std::move(buffer);
  if (!stream.ssrc) stream.ssrc = header->ssrc;
  if (!stream.payload_type) stream.payload_type = header->payload_type;
  const bool media = *stream.ssrc == header->ssrc && *stream.payload_type == header->payload_type;
  const gsize headers = header->header_size + (state.link ? state.link->trailer() : 0);
  stream.overhead.Add(media && size > headers ? size - headers : 0, item.size);
  state.controller->OnQueued(now, stream.id,
                             {header->ssrc, item.size, header->marker, header->timestamp, scan});
  stream.queue.push_back(std::move(item));
  ++stream.counters.packets_queued;
  state.reporter.notices().watch().OnInput(now);
}

/// Returns true if upstream is live. Queries upstream only once per stream.
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
  const bool live = KnownLive(state, stream, pad);
  TxLock lock(state.mutex);
  if (!live) state.gate.Wait(lock, GST_ELEMENT(self), state.max_queue_delay, stream, first);
  const GstFlowReturn flow = state.gate.Check(stream);
  if (flow != GST_FLOW_OK) return flow;
  take(state, stream, TxNow(state));
  state.pacing.OnQueued();
  return GST_FLOW_OK;
}

void Push(TxStream& stream, GstEvent* event) {
  TxItem item;
  item.event.reset(event);
  stream.queue.push_back(std::move(item));
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
    const gchar* encoding = gst_structure_get_string(s, "encoding-name");
    stream.wants_receipts = encoding != nullptr && g_str_has_prefix(encoding, "X-LIDAR");
    if (state.controller) start = FirstTarget(stream, *state.controller, TxNow(state));
    Push(stream, gst_event_ref(event));
    state.pacing.Wake();
  }
  if (start) gst_pad_push_event(pad, start.release());
}

/// Call it when a stream begins after its end. If the end of all streams was already sent, the
/// output begins anew, too.
void BeginAnew(TxState& state) {
  if (state.pacing.end_sent()) state.merger.BeginAnew();
  state.pacing.ForgetEnd();
}

void OnFlushStart(GstLidarScreamTx* self, TxStream& stream) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  stream.flushing = true;
  if (state.controller) FlushQueue(state, stream, TxNow(state));
  state.gate.Release(stream);
}

/// Handles the end of a flush. If the flush went downstream, it has removed the EOS and the segment
/// there.
void OnFlushStop(GstLidarScreamTx* self, TxStream& stream, GstEvent* event, bool flushes_src) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (state.controller) FlushQueue(state, stream, TxNow(state));
  gboolean resets_time = TRUE;
  gst_event_parse_flush_stop(event, &resets_time);
  stream.entry_shift.due = resets_time != FALSE;
  stream.flushing = false;
  stream.eos = false;
  gst_segment_init(&stream.segment, GST_FORMAT_TIME);
  if (flushes_src) {
    state.merger.ForgetSegment();
    state.pacing.ForgetEnd();
  } else {
    BeginAnew(state);
  }
  state.gate.set_flow(GST_FLOW_OK);
}

}  // namespace

/// Handles the start or end of a flush. The flush of the only stream goes downstream, whereas the
/// flush of one of several streams does not. Pads may be added or removed during a flush, so the
/// end of a flush goes downstream if its start did.
gboolean TxFlush(GstLidarScreamTx* self, TxStream& stream, GstEvent* event) {
  TxState& state = *self->state;
  const EventPtr owner(event);
  const bool start = GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_START;
  bool flushes_src = false;
  {
    TxLock lock(state.mutex);
    const bool alone = state.streams.size() == 1;
    flushes_src = stream.flushes_src || (alone && (start || !stream.flushing));
    stream.flushes_src = start && flushes_src;
  }
  if (start) OnFlushStart(self, stream);
  const gboolean done =
      flushes_src ? gst_pad_push_event(self->src, gst_event_ref(event)) : gboolean{TRUE};
  if (start && flushes_src) state.pacing.Pause(GST_FLOW_FLUSHING);
  if (!start) {
    OnFlushStop(self, stream, event, flushes_src);
    state.pacing.Start();  // pauses again if downstream still takes nothing
  }
  return done;
}

namespace {

void Remember(TxState& state, TxStream& stream, GstEvent* event) {
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      stream.live.reset();
      // If the end was already sent, the stream of a new pad begins the output anew, too.
      if (std::exchange(stream.eos, false) || state.pacing.end_sent()) BeginAnew(state);
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
    return TxFlush(self, stream, event);
  if (!GST_EVENT_IS_SERIALIZED(event)) return gst_pad_push_event(self->src, event);
  if (type == GST_EVENT_CAPS) {
    OnCaps(self, pad, stream, event);
    gst_event_unref(event);
    return TRUE;
  }
  TxLock lock(state.mutex);
  if (!state.gate.open() || stream.flushing) {
    gst_event_unref(event);
    return FALSE;
  }
  Remember(state, stream, event);
  Push(stream, event);
  state.pacing.Wake();
  return TRUE;
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The pacing task of screamtx: takes packets out of the queues when the controller says.
#include <algorithm>

#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

constexpr std::size_t kMaxBatch = 64;
constexpr int kByeCopies = 3;  // the network may lose one

/// What one round sends: packets, or one event.
struct Batch {
  std::vector<BufferPtr> packets;
  EventPtr event;
  bool end = false;
};

/// How long a frame that has begun to leave may take for the rest of it.
Duration LongestStay(const TxState& state) { return 2 * state.settings.max_queue_delay(); }

/// The rest of a frame that has begun to leave, where it waited so long that nobody can use it.
std::size_t StuckPackets(const TxState& state, const TxStream& stream, Time now) {
  if (stream.HeadAge(now) < LongestStay(state)) return 0;
  std::optional<guint32> frame;
  std::size_t packets = 0;
  for (const TxItem& item : stream.queue) {
    if (!item.buffer) continue;
    if (frame && *frame != item.header.timestamp) break;
    frame = item.header.timestamp;
    ++packets;
  }
  return packets;
}

/// Live input that waited too long is of no use any more, and in the way of what comes next.
void DropLate(TxState& state, TxStream& stream, Time now) {
  std::size_t late = state.controller->LatePackets(now, stream.id);
  if (late == 0) late = StuckPackets(state, stream, now);
  if (late == 0) return;
  state.controller->OnDropped(now, stream.id, late);
  std::optional<guint32> frame;
  for (auto it = stream.queue.begin(); it != stream.queue.end() && late > 0;) {
    if (!it->buffer) {
      ++it;
      continue;
    }
    if (frame != it->header.timestamp) ++stream.counters.frames_dropped;
    frame = it->header.timestamp;
    it = stream.queue.erase(it);
    --late;
  }
  if (stream.is_video) stream.key_unit_due = true;
}

/// Takes the first packet of `stream`, which the controller chose, and accounts for it.
BufferPtr TakePacket(TxState& state, TxStream& stream, scream::Ecn ecn, Time now) {
  TxItem item = std::move(stream.queue.front());
  stream.queue.pop_front();
  state.controller->OnSent(now, stream.id, {item.header.ssrc, item.header.seq, item.size, ecn});
  GstBuffer* buffer = item.buffer.release();
  if (state.settings.ecn_mode != kEcnOff) {
    buffer = gst_buffer_make_writable(buffer);
    gst_lidar_buffer_set_ecn(buffer, static_cast<GstLidarEcn>(ecn), GST_CLOCK_TIME_NONE);
  }
  if (state.streams.size() > 1 && stream.segment.format == GST_FORMAT_TIME &&
      !gst_segment_is_equal(&stream.segment, &state.out_segment)) {
    buffer = gst_buffer_make_writable(buffer);
    for (GstClockTime* t : {&GST_BUFFER_PTS(buffer), &GST_BUFFER_DTS(buffer)}) {
      if (!GST_CLOCK_TIME_IS_VALID(*t)) continue;
      const GstClockTime running =
          gst_segment_to_running_time(&stream.segment, GST_FORMAT_TIME, *t);
      *t = gst_segment_position_from_running_time(&state.out_segment, GST_FORMAT_TIME, running);
    }
  }
  return BufferPtr(buffer);
}

void CollectPackets(TxState& state, Time now, Batch* batch) {
  while (batch->packets.size() < kMaxBatch) {
    const auto decision = state.controller->NextSend(now);
    if (!decision || decision->time > now) return;
    TxStream* stream = FindStream(state, decision->stream);
    // An event in front goes first, next round.
    if (stream == nullptr || stream->queue.empty() || !stream->queue.front().buffer) return;
    batch->packets.push_back(TakePacket(state, *stream, decision->ecn, now));
  }
}

/// Of the merged stream, which has an identity of its own.
GstEvent* GenericStart() {
  const StringPtr id(g_strdup_printf("screamtx/%08x%08x", g_random_int(), g_random_int()));
  return gst_event_new_stream_start(id.get());
}

/// With several streams the src pad has events of its own, which suit all of them.
bool SuitsMerged(TxState& state, const TxStream& stream, GstEvent* event) {
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      return !state.sent_stream_start;
    case GST_EVENT_SEGMENT:
      return state.out_segment.format == GST_FORMAT_UNDEFINED;
    case GST_EVENT_CAPS:
      return !state.merged_caps;
    default:
      return &stream == state.streams.front().get();
  }
}

/// Remembers what the src pad has had; may replace the event.
void NoteSent(TxState& state, EventPtr* event) {
  switch (GST_EVENT_TYPE(event->get())) {
    case GST_EVENT_STREAM_START:
      state.sent_stream_start = true;
      break;
    case GST_EVENT_SEGMENT:
      gst_event_copy_segment(event->get(), &state.out_segment);
      break;
    case GST_EVENT_CAPS:
      state.merged_caps = state.streams.size() > 1;
      if (!state.merged_caps) break;
      event->reset(
          gst_event_new_caps(CapsPtr(gst_caps_new_empty_simple("application/x-rtp")).get()));
      break;
    default:
      break;
  }
}

/// The next event that waits at the head of a queue, if any.
bool CollectEvent(GstLidarScreamTx* self, Batch* batch) {
  TxState& state = *self->state;
  for (auto& stream : state.streams) {
    while (!stream->queue.empty() && stream->queue.front().event) {
      EventPtr event = std::move(stream->queue.front().event);
      if (GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS) {
        stream->queue.pop_front();
        continue;  // sent once all streams have ended
      }
      if (GST_EVENT_TYPE(event.get()) != GST_EVENT_STREAM_START && !state.sent_stream_start) {
        stream->queue.front().event = std::move(event);
        event.reset(GenericStart());
      } else {
        stream->queue.pop_front();
      }
      if (state.streams.size() > 1 && !SuitsMerged(state, *stream, event.get())) continue;
      NoteSent(state, &event);
      batch->event = std::move(event);
      return true;
    }
  }
  return false;
}

bool AllEnded(const TxState& state) {
  return !state.streams.empty() && std::all_of(state.streams.begin(), state.streams.end(),
                                               [](const auto& s) { return s->eos; });
}

bool AllSent(const TxState& state) {
  return std::all_of(state.streams.begin(), state.streams.end(),
                     [](const auto& s) { return s->queue.empty(); });
}

/// True once everything has left, or after as long as a frame that has begun to leave may take.
bool Drained(TxState& state, Time now) {
  if (!AllEnded(state) || state.eos_sent) return false;
  if (!state.eos_deadline) state.eos_deadline = now + LongestStay(state);
  if (!AllSent(state) && now < *state.eos_deadline) return false;
  for (auto& stream : state.streams) ClearQueue(state, *stream, now);
  state.eos_sent = true;
  return true;
}

Batch NextBatch(GstLidarScreamTx* self, Time now) {
  TxState& state = *self->state;
  Batch batch;
  for (auto& stream : state.streams)
    if (stream->live.value_or(true)) DropLate(state, *stream, now);
  if (CollectEvent(self, &batch)) return batch;
  CollectPackets(state, now, &batch);
  if (batch.packets.empty()) batch.end = Drained(state, now);
  return batch;
}

/// When the task has something to do again, whatever happens.
Time NextWake(TxState& state, Time now) {
  Time wake = now + std::chrono::milliseconds(200);  // the pulse of target-bitrate
  wake = std::min(wake, state.controller->NextTimer());
  if (state.settings.stats_interval > Duration{0}) wake = std::min(wake, state.next_stats);
  if (state.eos_deadline && !state.eos_sent) wake = std::min(wake, *state.eos_deadline);
  for (const auto& stream : state.streams)
    if (!stream->queue.empty() && stream->live.value_or(true))
      wake = std::min(wake, now - stream->HeadAge(now) + state.settings.max_queue_delay());
  // A late frame that has begun to leave stays: look again, but not without end.
  return std::max(wake, now + std::chrono::milliseconds(1));
}

void Wait(TxState& state, TxLock& lock) {
  const Time now = TxNow(state);
  const auto decision = state.controller->NextSend(now);
  Time wake = NextWake(state, now);
  state.waits_for_pace = decision && decision->time <= wake;
  if (state.waits_for_pace) wake = decision->time;
  if (wake <= now) return;
  GstClock* clock = state.clock;
  GstClockID id = gst_clock_new_single_shot_id(
      clock, static_cast<GstClockTime>(wake.time_since_epoch().count()));
  state.timer = id;
  lock.unlock();
  gst_clock_id_wait(id, nullptr);
  lock.lock();
  state.timer = nullptr;
  state.waits_for_pace = false;
  gst_clock_id_unref(id);
}

GstFlowReturn PushPackets(GstLidarScreamTx* self, std::vector<BufferPtr> packets) {
  if (packets.size() == 1) return gst_pad_push(self->src, packets.front().release());
  GstBufferList* list = gst_buffer_list_new_sized(static_cast<guint>(packets.size()));
  for (BufferPtr& packet : packets) gst_buffer_list_add(list, packet.release());
  return gst_pad_push_list(self->src, list);
}

/// Says goodbye for all SSRCs, then ends the stream.
void PushEnd(GstLidarScreamTx* self, const std::vector<guint32>& ssrcs) {
  const auto bye = BuildBye(ssrcs);
  for (int i = 0; i < kByeCopies && !bye.empty(); ++i) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, bye.size(), nullptr);
    gst_buffer_fill(buffer, 0, bye.data(), bye.size());
    gst_pad_push(self->src, buffer);
  }
  gst_pad_push_event(self->src, gst_event_new_eos());
}

std::vector<guint32> Goodbyes(const TxState& state) {
  std::vector<guint32> ssrcs;
  if (!state.settings.send_bye) return ssrcs;
  for (const auto& stream : state.streams)
    if (stream->ssrc) ssrcs.push_back(*stream->ssrc);
  return ssrcs;
}

void StopOn(GstLidarScreamTx* self, GstFlowReturn flow) {
  TxState& state = *self->state;
  {
    TxLock lock(state.mutex);
    if (state.flow == GST_FLOW_OK) state.flow = flow;
    state.room.notify_all();
  }
  GST_DEBUG_OBJECT(self, "pausing, reason %s", gst_flow_get_name(flow));
  gst_pad_pause_task(self->src);
}

}  // namespace

void TxPace(gpointer data) {
  auto* self = GST_LIDAR_SCREAM_TX(data);
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (!state.running || state.flow != GST_FLOW_OK) {
    lock.unlock();
    gst_pad_pause_task(self->src);
    return;
  }
  const Time now = TxNow(state);
  if (state.settings_changed) {
    state.settings_changed = false;
    for (auto& stream : state.streams) Configure(state, *stream);
  }
  if (now >= state.controller->NextTimer()) state.controller->OnTimer(now);
  Batch batch = NextBatch(self, now);
  Evaluate(self, now);
  if (batch.packets.empty() && !batch.event && !batch.end) {
    Wait(state, lock);
    return;
  }
  const auto ssrcs = batch.end ? Goodbyes(state) : std::vector<guint32>{};
  state.room.notify_all();
  lock.unlock();
  GstFlowReturn flow = GST_FLOW_OK;
  if (batch.event) gst_pad_push_event(self->src, batch.event.release());
  if (!batch.packets.empty()) flow = PushPackets(self, std::move(batch.packets));
  if (batch.end) PushEnd(self, ssrcs);
  if (flow != GST_FLOW_OK) StopOn(self, flow);
}

gboolean TxActivateSrc(GstPad* pad, GstObject* parent, GstPadMode mode, gboolean active) {
  auto* self = GST_LIDAR_SCREAM_TX(parent);
  TxState& state = *self->state;
  if (mode != GST_PAD_MODE_PUSH) return FALSE;
  {
    TxLock lock(state.mutex);
    state.running = active != FALSE;
    state.flow = active ? GST_FLOW_OK : GST_FLOW_FLUSHING;
    state.room.notify_all();
    WakePacer(state);
  }
  if (!active) return gst_pad_stop_task(pad);
  return gst_pad_start_task(pad, TxPace, self, nullptr);
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/pacing_task.h"

#include <algorithm>

#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

constexpr std::size_t kMaxBatch = 64;
// The receiver is gone if it has acknowledged nothing for this time.
constexpr Duration kReceiverTimeout = std::chrono::seconds(1);
constexpr int kByeCopies = 3;  // the network may lose some

bool AllEnded(const TxState& state) {
  return !state.streams.empty() && std::all_of(state.streams.begin(), state.streams.end(),
                                               [](const auto& s) { return s->eos; });
}

bool AllSent(const TxState& state) {
  return std::all_of(state.streams.begin(), state.streams.end(),
                     [](const auto& s) { return s->queue.empty(); });
}

GstFlowReturn PushPackets(GstPad* src, std::vector<BufferPtr> packets) {
  if (packets.size() == 1) return gst_pad_push(src, packets.front().release());
  GstBufferList* list = gst_buffer_list_new_sized(static_cast<guint>(packets.size()));
  for (BufferPtr& packet : packets) gst_buffer_list_add(list, packet.release());
  return gst_pad_push_list(src, list);
}

GstFlowReturn PushRtcp(GstPad* src, const std::vector<std::uint8_t>& rtcp) {
  return gst_pad_push(src, gst_buffer_new_memdup(rtcp.data(), rtcp.size()));
}

/// Sends an RTCP BYE for `ssrcs`, and then EOS.
void PushEnd(GstPad* src, const std::vector<guint32>& ssrcs) {
  const auto bye = BuildBye(ssrcs);
  for (int i = 0; i < kByeCopies && !bye.empty(); ++i) PushRtcp(src, bye);
  gst_pad_push_event(src, gst_event_new_eos());
}

std::vector<guint32> Goodbyes(const TxState& state) {
  std::vector<guint32> ssrcs;
  if (!state.settings.send_bye) return ssrcs;
  for (const auto& stream : state.streams)
    if (stream->ssrc) ssrcs.push_back(*stream->ssrc);
  return ssrcs;
}

}  // namespace

TxState& PacingTask::state() const { return *self_->state; }

bool PacingTask::Start() { return gst_pad_start_task(self_->src, Run, this, nullptr) != FALSE; }
bool PacingTask::Stop() { return gst_pad_stop_task(self_->src) != FALSE; }

void PacingTask::Pause(GstFlowReturn flow) {
  {
    const TxLock lock(state().mutex);
    if (state().gate.flow() == GST_FLOW_OK) state().gate.set_flow(flow);
    Wake();
  }
  GST_DEBUG_OBJECT(self_, "pausing, reason %s", gst_flow_get_name(flow));
  gst_pad_pause_task(self_->src);
}

void PacingTask::Wake() {
  if (timer_ != nullptr) gst_clock_id_unschedule(timer_);
}

void PacingTask::ForgetEnd() {
  end_deadline_.reset();
  end_sent_ = false;
}

void PacingTask::Run(gpointer data) {
  auto* self = static_cast<PacingTask*>(data);
  TxLock lock(self->state().mutex);
  if (self->state().gate.open() && self->state().gate.flow() == GST_FLOW_OK)
    return self->Round(lock);
  lock.unlock();
  gst_pad_pause_task(self->self_->src);
}

void PacingTask::Round(TxLock& lock) {
  TxState& s = state();
  const Time now = TxNow(s);
  if (settings_changed_)
    for (auto& stream : s.streams) Configure(s, *stream);
  settings_changed_ = false;
  if (now >= s.controller->NextTimer()) s.controller->OnTimer(now);
  Batch batch = NextBatch(now);
  s.reporter.Evaluate(now);
  if (batch.empty()) return Wait(lock);
  s.gate.OnRoom();
  lock.unlock();
  const GstFlowReturn flow = Push(std::move(batch));
  if (flow != GST_FLOW_OK) Pause(flow);
}

PacingTask::Batch PacingTask::NextBatch(Time now) {
  TxState& s = state();
  Batch batch;
  for (auto& stream : s.streams)
    if (stream->live.value_or(true)) DropLate(*stream, now);
  batch.event = s.merger.NextEvent(s.streams);
  if (batch.event) return batch;
  CollectPackets(now, &batch);
  if (batch.packets.empty())
    batch.end = Drained(now);
  else
    batch.report = s.reports.Take(s.settings.report_interval, s.streams, *s.controller, now);
  if (batch.end) batch.goodbyes = Goodbyes(s);
  batch.unheard = batch.end && s.reporter.notices().TakeUnheard(now);
  return batch;
}

/// Drops live packets that have waited too long, because they are useless to the receiver and delay
/// newer packets.
void PacingTask::DropLate(TxStream& stream, Time now) {
  std::size_t late = state().controller->LatePackets(now, stream.id);
  if (late == 0) return;
  state().controller->OnDropped(now, stream.id, late);
  GST_DEBUG_OBJECT(stream.pad, "dropping %" G_GSIZE_FORMAT " late packets", late);
  std::optional<guint32> frame;
  for (auto it = stream.queue.begin(); it != stream.queue.end() && late > 0;) {
    if (!it->buffer) {
      ++it;
      continue;
    }
    if (frame != it->header.timestamp) {
      ++stream.counters.frames_dropped;
      ++state().frames_dropped;
    }
    frame = it->header.timestamp;
    if (state().link) state().link->OnDropped(now, it->header.ssrc, it->header.seq);
    it = stream.queue.erase(it);
    --late;
  }
  if (stream.is_video) stream.key_unit_due = true;
}

/// Drops packets at the head of the queue that another link has already delivered, or that are too
/// late on all links.
void PacingTask::DropUnwanted(TxStream& stream, Time now) {
  TxState& s = state();
  while (!stream.queue.empty() && stream.queue.front().buffer) {
    const RtpHeader header = stream.queue.front().header;
    if (s.link->Wants(now, header.ssrc, header.seq)) return;
    if (s.link->OnDropped(now, header.ssrc, header.seq))
      s.controller->OnUnneeded(now, stream.id);
    else
      s.controller->OnDropped(now, stream.id, 1);
    stream.queue.pop_front();
  }
}

/// Removes the first packet from the queue of `stream`, which the controller chose, and counts the
/// packet as sent.
BufferPtr PacingTask::TakePacket(TxStream& stream, Ecn ecn, Time now) {
  TxState& s = state();
  TxItem item = std::move(stream.queue.front());
  stream.queue.pop_front();
  s.reporter.notices().watch().OnSent(now);
  const RtpHeader& header = item.header;
  const guint16 seq = s.link ? s.link->OnSent(now, header.ssrc, header.seq) : header.seq;
  s.controller->OnSent(now, stream.id, {header.ssrc, seq, item.size, ecn});
  if (s.settings.ecn_mode != kEcnOff) {
    GstBuffer* buffer = gst_buffer_make_writable(item.buffer.release());
    gst_lidar_buffer_set_ecn(buffer, static_cast<GstLidarEcn>(ecn), GST_CLOCK_TIME_NONE);
    item.buffer.reset(buffer);
  }
  return s.merger.ToOutput(stream, std::move(item.buffer));
}

void PacingTask::CollectPackets(Time now, Batch* batch) {
  while (batch->packets.size() < kMaxBatch) {
    if (state().link)
      for (auto& stream : state().streams) DropUnwanted(*stream, now);
    const auto decision = state().controller->NextSend(now);
    if (!decision || decision->time > now) return;
    TxStream* stream = FindStream(state(), decision->stream);
    // If an event is ahead of the packet, the next round sends the event first.
    if (stream == nullptr || stream->queue.empty() || !stream->queue.front().buffer) return;
    batch->packets.push_back(TakePacket(*stream, decision->ecn, now));
  }
}

void PacingTask::OnAccepted(Time now) {
  const auto waits = [](const auto& stream) { return !stream->live.value_or(true); };
  if (end_deadline_ && std::any_of(state().streams.begin(), state().streams.end(), waits))
    end_deadline_ = now + std::max(kReceiverTimeout, 2 * state().max_queue_delay);
}

/// Returns true once: when all streams have ended, and either all packets have been sent or the
/// deadline of the end has passed.
bool PacingTask::Drained(Time now) {
  TxState& s = state();
  if (!AllEnded(s) || end_sent_) return false;
  if (!end_deadline_) end_deadline_ = now + 2 * s.max_queue_delay;
  if (!AllSent(s) && now < *end_deadline_) return false;
  for (auto& stream : s.streams) ClearQueue(s, *stream, now);
  end_sent_ = true;
  return true;
}

/// Returns the latest time at which the task must run again.
Time PacingTask::NextWake(Time now) const {
  TxState& s = state();
  Time wake = std::min(s.reporter.NextLook(now), s.controller->NextTimer());
  if (end_deadline_ && !end_sent_) wake = std::min(wake, *end_deadline_);
  for (const auto& stream : s.streams)
    if (!stream->queue.empty() && stream->live.value_or(true))
      wake = std::min(wake, now - stream->HeadAge(now) + s.max_queue_delay);
  // A late frame stays in the queue if a part of it has been sent, or while a gap of the link
  // extends the limit. The task then checks the frame again after a millisecond.
  return std::max(wake, now + std::chrono::milliseconds(1));
}

void PacingTask::Wait(TxLock& lock) {
  TxState& s = state();
  const Time now = TxNow(s);
  const auto decision = s.controller->NextSend(now);
  Time wake = NextWake(now);
  waits_for_pace_ = decision && decision->time <= wake;
  if (waits_for_pace_) wake = decision->time;
  if (wake <= now) return;
  const auto at = static_cast<GstClockTime>(wake.time_since_epoch().count());
  GstClockID id = gst_clock_new_single_shot_id(s.clock, at);
  timer_ = id;
  lock.unlock();
  gst_clock_id_wait(id, nullptr);
  lock.lock();
  timer_ = nullptr;
  waits_for_pace_ = false;
  gst_clock_id_unref(id);
}

GstFlowReturn PacingTask::Push(Batch batch) {
  GstFlowReturn flow = GST_FLOW_OK;
  if (batch.event) gst_pad_push_event(self_->src, batch.event.release());
  if (!batch.packets.empty()) flow = PushPackets(self_->src, std::move(batch.packets));
  if (!batch.report.empty() && flow == GST_FLOW_OK) flow = PushRtcp(self_->src, batch.report);
  // The warning is posted before EOS, because an application may stop at EOS.
  if (batch.unheard) Notices::PostUnheard(GST_ELEMENT(self_), self_->src);
  if (batch.end) PushEnd(self_->src, batch.goodbyes);
  return flow;
}

}  // namespace lidar::gst

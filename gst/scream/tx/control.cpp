// SPDX-License-Identifier: LGPL-2.1-or-later
// The control thread of screamtx: target-bitrate and key unit events upstream, messages, notify.
#include <gst/video/video.h>

#include <algorithm>
#include <cmath>

#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

using namespace std::chrono_literals;

constexpr Duration kKeyUnitInterval = 500ms;
// The wire share moves the encoder's bounds only where it changed by more than this.
constexpr double kShareThreshold = 0.02;

struct PadEvent {
  PadPtr pad;
  EventPtr event;
};
struct Work {
  std::vector<PadEvent> events;
  std::vector<MessagePtr> messages;
  bool notify = false;
};

void EvaluateStream(TxState& state, TxStream& stream, Time now, bool* due) {
  const double share = stream.overhead.payload_share();
  if (stream.bounds && std::abs(share / stream.configured_share - 1) > kShareThreshold)
    Configure(state, stream);
  if (stream.has_caps &&
      stream.notifier.ShouldNotify(now, state.controller->target_bitrate(stream.id))) {
    stream.target_due = *due = true;
  }
  if (state.settings.key_unit_on_loss && stream.is_video) {
    const guint64 lost = state.controller->stream_statistics(now, stream.id).packets_lost;
    stream.key_unit_due = stream.key_unit_due || lost > stream.lost_seen;
    stream.lost_seen = lost;
  }
  if (!stream.key_unit_due) return;
  // Key frames are large: asked for too often they are the congestion.
  if (stream.last_key_unit && now - *stream.last_key_unit < kKeyUnitInterval) return;
  *due = true;
}

MessagePtr EcnMessage(GstLidarScreamTx* self) {
  TxState& state = *self->state;
  GstStructure* s = gst_structure_new("scream-ecn-state-changed", "state", G_TYPE_STRING,
                                      scream::ToString(state.ecn_state), "previous", G_TYPE_STRING,
                                      scream::ToString(state.ecn_announced), nullptr);
  state.ecn_announced = state.ecn_state;
  return MessagePtr(gst_message_new_element(GST_OBJECT(self), s));
}

GstEvent* KeyUnitEvent(TxStream& stream, Time now) {
  stream.key_unit_due = false;
  stream.last_key_unit = now;
  return gst_video_event_new_upstream_force_key_unit(GST_CLOCK_TIME_NONE, TRUE, ++stream.key_units);
}

PadPtr Ref(GstPad* pad) { return PadPtr(GST_PAD(gst_object_ref(pad))); }

/// Takes what is due out of the state; with the lock held.
Work TakeWork(GstLidarScreamTx* self, Time now) {
  TxState& state = *self->state;
  Work work;
  for (auto& stream : state.streams) {
    if (stream->target_due) {
      stream->target_due = false;
      work.events.push_back(
          {Ref(stream->pad), EventPtr(TargetEvent(state, *stream, now, nullptr))});
    }
    if (stream->key_unit_due &&
        (!stream->last_key_unit || now - *stream->last_key_unit >= kKeyUnitInterval)) {
      work.events.push_back({Ref(stream->pad), EventPtr(KeyUnitEvent(*stream, now))});
    }
  }
  if (state.ecn_due) work.messages.push_back(EcnMessage(self));
  if (state.stats_due)
    work.messages.push_back(
        MessagePtr(gst_message_new_element(GST_OBJECT(self), StatsOf(state).release())));
  work.notify = state.estimate_due;
  state.ecn_due = state.stats_due = state.estimate_due = false;
  return work;
}

bool HasWork(const TxState& state) {
  return state.control_stop || state.ecn_due || state.stats_due || state.estimate_due ||
         std::any_of(state.streams.begin(), state.streams.end(),
                     [](const auto& s) { return s->target_due || s->key_unit_due; });
}

void Run(GstLidarScreamTx* self) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  for (;;) {
    // A key unit that must wait for its interval is looked at with the next target.
    state.control.wait_for(lock, 200ms, [&] { return HasWork(state); });
    if (state.control_stop) return;
    Work work = TakeWork(self, TxNow(state));
    lock.unlock();
    for (PadEvent& e : work.events) gst_pad_push_event(e.pad.get(), e.event.release());
    for (MessagePtr& m : work.messages) gst_element_post_message(GST_ELEMENT(self), m.release());
    if (work.notify) g_object_notify(G_OBJECT(self), "estimated-bitrate");
    work = {};
    lock.lock();
  }
}

}  // namespace

GstEvent* TargetEvent(const TxState& state, const TxStream& stream, Time now, const char* reason) {
  const scream::Statistics s = state.controller->statistics(now);
  GstLidarTargetBitrate target{};
  target.bitrate = ToEncoder(stream, state.controller->target_bitrate(stream.id));
  target.ssrc = stream.ssrc.value_or(0);
  target.min_bitrate = ToEncoder(stream, stream.config.needed_bitrate);
  target.max_bitrate = ToEncoder(stream, stream.config.max_bitrate);
  target.rtt = static_cast<guint64>(std::max<std::int64_t>(s.s_rtt.count(), 0));
  target.queue_delay = static_cast<guint64>(std::max<std::int64_t>(s.qdelay.count(), 0));
  target.reason = reason != nullptr ? reason : scream::ToString(s.reason);
  return gst_lidar_event_new_target_bitrate(&target);
}

void Evaluate(GstLidarScreamTx* self, Time now) {
  TxState& state = *self->state;
  bool due = false;
  for (auto& stream : state.streams) EvaluateStream(state, *stream, now, &due);
  const DataRate total = state.controller->target_bitrate();
  if (state.notifier.ShouldNotify(now, total)) {
    const auto bps = static_cast<guint>(std::min(total.bits_per_second(), 4294967295.0));
    state.estimate_due = state.estimate_due || bps != state.estimated_bps;
    state.estimated_bps = bps;
    due = due || state.estimate_due;
  }
  state.ecn_state = state.controller->ecn_state();
  if (state.ecn_state != state.ecn_announced) state.ecn_due = due = true;
  if (state.settings.stats_interval > Duration{0} && now >= state.next_stats) {
    state.next_stats = now + state.settings.stats_interval;
    state.stats_due = due = true;
  }
  if (due) state.control.notify_one();
}

void StartControl(GstLidarScreamTx* self) {
  self->state->control_stop = false;
  self->state->control_thread = std::thread(Run, self);
}

void StopControl(GstLidarScreamTx* self) {
  TxState& state = *self->state;
  {
    TxLock lock(state.mutex);
    state.control_stop = true;
    state.control.notify_one();
  }
  if (state.control_thread.joinable()) state.control_thread.join();
}

}  // namespace lidar::gst

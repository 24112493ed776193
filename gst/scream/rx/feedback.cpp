// SPDX-License-Identifier: LGPL-2.1-or-later
// The task of screamrx that sends RFC 8888 reports on rtcp_src.
#include <gst/net/gstnetaddressmeta.h>

#include <algorithm>
#include <utility>

#include "gst/scream/rx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_rx_debug

namespace lidar::gst {
namespace {

constexpr Duration kIdle = std::chrono::seconds(1);

void StartStream(GstLidarScreamRx* self) {
  gchar* id = gst_pad_create_stream_id(self->rtcp_src, GST_ELEMENT(self), "feedback");
  gst_pad_push_event(self->rtcp_src, gst_event_new_stream_start(id));
  g_free(id);
  const CapsPtr caps(gst_caps_new_empty_simple("application/x-rtcp"));
  gst_pad_push_event(self->rtcp_src, gst_event_new_caps(caps.get()));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_pad_push_event(self->rtcp_src, gst_event_new_segment(&segment));
}

void Wait(RxState& state, RxLock& lock, Time now) {
  const Time until = std::min(state.generator.NextDue(), now + kIdle);
  if (until <= now) return;
  GstClockID id = gst_clock_new_single_shot_id(
      state.clock, static_cast<GstClockTime>(until.time_since_epoch().count()));
  state.timer = id;
  state.waits_until = until;
  lock.unlock();
  gst_clock_id_wait(id, nullptr);
  lock.lock();
  state.timer = nullptr;
  gst_clock_id_unref(id);
}

/// The report as a buffer that names the peer, for a sink that replies.
GstBuffer* ToBuffer(const RxState& state, const scream::CongestionFeedback& report) {
  const auto reading = state.settings.num_reports == kNumReportsEricsson
                           ? scream::NumReports::kCountMinusOne
                           : scream::NumReports::kCount;
  const auto bytes = scream::BuildCcfb(report, reading);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, bytes.size(), nullptr);
  gst_buffer_fill(buffer, 0, bytes.data(), bytes.size());
  if (state.latch.peer() != nullptr) gst_buffer_add_net_address_meta(buffer, state.latch.peer());
  return buffer;
}

void Run(gpointer data) {
  auto* self = GST_LIDAR_SCREAM_RX(data);
  RxState& state = *self->state;
  RxLock lock(state.mutex);
  if (!state.running) {
    lock.unlock();
    gst_pad_pause_task(self->rtcp_src);
    return;
  }
  if (state.settings_changed) {
    state.settings_changed = false;
    state.generator.set_config(ToConfig(state.settings, state.own_ssrc));
  }
  const Time now = RxNow(state);
  const auto report = state.generator.Take(now);
  if (!report) {
    Wait(state, lock, now);
    return;
  }
  GstBuffer* buffer = ToBuffer(state, *report);
  GST_LOG_OBJECT(self, "reporting %" G_GSIZE_FORMAT " SSRCs", report->blocks.size());
  const bool first = !std::exchange(state.rtcp_started, true);
  lock.unlock();
  if (first) StartStream(self);
  // Feedback that nobody takes does not stop the media.
  const GstFlowReturn flow = gst_pad_push(self->rtcp_src, buffer);
  if (flow == GST_FLOW_FLUSHING || flow == GST_FLOW_EOS) gst_pad_pause_task(self->rtcp_src);
}

}  // namespace

void WakeFeedback(RxState& state) {
  if (state.timer != nullptr && state.generator.NextDue() < state.waits_until)
    gst_clock_id_unschedule(state.timer);
}

gboolean RxActivateRtcp(GstPad* pad, GstObject* parent, GstPadMode mode, gboolean active) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  RxState& state = *self->state;
  if (mode != GST_PAD_MODE_PUSH) return FALSE;
  {
    RxLock lock(state.mutex);
    state.running = active != FALSE;
    state.rtcp_started = false;
    if (state.timer != nullptr) gst_clock_id_unschedule(state.timer);
  }
  if (!active) return gst_pad_stop_task(pad);
  return gst_pad_start_task(pad, Run, self, nullptr);
}

}  // namespace lidar::gst

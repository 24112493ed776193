// SPDX-License-Identifier: LGPL-2.1-or-later
// The task of screamrx that sends RFC 8888 reports on rtcp_src.
#include <gst/net/gstnetaddressmeta.h>

#include <algorithm>
#include <utility>

#include "gst/scream/key_request.h"
#include "gst/scream/rx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_rx_debug

namespace lidar::gst {
namespace {

constexpr Duration kIdleReports = std::chrono::seconds(1);

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
  const Time until = std::min(state.reports.NextDue(), now + kIdleReports);
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

/// Returns a buffer with the RTCP in `bytes`. If `to` is not NULL, attaches `to` as the address to
/// which an ecnudpsink with `reply` sends the buffer.
GstBuffer* ToBuffer(GSocketAddress* to, const std::vector<std::uint8_t>& bytes) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, bytes.size(), nullptr);
  gst_buffer_fill(buffer, 0, bytes.data(), bytes.size());
  if (to != nullptr) gst_buffer_add_net_address_meta(buffer, to);
  return buffer;
}

/// Returns the next packet to send, or null.
GstBuffer* NextPacket(GstLidarScreamRx* self, Time now) {
  RxState& state = *self->state;
  if (!state.key_requests.empty()) {
    const auto [ssrc, link] = *state.key_requests.begin();
    state.key_requests.erase(state.key_requests.begin());
    GST_DEBUG_OBJECT(self, "asking for a key unit of %08x", ssrc);
    GSocketAddress* to = link < state.latch.links() ? state.latch.link(link) : state.latch.peer();
    return ToBuffer(to, BuildKeyRequest(state.own_ssrc, ssrc));
  }
  const auto report = state.reports.Take(now);
  if (!report) return nullptr;
  GST_LOG_OBJECT(self, "reporting %" G_GSIZE_FORMAT " SSRCs", report->feedback.blocks.size());
  const auto reading = state.settings.num_reports == kNumReportsEricsson
                           ? rtcp::NumReports::kCountMinusOne
                           : rtcp::NumReports::kCount;
  return ToBuffer(report->to, rtcp::BuildCcfb(report->feedback, reading));
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
    state.reports.set_config(ToConfig(state.settings, state.own_ssrc));
  }
  const Time now = RxNow(state);
  GstBuffer* buffer = NextPacket(self, now);
  if (buffer == nullptr) {
    Wait(state, lock, now);
    return;
  }
  const bool first = !std::exchange(state.rtcp_started, true);
  lock.unlock();
  if (first) StartStream(self);
  // If the pad refuses a report, the report is lost. The task still continues, because the pad may
  // be linked to another sink.
  gst_pad_push(self->rtcp_src, buffer);
}

}  // namespace

void WakeFeedback(RxState& state) {
  if (state.timer != nullptr && state.reports.NextDue() < state.waits_until)
    gst_clock_id_unschedule(state.timer);
}

gboolean RxSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  if (GST_EVENT_TYPE(event) != GST_EVENT_CUSTOM_UPSTREAM ||
      !gst_event_has_name(event, "GstForceKeyUnit")) {
    return gst_pad_event_default(pad, parent, event);
  }
  const EventPtr owner(event);
  RxState& state = *GST_LIDAR_SCREAM_RX(parent)->state;
  const RxLock lock(state.mutex);
  // Requests key units of all SSRCs, because only the streaming thread may look up the SSRC of the
  // pad. Sends the request over each link, because a link that has an outage would lose the
  // request.
  for (const auto& [ssrc, last] : state.ssrcs)
    for (std::size_t i = 0; i < std::max<std::size_t>(state.latch.links(), 1); ++i)
      state.key_requests.emplace(ssrc, i);
  if (state.timer != nullptr) gst_clock_id_unschedule(state.timer);
  return state.ssrcs.empty() ? FALSE : TRUE;
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

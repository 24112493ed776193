// SPDX-License-Identifier: LGPL-2.1-or-later
// The input of screamtx on rtcp_sink: gives feedback to the controller, and passes RTCP on.
#include "gst/scream/tx/feedback.h"

#include "gst/common/buffer_map.h"
#include "gst/scream/key_request.h"
#include "gst/scream/tx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

namespace lidar::gst {
namespace {

const char* ToString(scream::FeedbackResult result) {
  switch (result) {
    case scream::FeedbackResult::kAccepted:
      return "accepted";
    case scream::FeedbackResult::kImplausible:
      return "implausible";
    case scream::FeedbackResult::kNotOurs:
      return "of other SSRCs";
    case scream::FeedbackResult::kStale:
      return "stale";
  }
  return "?";
}

/// Stores which packets have arrived, for the payloaders that want receipts. The caller holds the
/// lock.
void KeepReceipts(TxState& state, const rtcp::CongestionFeedback& report) {
  for (const rtcp::SsrcReport& block : report.blocks) {
    const auto id = state.controller->FindStream(block.ssrc);
    TxStream* stream = id ? FindStream(state, *id) : nullptr;
    if (stream != nullptr && stream->wants_receipts)
      stream->receipts.Add(report.sender_ssrc, block);
  }
}

/// Handles a receiver's request for a key unit of one of our streams. Does nothing if rtcp_src is
/// linked, because the element behind rtcp_src then sends the request upstream.
void TakeKeyRequest(GstLidarScreamTx* self, ByteView packet) {
  const auto ssrc = ParseKeyRequest(packet);
  if (!ssrc || gst_pad_is_linked(self->rtcp_src)) return;
  TxState& state = *self->state;
  const TxLock lock(state.mutex);
  if (!state.controller || !state.gate.open()) return;
  const auto id = state.controller->FindStream(*ssrc);
  TxStream* stream = id ? FindStream(state, *id) : nullptr;
  // The request is for LiDAR streams only. A video encoder gets the request from the element that
  // manages its RTP session.
  if (stream == nullptr || !stream->wants_receipts) return;
  stream->key_unit_due = true;
  state.reporter.Evaluate(TxNow(state));
}

/// Gives the report to the controller. If screamtx is one of several links, first converts the
/// report to the sequence numbers that its controller uses.
scream::FeedbackResult GiveToController(TxState& state, Time now,
                                        const rtcp::CongestionFeedback& report) {
  if (!state.link) return state.controller->OnFeedback(now, report);
  const auto own = state.link->OnFeedback(now, report);
  if (!own) {
    ++state.reports_of_others;
    return scream::FeedbackResult::kImplausible;
  }
  const auto result = state.controller->OnFeedback(now, *own);
  state.link->OnPath(state.controller->statistics(now));
  return result;
}

/// Handles a report. Returns false if the report is not about our packets. The caller holds the
/// lock.
bool Take(GstLidarScreamTx* self, const rtcp::CongestionFeedback& report, GSocketAddress* from) {
  TxState& state = *self->state;
  const Time now = TxNow(state);
  const auto result = GiveToController(state, now, report);
  if (result == scream::FeedbackResult::kNotOurs) return false;
  GST_LOG_OBJECT(self, "feedback: %s", ToString(result));
  if (result != scream::FeedbackResult::kImplausible) state.reporter.notices().watch().OnFeedback();
  if (result == scream::FeedbackResult::kAccepted && state.feedback_peer.OnFeedback(now, from)) {
    GST_INFO_OBJECT(self, "feedback comes from a new address: a new path");
    state.controller->OnRouteChange(now);
  }
  if (result == scream::FeedbackResult::kAccepted) state.pacing.OnAccepted(now);
  // Receipts are not kept for reports that come from TWCC; such reports name no receiver. Packets
  // in these reports have reached the RTP session of the receiver, but elements behind the session
  // may still drop them.
  if (result == scream::FeedbackResult::kAccepted && report.sender_ssrc != 0)
    KeepReceipts(state, report);
  state.reporter.Evaluate(now);
  state.pacing.Wake();
  return true;
}

/// Parses a CCFB packet and gives it to the controller. Returns false if the packet is malformed or
/// not about our packets.
bool Feed(GstLidarScreamTx* self, ByteView packet, GSocketAddress* from) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (!state.controller || !state.gate.open()) return true;
  const auto report = state.parser.Parse(packet);
  if (report) return Take(self, *report, from);
  ++state.malformed_rtcp;
  GST_DEBUG_OBJECT(self, "malformed feedback of %" G_GSIZE_FORMAT " bytes", packet.size);
  return false;
}

}  // namespace

void TxTakeReport(GstLidarScreamTx* tx, const rtcp::CongestionFeedback& report) {
  const TxLock lock(tx->state->mutex);
  if (tx->state->controller && tx->state->gate.open()) Take(tx, report, nullptr);
}

GstFlowReturn TxRtcpChain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_SCREAM_TX(parent);
  BufferPtr owner(buffer);
  std::vector<std::uint8_t> rest;
  {
    const BufferMap map(buffer, GST_MAP_READ);
    if (!map) return GST_FLOW_OK;
    const auto packets = rtcp::SplitRtcp(map.view());
    if (packets.empty()) rest.assign(map.view().begin(), map.view().end());
    for (const ByteView packet : packets) TakeKeyRequest(self, packet);
    for (const ByteView packet : packets)
      if (!rtcp::IsCcfb(packet) || !Feed(self, packet, SourceOf(buffer)))
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

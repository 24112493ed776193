// SPDX-License-Identifier: LGPL-2.1-or-later
// What enters screamtx on rtcp_sink: feedback for the controller, and RTCP that goes on.
#include "gst/common/buffer_map.h"
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

/// Hands one CCFB packet to the controller; false where it is not for us.
bool Feed(GstLidarScreamTx* self, ByteView packet, GSocketAddress* from) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (!state.controller || !state.gate.open()) return true;
  const auto feedback = state.parser.Parse(packet);
  if (!feedback) {
    ++state.malformed_rtcp;
    GST_DEBUG_OBJECT(self, "malformed feedback of %" G_GSIZE_FORMAT " bytes", packet.size);
    return false;
  }
  const Time now = TxNow(state);
  const auto result = state.controller->OnFeedback(now, *feedback);
  if (result == scream::FeedbackResult::kNotOurs) return false;
  GST_LOG_OBJECT(self, "feedback of %" G_GSIZE_FORMAT " bytes: %s", packet.size, ToString(result));
  if (result != scream::FeedbackResult::kImplausible) state.reporter.OnFeedback();
  if (result == scream::FeedbackResult::kAccepted && state.feedback_peer.OnFeedback(now, from)) {
    GST_INFO_OBJECT(self, "feedback comes from a new address: a new path");
    state.controller->OnRouteChange(now);
  }
  state.reporter.Evaluate(now);
  state.pacing.Wake();
  return true;
}

}  // namespace

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

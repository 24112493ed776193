// SPDX-License-Identifier: LGPL-2.1-or-later
// The statistics of screamtx as a GstStructure.
#include <algorithm>

#include "gst/scream/tx/private.h"

namespace lidar::gst {
namespace {

guint Bps(DataRate rate) {
  return static_cast<guint>(std::clamp(rate.bits_per_second(), 0.0, 4294967295.0));
}
guint64 Bytes(DataSize size) {
  return static_cast<guint64>(std::max<std::int64_t>(size.bytes(), 0));
}
guint64 Ns(Duration d) { return static_cast<guint64>(std::max<std::int64_t>(d.count(), 0)); }
guint64 U64(std::uint64_t v) { return v; }

GstStructure* StreamStats(TxState& state, const TxStream& stream, Time now) {
  const scream::StreamStatistics s = state.controller->stream_statistics(now, stream.id);
  gchar* name = gst_pad_get_name(stream.pad);
  GstStructure* out = gst_structure_new(
      "stream", "pad", G_TYPE_STRING, name, "ssrc", G_TYPE_UINT, stream.ssrc.value_or(0),
      "target-bitrate", G_TYPE_UINT, Bps(s.target_bitrate), "encoder-bitrate", G_TYPE_UINT,
      ToEncoder(stream, s.target_bitrate), "min-bitrate", G_TYPE_UINT,
      Bps(stream.config.needed_bitrate), "max-bitrate", G_TYPE_UINT, Bps(stream.config.max_bitrate),
      "sent-bitrate", G_TYPE_UINT, Bps(s.sent_bitrate), "queued-bytes", G_TYPE_UINT64,
      Bytes(s.queued), "sender-queue-delay", G_TYPE_UINT64, Ns(s.media_qdelay), "packets-queued",
      G_TYPE_UINT64, stream.packets_queued, "packets-sent", G_TYPE_UINT64, U64(s.packets_sent),
      "packets-dropped", G_TYPE_UINT64, U64(s.packets_dropped), "frames-dropped", G_TYPE_UINT64,
      stream.frames_dropped, "packets-lost", G_TYPE_UINT64, U64(s.packets_lost), "packets-ce",
      G_TYPE_UINT64, U64(s.packets_ce), "bytes-sent", G_TYPE_UINT64, Bytes(s.bytes_sent),
      "malformed", G_TYPE_UINT64, stream.malformed, nullptr);
  g_free(name);
  return out;
}

void AddCounters(GstStructure* out, const scream::Statistics& s) {
  gst_structure_set(
      out, "packets-sent", G_TYPE_UINT64, U64(s.packets_sent), "packets-acked", G_TYPE_UINT64,
      U64(s.packets_acked), "packets-lost", G_TYPE_UINT64, U64(s.packets_lost), "packets-late",
      G_TYPE_UINT64, U64(s.packets_late), "packets-ce", G_TYPE_UINT64, U64(s.packets_ce),
      "packets-dropped", G_TYPE_UINT64, U64(s.packets_dropped), "bytes-sent", G_TYPE_UINT64,
      Bytes(s.bytes_sent), "bytes-acked", G_TYPE_UINT64, Bytes(s.bytes_acked), "feedback-accepted",
      G_TYPE_UINT64, U64(s.feedback_accepted), "feedback-ignored", G_TYPE_UINT64,
      U64(s.feedback_ignored), "feedback-foreign-blocks", G_TYPE_UINT64, U64(s.foreign_blocks),
      "feedback-timeouts", G_TYPE_UINT64, U64(s.feedback_timeouts), "loss-events", G_TYPE_UINT64,
      U64(s.loss_events), "ce-events", G_TYPE_UINT64, U64(s.ce_events), "delay-events",
      G_TYPE_UINT64, U64(s.delay_events), "capacity-drops", G_TYPE_UINT64, U64(s.capacity_drops),
      "clock-resets", G_TYPE_UINT64, U64(s.clock_resets), nullptr);
}

}  // namespace

GstStructure* TxStats(TxState& state) {
  if (!state.controller) return gst_structure_new_empty("application/x-screamtx-stats");
  const Time now = TxNow(state);
  const scream::Statistics s = state.controller->statistics(now);
  GstStructure* out = gst_structure_new(
      "application/x-screamtx-stats", "target-bitrate", G_TYPE_UINT, Bps(s.target_bitrate),
      "sent-bitrate", G_TYPE_UINT, Bps(s.sent_bitrate), "acked-bitrate", G_TYPE_UINT,
      Bps(s.acked_bitrate), "pace-bitrate", G_TYPE_UINT, Bps(s.pace_bitrate), "queue-delay",
      G_TYPE_UINT64, Ns(s.qdelay), "queue-delay-avg", G_TYPE_UINT64, Ns(s.qdelay_avg),
      "queue-delay-target", G_TYPE_UINT64, Ns(s.qdelay_target), "rtt", G_TYPE_UINT64, Ns(s.s_rtt),
      "min-rtt", G_TYPE_UINT64, Ns(s.min_rtt), "ref-wnd", G_TYPE_UINT64, Bytes(s.ref_wnd),
      "bytes-in-flight", G_TYPE_UINT64, Bytes(s.bytes_in_flight), "l4s-alpha", G_TYPE_DOUBLE,
      s.l4s_alpha, "loss-rate", G_TYPE_DOUBLE, s.loss_rate, "queued-bytes", G_TYPE_UINT64,
      Bytes(s.queued), "sender-queue-delay", G_TYPE_UINT64, Ns(s.media_qdelay), "ecn-state",
      G_TYPE_STRING, scream::ToString(s.ecn_state), "reason", G_TYPE_STRING,
      scream::ToString(s.reason), "rtcp-malformed", G_TYPE_UINT64, state.malformed_rtcp, nullptr);
  AddCounters(out, s);
  guint64 frames_dropped = 0;
  GValue streams = G_VALUE_INIT;
  gst_value_array_init(&streams, static_cast<guint>(state.streams.size()));
  for (const auto& stream : state.streams) {
    frames_dropped += stream->frames_dropped;
    GValue value = G_VALUE_INIT;
    g_value_init(&value, GST_TYPE_STRUCTURE);
    g_value_take_boxed(&value, StreamStats(state, *stream, now));
    gst_value_array_append_and_take_value(&streams, &value);
  }
  gst_structure_set(out, "frames-dropped", G_TYPE_UINT64, frames_dropped, nullptr);
  gst_structure_take_value(out, "streams", &streams);
  return out;
}

}  // namespace lidar::gst

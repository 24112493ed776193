// SPDX-License-Identifier: LGPL-2.1-or-later
// The statistics of screamtx as a GstStructure.
#include "gst/common/stats.h"

#include "gst/scream/tx/private.h"

namespace lidar::gst {
namespace {

/// Statistics of a stream, from the controller and from screamtx.
struct ShownStream {
  scream::StreamStatistics core;
  scream::StreamConfig config;
  StreamCounters own;
  std::string pad;
  guint ssrc = 0;
  guint encoder_bps = 0;
};
template <auto field>
constexpr auto C = At<&ShownStream::core, field>;
template <auto field>
constexpr auto O = At<&ShownStream::own, field>;

StructurePtr StreamStats(TxState& state, const TxStream& stream, Time now) {
  using S = scream::StreamStatistics;
  using G = scream::StreamConfig;
  static const std::array<Stat<ShownStream>, 17> kStats = {{
      {"pad", &ShownStream::pad},
      {"ssrc", &ShownStream::ssrc},
      {"target-bitrate", C<&S::target_bitrate>},
      {"encoder-bitrate", &ShownStream::encoder_bps},
      {"min-bitrate", At<&ShownStream::config, &G::needed_bitrate>},
      {"max-bitrate", At<&ShownStream::config, &G::max_bitrate>},
      {"sent-bitrate", C<&S::sent_bitrate>},
      {"queued-bytes", C<&S::queued>},
      {"sender-queue-delay", C<&S::media_qdelay>},
      {"packets-queued", O<&StreamCounters::packets_queued>},
      {"packets-sent", C<&S::packets_sent>},
      {"packets-dropped", C<&S::packets_dropped>},
      {"frames-dropped", O<&StreamCounters::frames_dropped>},
      {"packets-lost", C<&S::packets_lost>},
      {"packets-ce", C<&S::packets_ce>},
      {"bytes-sent", C<&S::bytes_sent>},
      {"malformed", O<&StreamCounters::malformed>},
  }};
  const StringPtr name(gst_pad_get_name(stream.pad));
  ShownStream shown{state.controller->stream_statistics(now, stream.id),
                    stream.config,
                    stream.counters,
                    name.get(),
                    stream.ssrc.value_or(0),
                    0};
  shown.encoder_bps = ToEncoder(stream, shown.core.target_bitrate);
  return ToStructure("stream", kStats, shown);
}

StructurePtr ControllerStats(const scream::Statistics& statistics) {
  using S = scream::Statistics;
  static const std::array<Stat<S>, 37> kStats = {{
      {"target-bitrate", &S::target_bitrate},
      {"sent-bitrate", &S::sent_bitrate},
      {"acked-bitrate", &S::acked_bitrate},
      {"estimated-capacity", &S::estimated_capacity},
      {"pace-bitrate", &S::pace_bitrate},
      {"queue-delay", &S::qdelay},
      {"queue-delay-avg", &S::qdelay_avg},
      {"queue-delay-target", &S::qdelay_target},
      {"rtt", &S::s_rtt},
      {"min-rtt", &S::min_rtt},
      {"ref-wnd", &S::ref_wnd},
      {"bytes-in-flight", &S::bytes_in_flight},
      {"l4s-alpha", &S::l4s_alpha},
      {"loss-rate", &S::loss_rate},
      {"cross-traffic", &S::cross_traffic},
      {"queued-bytes", &S::queued},
      {"sender-queue-delay", &S::media_qdelay},
      {"ecn-state", +[](const S& s) { return scream::ToString(s.ecn_state); }},
      {"reason", +[](const S& s) { return scream::ToString(s.reason); }},
      {"packets-sent", &S::packets_sent},
      {"packets-acked", &S::packets_acked},
      {"packets-lost", &S::packets_lost},
      {"packets-late", &S::packets_late},
      {"packets-ce", &S::packets_ce},
      {"packets-dropped", &S::packets_dropped},
      {"bytes-sent", &S::bytes_sent},
      {"bytes-acked", &S::bytes_acked},
      {"feedback-accepted", &S::feedback_accepted},
      {"feedback-ignored", &S::feedback_ignored},
      {"feedback-foreign-blocks", &S::foreign_blocks},
      {"feedback-timeouts", &S::feedback_timeouts},
      {"loss-events", &S::loss_events},
      {"ce-events", &S::ce_events},
      {"delay-events", &S::delay_events},
      {"capacity-drops", &S::capacity_drops},
      {"gaps", &S::gaps},
      {"clock-resets", &S::clock_resets},
  }};
  return ToStructure("application/x-screamtx-stats", kStats, statistics);
}

}  // namespace

StructurePtr StatsOf(TxState& state) {
  if (!state.controller)
    return StructurePtr(gst_structure_new_empty("application/x-screamtx-stats"));
  const Time now = TxNow(state);
  scream::Statistics statistics = state.controller->statistics(now);
  statistics.feedback_ignored += state.reports_of_others;
  StructurePtr out = ControllerStats(statistics);
  GValue streams = G_VALUE_INIT;
  gst_value_array_init(&streams, static_cast<guint>(state.streams.size()));
  for (const auto& stream : state.streams) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, GST_TYPE_STRUCTURE);
    g_value_take_boxed(&value, StreamStats(state, *stream, now).release());
    gst_value_array_append_and_take_value(&streams, &value);
  }
  gst_structure_set(out.get(), "frames-dropped", G_TYPE_UINT64, state.frames_dropped,
                    "rtcp-malformed", G_TYPE_UINT64, state.malformed_rtcp, nullptr);
  gst_structure_take_value(out.get(), "streams", &streams);
  return out;
}

}  // namespace lidar::gst

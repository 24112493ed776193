// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/figures.h"

#include "gst/common/stats.h"

namespace lidar::gst {
namespace {

template <auto field>
constexpr auto Core = At<&ShownStream::core, field>;
template <auto field>
constexpr auto Own = At<&ShownStream::own, field>;

}  // namespace

StructurePtr ShowStream(const ShownStream& stream) {
  using S = scream::StreamStatistics;
  using G = scream::StreamConfig;
  static const std::array<Stat<ShownStream>, 17> kStats = {{
      {"pad", &ShownStream::pad},
      {"ssrc", &ShownStream::ssrc},
      {"target-bitrate", Core<&S::target_bitrate>},
      {"encoder-bitrate", &ShownStream::encoder_bps},
      {"min-bitrate", At<&ShownStream::config, &G::needed_bitrate>},
      {"max-bitrate", At<&ShownStream::config, &G::max_bitrate>},
      {"sent-bitrate", Core<&S::sent_bitrate>},
      {"queued-bytes", Core<&S::queued>},
      {"sender-queue-delay", Core<&S::media_qdelay>},
      {"packets-queued", Own<&StreamCounters::packets_queued>},
      {"packets-sent", Core<&S::packets_sent>},
      {"packets-dropped", Core<&S::packets_dropped>},
      {"frames-dropped", Own<&StreamCounters::frames_dropped>},
      {"packets-lost", Core<&S::packets_lost>},
      {"packets-ce", Core<&S::packets_ce>},
      {"bytes-sent", Core<&S::bytes_sent>},
      {"malformed", Own<&StreamCounters::malformed>},
  }};
  return ToStructure("stream", kStats, stream);
}

StructurePtr ShowController(const scream::Statistics& statistics) {
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

}  // namespace lidar::gst

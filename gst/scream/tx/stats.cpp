// SPDX-License-Identifier: LGPL-2.1-or-later
// The statistics of screamtx as a GstStructure.
#include "gst/scream/tx/private.h"

namespace lidar::gst {
namespace {

StructurePtr StreamStats(TxState& state, const TxStream& stream, Time now) {
  const StringPtr name(gst_pad_get_name(stream.pad));
  ShownStream shown{state.controller->stream_statistics(now, stream.id),
                    stream.config,
                    stream.counters,
                    name.get(),
                    stream.ssrc.value_or(0),
                    0};
  shown.encoder_bps = ToEncoder(stream, shown.core.target_bitrate);
  return ShowStream(shown);
}

}  // namespace

StructurePtr StatsOf(TxState& state) {
  if (!state.controller)
    return StructurePtr(gst_structure_new_empty("application/x-screamtx-stats"));
  const Time now = TxNow(state);
  scream::Statistics statistics = state.controller->statistics(now);
  statistics.feedback_ignored += state.reports_of_others;
  StructurePtr out = ShowController(statistics);
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

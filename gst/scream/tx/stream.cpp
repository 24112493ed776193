// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/stream.h"

#include <algorithm>

namespace lidar::gst {
namespace {

DataRate Bps(double v) { return DataRate::BitsPerSecond(v); }
guint Clamp(double bps) { return static_cast<guint>(std::clamp(bps, 0.0, 4294967295.0)); }

}  // namespace

Duration TxStream::HeadAge(Time now) const {
  for (const TxItem& item : queue)
    if (item.buffer) return now - item.queued;
  return Duration{0};
}

Time TimeOf(GstClock* clock) {
  return Time{Duration{static_cast<std::int64_t>(gst_clock_get_time(clock))}};
}

scream::StreamConfig MakeConfig(const TxStream& stream, const TxPadSettings& pad,
                                const TxSettings& element) {
  double min = pad.min_bps != 0 ? pad.min_bps : element.min_bps;
  double start = pad.start_bps != 0 ? pad.start_bps : element.start_bps;
  double max = pad.max_bps != 0 ? pad.max_bps : element.max_bps;
  double needed = 0;
  if (stream.bounds) {
    const double wire = 1 / stream.overhead.payload_share();
    needed = stream.bounds->min_bitrate * wire;
    if (stream.bounds->max_bitrate > 0) max = std::min(max, stream.bounds->max_bitrate * wire);
  }
  // The user's maximum limits the load on the network, so it takes precedence over what the encoder
  // needs.
  min = std::min(min, max);
  needed = std::clamp(needed, min, max);
  scream::StreamConfig config;
  config.priority = pad.priority;
  config.strict = pad.strict;
  config.min_bitrate = Bps(min);
  config.start_bitrate = Bps(std::clamp(start, needed, max));
  config.max_bitrate = Bps(max);
  // The needed bitrate is not a minimum. If the path cannot carry the needed bitrate, the encoder
  // gets a lower target and can leave out scans. A target above the path's capacity would only
  // lengthen the queue.
  config.needed_bitrate = Bps(needed);
  return config;
}

guint ToEncoder(const TxStream& stream, DataRate wire) {
  return Clamp(wire.bits_per_second() * stream.overhead.payload_share());
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of rtplidarpay that converts slices to lists of RTP buffers.
#pragma once
#include <gst/rtp/gstrtpbasepayload.h>

#include <mutex>
#include <optional>
#include <vector>

#include "gst/lidar/gstlidar.h"
#include "src/rtp/packetizer.h"
#include "src/rtp/stream_config.h"

namespace lidar::gst {

struct PaySettings {
  guint config_interval_s = 1;
  bool aggregate = false;
};

struct PayCounters {
  guint64 scans = 0;
  guint64 slices = 0;
  guint64 packets = 0;
  guint64 configs = 0;
  guint64 slice_bytes = 0;
  guint64 payload_bytes = 0;  // includes the headers of the payload format
  guint64 empty = 0;          // buffers without data, which are not sent
};

/// A slice to be sent, with its unit, meta and times.
struct PaySlice {
  rtp::Unit unit;
  GstLidarSlice meta{};
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
};

struct PayState {
  // Guards the members up to config_due. It is never held while pushing.
  std::mutex mutex;
  PaySettings settings;
  PayCounters counters;
  gdouble recent_slice_bytes = 0;
  gdouble recent_payload_bytes = 0;
  bool config_due = true;

  // The members below are used by the streaming thread only.
  std::optional<rtp::StreamConfig> config;
  std::vector<std::uint8_t> config_bytes;
  std::uint8_t config_id = 0;
  GstClockTime config_sent_at = GST_CLOCK_TIME_NONE;
  rtp::ScanCounter scans{g_random_int()};
  std::optional<std::uint32_t> last_scan;
  guint unnamed_scans = 0;  // scan id for the next buffer without meta
  rtp::Aggregator aggregator;
  PaySlice first_aggregated;
  std::optional<GstLidarBitrateBounds> bounds;  // the encoder's bounds, without headers
  gdouble bounds_share = 1;                     // SliceShare() when `bounds` was last sent
};

/// Returns the greatest payload size of an RTP packet [bytes].
std::size_t MaxPayload(GstRTPBasePayload* base);
/// Converts one encoded slice to packets and pushes them. Posts an error if the slice cannot be
/// sent.
GstFlowReturn PaySliceBuffer(GstRTPBasePayload* base, PayState& state, GstBuffer* buffer);
/// Pushes the slices that wait for aggregation.
GstFlowReturn PushAggregate(GstRTPBasePayload* base, PayState& state);
/// Returns the recent share of the encoder's bytes in the RTP payload. Before the first slice it is
/// an estimate.
gdouble SliceShare(GstRTPBasePayload* base, PayState& state);
/// Returns an event with the bounds of the encoder, increased by the share of the headers.
GstEvent* BoundsWithHeaders(GstRTPBasePayload* base, PayState& state);
/// Sends the bounds again if the share of the headers has changed by more than 2 %.
void UpdateBounds(GstRTPBasePayload* base, PayState& state);

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The streaming side of rtplidarpay: converts slices to lists of RTP buffers.
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
  guint64 payload_bytes = 0;  // with our headers
  guint64 empty = 0;          // buffers without a byte, not sent
};

/// A slice to send: its unit, meta and times.
struct PaySlice {
  rtp::Unit unit;
  GstLidarSlice meta{};
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  GstClockTime duration = GST_CLOCK_TIME_NONE;
};

struct PayState {
  std::mutex mutex;  // guards members up to config_due; never held while pushing
  PaySettings settings;
  PayCounters counters;
  gdouble recent_slice_bytes = 0;
  gdouble recent_payload_bytes = 0;
  bool config_due = true;

  // Only the streaming thread uses these.
  std::optional<rtp::StreamConfig> config;
  std::vector<std::uint8_t> config_bytes;
  std::uint8_t config_id = 0;
  GstClockTime config_sent_at = GST_CLOCK_TIME_NONE;
  rtp::ScanCounter scans{g_random_int()};
  std::optional<std::uint32_t> last_scan;
  guint unnamed_scans = 0;  // next scan id of a buffer without a meta
  rtp::Aggregator aggregator;
  PaySlice first_aggregated;
  std::optional<GstLidarBitrateBounds> bounds;  // the encoder's, without our headers
  gdouble bounds_share = 1;                     // share at the last scaling
};

/// Room for payload in one RTP packet [bytes].
std::size_t MaxPayload(GstRTPBasePayload* base);
/// Payloads and pushes one encoded slice; posts an error if it cannot be sent.
GstFlowReturn PaySliceBuffer(GstRTPBasePayload* base, PayState& state, GstBuffer* buffer);
/// Pushes the slices that wait for aggregation.
GstFlowReturn PushAggregate(GstRTPBasePayload* base, PayState& state);
/// Recent share of the encoder's bytes in the RTP payload; a guess before the first slice.
gdouble SliceShare(GstRTPBasePayload* base, PayState& state);
/// Returns the encoder's bounds plus our headers.
GstEvent* BoundsWithHeaders(GstRTPBasePayload* base, PayState& state);
/// Sends the bounds again if the headers' share has changed by more than 2 %.
void UpdateBounds(GstRTPBasePayload* base, PayState& state);

}  // namespace lidar::gst

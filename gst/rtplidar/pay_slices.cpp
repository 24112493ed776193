// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/rtplidar/pay_slices.h"

#include <gst/rtp/gstrtpbuffer.h>

#include <cmath>
#include <cstring>

#include "gst/common/buffer_map.h"
#include "gst/common/refs.h"
#include "src/rtp/ntp_time.h"

namespace lidar::gst {
namespace {

constexpr guint kClockRate = 90'000;
// The sums of bytes are multiplied by this for each slice, so they cover about the last second.
constexpr gdouble kShareMemory = 0.98;

/// Returns an RTP buffer with `packet`. The body is not copied, but refers to memory of
/// `slice_buffer`.
GstBuffer* MakeBuffer(GstRTPBasePayload* base, const rtp::Packet& packet, GstBuffer* slice_buffer) {
  GstBuffer* out = gst_rtp_base_payload_allocate_output_buffer(
      base, static_cast<guint>(packet.header.size()), 0, 0);
  GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
  gst_rtp_buffer_map(out, GST_MAP_WRITE, &rtp);
  memcpy(gst_rtp_buffer_get_payload(&rtp), packet.header.data(), packet.header.size());
  gst_rtp_buffer_set_marker(&rtp, packet.marker);
  gst_rtp_buffer_unmap(&rtp);
  if (packet.marker) GST_BUFFER_FLAG_SET(out, GST_BUFFER_FLAG_MARKER);
  if (packet.body_size > 0) {
    out = gst_buffer_append(out, gst_buffer_copy_region(slice_buffer, GST_BUFFER_COPY_MEMORY,
                                                        packet.body_offset, packet.body_size));
  }
  return out;
}

/// Converts `packets` to buffers and appends them to `list`. Each buffer has the meta of its slice,
/// so that an element downstream can drop whole scans.
void Append(GstRTPBasePayload* base, PayState& state, const std::vector<rtp::Packet>& packets,
            const PaySlice& slice, GstBuffer* body, GstBufferList* list) {
  for (const auto& packet : packets) {
    GstBuffer* out = MakeBuffer(base, packet, body);
    GST_BUFFER_PTS(out) = slice.pts;
    GST_BUFFER_DURATION(out) = slice.duration;
    gst_lidar_buffer_set_slice(out, &slice.meta);
    gst_buffer_list_add(list, out);
    std::lock_guard lock(state.mutex);
    ++state.counters.packets;
    const auto bytes = packet.header.size() + packet.body_size;
    state.counters.payload_bytes += bytes;
    state.recent_payload_bytes += static_cast<gdouble>(bytes);
  }
}

bool ConfigIsDue(PayState& state, GstClockTime pts) {
  std::lock_guard lock(state.mutex);
  const GstClockTime interval = state.settings.config_interval_s * GST_SECOND;
  const GstClockTime last = state.config_sent_at;
  const bool repeat =
      interval > 0 && (!GST_CLOCK_TIME_IS_VALID(pts) || !GST_CLOCK_TIME_IS_VALID(last) ||
                       pts < last || pts - last >= interval);
  if (!state.config_due && !repeat) return false;
  state.config_due = false;
  state.config_sent_at = pts;
  ++state.counters.configs;
  return true;
}

void AppendConfig(GstRTPBasePayload* base, PayState& state, const PaySlice& slice,
                  GstBufferList* list) {
  rtp::Unit unit;
  unit.unit = rtp::UnitType::kStreamConfig;
  unit.config_id = state.config_id;
  const ByteView bytes{state.config_bytes.data(), state.config_bytes.size()};
  const BufferPtr body(gst_buffer_new_memdup(bytes.data, bytes.size));
  Append(base, state, rtp::Packetize(unit, bytes, MaxPayload(base)), slice, body.get(), list);
}

GstFlowReturn PushList(GstRTPBasePayload* base, BufferListPtr list) {
  if (gst_buffer_list_length(list.get()) == 0) return GST_FLOW_OK;
  return gst_rtp_base_payload_push_list(base, list.release());
}

/// Describes the slice in `buffer`. If the slice meta is out of range, posts an error and returns
/// nothing.
std::optional<PaySlice> DescribeSlice(GstRTPBasePayload* base, PayState& state, GstBuffer* buffer) {
  PaySlice slice;
  if (!gst_lidar_buffer_get_slice(buffer, &slice.meta)) slice.meta.scan_id = state.unnamed_scans++;
  if (slice.meta.slice_count > rtp::kMaxSlicesPerScan ||
      slice.meta.slice_index >= slice.meta.slice_count || slice.meta.first_column > G_MAXUINT16) {
    GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                      ("The LidarSliceMeta of a buffer is out of range: slice %u of %u, column %u.",
                       slice.meta.slice_index, slice.meta.slice_count, slice.meta.first_column),
                      ("a scan may have at most %u slices", rtp::kMaxSlicesPerScan));
    return std::nullopt;
  }
  slice.pts = GST_BUFFER_PTS(buffer);
  slice.duration = GST_BUFFER_DURATION(buffer);
  slice.unit.config_id = state.config_id;
  slice.unit.slice.index = static_cast<std::uint16_t>(slice.meta.slice_index);
  slice.unit.slice.count = static_cast<std::uint16_t>(slice.meta.slice_count);
  slice.unit.info.scan_id = slice.meta.scan_id;
  state.scans.Place(&slice.unit);
  slice.unit.info.first_column = static_cast<std::uint16_t>(slice.meta.first_column);
  if (slice.duration < rtp::SliceInfo::kUnknownDuration)
    slice.unit.info.duration_ns = static_cast<std::uint32_t>(slice.duration);
  const GstClockTime capture = gst_lidar_buffer_get_capture_time(buffer);
  if (GST_CLOCK_TIME_IS_VALID(capture)) slice.unit.info.capture_ntp = rtp::ToNtp(capture);
  return slice;
}

void CountSlice(PayState& state, const PaySlice& slice, gsize size) {
  std::lock_guard lock(state.mutex);
  ++state.counters.slices;
  if (state.last_scan != slice.unit.slice.scan_number) ++state.counters.scans;
  state.last_scan = slice.unit.slice.scan_number;
  state.counters.slice_bytes += size;
  state.recent_slice_bytes = state.recent_slice_bytes * kShareMemory + static_cast<gdouble>(size);
  state.recent_payload_bytes *= kShareMemory;
}

/// Returns true if the slice belongs to the same scan as the slices already in the aggregate. A
/// receiver accepts only aggregates of a single scan.
bool IsOfAggregate(const PayState& state, const rtp::SliceId& slice) {
  const rtp::SliceId& first = state.first_aggregated.unit.slice;
  return state.aggregator.empty() ||
         (slice.scan_number == first.scan_number && slice.count == first.count);
}

/// Adds the slice to the aggregate, and pushes the aggregate when it is complete. Returns false if
/// the slice must be sent in packets of its own.
bool Aggregate(GstRTPBasePayload* base, PayState& state, const PaySlice& slice, ByteView bytes,
               GstFlowReturn* flow) {
  const auto ticks = GST_CLOCK_TIME_IS_VALID(slice.pts)
                         ? gst_util_uint64_scale(slice.pts, kClockRate, GST_SECOND)
                         : 0;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const bool starts = state.aggregator.empty();
    if (IsOfAggregate(state, slice.unit.slice) &&
        state.aggregator.Add(slice.unit, bytes, MaxPayload(base), ticks)) {
      if (starts) state.first_aggregated = slice;
      const GstClockTime held = slice.pts + slice.duration - state.first_aggregated.pts;
      const bool scan_ends = slice.unit.slice.index + 1 == slice.unit.slice.count;
      if (scan_ends || gst_rtp_base_payload_is_filled(base, 0, held))
        *flow = PushAggregate(base, state);
      return true;
    }
    *flow = PushAggregate(base, state);
    if (*flow != GST_FLOW_OK) return true;
  }
  return false;
}

bool MtuSuffices(GstRTPBasePayload* base) {
  if (MaxPayload(base) >= rtp::kMinPayload) return true;
  GST_ELEMENT_ERROR(base, RESOURCE, SETTINGS,
                    ("mtu is too small; set it to %u or more.",
                     gst_rtp_buffer_calc_packet_len(rtp::kMinPayload, 0, 0)),
                    (nullptr));
  return false;
}

}  // namespace

std::size_t MaxPayload(GstRTPBasePayload* base) {
  return gst_rtp_buffer_calc_payload_len(GST_RTP_BASE_PAYLOAD_MTU(base), 0, 0);
}

GstFlowReturn PushAggregate(GstRTPBasePayload* base, PayState& state) {
  const auto packet = state.aggregator.Take();
  if (!packet) return GST_FLOW_OK;
  BufferListPtr list(gst_buffer_list_new());
  if (ConfigIsDue(state, state.first_aggregated.pts))
    AppendConfig(base, state, state.first_aggregated, list.get());
  Append(base, state, {*packet}, state.first_aggregated, nullptr, list.get());
  return PushList(base, std::move(list));
}

GstFlowReturn PaySliceBuffer(GstRTPBasePayload* base, PayState& state, GstBuffer* buffer) {
  const BufferMap map(buffer, GST_MAP_READ);
  if (!map || map.size() > rtp::kMaxUnitBytes) {
    GST_ELEMENT_ERROR(base, STREAM, FORMAT,
                      ("A slice of %" G_GSIZE_FORMAT " bytes cannot be sent.", map.size()),
                      ("a slice may have at most %" G_GSIZE_FORMAT " bytes", rtp::kMaxUnitBytes));
    return GST_FLOW_ERROR;
  }
  if (map.size() == 0) {
    std::lock_guard lock(state.mutex);
    ++state.counters.empty;
    return GST_FLOW_OK;
  }
  if (!MtuSuffices(base)) return GST_FLOW_ERROR;
  const auto slice = DescribeSlice(base, state, buffer);
  if (!slice) return GST_FLOW_ERROR;
  CountSlice(state, *slice, map.size());
  bool aggregate = false;
  {
    std::lock_guard lock(state.mutex);
    aggregate = state.settings.aggregate;
  }
  GstFlowReturn flow = GST_FLOW_OK;
  if (aggregate && Aggregate(base, state, *slice, map.view(), &flow)) return flow;
  flow = PushAggregate(base, state);  // slices may be left from before `aggregate` was disabled
  if (flow != GST_FLOW_OK) return flow;
  BufferListPtr list(gst_buffer_list_new());
  if (ConfigIsDue(state, slice->pts)) AppendConfig(base, state, *slice, list.get());
  Append(base, state, rtp::Packetize(slice->unit, map.view(), MaxPayload(base)), *slice, buffer,
         list.get());
  return PushList(base, std::move(list));
}

gdouble SliceShare(GstRTPBasePayload* base, PayState& state) {
  std::lock_guard lock(state.mutex);
  if (state.recent_slice_bytes > 0 && state.recent_payload_bytes > 0)
    return MIN(1.0, state.recent_slice_bytes / state.recent_payload_bytes);
  const auto payload = static_cast<gdouble>(MaxPayload(base));
  const auto header = static_cast<gdouble>(
      rtp::HeaderSize(rtp::PacketType::kMiddleFragment, rtp::UnitType::kSlice));
  return MAX(0.5, 1 - header / payload);
}

GstEvent* BoundsWithHeaders(GstRTPBasePayload* base, PayState& state) {
  state.bounds_share = SliceShare(base, state);
  const auto scaled = [&](guint bps) {
    return static_cast<guint>(MIN(bps / state.bounds_share, gdouble{G_MAXUINT}));
  };
  const GstLidarBitrateBounds bounds{scaled(state.bounds->min_bitrate),
                                     scaled(state.bounds->max_bitrate),
                                     scaled(state.bounds->nominal_bitrate)};
  return gst_lidar_event_new_bitrate_bounds(&bounds);
}

void UpdateBounds(GstRTPBasePayload* base, PayState& state) {
  constexpr gdouble kMoved = 0.02;
  if (!state.bounds || std::abs(SliceShare(base, state) / state.bounds_share - 1) <= kMoved) return;
  gst_pad_push_event(GST_RTP_BASE_PAYLOAD_SRCPAD(base), BoundsWithHeaders(base, state));
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions that make encoded slices without an encoder and parse RTP buffers, and a depayloader
// for the packets.
#pragma once
#include <gst/check/gstharness.h>
#include <gst/rtp/gstrtpbuffer.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/cloud/sensor_model.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"

namespace lidar::test {

constexpr guint64 kCaptureStart = guint64{1'764'000'000} * 1'000'000'000;
constexpr guint kSlices = 4;

inline std::string EncodedCaps(const char* geometry = "range", int framerate = 10,
                               const char* media_type = GST_LIDAR_DRACO_MEDIA_TYPE) {
  SensorModel model;
  model.columns_per_scan = 512;
  model.beams = {{1, 10, 0}, {-1, -10, 4}};
  gst::CapsPtr caps(gst_caps_new_simple(media_type, "geometry", G_TYPE_STRING, geometry,
                                        "alignment", G_TYPE_STRING, "slice", "fields",
                                        G_TYPE_STRING, "x:F32:0,y:F32:4,z:F32:8,range:U32:12",
                                        "framerate", GST_TYPE_FRACTION, framerate, 1, nullptr));
  const gst::BufferPtr bytes(gst::SensorModelToBuffer(model));
  gst_caps_set_simple(caps.get(), "sensor-model", GST_TYPE_BUFFER, bytes.get(), nullptr);
  const gst::StringPtr text(gst_caps_to_string(caps.get()));
  return text.get();
}

/// Returns slice `index` of scan `scan`, in the form in which an encoder outputs it.
inline GstBuffer* EncodedSlice(guint scan, guint index, gsize size = 3'000) {
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
  gst_buffer_memset(buffer, 0, static_cast<guint8>(scan * 16 + index), size);
  const auto at = static_cast<GstClockTime>((scan * 100 + index * 25) * GST_MSECOND);
  GST_BUFFER_PTS(buffer) = at;
  GST_BUFFER_DURATION(buffer) = 25 * GST_MSECOND;
  const GstLidarSlice meta{scan, index, kSlices, index * 128};
  gst_lidar_buffer_set_slice(buffer, &meta);
  gst_lidar_buffer_set_capture_time(buffer, kCaptureStart + at + 123);
  return buffer;
}

struct Rtp {
  explicit Rtp(GstBuffer* b) : buffer(b) {
    GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
    gst_rtp_buffer_map(b, GST_MAP_READ, &rtp);
    marker = gst_rtp_buffer_get_marker(&rtp) != FALSE;
    sequence = gst_rtp_buffer_get_seq(&rtp);
    timestamp = gst_rtp_buffer_get_timestamp(&rtp);
    const auto* data = static_cast<const guint8*>(gst_rtp_buffer_get_payload(&rtp));
    payload.assign(data, data + gst_rtp_buffer_get_payload_len(&rtp));
    gst_rtp_buffer_unmap(&rtp);
  }
  gst::BufferPtr buffer;
  bool marker = false;
  guint16 sequence = 0;
  guint32 timestamp = 0;
  std::vector<guint8> payload;
  /// Returns true if the first byte of the payload has the packet type and unit type of a config.
  bool IsConfig() const { return (payload.at(0) & 31) == 0 && payload.at(0) >> 5 != 1; }
};

inline std::vector<Rtp> PullAll(GstHarness* h) {
  std::vector<Rtp> packets;
  while (GstBuffer* b = gst_harness_try_pull(h)) packets.emplace_back(b);
  return packets;
}

inline guint64 Stat(GstHarness* h, const char* name) { return StatOf(h->element, name); }

inline constexpr const char* kRtpCaps =
    "application/x-rtp,media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO,payload=96";

/// Returns the RTP packets of `scans` scans.
inline std::vector<gst::BufferPtr> Packets(guint scans, gsize size = 3'000,
                                           bool aggregate = false) {
  Harness h(gst_harness_new("rtplidarpay"));
  g_object_set(h->element, "aggregate", aggregate, nullptr);
  gst_harness_set_src_caps_str(h.get(), EncodedCaps().c_str());
  for (guint s = 0; s < scans; ++s)
    for (guint i = 0; i < kSlices; ++i) gst_harness_push(h.get(), EncodedSlice(s, i, size));
  std::vector<gst::BufferPtr> packets;
  while (GstBuffer* b = gst_harness_try_pull(h.get())) packets.emplace_back(b);
  return packets;
}

inline Harness Depay() {
  Harness h(gst_harness_new("rtplidardepay"));
  gst_harness_set_src_caps_str(h.get(), kRtpCaps);
  return h;
}

inline void Push(GstHarness* h, const std::vector<gst::BufferPtr>& packets) {
  for (const auto& p : packets)
    ASSERT_EQ(gst_harness_push(h, gst_buffer_copy_deep(p.get())), GST_FLOW_OK);
}

inline std::vector<gst::BufferPtr> Pull(GstHarness* h) {
  std::vector<gst::BufferPtr> out;
  while (GstBuffer* b = gst_harness_try_pull(h)) out.emplace_back(b);
  return out;
}

/// Returns `packets` with their payload type changed to `type`.
inline std::vector<gst::BufferPtr> WithType(std::vector<gst::BufferPtr> packets, guint8 type) {
  for (auto& packet : packets) {
    GstRTPBuffer rtp = GST_RTP_BUFFER_INIT;
    packet.reset(gst_buffer_make_writable(packet.release()));
    gst_rtp_buffer_map(packet.get(), GST_MAP_READWRITE, &rtp);
    gst_rtp_buffer_set_payload_type(&rtp, type);
    gst_rtp_buffer_unmap(&rtp);
  }
  return packets;
}

}  // namespace lidar::test

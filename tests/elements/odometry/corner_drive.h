// SPDX-License-Identifier: LGPL-2.1-or-later
// Scans of a drive along a corner of walls, a scan of a far wall that matches none of them, and
// samples of an IMU at rest.
#pragma once
#include <array>
#include <vector>

#include "gst/common/imu_caps.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/byte_writer.h"
#include "src/cdr/motion_samples.h"
#include "tests/support/harness.h"

namespace lidar::test {

inline constexpr const char* kCornerCaps =
    "application/x-pointcloud2,width=0,height=1,point-step=16,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,t:F32:12\",framerate=10/1";
inline constexpr GstClockTime kCornerPeriod = 100 * GST_MSECOND;

/// Returns a scan of a corner of three walls, which are 2 to 19 m away. The sensor moves along x at
/// 10 m/s and measures one wall after the other.
inline gst::BufferPtr CornerFrom(double metres) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (unsigned wall = 0; wall < 3; ++wall)
    for (int a = -10; a < 10; ++a)
      for (int b = -10; b < 10; ++b) {
        const double t = 0.1 * (20 * (a + 10) + b + 10 + 400.0 * wall) / 1200;
        const double u = a * 0.7;
        const double v = b * 0.7;
        const double here = metres + 10 * t;
        const std::array<double, 3> p = wall == 0   ? std::array{u - here, v, -2.0}
                                        : wall == 1 ? std::array{u - here, 10.0, v}
                                                    : std::array{12 - here, u, v};
        for (const double value : {p[0], p[1], p[2], t}) w.LeF32(static_cast<float>(value));
      }
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

inline gst::BufferPtr ScanAt(gst::BufferPtr buffer, GstClockTime time) {
  GST_BUFFER_PTS(buffer.get()) = time;
  GST_BUFFER_DURATION(buffer.get()) = kCornerPeriod;
  gst_lidar_buffer_set_capture_time(buffer.get(), GST_SECOND + time);
  return buffer;
}

inline gst::BufferPtr SliceOf(gst::BufferPtr buffer, const GstLidarSlice& slice) {
  gst_lidar_buffer_set_slice(buffer.get(), &slice);
  return buffer;
}

/// Returns a scan of a wall 80 m ahead. Such a scan does not show any motion to the side.
inline gst::BufferPtr FarWall() {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (int a = -10; a < 10; ++a)
    for (int b = -10; b < 10; ++b)
      for (const int value : {80, a, b, 0}) w.LeF32(static_cast<float>(value));
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

/// Begins a stream of IMU samples on `pad`. The IMU has the same axes as the sensor.
inline void BeginImu(GstPad* pad) {
  gst_pad_send_event(pad, gst_event_new_stream_start("imu"));
  gst_pad_send_event(
      pad,
      gst_event_new_caps(gst::ImuCaps({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).get()));
  gst_pad_send_event(pad, NewSegment());
}

/// Returns ten samples of an IMU at rest. They are 10 ms apart and begin at `from`.
inline gst::BufferPtr StillnessAt(GstClockTime from) {
  std::vector<std::uint8_t> bytes;
  for (unsigned i = 0; i < 10; ++i) {
    cdr::Imu imu;
    imu.header.stamp =
        Time{} + Duration{static_cast<std::int64_t>(GST_SECOND + from + i * 10 * GST_MSECOND)};
    const auto sample = cdr::WriteImuSample(imu);
    bytes.insert(bytes.end(), sample.begin(), sample.end());
  }
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

}  // namespace lidar::test

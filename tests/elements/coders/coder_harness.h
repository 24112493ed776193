// SPDX-License-Identifier: LGPL-2.1-or-later
// The coders with their names, and functions that make buffers and caps for their tests.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "tests/core/codec/test_clouds.h"
#include "tests/elements/coders/example_coder.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"

namespace lidar::gst {

using test::Harness;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// An encoder, with properties if needed, and its decoder.
struct CoderCase {
  const char* name;
  const char* encoder;
  const char* decoder;
  bool xyz = false;  // true: codes coordinates, not ranges
};
inline void PrintTo(const CoderCase& c, std::ostream* out) { *out << c.name; }

// The efforts are fixed. With effort=auto, the sizes of slices would depend on the load of the
// machine.
constexpr CoderCase kLidar{"lidar", "lidarenc effort=1", "lidardec"};
constexpr CoderCase kLidarXyz{"lidar_xyz", "lidarenc effort=0 geometry=xyz", "lidardec", true};
constexpr CoderCase kDraco{"draco", "dracoenc", "dracodec"};
constexpr CoderCase kDracoXyz{"draco_xyz", "dracoenc geometry=xyz", "dracodec", true};

constexpr CoderCase kExample{"example", "exampleenc", "exampledec", true};

/// Returns the coders that code organised scans by the ranges of their points.
inline std::vector<CoderCase> RangeCoders() {
#ifdef HAVE_DRACO
  return {kLidar, kDraco};
#else
  return {kLidar};
#endif
}
/// Returns the coders that this project installs.
inline std::vector<CoderCase> OurCoders() {
  std::vector<CoderCase> coders = RangeCoders();
  coders.push_back(kLidarXyz);
#ifdef HAVE_DRACO
  coders.push_back(kDracoXyz);
#endif
  return coders;
}
inline std::vector<CoderCase> AllCoders() {
  std::vector<CoderCase> coders = OurCoders();
  coders.push_back(kExample);
  return coders;
}

inline Harness Launch(const std::string& description) {
  static const gboolean registered = example_coder_register(nullptr);
  EXPECT_TRUE(registered);
  return Harness(gst_harness_new_parse(description.c_str()));
}

inline std::vector<float> PointsOf(GstBuffer* buffer, gsize step) {
  const BufferMap map(buffer, GST_MAP_READ);
  std::vector<float> points;
  for (gsize at = 0; at + step <= map.size(); at += step) {
    float p[3];
    std::memcpy(p, map.data() + at, sizeof p);
    points.insert(points.end(), p, p + 3);
  }
  return points;
}

using test::StatsOf;

inline CloudInfo OrganisedInfo(const SensorModel& model, guint columns) {
  CloudInfo info;
  info.width = columns;
  info.height = static_cast<guint>(model.beams.size());
  info.point_step = 20;
  info.fields = test::OrganisedLayout().fields;
  info.framerate_n = 10;
  info.sensor_model = model;
  return info;
}

/// Returns the points of `columns` columns of a room. The room is the same in each scan, so the
/// points are computed once and cached.
inline const std::vector<std::uint8_t>& RoomPoints(const SensorModel& model, guint first_column,
                                                   guint columns) {
  using Part = std::tuple<std::vector<std::uint8_t>, guint, guint>;
  static std::map<Part, std::vector<std::uint8_t>> parts;
  std::vector<std::uint8_t>& points = parts[{model.Serialise(), first_column, columns}];
  if (points.empty()) points = test::RawCloud(model, test::RoomScan(model, first_column, columns));
  return points;
}

inline GstBuffer* OrganisedBuffer(const SensorModel& model, guint columns,
                                  const GstLidarSlice& slice) {
  const auto& raw = RoomPoints(model, slice.first_column, columns);
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size());
  gst_lidar_buffer_set_slice(buffer, &slice);
  const GstClockTime time = (slice.scan_id * 8 + slice.slice_index) * 12'500 * GST_USECOND;
  gst_lidar_buffer_set_capture_time(buffer, 1'700'000'000 * GST_SECOND + time);
  GST_BUFFER_PTS(buffer) = time;
  GST_BUFFER_DURATION(buffer) = 12'500 * GST_USECOND;
  return buffer;
}

inline Harness Encoder(const CoderCase& coder, const std::string& properties = "") {
  return Launch(std::string(coder.encoder) + " name=enc " + properties);
}

inline Harness Codec(const CoderCase& coder, const std::string& properties = "") {
  return Launch(std::string(coder.encoder) + " name=enc " + properties + " ! " + coder.decoder +
                " name=dec");
}

inline void SetCaps(GstHarness* h, const CloudInfo& info) {
  const CapsPtr caps(info.ToCaps());
  gst_harness_set_src_caps(h, gst_caps_ref(caps.get()));
}

/// Tests that must pass with every coder that codes ranges.
class EitherCoder : public ::testing::TestWithParam<CoderCase> {};
/// Tests that must pass with every coder.
class AnyCoder : public ::testing::TestWithParam<CoderCase> {};

inline double LargestDistance(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = static_cast<double>(a[i + k]) - static_cast<double>(b[i + k]);
      sum += d * d;
    }
    largest = std::max(largest, std::sqrt(sum));
  }
  return largest;
}

}  // namespace lidar::gst

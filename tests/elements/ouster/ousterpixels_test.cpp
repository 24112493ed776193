// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of a sensor whose metadata has angles for every pixel. The points follow these angles.
// Clouds have no sensor model, so the encoder uses xyz geometry.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "src/ouster/metadata_writer.h"
#include "tests/elements/ouster/ouster_support.h"

namespace lidar::test {
namespace {

using gst::BufferMap;
using gst::BufferPtr;
using gst::CapsPtr;
using gst::CloudInfo;

const char* const kPcap = "OS-1-128_v2.3.0_1024x10_lb_n3.pcap";

/// A fixture with the sensor of kPcap. Its metadata has pixel angles for a view of 120 by 50
/// degrees.
class OusterPixels : public ::testing::Test {
 protected:
  OusterPixels() {
    metadata_.model.beam_to_lidar_z_m = 0.02;
    for (std::uint32_t beam = 0; beam < 128; ++beam) {
      for (std::uint32_t column = 0; column < 1024; ++column) {
        metadata_.pixel_angles.azimuth_deg.push_back(60.0F -
                                                     static_cast<float>(column) * 0.1171875F);
        metadata_.pixel_angles.altitude_deg.push_back(25.0F - static_cast<float>(beam) * 0.390625F);
      }
    }
    std::ofstream(json_) << ouster::WriteMetadata(metadata_);
  }
  ~OusterPixels() override { std::remove(json_.c_str()); }
  Harness Play(const std::string& more) {
    Harness h(gst_harness_new_parse(
        ("ouster_src slices-per-scan=1 location=" + DataPath(kPcap) + " metadata=" + json_ + more)
            .c_str()));
    SetPlaying(h.get());
    return h;
  }

  ouster::Metadata metadata_ = LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  const std::string json_ = ::testing::TempDir() + "ouster_pixels.json";
};

std::array<float, 3> At(const BufferMap& map, std::size_t point, std::size_t step) {
  std::array<float, 3> xyz{};
  std::memcpy(xyz.data(), map.data() + point * step, sizeof xyz);
  return xyz;
}

TEST_F(OusterPixels, PointsFollowTheAnglesOfTheirPixels) {
  const Harness h = Play("");
  const BufferPtr buffer(gst_harness_pull(h.get()));
  ASSERT_TRUE(buffer);
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(caps.get());
  ASSERT_TRUE(info);
  EXPECT_FALSE(info->sensor_model);
  const BufferMap map(buffer.get(), GST_MAP_READ);
  const double origin =
      std::hypot(metadata_.model.beam_to_lidar_x_m, metadata_.model.beam_to_lidar_z_m);
  const auto& t = metadata_.model.lidar_to_sensor;
  std::size_t returns = 0;
  for (std::size_t i = 0; i < info->Points(); ++i) {
    std::uint32_t range = 0;
    std::memcpy(&range, map.data() + i * info->point_step + 16, sizeof range);
    if (range == 0) continue;
    ++returns;
    const double azimuth = static_cast<double>(metadata_.pixel_angles.azimuth_deg[i]) * M_PI / 180;
    const double altitude =
        static_cast<double>(metadata_.pixel_angles.altitude_deg[i]) * M_PI / 180;
    const double r = range * 1e-3 - origin;
    const std::array<double, 3> lidar = {
        r * std::cos(azimuth) * std::cos(altitude) + metadata_.model.beam_to_lidar_x_m,
        r * std::sin(azimuth) * std::cos(altitude),
        r * std::sin(altitude) + metadata_.model.beam_to_lidar_z_m};
    const auto xyz = At(map, i, info->point_step);
    for (std::size_t row = 0; row < 3; ++row)
      ASSERT_NEAR(static_cast<double>(xyz[row]),
                  t[row * 4] * lidar[0] + t[row * 4 + 1] * lidar[1] + t[row * 4 + 2] * lidar[2] +
                      t[row * 4 + 3],
                  1e-4)
          << i;
  }
  EXPECT_GT(returns, 10'000U);
}

TEST_F(OusterPixels, TravelAsCoordinates) {
  const Harness plain = Play("");
  const BufferPtr sent(gst_harness_pull(plain.get()));
  const Harness coded = Play(" ! dracoenc max-error=0.02 ! dracodec");
  const BufferPtr received(gst_harness_pull(coded.get()));
  ASSERT_TRUE(sent && received);
  const CapsPtr caps(gst_pad_get_current_caps(coded->sinkpad));
  const auto info = CloudInfo::FromCaps(caps.get());
  ASSERT_TRUE(info);
  EXPECT_FALSE(info->sensor_model);
  EXPECT_EQ(info->height, 1U);  // with xyz geometry the order of points is lost
  const BufferMap from(sent.get(), GST_MAP_READ);
  std::size_t returns = 0;
  for (std::size_t i = 0; i < from.size() / 20; ++i) {
    std::uint32_t range = 0;
    std::memcpy(&range, from.data() + i * 20 + 16, sizeof range);
    returns += range != 0 ? 1 : 0;
  }
  // Points that are in the same cell of the grid become one point.
  EXPECT_LE(info->Points(), returns);
  EXPECT_GT(info->Points(), returns / 2);
}

TEST_F(OusterPixels, RangeGeometryIsRefusedWithTheRemedy) {
  const std::string error =
      RunToEnd("ouster_src location=" + DataPath(kPcap) + " metadata=" + json_ +
               " ! dracoenc geometry=range ! fakesink");
  EXPECT_NE(error.find("cannot be encoded: geometry=range needs"), std::string::npos) << error;
  EXPECT_NE(error.find("geometry=auto"), std::string::npos) << error;
}

}  // namespace
}  // namespace lidar::test

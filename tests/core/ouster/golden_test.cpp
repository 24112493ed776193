// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares captures with the digests that the Ouster SDK ships with them, and points with the
// formulas of the SDK.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/ouster/lidar_packet.h"
#include "src/ouster/point_writer.h"
#include "src/ouster/scan_batcher.h"
#include "tests/core/ouster/captures.h"
#include "tests/core/ouster/md5.h"

namespace lidar::ouster {
namespace {

using test::Md5;

/// Adds `value` to the hash as the smallest unsigned type that holds all values of the channel.
void AddValue(const ChannelBits& bits, std::uint32_t value, Md5* md5) {
  const unsigned width = bits.bits + bits.scale_shift;
  if (width <= 8)
    md5->Add(static_cast<std::uint8_t>(value));
  else if (width <= 16)
    md5->Add(static_cast<std::uint16_t>(value));
  else
    md5->Add(value);
}

class Golden : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string name = GetParam();
    metadata_ = test::LoadMetadata(name + ".json");
    packets_ = test::LoadPackets(name + ".pcap", metadata_);
    digest_ = nlohmann::json::parse(test::ReadFile(test::DataPath(name + "_digest.json")));
    ASSERT_EQ(packets_.size(), 64U);
  }
  ByteView Packet(std::size_t i) const { return {packets_[i].data(), packets_[i].size()}; }

  Metadata metadata_;
  std::vector<std::vector<std::uint8_t>> packets_;
  nlohmann::json digest_;
};

TEST_P(Golden, EveryChannelOfEveryPacketHasTheDigestOfTheSdk) {
  int checked = 0;
  for (const ChannelBits& bits : LayoutOf(metadata_.format.profile)) {
    const std::string name(ToString(bits.channel));
    if (!digest_["packet_hash"].contains(name)) continue;
    Md5 md5;
    const ChannelReader reader(bits);
    for (std::size_t p = 0; p < packets_.size(); ++p) {
      const auto packet = LidarPacket::Parse(Packet(p), metadata_.format);
      ASSERT_TRUE(packet);
      for (std::uint32_t beam = 0; beam < metadata_.format.beams; ++beam)
        for (std::uint32_t i = 0; i < packet->columns(); ++i)
          AddValue(bits,
                   reader.Read(packet->Column(i).pixels + beam * metadata_.format.pixel_size()),
                   &md5);
    }
    EXPECT_EQ(md5.Text(), digest_["packet_hash"][name]) << name;
    ++checked;
  }
  EXPECT_GE(checked, 4);
}

TEST_P(Golden, EveryColumnHeaderHasTheDigestOfTheSdk) {
  std::map<std::string, Md5> md5;
  for (std::size_t p = 0; p < packets_.size(); ++p) {
    const auto packet = LidarPacket::Parse(Packet(p), metadata_.format);
    for (std::uint32_t i = 0; i < packet->columns(); ++i) {
      const PacketColumn column = packet->Column(i);
      md5["TIMESTAMP"].Add(column.timestamp);
      md5["MEASUREMENT_ID"].Add(static_cast<std::uint16_t>(column.measurement_id));
      md5["STATUS"].Add(column.status);
    }
  }
  for (auto& [name, sum] : md5) EXPECT_EQ(sum.Text(), digest_["packet_hash"][name]) << name;
}

/// Returns the hash of the field `name` of all points, in the type that the SDK uses for the field.
std::string FieldDigest(const std::vector<std::uint8_t>& points, const PointWriter& writer,
                        const char* name, std::size_t bytes) {
  Md5 md5;
  for (std::size_t at = writer.fields().Find(name)->offset; at < points.size();
       at += writer.point_step()) {
    std::uint32_t value = 0;
    std::memcpy(&value, &points[at], bytes);
    if (bytes == 1)
      md5.Add(static_cast<std::uint8_t>(value));
    else if (bytes == 2)
      md5.Add(static_cast<std::uint16_t>(value));
    else
      md5.Add(value);
  }
  return md5.Text();
}

TEST_P(Golden, TheScanOutOfTheBatcherHasTheDigestOfTheSdk) {
  const auto& scan = digest_["scans"][0];
  const bool has_signal = LayoutOf(metadata_.format.profile).Find(Channel::kSignal) != nullptr;
  std::vector<Return> returns = {Return::kStrongest};
  if (metadata_.format.has_second_return()) returns.push_back(Return::kSecond);
  for (const Return r : returns) {
    PointOptions options;
    options.returns = r;
    options.channels = {"reflectivity", "near-ir"};
    if (has_signal) options.channels.emplace_back("signal");
    std::string error;
    const auto writer = PointWriter::Create(metadata_, options, &error);
    ASSERT_TRUE(writer) << error;
    ScanBatcher batcher(metadata_, *writer, {1, 4});
    for (std::size_t p = 0; p < packets_.size(); ++p)
      batcher.Push(*LidarPacket::Parse(Packet(p), metadata_.format));
    const auto slice = batcher.Pop();
    ASSERT_TRUE(slice);
    EXPECT_EQ(slice->missing_columns, 0U);
    const std::string suffix = r == Return::kSecond ? "2" : "";
    const auto check = [&](const char* field, const std::string& name, std::size_t bytes) {
      EXPECT_EQ(FieldDigest(slice->points, *writer, field, bytes), scan[name]) << name;
    };
    check("range", "RANGE" + suffix, 4);
    check("reflectivity", "REFLECTIVITY" + suffix, 1);
    check("near-ir", "NEAR_IR", 2);
    if (has_signal) check("signal", "SIGNAL" + suffix, 2);
  }
}

/// Computes a point by the formulas for the xyz table in the SDK's documentation, step by step and
/// in double precision.
std::array<double, 3> ReferencePoint(const Metadata& m, std::uint32_t beam, std::uint32_t column,
                                     double range_m) {
  constexpr double kPi = 3.14159265358979323846;
  const SensorModel& s = m.model;
  const double encoder = 2 * kPi * (1 - static_cast<double>(column) / s.columns_per_scan);
  const double azimuth = -s.beams[beam].azimuth_deg * kPi / 180;
  const double altitude = s.beams[beam].altitude_deg * kPi / 180;
  const double n = std::hypot(s.beam_to_lidar_x_m, s.beam_to_lidar_z_m);
  const std::array<double, 3> p = {
      (range_m - n) * std::cos(encoder + azimuth) * std::cos(altitude) +
          s.beam_to_lidar_x_m * std::cos(encoder),
      (range_m - n) * std::sin(encoder + azimuth) * std::cos(altitude) +
          s.beam_to_lidar_x_m * std::sin(encoder),
      (range_m - n) * std::sin(altitude) + s.beam_to_lidar_z_m};
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double* row = &s.lidar_to_sensor[i * 4];
    out[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
  }
  return out;
}

TEST_P(Golden, PointsAreWithinATenthOfAMillimetreOfTheFormulas) {
  std::string error;
  const auto writer = PointWriter::Create(metadata_, {}, &error);
  ScanBatcher batcher(metadata_, *writer, {8, 4});
  for (std::size_t p = 0; p < packets_.size(); ++p)
    batcher.Push(*LidarPacket::Parse(Packet(p), metadata_.format));
  std::size_t returns = 0;
  while (const auto slice = batcher.Pop()) {
    for (std::size_t i = 0; i * writer->point_step() < slice->points.size(); ++i) {
      std::array<float, 3> xyz{};
      std::uint32_t range = 0;
      std::memcpy(xyz.data(), &slice->points[i * writer->point_step()], sizeof xyz);
      std::memcpy(&range, &slice->points[i * writer->point_step() + 16], sizeof range);
      const auto expected =
          range == 0
              ? std::array<double, 3>{}
              : ReferencePoint(metadata_, static_cast<std::uint32_t>(i / slice->width),
                               slice->first_column + static_cast<std::uint32_t>(i % slice->width),
                               range * 1e-3);
      returns += range != 0 ? 1 : 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        ASSERT_NEAR(static_cast<double>(xyz[axis]), expected[axis], 1e-4) << "point " << i;
    }
  }
  EXPECT_GT(returns, 5000U);
}

INSTANTIATE_TEST_SUITE_P(Captures, Golden,
                         ::testing::Values("OS-0-32-U1_v2.2.0_1024x10", "OS-1-32-G_v2.1.1_1024x10",
                                           "OS-0-128-U1_v2.3.0_1024x10"));

}  // namespace
}  // namespace lidar::ouster

// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds through CloudEncoder and CloudDecoder.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>

#include "src/cloud/cloud_files.h"
#include "src/cloud/nearest_point.h"
#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/cloud/cloud_encoder.h"

namespace lidar::codec::cloud {
namespace {

constexpr std::uint32_t kMaxPoints = 1U << 20;

CloudLayout PlainLayout() {
  return {*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12"), 16};
}

/// x, y, z and intensity of each point.
using PlainPoints = std::vector<std::array<float, 4>>;

ByteView BytesOf(const PlainPoints& points) {
  return {reinterpret_cast<const std::uint8_t*>(points.data()), points.size() * 16};
}

/// A scan of tests/data/lidars. Its intensities are those of some order of the points.
PlainPoints ScanOf(const std::string& sensor) {
  std::ifstream file(LIDARS_FOLDER "/" + sensor + ".pcd", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::string why;
  const auto cloud =
      ReadPcd({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, &why);
  PlainPoints points;
  for (std::size_t at = 0; cloud && at < cloud->points.size(); at += cloud->point_step) {
    auto& p = points.emplace_back();
    for (unsigned k = 0; k < 3; ++k)
      std::memcpy(&p[k], &cloud->points[at + cloud->fields[k].offset], sizeof(float));
    p[3] = static_cast<float>(points.size() / 64 % 256);
  }
  EXPECT_GT(points.size(), 10'000U) << why;
  return points;
}

struct Coded {
  EncodedSlice slice;
  XyzCloud cloud;
};

Coded RoundTrip(const PlainPoints& points, const SliceSettings& settings, unsigned effort) {
  Coded coded;
  auto encoder = CloudEncoder::Create(PlainLayout());
  encoder->set_effort(effort);
  encoder->Load(BytesOf(points), settings.intensity_bits > 0);
  EXPECT_EQ(encoder->Encode(settings, &coded.slice), SliceResult::kEncoded);
  CloudDecoder decoder(kMaxPoints);
  EXPECT_TRUE(decoder.Decode({coded.slice.bytes.data(), coded.slice.bytes.size()}));
  coded.cloud = decoder.cloud();
  return coded;
}

double BitsPerPoint(const Coded& coded) {
  return 8.0 * static_cast<double>(coded.slice.bytes.size()) /
         static_cast<double>(coded.slice.returns);
}

/// The largest distance from a point of one cloud to the nearest of the other, both ways.
double LargestDistance(const PlainPoints& points, const XyzCloud& cloud) {
  std::vector<float> xyz;
  for (const auto& p : points) xyz.insert(xyz.end(), p.begin(), p.begin() + 3);
  const NearestPoint before(xyz);
  const NearestPoint after(cloud.xyz);
  double largest = 0;
  for (std::size_t i = 0; i < xyz.size(); i += 3)
    largest = std::max(largest, after.DistanceFrom(&xyz[i]));
  for (std::size_t i = 0; i < cloud.xyz.size(); i += 3)
    largest = std::max(largest, before.DistanceFrom(&cloud.xyz[i]));
  return largest;
}

struct SensorCase {
  const char* name;
  unsigned effort;
  double most_bits_at_2cm;
  double most_bits_at_5cm;
};
class SensorClouds : public ::testing::TestWithParam<SensorCase> {};

// The bits are a twentieth above those of the first version.
TEST_P(SensorClouds, ComeBackWithinTheErrorInFewBits) {
  const SensorCase& c = GetParam();
  const PlainPoints points = ScanOf(c.name);
  for (const double error_m : {0.02, 0.05}) {
    const Coded coded = RoundTrip(points, {error_m, 0, 0}, c.effort);
    EXPECT_EQ(coded.cloud.size(), points.size());
    EXPECT_LE(coded.slice.error_m, error_m);
    EXPECT_LE(LargestDistance(points, coded.cloud), error_m);
    EXPECT_LE(BitsPerPoint(coded), error_m < 0.03 ? c.most_bits_at_2cm : c.most_bits_at_5cm);
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, SensorClouds,
    ::testing::Values(SensorCase{"at128", 0, 4.6, 2.25}, SensorCase{"at128", 3, 4.6, 2.0},
                      SensorCase{"vlp16", 0, 3.8, 2.1}, SensorCase{"vlp16", 3, 3.8, 2.0}),
    [](const auto& c) { return std::string(c.param.name) + std::to_string(c.param.effort); });

TEST(CloudCodec, DoesNotDependOnTheOrderOfThePoints) {
  PlainPoints points = ScanOf("at128");
  const double before = BitsPerPoint(RoundTrip(points, {0.02, 0, 0}, 3));
  std::shuffle(points.begin(), points.end(), std::mt19937(5));
  EXPECT_NEAR(BitsPerPoint(RoundTrip(points, {0.02, 0, 0}, 3)), before, 0.01 * before);
}

TEST(CloudCodec, GivesBackTheLevelsOfIntensities) {
  const PlainPoints points = ScanOf("at128");
  for (const unsigned effort : {0U, 1U}) {
    const Coded coded = RoundTrip(points, {0.02, 0, 8}, effort);
    std::vector<float> before;
    for (const auto& p : points) before.push_back(p[3]);
    std::vector<float> after = coded.cloud.intensity;
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    EXPECT_EQ(after, before);
  }
}

TEST(CloudCodec, KeepsPointsThatNoGridHoldsAsTheyAre) {
  const PlainPoints points = {{1e30F, 1, 2, 200}, {1, 2, 3, 100}, {-5e9F, 5e9F, 7, 50}};
  const Coded coded = RoundTrip(points, {0.001, 0, 8}, 1);
  ASSERT_EQ(coded.cloud.size(), 3U);
  EXPECT_EQ(std::vector<float>(coded.cloud.xyz.begin() + 3, coded.cloud.xyz.end()),
            (std::vector<float>{1e30F, 1, 2, -5e9F, 5e9F, 7}));
  EXPECT_EQ(coded.cloud.intensity, (std::vector<float>{100, 200, 50}));
}

TEST(CloudCodec, TakesCloudsThatCostNextToNothing) {
  // A million points in one place, and a cube full of them.
  const PlainPoints one(1U << 20, {1, 2, 3, 0});
  EXPECT_EQ(RoundTrip(one, {0.02, 0, 0}, 0).cloud.size(), one.size());
  PlainPoints cube;
  for (std::size_t i = 0; i < 1U << 18; ++i)
    cube.push_back({0.01F + 0.02F * static_cast<float>(i % 64),
                    0.01F + 0.02F * static_cast<float>(i / 64 % 64),
                    0.01F + 0.02F * static_cast<float>(i / 4096), 0});
  EXPECT_EQ(RoundTrip(cube, {0.0174, 0, 0}, 0).cloud.size(), cube.size());
}

TEST(CloudCodec, SurvivesDamagedStreams) {
  PlainPoints points = ScanOf("at128");
  points.resize(2'000);
  points.push_back({1e30F, 1, 2, 3});
  const auto bytes = RoundTrip(points, {0.02, 0, 4}, 1).slice.bytes;
  CloudDecoder decoder(4'096);
  for (std::size_t n = 0; n < bytes.size(); n += n < 100 ? 1 : 50)
    EXPECT_FALSE(decoder.Decode({bytes.data(), n})) << n;
  std::mt19937 random(7);
  for (int i = 0; i < 1'000; ++i) {
    auto damaged = bytes;
    const std::size_t reach = i % 2 == 0 ? 32 : bytes.size();
    damaged[random() % reach] ^= static_cast<std::uint8_t>(1U << random() % 8);
    if (!decoder.Decode({damaged.data(), damaged.size()})) continue;
    EXPECT_LE(decoder.cloud().size(), 4'096U);
  }
  EXPECT_TRUE(decoder.Decode({bytes.data(), bytes.size()}));
  CloudDecoder strict(2'000);
  EXPECT_FALSE(strict.Decode({bytes.data(), bytes.size()}));
}

}  // namespace
}  // namespace lidar::codec::cloud

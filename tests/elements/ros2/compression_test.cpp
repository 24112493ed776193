// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of clouds that are compressed as the plugins of point_cloud_transport do it.
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

#include "ext/draco/field_codec.h"
#include "ext/ros2/cloud_compression.h"
#include "ext/ros2/message_reader.h"
#include "ext/ros2/message_writer.h"
#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Verdict = MessageReader::Verdict;

ByteView ViewOf(const Bytes& bytes) { return {bytes.data(), bytes.size()}; }

constexpr std::uint32_t kStep = 26;
constexpr std::uint32_t kRow = 500;

/// A fixture with a cloud like those that Hesai's driver publishes. Its points 1 and 2 are equal.
class CompressedClouds : public ::testing::TestWithParam<CloudCompression> {
 protected:
  CompressedClouds() {
    cloud_.header = {Time{} + Duration{1'700'000'000'000'000'005}, "lidar"};
    cloud_.layout = {1,
                     kRow,
                     {{"x", 0, 7, 1},
                      {"y", 4, 7, 1},
                      {"z", 8, 7, 1},
                      {"intensity", 12, 7, 1},
                      {"ring", 16, 4, 1},
                      {"timestamp", 18, 8, 1}},
                     false,
                     kStep,
                     kStep * kRow};
    cloud_.is_dense = true;
    ByteWriter w(&points_);
    for (std::uint32_t i = 0; i < kRow; ++i) {
      const auto v = static_cast<float>(i == 2 ? 1 : i);
      for (const float k : {1.F, 2.F, 3.F, 4.F}) w.LeF32(0.1F * k * v);
      w.Le16(static_cast<std::uint16_t>(v));
      w.LeF64(1e9 + static_cast<double>(v));
    }
    cloud_.data = ViewOf(points_);
  }
  Bytes Message() const {
    Bytes packed;
    return cdr::WriteCompressedCloud(*Compress(GetParam(), cloud_, &packed));
  }

  cdr::PointCloud2 cloud_;
  Bytes points_;
};

TEST_P(CompressedClouds, OfNoPointsAreEmptyWhateverTheirData) {
  MessageReader reader(cdr::RosType::kCompressedCloud, [] { return CapsPtr(); });
  cdr::CompressedCloud compressed{cloud_, NameOf(GetParam())};
  compressed.cloud.layout.width = compressed.cloud.layout.row_step = 0;
  for (const Bytes& data : {Bytes(), Bytes{1, 2, 3}}) {
    compressed.cloud.data = ViewOf(data);
    const Bytes message = cdr::WriteCompressedCloud(compressed);
    EXPECT_EQ(reader.Read(ViewOf(message)), Verdict::kEmpty) << data.size();
  }
}

TEST_P(CompressedClouds, ComeBackAsTheyWere) {
  MessageReader reader(cdr::RosType::kCompressedCloud, [] { return CapsPtr(); });
  const Bytes message = Message();
  EXPECT_LT(message.size(), points_.size() + 400);
  ASSERT_EQ(reader.Read(ViewOf(message)), Verdict::kBuffer) << reader.why();
  const BufferPtr buffer = reader.TakeBuffer();
  const BufferMap map(buffer.get(), GST_MAP_READ);
  EXPECT_EQ(Bytes(map.view().begin(), map.view().end()), points_);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), 1'700'000'000'000'000'005U);
}

TEST_P(CompressedClouds, MayHaveRowsWithPadding) {
  if (GetParam() == CloudCompression::kDraco) GTEST_SKIP() << "Draco has points, and no rows";
  cloud_.layout.height = 2;
  cloud_.layout.width = kRow / 2;
  cloud_.layout.row_step = kStep * kRow / 2 + 6;
  Bytes padded;
  for (std::uint32_t row = 0; row < 2; ++row) {
    const auto begin = points_.begin() + row * kStep * kRow / 2;
    padded.insert(padded.end(), begin, begin + kStep * kRow / 2);
    padded.resize(padded.size() + 6);
  }
  cloud_.data = ViewOf(padded);
  Bytes packed;
  std::string why;
  const auto made = Decompress(*Compress(GetParam(), cloud_, &packed), &why);
  ASSERT_TRUE(made) << why;
  EXPECT_EQ(made->points, padded);
  EXPECT_EQ(cdr::RowStride(made->cloud), cloud_.layout.row_step);
}

TEST_P(CompressedClouds, HaveTheirOwnSizeWhateverTheStepOfARowSays) {
  cloud_.layout.row_step += 1'000;
  Bytes packed;
  std::string why;
  const auto made = Decompress(*Compress(GetParam(), cloud_, &packed), &why);
  ASSERT_TRUE(made) << why;
  EXPECT_EQ(made->points, points_);
  EXPECT_EQ(made->cloud.data.size, points_.size());
}

TEST_P(CompressedClouds, MayHaveAsManyFieldsAsDracoTakes) {
  const std::size_t most = draco::FieldLayout::kMaxFields;
  for (const std::size_t count : {most, most + 1}) {
    cdr::PointCloud2 cloud = cloud_;
    cloud.layout.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}};
    for (std::size_t i = 3; i < count; ++i)
      cloud.layout.fields.push_back(
          {"f" + std::to_string(i), static_cast<std::uint32_t>(9 + i), 2, 1});
    cloud.layout.point_step = static_cast<std::uint32_t>(9 + count);
    cloud.layout.width = 20;
    cloud.layout.row_step = cloud.layout.width * cloud.layout.point_step;
    Bytes points(cloud.layout.row_step);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<std::uint8_t>(i % 61);
    cloud.data = ViewOf(points);
    Bytes packed;
    std::string why;
    const auto compressed = Compress(GetParam(), cloud, &packed);
    if (count > most && GetParam() == CloudCompression::kDraco) {
      EXPECT_FALSE(compressed);
      continue;
    }
    ASSERT_TRUE(compressed);
    const auto made = Decompress(*compressed, &why);
    ASSERT_TRUE(made) << why;
    EXPECT_EQ(made->points, points);
  }
}

TEST_P(CompressedClouds, MayHaveFieldsOfManyNumbers) {
  for (const std::uint32_t count : {2U, 5U, 32U}) {
    cloud_.layout.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"h", 12, 2, count}};
    cloud_.layout.point_step = 12 + count;
    cloud_.layout.width = 200;
    cloud_.layout.row_step = cloud_.layout.width * cloud_.layout.point_step;
    const Bytes points(points_.begin(), points_.begin() + cloud_.layout.row_step);
    cloud_.data = ViewOf(points);
    Bytes packed;
    std::string why;
    const auto made = Decompress(*Compress(GetParam(), cloud_, &packed), &why);
    ASSERT_TRUE(made) << why << ": " << count;
    EXPECT_EQ(made->points, points) << count;
  }
}

TEST_P(CompressedClouds, AreWhatTheSinkPublishes) {
  const CapsPtr caps(gst_caps_from_string(
      "application/x-pointcloud2,width=500,height=1,point-step=26,is-dense=true,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,timestamp:F64:18\""));
  std::string why;
  const auto writer = MessageWriter::Make(cdr::RosType::kCompressedCloud, caps.get(), &why);
  ASSERT_TRUE(writer) << why;
  const BufferPtr buffer(gst_buffer_new_memdup(points_.data(), points_.size()));
  MessageSettings settings;
  settings.compression = GetParam();
  settings.frames.frame_id = "lidar";
  Bytes message;
  ASSERT_TRUE(writer->Write(buffer.get(), settings, cloud_.header.stamp,
                            [&](const std::vector<ByteView>& pieces) {
                              for (const ByteView& p : pieces)
                                message.insert(message.end(), p.begin(), p.end());
                            }));
  EXPECT_EQ(message, Message());
}

TEST_P(CompressedClouds, ThatAreDamagedAreRefused) {
  const Bytes message = Message();
  const auto whole = cdr::ReadCompressedCloud(ViewOf(message));
  std::string why;
  for (std::size_t cut = 1; cut < whole->cloud.data.size; cut += 37) {
    auto shorter = *whole;
    shorter.cloud.data.size -= cut;
    EXPECT_FALSE(Decompress(shorter, &why)) << cut;
    EXPECT_EQ(why, "its compressed data are damaged");
  }
  // Damaged data may be accepted, but must never result in more points.
  std::mt19937 random(7);
  for (int round = 0; round < 2'000; ++round) {
    Bytes data(whole->cloud.data.begin(), whole->cloud.data.end());
    for (int i = 0; i < 3; ++i) data[random() % data.size()] = static_cast<std::uint8_t>(random());
    auto damaged = *whole;
    damaged.cloud.data = ViewOf(data);
    const auto made = Decompress(damaged, &why);
    EXPECT_TRUE(!made || made->points.size() <= points_.size());
  }
}

TEST_P(CompressedClouds, CannotClaimMoreThanTheirDataHold) {
  const Bytes message = Message();
  auto claims = *cdr::ReadCompressedCloud(ViewOf(message));
  std::string why;
  claims.cloud.layout.width = 0xffffffff;
  EXPECT_FALSE(Decompress(claims, &why));
  EXPECT_EQ(why, "width x height x point_step is above 256 MiB");
  claims.cloud.layout.width = 10'000'000;
  EXPECT_FALSE(GetParam() == CloudCompression::kZlib && Decompress(claims, &why));
  claims.cloud.layout.width = kRow - 1;
  claims.cloud.layout.row_step = 0;
  const auto fewer = Decompress(claims, &why);
  EXPECT_FALSE(fewer && cdr::RowStride(fewer->cloud));
}

INSTANTIATE_TEST_SUITE_P(All, CompressedClouds,
                         ::testing::Values(CloudCompression::kDraco, CloudCompression::kZlib,
                                           CloudCompression::kZstd),
                         [](const auto& made) { return NameOf(made.param); });

class Transport : public CompressedClouds {};

TEST_F(Transport, ZlibIsGzipAndEitherIsRead) {
  Bytes packed;
  auto compressed = *Compress(CloudCompression::kZlib, cloud_, &packed);
  EXPECT_EQ(packed[0], 0x1F);
  EXPECT_EQ(packed[1], 0x8B);
  Bytes plain(compressBound(points_.size()));
  uLongf size = plain.size();
  ASSERT_EQ(compress(plain.data(), &size, points_.data(), points_.size()), Z_OK);
  plain.resize(size);
  compressed.cloud.data = ViewOf(plain);
  std::string why;
  const auto made = Decompress(compressed, &why);
  ASSERT_TRUE(made) << why;
  EXPECT_EQ(made->points, points_);
}

TEST_F(Transport, DracoMayHaveMetadataAndLeaveDoublesOut) {
  Bytes without = points_;
  without.erase(without.begin() + 2 * kStep, without.begin() + 3 * kStep);
  ::draco::PointCloudBuilder builder;
  builder.Start(kRow - 1);
  using Attribute = ::draco::GeometryAttribute;
  constexpr ::draco::DataType kTypes[] = {::draco::DT_FLOAT32, ::draco::DT_FLOAT32,
                                          ::draco::DT_FLOAT32, ::draco::DT_FLOAT32,
                                          ::draco::DT_UINT16,  ::draco::DT_FLOAT64};
  for (std::size_t i = 0; i < 6; ++i) {
    const int id =
        builder.AddAttribute(i < 3 ? Attribute::POSITION : Attribute::GENERIC, 1, kTypes[i]);
    builder.SetAttributeValuesForAllPoints(id, without.data() + cloud_.layout.fields[i].offset,
                                           kStep);
  }
  const auto points = builder.Finalize(false);
  auto metadata = std::make_unique<::draco::GeometryMetadata>();
  metadata->AddEntryInt("deduplicate", 1);
  points->AddMetadata(std::move(metadata));
  ::draco::Encoder encoder;
  encoder.SetSpeedOptions(7, 7);
  ::draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodePointCloudToBuffer(*points, &buffer).ok());
  cdr::CompressedCloud compressed{cloud_, "draco"};
  const auto* data = reinterpret_cast<const std::uint8_t*>(buffer.data());
  compressed.cloud.data = {data, buffer.size()};
  std::string why;
  const auto made = Decompress(compressed, &why);
  ASSERT_TRUE(made) << why;
  EXPECT_EQ(made->cloud.layout.width, kRow - 1);
  EXPECT_TRUE(cdr::RowStride(made->cloud));
  EXPECT_EQ(made->points, without);
  compressed.cloud.layout.is_bigendian = true;
  EXPECT_FALSE(Decompress(compressed, &why)) << "Draco has numbers in the order of the machine";
  compressed.cloud.layout.is_bigendian = false;
  compressed.cloud.layout.height = 2;
  compressed.cloud.layout.width = kRow / 2;
  const auto of_rows = Decompress(compressed, &why);
  ASSERT_TRUE(of_rows) << why;
  EXPECT_EQ(of_rows->cloud.layout.height, 1U);
  EXPECT_EQ(of_rows->cloud.layout.width, kRow - 1);
}

TEST_F(Transport, OthersAreRefused) {
  std::string why;
  EXPECT_FALSE(Decompress({cloud_, "cloudini"}, &why));
  EXPECT_EQ(why, "its compression is not draco, zlib or zstd, or support for it was not built");
}

}  // namespace
}  // namespace lidar::gst

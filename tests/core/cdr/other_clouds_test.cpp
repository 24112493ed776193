// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests messages whose clouds are not PointCloud2.
#include <gtest/gtest.h>

#include "src/cdr/point_cloud2.h"
#include "tests/core/cdr/bytes.h"

namespace lidar::cdr {
namespace {

/// Returns a message in the format of livox_ros_driver2.
Bytes LivoxMessage(std::uint32_t points) {
  Bytes message;
  CdrWriter w(&message);
  WriteHeader({Time{} + Duration{1'700'000'000'000'000'000}, "livox_frame"}, &w);
  w.U64(1'700'000'000'000'000'000);
  w.U32(points);
  for (int i = 0; i < 4; ++i) w.U8(0);
  w.U32(points);
  for (std::uint32_t i = 0; i < points; ++i) {
    w.U32(1024 * i);
    for (const float v : {1.5F, -2.F, 0.25F}) w.F32(v + static_cast<float>(i));
    w.U8(static_cast<std::uint8_t>(200 + i));
    w.U8(16);
    w.U8(static_cast<std::uint8_t>(i % 4));
  }
  return message;
}

template <class T>
T ValueAt(const Bytes& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST(LivoxMessages, BecomeTheCloudThatTheDriverMakesOfThem) {
  const Bytes message = LivoxMessage(5);
  const auto made = ReadLivox(View(message));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->cloud.header.frame_id, "livox_frame");
  EXPECT_EQ(made->cloud.layout.width, 5U);
  EXPECT_EQ(made->cloud.layout.height, 1U);
  EXPECT_EQ(made->cloud.layout.point_step, 26U);
  EXPECT_EQ(made->cloud.layout.row_step, 5U * 26);
  EXPECT_TRUE(made->cloud.is_dense);
  ASSERT_EQ(made->cloud.layout.fields.size(), 7U);
  EXPECT_EQ(made->cloud.layout.fields[5].name, "line");
  ASSERT_EQ(made->points.size(), 130U);
  EXPECT_EQ(made->cloud.data.data, made->points.data());
  EXPECT_EQ(ValueAt<float>(made->points, 26), 2.5F);
  EXPECT_EQ(ValueAt<float>(made->points, 26 + 8), 1.25F);
  EXPECT_EQ(ValueAt<float>(made->points, 26 + 12), 201);
  EXPECT_EQ(made->points[26 + 16], 16);
  EXPECT_EQ(made->points[3 * 26 + 17], 3);
  EXPECT_EQ(ValueAt<double>(made->points, 26 + 18), 1'700'000'000'000'001'024.0);
}

TEST(LivoxMessages, MayHoldNoPoints) {
  const auto made = ReadLivox(View(LivoxMessage(0)));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->cloud.layout.width, 0U);
}

TEST(LivoxMessages, ThatAreCutAreRefused) {
  const Bytes message = LivoxMessage(3);
  std::string why;
  for (std::size_t n = 0; n < message.size(); ++n) {
    EXPECT_FALSE(ReadLivox({message.data(), n}, &why)) << n;
    EXPECT_EQ(why, "the message is truncated or is not a CustomMsg of Livox");
  }
  Bytes claims = message;
  claims[claims.size() - 3 * 20 - 3] = 0xff;  // a byte of the number of points
  EXPECT_FALSE(ReadLivox(View(claims)));
}

TEST(CompressedClouds, ComeBack) {
  const Bytes data = {1, 2, 3};
  CompressedCloud cloud;
  cloud.cloud.header = {Time{} + Duration{7}, "os"};
  cloud.cloud.layout = {1, 9, {{"x", 0, 7, 1}}, false, 4, 36};
  cloud.cloud.data = View(data);
  cloud.cloud.is_dense = true;
  cloud.format = "zstd";
  for (const bool dense : {true, false}) {
    cloud.cloud.is_dense = dense;
    EXPECT_EQ(ReadCompressedCloud(View(WriteCompressedCloud(cloud)))->cloud.is_dense, dense);
  }
  cloud.cloud.is_dense = true;
  const Bytes message = WriteCompressedCloud(cloud);
  const auto read = ReadCompressedCloud(View(message));
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->cloud.layout == cloud.cloud.layout);
  EXPECT_EQ(Bytes(read->cloud.data.begin(), read->cloud.data.end()), data);
  EXPECT_TRUE(read->cloud.is_dense);
  EXPECT_EQ(read->format, "zstd");
  std::string why;
  for (std::size_t n = 0; n < message.size(); ++n)
    EXPECT_FALSE(ReadCompressedCloud({message.data(), n}, &why)) << n;
  EXPECT_EQ(why, "the message is truncated or is not a CompressedPointCloud2");
}

}  // namespace
}  // namespace lidar::cdr

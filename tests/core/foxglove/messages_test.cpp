// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/foxglove/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "src/base/base64.h"
#include "src/foxglove/schemas.h"
#include "tests/support/proto_reader.h"

namespace lidar::foxglove {
namespace {

using test::ProtoMessage;

struct Point {
  float x, y, z;
  std::uint16_t intensity;
  std::uint16_t gap = 0;
};

const PointFields kFields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:U16:12");
constexpr std::uint64_t kTime_ns = 1'700'000'000'123'456'789;

PointsView View(const std::vector<Point>& points, std::uint32_t width) {
  return {kFields,
          sizeof(Point),
          width,
          static_cast<std::uint32_t>(points.size()) / width,
          {reinterpret_cast<const std::uint8_t*>(points.data()), points.size() * sizeof(Point)}};
}

ProtoMessage Parse(const std::vector<std::uint8_t>& bytes) {
  ProtoMessage message({bytes.data(), bytes.size()});
  EXPECT_TRUE(message.whole());
  return message;
}

void ExpectTime(const ProtoMessage& message) {
  EXPECT_EQ(message.Message(1).Number(1), 1'700'000'000U);
  EXPECT_EQ(message.Message(1).Number(2), 123'456'789U);
}

float XOf(const ProtoMessage& cloud, std::size_t point) {
  float x = 0;
  std::memcpy(&x, cloud.Text(6).data() + point * cloud.Number(4), sizeof x);
  return x;
}

TEST(PointCloud, HasTimeFrameFieldsAndPoints) {
  const std::vector<Point> points = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  const auto encoded = EncodePointCloud({kTime_ns, "lidar"}, View(points, 2), 0);
  const ProtoMessage cloud = Parse(encoded.message);
  EXPECT_EQ(encoded.points, 2U);
  ExpectTime(cloud);
  EXPECT_EQ(cloud.Text(2), "lidar");
  EXPECT_EQ(cloud.Message(3).Message(2).Double(4), 1.0);  // w of the identity quaternion
  EXPECT_EQ(cloud.Number(4), sizeof(Point));
  ASSERT_EQ(cloud.Count(5), 4U);
  EXPECT_EQ(cloud.Message(5, 3).Text(1), "intensity");
  EXPECT_EQ(cloud.Message(5, 3).Number(2), 12U);
  EXPECT_EQ(cloud.Message(5, 3).Number(3), 3U);  // UINT16
  EXPECT_EQ(cloud.Text(6), std::string(reinterpret_cast<const char*>(points.data()),
                                       points.size() * sizeof(Point)));
}

TEST(PointCloud, LeavesOutWhatIsNoReturn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const auto encoded = EncodePointCloud(
      {}, View({{0, 0, 0, 9}, {1, 0, 0, 1}, {nan, 1, 1, 1}, {0, -infinity, 0, 1}, {2, 0, 0, 1}}, 5),
      0);
  const ProtoMessage cloud = Parse(encoded.message);
  ASSERT_EQ(encoded.points, 2U);
  EXPECT_EQ(XOf(cloud, 0), 1.0F);
  EXPECT_EQ(XOf(cloud, 1), 2.0F);
}

TEST(PointCloud, KeepsWhatLiesOnAnAxis) {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Point> points = {
      {0, 0, -1, 0}, {0, -1, 0, 0}, {-1, 0, 0, 0}, {1, 0, infinity, 0}, {infinity, 0, 1, 0}};
  EXPECT_EQ(EncodePointCloud({}, View(points, 5), 0).points, 3U);
}

TEST(PointCloud, NamesTheTypeOfEachField) {
  const std::vector<std::uint8_t> point(40, 1);
  const auto fields = PointFields::Parse(
      "x:F32:0,y:F32:4,z:F32:8,a:U8:12,b:I8:13,c:U16:14,d:I16:16,e:U32:20,f:I32:24,g:F64:32");
  ASSERT_TRUE(fields);
  const auto encoded = EncodePointCloud({}, {*fields, 40, 1, 1, {point.data(), point.size()}}, 0);
  const ProtoMessage cloud = Parse(encoded.message);
  // In PackedElementField.NumericType, the types are UINT8 = 1, INT8 = 2 and so on to FLOAT32 = 7
  // and FLOAT64 = 8.
  const std::vector<std::uint64_t> expected = {7, 7, 7, 1, 2, 3, 4, 5, 6, 8};
  ASSERT_EQ(cloud.Count(5), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(cloud.Message(5, i).Number(3), expected[i]) << cloud.Message(5, i).Text(1);
}

TEST(PointCloud, TellsTheBeamPast255) {
  std::vector<Point> points(300, {1, 0, 0, 0});
  const auto encoded = EncodePointCloud({}, View(points, 1), 0);
  const std::string data = Parse(encoded.message).Text(6);
  const std::size_t last = 299 * (sizeof(Point) + 2) + sizeof(Point);
  ASSERT_EQ(data.size(), last + 2);
  EXPECT_EQ(data[last], 299 - 256);
  EXPECT_EQ(data[last + 1], 1);
}

TEST(PointCloud, OfAsManyPointsAsAreAllowedIsNotThinned) {
  const std::vector<Point> points(30, {1, 0, 0, 0});
  EXPECT_EQ(EncodePointCloud({}, View(points, 30), 30).points, 30U);
  EXPECT_EQ(EncodePointCloud({}, View(points, 30), 29).points, 15U);
}

TEST(PointCloud, OfAnOrganisedCloudTellsTheBeam) {
  const auto encoded =
      EncodePointCloud({}, View({{0, 0, 0, 0}, {1, 0, 0, 1}, {2, 0, 0, 1}, {3, 0, 0, 1}}, 2), 0);
  const ProtoMessage cloud = Parse(encoded.message);
  ASSERT_EQ(cloud.Count(5), 5U);
  EXPECT_EQ(cloud.Message(5, 4).Text(1), "ring");
  EXPECT_EQ(cloud.Number(4), sizeof(Point) + 2);
  const std::string data = cloud.Text(6);
  ASSERT_EQ(data.size(), 3 * (sizeof(Point) + 2));
  EXPECT_EQ(data[sizeof(Point)], 0);                            // row 0
  EXPECT_EQ(data[2 * (sizeof(Point) + 2) + sizeof(Point)], 1);  // row 1
}

TEST(PointCloud, OfAnOrganisedCloudThatTellsTheBeamIsAsItWas) {
  const std::vector<Point> points = {{1, 0, 0, 7}, {2, 0, 0, 6}};
  const PointFields fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,ring:U16:12");
  const PointsView rows = View(points, 1);
  const auto encoded =
      EncodePointCloud({}, {fields, rows.point_step, rows.width, rows.height, rows.data}, 0);
  const ProtoMessage cloud = Parse(encoded.message);
  EXPECT_EQ(cloud.Count(5), 4U);
  EXPECT_EQ(cloud.Number(4), sizeof(Point));
}

TEST(PointCloud, ThinsToTheMostPoints) {
  std::vector<Point> points;
  for (int i = 1; i <= 100; ++i) points.push_back({static_cast<float>(i), 0, 0, 0});
  const auto encoded = EncodePointCloud({}, View(points, 100), 30);
  const ProtoMessage cloud = Parse(encoded.message);
  EXPECT_EQ(encoded.points, 25U);  // every fourth point
  EXPECT_EQ(cloud.Text(6).size(), 25 * sizeof(Point));
  EXPECT_EQ(XOf(cloud, 1), 5.0F);
}

TEST(PointCloud, WithoutAReturnIsEmpty) {
  const auto encoded = EncodePointCloud({}, View({{0, 0, 0, 0}}, 1), 10);
  EXPECT_EQ(encoded.points, 0U);
  EXPECT_EQ(Parse(encoded.message).Text(6), "");
}

TEST(Video, CarriesTheFrameAsItIs) {
  const std::vector<std::uint8_t> frame = {0, 0, 0, 1, 0x65};
  const ProtoMessage video =
      Parse(EncodeVideo({kTime_ns, "camera"}, {frame.data(), frame.size()}, "h264"));
  ExpectTime(video);
  EXPECT_EQ(video.Text(2), "camera");
  EXPECT_EQ(video.Text(3), std::string(frame.begin(), frame.end()));
  EXPECT_EQ(video.Text(4), "h264");
}

TEST(Video, CarriesFramesOfAnySize) {
  for (const std::size_t size : {0U, 1U, 127U, 128U, 129U, 16'383U, 16'384U}) {
    const std::vector<std::uint8_t> frame(size, 7);
    const ProtoMessage video = Parse(EncodeVideo({}, {frame.data(), size}, "vp8"));
    EXPECT_EQ(video.Text(3), std::string(size, 7)) << size;
    EXPECT_EQ(video.Text(4), "vp8") << size;
  }
}

TEST(DracoCloud, CarriesTheFileAsItIs) {
  const std::vector<std::uint8_t> file = {'D', 'R', 'A', 'C', 'O'};
  const ProtoMessage cloud =
      Parse(EncodeDracoCloud({kTime_ns, "lidar"}, {file.data(), file.size()}));
  ExpectTime(cloud);
  EXPECT_EQ(cloud.Text(2), "lidar");
  EXPECT_EQ(cloud.Message(3).Message(2).Double(4), 1.0);
  EXPECT_EQ(cloud.Text(4), "DRACO");
  EXPECT_EQ(cloud.Text(5), "draco");
}

TEST(Poses, AreInTheFixedFrame) {
  const Pose pose{{1, 2, 3}, {0, 0, 0.6, 0.8}};
  const ProtoMessage in_frame = Parse(EncodePose({kTime_ns, "odom"}, pose));
  ExpectTime(in_frame);
  EXPECT_EQ(in_frame.Text(2), "odom");
  EXPECT_EQ(in_frame.Message(3).Message(1).Double(3), 3.0);
  EXPECT_EQ(in_frame.Message(3).Message(2).Double(4), 0.8);
  const ProtoMessage transform = Parse(EncodeTransform({kTime_ns, "odom"}, "lidar", pose));
  ExpectTime(transform);
  EXPECT_EQ(transform.Text(2), "odom");
  EXPECT_EQ(transform.Text(3), "lidar");
  EXPECT_EQ(transform.Message(4).Double(2), 2.0);
  EXPECT_EQ(transform.Message(5).Double(3), 0.6);
}

TEST(Schemas, DescribeEachMessageAndWhatItNeeds) {
  const auto bytes = FileDescriptorSet();
  const ProtoMessage set = Parse(bytes);
  ASSERT_EQ(set.Count(1), 2U);
  const ProtoMessage time = set.Message(1, 0);
  const ProtoMessage file = set.Message(1, 1);
  EXPECT_EQ(file.Text(3), time.Text(1));  // A dependency is written first.
  EXPECT_EQ(file.Text(12), "proto3");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < file.Count(4); ++i) names.push_back(file.Message(4, i).Text(1));
  for (const Schema schema : {Schema::kPointCloud, Schema::kCompressedPointCloud,
                              Schema::kCompressedVideo, Schema::kPose, Schema::kFrameTransform}) {
    const SchemaText text = TextOf(schema);
    const std::string name = std::string(text.name).substr(sizeof "foxglove." - 1);
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
    EXPECT_EQ(text.text, Base64(bytes));
  }
}

}  // namespace
}  // namespace lidar::foxglove

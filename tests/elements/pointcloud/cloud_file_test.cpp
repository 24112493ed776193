// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "tests/support/element_bus.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

/// A point of 24 bytes, with unused bytes after z as in many files of PCL.
struct Point {
  float x, y, z;
  std::uint32_t gap;
  float intensity;
  std::uint16_t ring;
  std::uint16_t end;
};
static_assert(sizeof(Point) == 24);

CloudInfo Info(guint width, guint height) {
  CloudInfo info;
  info.width = width;
  info.height = height;
  info.point_step = sizeof(Point);
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:16,ring:U16:20");
  info.framerate_n = 10;
  return info;
}

const std::vector<Point> kPoints = {{1.5F, -2.25F, 0.1F, 99, 17, 3, 99},
                                    {0, 0, 0, 99, 0, 4, 99},
                                    {-7, 8, 9.5F, 99, 255, 65535, 99}};

/// Returns the file that the element makes from `points`.
std::string Encode(const std::string& element, const CloudInfo& info,
                   const std::vector<Point>& points = kPoints) {
  const Harness h(gst_harness_new_parse(element.c_str()));
  gst_harness_set_src_caps(h.get(), info.ToCaps());
  GstBuffer* in = gst_buffer_new_memdup(points.data(), points.size() * sizeof(Point));
  GST_BUFFER_PTS(in) = 5;
  gst_lidar_buffer_set_capture_time(in, 12 * GST_SECOND + 34);
  EXPECT_EQ(gst_harness_push(h.get(), in), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(h.get()));
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 5U);
  const BufferMap map(out.get(), GST_MAP_READ);
  return {reinterpret_cast<const char*>(map.data()), map.size()};
}

TEST(PcdEnc, OrganisedTextKeepsTheOrderAndMarksMissingReturnsAsNan) {
  EXPECT_EQ(Encode("pcdenc binary=false", Info(1, 3)),
            "# .PCD v0.7 - Point Cloud Data file format\n"
            "# capture time [s since 1970-01-01T00:00:00Z]: 12.000000034\n"
            "VERSION 0.7\n"
            "FIELDS x y z intensity ring\n"
            "SIZE 4 4 4 4 2\n"
            "TYPE F F F F U\n"
            "COUNT 1 1 1 1 1\n"
            "WIDTH 1\n"
            "HEIGHT 3\n"
            "VIEWPOINT 0 0 0 1 0 0 0\n"
            "POINTS 3\n"
            "DATA ascii\n"
            "1.5 -2.25 0.1 17 3\n"
            "nan nan nan 0 4\n"
            "-7 8 9.5 255 65535\n");
}

TEST(PcdEnc, APointAtInfinityIsNoReturn) {
  std::vector<Point> points = kPoints;
  points[0].y = std::numeric_limits<float>::infinity();
  points[2].z = -std::numeric_limits<float>::infinity();
  EXPECT_NE(Encode("pcdenc", Info(3, 1), points).find("POINTS 0\n"), std::string::npos);
  EXPECT_NE(Encode("plyenc", Info(3, 1), points).find("element vertex 0\n"), std::string::npos);
  const std::string organised = Encode("pcdenc binary=false", Info(1, 3), points);
  EXPECT_NE(organised.find("nan nan nan 17 3\n"), std::string::npos) << organised;
}

TEST(PcdEnc, UnorganisedCloudsLoseMissingReturns) {
  const std::string file = Encode("pcdenc binary=false", Info(3, 1));
  EXPECT_NE(file.find("WIDTH 2\nHEIGHT 1\n"), std::string::npos);
  EXPECT_NE(file.find("POINTS 2\nDATA ascii\n1.5 -2.25 0.1 17 3\n-7 8"), std::string::npos);
}

TEST(PcdEnc, BinaryIsPackedWithoutTheGaps) {
  const std::string file = Encode("pcdenc", Info(3, 1));
  const std::string end = "DATA binary\n";
  const std::size_t start = file.find(end) + end.size();
  ASSERT_EQ(file.size() - start, 2U * 18);
  float z = 0;
  std::uint16_t ring = 0;
  std::memcpy(&z, &file[start + 18 + 8], sizeof z);
  std::memcpy(&ring, &file[start + 18 + 16], sizeof ring);
  EXPECT_EQ(z, 9.5F);
  EXPECT_EQ(ring, 65535);
}

TEST(PlyEnc, TextListsTheReturns) {
  EXPECT_EQ(Encode("plyenc binary=false", Info(1, 3)),
            "ply\n"
            "format ascii 1.0\n"
            "comment capture time [s since 1970-01-01T00:00:00Z]: 12.000000034\n"
            "element vertex 2\n"
            "property float x\n"
            "property float y\n"
            "property float z\n"
            "property float intensity\n"
            "property ushort ring\n"
            "end_header\n"
            "1.5 -2.25 0.1 17 3\n"
            "-7 8 9.5 255 65535\n");
}

TEST(PlyEnc, BinaryIsLittleEndianAndPacked) {
  const std::string file = Encode("plyenc", Info(3, 1));
  EXPECT_EQ(file.substr(0, 36), "ply\nformat binary_little_endian 1.0\n");
  const std::string end = "end_header\n";
  const std::size_t start = file.find(end) + end.size();
  ASSERT_EQ(file.size() - start, 2U * 18);
  EXPECT_EQ(file.substr(start, 4), std::string("\0\0\xC0\x3F", 4));  // the number 1.5
}

TEST(CloudFiles, AScanWithoutReturnsIsAFileWithoutPoints) {
  const std::vector<Point> none(3);
  EXPECT_NE(Encode("plyenc", Info(3, 1), none).find("element vertex 0\n"), std::string::npos);
  EXPECT_NE(Encode("pcdenc", Info(3, 1), none).find("POINTS 0\n"), std::string::npos);
}

TEST(CloudFiles, KeepAllPointsOfACloudWithoutCoordinates) {
  CloudInfo info = Info(3, 1);
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,ring:U16:20");
  EXPECT_NE(Encode("pcdenc binary=false", info).find("POINTS 3\n"), std::string::npos);
  EXPECT_NE(Encode("plyenc", info).find("element vertex 3\n"), std::string::npos);
}

TEST(CloudFiles, NamesOfFieldsCannotBreakTheHeader) {
  CloudInfo info = Info(3, 1);
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,a b\"c:U8:20");
  EXPECT_NE(Encode("plyenc", info).find("property uchar a_b_c\n"), std::string::npos);
}

TEST(CloudFiles, NamesOfFieldsStayDifferent) {
  CloudInfo info = Info(3, 1);
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,a b:U8:20,a_b:U8:21,a-b:U8:22");
  EXPECT_NE(Encode("pcdenc", info).find("FIELDS x y z a_b a_b_ a_b__\n"), std::string::npos);
  EXPECT_NE(Encode("plyenc", info)
                .find("property uchar a_b\nproperty uchar a_b_\nproperty uchar a_b__\n"),
            std::string::npos);
}

class CloudFileManners : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, CloudFileManners, ::testing::Values("pcdenc", "plyenc"));

TEST_P(CloudFileManners, RefusesACloudOfAnotherSizeThanItsCaps) {
  const Harness h(gst_harness_new(GetParam()));
  gst_harness_set_src_caps(h.get(), Info(3, 1).ToCaps());
  EXPECT_EQ(gst_harness_push(h.get(), gst_buffer_new_allocate(nullptr, 10, nullptr)),
            GST_FLOW_ERROR);
}

TEST_P(CloudFileManners, WarnsOnceWhereSlicesComeInsteadOfScans) {
  const Harness h(gst_harness_new(GetParam()));
  const test::ElementBus bus(h->element);
  gst_harness_set_src_caps(h.get(), Info(3, 1).ToCaps());
  guint warnings = 0;
  for (const guint slices : {1U, 8U, 8U}) {
    GstBuffer* in = gst_buffer_new_memdup(kPoints.data(), 3 * sizeof(Point));
    const GstLidarSlice slice{7, 0, slices, 0};
    gst_lidar_buffer_set_slice(in, &slice);
    EXPECT_EQ(gst_harness_push(h.get(), in), GST_FLOW_OK);
    while (const MessagePtr message = bus.Pop(GST_MESSAGE_WARNING)) {
      EXPECT_NE(test::MessageText(message.get()).find("8 files"), std::string::npos);
      EXPECT_EQ(slices, 8U);
      ++warnings;
    }
  }
  EXPECT_EQ(warnings, 1U);
}

TEST_P(CloudFileManners, RefusesCapsWithoutAWidth) {
  const Harness h(gst_harness_new(GetParam()));
  gst_harness_set_src_caps(h.get(), Info(0, 1).ToCaps());
  EXPECT_EQ(gst_harness_push(h.get(), gst_buffer_new_allocate(nullptr, 24, nullptr)),
            GST_FLOW_NOT_NEGOTIATED);
}

TEST_P(CloudFileManners, FollowsCapsAndStateCycles) {
  const Harness h(gst_harness_new(GetParam()));
  for (guint width = 1; width < 4; ++width) {
    gst_harness_set_src_caps(h.get(), Info(width, 1).ToCaps());
    GstBuffer* in = gst_buffer_new_memdup(kPoints.data(), width * sizeof(Point));
    EXPECT_EQ(gst_harness_push(h.get(), in), GST_FLOW_OK);
    EXPECT_TRUE(BufferPtr(gst_harness_pull(h.get())));
    gst_element_set_state(h->element, GST_STATE_NULL);
    gst_harness_play(h.get());
  }
}

}  // namespace
}  // namespace lidar::gst

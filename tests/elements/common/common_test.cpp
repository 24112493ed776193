// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "gst/common/latency.h"
#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "gst/lidar/gstlidarcloud.h"
#include "gst/lidar/gstlidarcloudinfo.h"

namespace lidar::gst {
namespace {

CloudInfo SmallCloud() {
  CloudInfo info;
  info.width = 64;
  info.height = 2;
  info.point_step = 20;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16");
  info.framerate_n = 10;
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = 512;
  info.sensor_model->beams = {{0, 1, 0}, {0, -1, 0}};
  return info;
}

TEST(Metas, SurviveACopyOfTheBuffer) {
  gst_lidar_init();
  const BufferPtr buffer(gst_buffer_new_allocate(nullptr, 16, nullptr));
  const GstLidarSlice slice{7, 3, 8, 384};
  gst_lidar_buffer_set_slice(buffer.get(), &slice);
  gst_lidar_buffer_set_ecn(buffer.get(), GST_LIDAR_ECN_CE, 123);
  gst_lidar_buffer_set_capture_time(buffer.get(), 456);
  gst_lidar_buffer_set_capture_time(buffer.get(), 789);
  const BufferPtr copy(gst_buffer_copy_deep(buffer.get()));
  GstLidarSlice read{};
  ASSERT_TRUE(gst_lidar_buffer_get_slice(copy.get(), &read));
  EXPECT_EQ(read.scan_id, 7U);
  EXPECT_EQ(read.slice_index, 3U);
  EXPECT_EQ(read.slice_count, 8U);
  EXPECT_EQ(read.first_column, 384U);
  GstLidarEcn ecn{};
  GstClockTime arrival = 0;
  ASSERT_TRUE(gst_lidar_buffer_get_ecn(copy.get(), &ecn, &arrival));
  EXPECT_EQ(ecn, GST_LIDAR_ECN_CE);
  EXPECT_EQ(arrival, 123U);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(copy.get()), 789U);
}

TEST(Metas, ABufferWithoutOneIsAScanOfOneSlice) {
  const BufferPtr buffer(gst_buffer_new());
  GstLidarSlice slice{9, 9, 9, 9};
  EXPECT_FALSE(gst_lidar_buffer_get_slice(buffer.get(), &slice));
  EXPECT_EQ(slice.slice_count, 1U);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), GST_CLOCK_TIME_NONE);
  EXPECT_FALSE(gst_lidar_buffer_get_ecn(buffer.get(), nullptr, nullptr));
}

GstStructure* FieldsOfMeta(GstBuffer* buffer, const char* meta) {
  return gst_custom_meta_get_structure(gst_buffer_get_custom_meta(buffer, meta));
}

TEST(Metas, ThatLackAFieldAreNone) {
  const BufferPtr whole(gst_buffer_new());
  const GstLidarSlice slice{7, 3, 8, 384};
  const GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  gst_lidar_buffer_set_slice(whole.get(), &slice);
  gst_lidar_buffer_set_pose(whole.get(), &pose);
  gst_lidar_buffer_set_ecn(whole.get(), GST_LIDAR_ECN_CE, 123);
  const auto each = [&](const char* meta, const std::function<void(GstBuffer*)>& check) {
    for (gint i = 0; i < gst_structure_n_fields(FieldsOfMeta(whole.get(), meta)); ++i) {
      const BufferPtr copy(gst_buffer_copy_deep(whole.get()));
      GstStructure* fields = FieldsOfMeta(copy.get(), meta);
      const std::string name = gst_structure_nth_field_name(fields, static_cast<guint>(i));
      SCOPED_TRACE(name);
      gst_structure_remove_field(fields, name.c_str());
      check(copy.get());
    }
  };
  each(GST_LIDAR_SLICE_META_NAME, [](GstBuffer* buffer) {
    GstLidarSlice read{9, 9, 9, 9};
    EXPECT_FALSE(gst_lidar_buffer_get_slice(buffer, &read));
    EXPECT_EQ(read.scan_id + read.slice_index + read.first_column, 0U);
    EXPECT_EQ(read.slice_count, 1U);
  });
  each(GST_LIDAR_POSE_META_NAME, [](GstBuffer* buffer) {
    GstLidarPose read{};
    EXPECT_FALSE(gst_lidar_buffer_get_pose(buffer, &read));
  });
  each(GST_LIDAR_ECN_META_NAME, [](GstBuffer* buffer) {
    GstLidarEcn ecn{};
    GstClockTime arrival = 0;
    // The arrival time is the only field that may be missing.
    if (gst_lidar_buffer_get_ecn(buffer, &ecn, &arrival)) {
      EXPECT_EQ(ecn, GST_LIDAR_ECN_CE);
      EXPECT_EQ(arrival, GST_CLOCK_TIME_NONE);
    }
  });
}

TEST(Metas, WhoseCovarianceIsNot36DoublesAreNone) {
  const BufferPtr buffer(gst_buffer_new());
  for (const auto& [size, type] : {std::pair(36, G_TYPE_DOUBLE), std::pair(35, G_TYPE_DOUBLE),
                                   std::pair(37, G_TYPE_DOUBLE), std::pair(36, G_TYPE_INT)}) {
    GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
    gst_lidar_buffer_set_pose(buffer.get(), &pose);
    GValue numbers = G_VALUE_INIT;
    g_value_init(&numbers, GST_TYPE_ARRAY);
    for (int i = 0; i < size; ++i) {
      GValue number = G_VALUE_INIT;
      g_value_init(&number, type);
      gst_value_array_append_and_take_value(&numbers, &number);
    }
    gst_structure_take_value(FieldsOfMeta(buffer.get(), GST_LIDAR_POSE_META_NAME), "covariance",
                             &numbers);
    EXPECT_EQ(gst_lidar_buffer_get_pose(buffer.get(), &pose), size == 36 && type == G_TYPE_DOUBLE)
        << size << " " << g_type_name(type);
  }
}

TEST(Metas, OfAnUnknownTrackingAreLost) {
  gst_lidar_init();
  const BufferPtr buffer(gst_buffer_new());
  for (const guint tracking : {0U, 1U, 2U, 3U, 4U, G_MAXUINT}) {
    GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
    gst_lidar_buffer_set_pose(buffer.get(), &pose);
    gst_structure_set(FieldsOfMeta(buffer.get(), GST_LIDAR_POSE_META_NAME), "tracking", G_TYPE_UINT,
                      tracking, nullptr);
    ASSERT_TRUE(gst_lidar_buffer_get_pose(buffer.get(), &pose));
    EXPECT_EQ(pose.tracking, std::min<guint>(tracking, GST_LIDAR_TRACKING_LOST));
  }
}

TEST(LatencyQueries, GrowByWhatAnElementHoldsBack) {
  const QueryPtr query(gst_query_new_latency());
  gst_query_set_latency(query.get(), TRUE, 10, 50);
  AddLatency(query.get(), 7);
  Latency latency = ReadLatency(query.get());
  EXPECT_TRUE(latency.live);
  EXPECT_EQ(latency.min, 17U);
  EXPECT_EQ(latency.max, 57U);
  gst_query_set_latency(query.get(), FALSE, 10, GST_CLOCK_TIME_NONE);
  AddLatency(query.get(), 7);
  latency = ReadLatency(query.get());
  EXPECT_FALSE(latency.live);
  EXPECT_EQ(latency.min, 17U);
  EXPECT_EQ(latency.max, GST_CLOCK_TIME_NONE);
}

TEST(CloudInfo, RoundTripsThroughCaps) {
  CloudInfo info = SmallCloud();
  info.is_dense = true;
  const CapsPtr caps(info.ToCaps());
  const auto back = CloudInfo::FromCaps(caps.get());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->width, 64U);
  EXPECT_EQ(back->height, 2U);
  EXPECT_EQ(back->point_step, 20U);
  EXPECT_EQ(back->fields, info.fields);
  EXPECT_EQ(back->framerate_n, 10);
  EXPECT_EQ(back->framerate_d, 1);
  EXPECT_TRUE(back->is_dense);
  EXPECT_EQ(back->FrameSize(), 64U * 2 * 20);
  EXPECT_EQ(back->ScanDuration(), 100 * GST_MSECOND);
  ASSERT_TRUE(back->sensor_model);
  EXPECT_EQ(back->sensor_model->beams.size(), 2U);
}

struct BadCaps {
  const char* caps;
  const char* why;  // part of the expected reason
};
class CloudCaps : public ::testing::TestWithParam<BadCaps> {};
TEST_P(CloudCaps, AreRefusedWithTheRealReason) {
  const CapsPtr caps(gst_caps_from_string(GetParam().caps));
  std::string why;
  EXPECT_FALSE(CloudInfo::FromCaps(caps.get()));
  EXPECT_FALSE(CloudInfo::FromCaps(caps.get(), &why));
  EXPECT_NE(why.find(GetParam().why), std::string::npos) << why;
}
#define CLOUD "application/x-pointcloud2,point-step=16,"
INSTANTIATE_TEST_SUITE_P(
    All, CloudCaps,
    ::testing::Values(
        BadCaps{"video/x-raw", "video/x-raw is not application/x-pointcloud2"},
        BadCaps{"application/x-pointcloud2", "fields is missing"},
        BadCaps{"application/x-pointcloud2,fields=(string)\"x:F32:0\"", "point-step is missing"},
        BadCaps{"application/x-pointcloud2,point-step=8,fields=(string)\"x:F32:0,z:F32:8\"",
                "the fields end past point-step=8"},
        BadCaps{"application/x-pointcloud2,point-step=-16,fields=(string)\"x:F32:0\"",
                "point-step is negative"},
        BadCaps{"application/x-pointcloud2,point-step=2000,fields=(string)\"x:F32:0\"",
                "point-step is above 1024"},
        BadCaps{CLOUD "width=-1,fields=(string)\"x:F32:0\"", "width is negative"},
        BadCaps{CLOUD "height=0,fields=(string)\"x:F32:0\"", "height is 0"},
        BadCaps{CLOUD "is-bigendian=true,fields=(string)\"x:F32:0\"", "little-endian"},
        BadCaps{CLOUD "width=2147483647,height=2147483647,fields=(string)\"x:F32:0\"", "1 GiB"},
        BadCaps{CLOUD "sensor-model=(buffer)00ff,fields=(string)\"x:F32:0\"", "damaged"},
        BadCaps{CLOUD "fields=(string)\"x:F16:0\"", "\"x:F16:0\" is not of type I8"},
        BadCaps{CLOUD "fields=(string)\":F32:0\"", "has no name"},
        BadCaps{CLOUD "fields=(string)\"x:F32\"", "has no offset"},
        BadCaps{CLOUD "fields=(string)\"x:F32:4000000000\"", "past the 1024 bytes"},
        BadCaps{CLOUD "fields=(string)\"x:F32:0,x:F32:4\"", "two fields x"}));

TEST(CloudInfo, HasAsManyRowsAsItsSensorModelHasBeams) {
  CloudInfo info = SmallCloud();
  info.height = 3;
  std::string why;
  EXPECT_FALSE(CloudInfo::FromCaps(CapsPtr(info.ToCaps()).get(), &why));
  EXPECT_EQ(why, "sensor-model has 2 beams where height=3");
}

TEST(CloudInfo, MayHaveAGibibyteAndNoMore) {
  constexpr guint kGibibyte = 1U << 30;
  for (const guint step : {4U, 12U, 16U, 1'024U})
    for (const guint height : {1U, 3U, 128U}) {
      CloudInfo info;
      info.fields = *PointFields::Parse("x:F32:0");
      info.point_step = step;
      info.height = height;
      info.width = kGibibyte / step / height;
      EXPECT_TRUE(CloudInfo::FromCaps(CapsPtr(info.ToCaps()).get())) << step << " " << height;
      ++info.width;
      EXPECT_FALSE(CloudInfo::FromCaps(CapsPtr(info.ToCaps()).get())) << step << " " << height;
    }
}

TEST(CloudInfo, OfFramesNeedsAWidth) {
  const CapsPtr caps(gst_caps_from_string(CLOUD "fields=(string)\"x:F32:0\""));
  std::string why;
  EXPECT_TRUE(CloudInfo::FromCaps(caps.get()));
  EXPECT_FALSE(CloudInfo::FromFrameCaps(caps.get(), &why));
  EXPECT_NE(why.find("width is missing"), std::string::npos) << why;
}

TEST(CloudFormats, GiveTheOffsetOfAFieldOfItsTypeOnly) {
  GstLidarCloudFormat format{};
  EXPECT_EQ(gst_lidar_cloud_format_get_offset(&format, "x", "F32"), -1);
  format.fields = "x:F32:0,ring:U16:12,t:F64:16";
  EXPECT_EQ(gst_lidar_cloud_format_get_offset(&format, "x", "F32"), 0);
  EXPECT_EQ(gst_lidar_cloud_format_get_offset(&format, "ring", "U16"), 12);
  EXPECT_EQ(gst_lidar_cloud_format_get_offset(&format, "t", "F64"), 16);
  for (const auto& [name, type] :
       {std::pair("ring", "I16"), std::pair("ring", "U8"), std::pair("t", "F32"),
        std::pair("intensity", "F32"), std::pair("x", "F16")})
    EXPECT_EQ(gst_lidar_cloud_format_get_offset(&format, name, type), -1) << name << ' ' << type;
}

TEST(Clouds, GiveTheNumbersOfFieldsByName) {
  CloudInfo parsed;
  parsed.width = 3;
  parsed.point_step = 16;
  parsed.fields = *PointFields::Parse("a:I8:0,b:U16:2,c:F64:8,d:I32:4");
  parsed.framerate_n = 30;
  parsed.framerate_d = 4;
  parsed.is_dense = true;
  const CapsPtr caps(parsed.ToCaps());
  GstLidarCloudInfo info;
  ASSERT_TRUE(gst_lidar_cloud_info_from_caps(&info, caps.get()));
  EXPECT_EQ(info.width, 3U);
  EXPECT_EQ(info.height, 1U);
  EXPECT_EQ(info.point_step, 16U);
  EXPECT_EQ(info.framerate_n * 2, info.framerate_d * 15);
  EXPECT_TRUE(info.is_dense);
  EXPECT_EQ(info.n_fields, 4U);
  EXPECT_EQ(info.fields[2].type, GST_LIDAR_FIELD_F64);
  EXPECT_EQ(info.fields[2].offset, 8U);
  EXPECT_EQ(gst_lidar_cloud_info_find(&info, "e"), nullptr);
  const BufferPtr buffer(gst_buffer_new_allocate(nullptr, 48, nullptr));
  gst_buffer_memset(buffer.get(), 0, 0, 48);
  GstLidarCloud cloud;
  ASSERT_TRUE(gst_lidar_cloud_map(&cloud, &info, buffer.get(), GST_MAP_READWRITE));
  EXPECT_EQ(cloud.n_points, 3U);
  const auto through = [&](const char* name, gdouble value) {
    const GstLidarField* field = gst_lidar_cloud_info_find(&info, name);
    gst_lidar_cloud_set(&cloud, field, 1, value);
    EXPECT_EQ(gst_lidar_cloud_get(&cloud, field, 0), 0);
    EXPECT_EQ(gst_lidar_cloud_get(&cloud, field, 2), 0);
    return gst_lidar_cloud_get(&cloud, field, 1);
  };
  EXPECT_EQ(through("a", -7), -7);
  EXPECT_EQ(through("a", 300), 127);
  EXPECT_EQ(through("b", -1), 0);
  EXPECT_EQ(through("b", 65'534.6), 65'535);
  EXPECT_EQ(through("c", 0.1), 0.1);
  EXPECT_EQ(through("d", -2e9), -2e9);
  EXPECT_EQ(through("d", NAN), 0);
  gst_lidar_cloud_unmap(&cloud);
}

TEST(Clouds, AreRefusedInABufferThatIsLargerThanTheirs) {
  const CapsPtr caps(SmallCloud().ToCaps());
  GstLidarCloudInfo info;
  ASSERT_TRUE(gst_lidar_cloud_info_from_caps(&info, caps.get()));
  for (const gsize more : {0U, 1U, 20U}) {
    const BufferPtr buffer(
        gst_buffer_new_allocate(nullptr, SmallCloud().FrameSize() + more, nullptr));
    GstLidarCloud cloud;
    EXPECT_EQ(gst_lidar_cloud_map(&cloud, &info, buffer.get(), GST_MAP_READ), more == 0) << more;
    gst_lidar_cloud_unmap(&cloud);
    GstMemory* memory = gst_buffer_peek_memory(buffer.get(), 0);
    GstMapInfo map;
    ASSERT_TRUE(gst_memory_map(memory, &map, GST_MAP_WRITE)) << "it stays mapped: " << more;
    gst_memory_unmap(memory, &map);
  }
}

TEST(Clouds, AreRefusedWhereBufferAndCapsContradictEachOther) {
  GstLidarCloudInfo info;
  const CapsPtr other(gst_caps_from_string("video/x-raw"));
  EXPECT_FALSE(gst_lidar_cloud_info_from_caps(&info, other.get()));
  const CapsPtr caps(SmallCloud().ToCaps());
  ASSERT_TRUE(gst_lidar_cloud_info_from_caps(&info, caps.get()));
  const BufferPtr buffer(gst_buffer_new_allocate(nullptr, 64, nullptr));
  GstLidarCloud cloud;
  EXPECT_FALSE(gst_lidar_cloud_map(&cloud, &info, buffer.get(), GST_MAP_READ));
  gst_lidar_cloud_unmap(&cloud);  // must have no effect
}

}  // namespace
}  // namespace lidar::gst

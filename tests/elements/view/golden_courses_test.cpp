// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what pointcloudview outputs and posts in scripted runs with golden files. The colours of
// pixels are not compared, because their last bits differ between machines.
#include <gtest/gtest.h>

#include "src/base/byte_writer.h"
#include "tests/support/golden_course.h"

namespace lidar::test {
namespace {

constexpr const char* kThreePoints =
    "application/x-pointcloud2,width=3,height=1,point-step=12,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1";

gst::BufferPtr ThreePoints(const GstLidarSlice& slice, bool drives) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (int i = 1; i <= 9; ++i) w.LeF32(static_cast<float>(i));
  gst::BufferPtr cloud(gst_buffer_new_memdup(bytes.data(), bytes.size()));
  GST_BUFFER_PTS(cloud.get()) = (slice.scan_id * 4 + slice.slice_index) * 25 * GST_MSECOND;
  GST_BUFFER_DURATION(cloud.get()) = 25 * GST_MSECOND;
  gst_lidar_buffer_set_slice(cloud.get(), &slice);
  gst_lidar_buffer_set_capture_time(cloud.get(), GST_SECOND + GST_BUFFER_PTS(cloud.get()));
  const GstLidarPose pose{{1.0 * slice.scan_id, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  if (drives) gst_lidar_buffer_set_pose(cloud.get(), &pose);
  return cloud;
}

void ViewCourse(Course& c) {
  gst_harness_set_sink_caps_str(c.harness(), "video/x-raw,format={ RGB, BGRx }");
  c.Ask();
  c.Tag();
  c.Begin(kThreePoints);
  c.Unknown();
  c.Push("a scan", ThreePoints({0, 0, 1, 0}, true));
  for (const guint i : {0U, 1U}) c.Push("a half", ThreePoints({1, i, 2, 0}, true));
  c.Push("a half whose rest is lost", ThreePoints({2, 0, 2, 0}, true));
  c.Push("the next", ThreePoints({3, 0, 1, 0}, true));
  c.Push("the one behind", ThreePoints({4, 0, 1, 0}, true));
  c.Gap(500 * GST_MSECOND, 100 * GST_MSECOND);
  for (int i = 0; i < 2; ++i) c.Push("without a pose", ThreePoints({5, 0, 1, 0}, false));
  c.Ask();
  c.Push("a half before a flush", ThreePoints({6, 0, 2, 0}, true));
  c.Flush();
  c.Push("behind a flush", ThreePoints({7, 0, 1, 0}, true));
  gst_harness_set_sink_caps_str(c.harness(), "video/x-raw,format=BGRx,width=80,height=40");
  c.Push("of another size", ThreePoints({8, 0, 1, 0}, true));
  c.SetCaps(
      "application/x-pointcloud2,width=3,height=1,point-step=12,framerate=25/1,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"");
  c.Push("of another rate", ThreePoints({9, 0, 1, 0}, true));
  c.SetCaps("application/x-pointcloud2,width=3,height=1,point-step=4,fields=(string)range:U32:0");
  c.Push("without coordinates", ThreePoints({10, 0, 1, 0}, true));
  c.Stop();
  c.Begin(kThreePoints);
  c.Push("in a second run", ThreePoints({0, 0, 1, 0}, false));
  c.Push("a half before the end", ThreePoints({1, 0, 2, 0}, true));
  c.End();
}

const std::size_t kViewCourses = AddGoldenCourses(
    "GoldenCourses",
    {
        {"view", "pointcloudview width=64 height=48", ViewCourse},
        {"view_map", "pointcloudview width=64 height=48 view=top map=true", ViewCourse},
    },
    GOLDEN_COURSES_FOLDER, false);

}  // namespace
}  // namespace lidar::test

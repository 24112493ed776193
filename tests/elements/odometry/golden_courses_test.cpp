// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what lidarodometry outputs, sends and posts in scripted runs with a golden file.
#include "tests/support/golden_course.h"

#include "tests/elements/odometry/corner_drive.h"

namespace lidar::test {
namespace {

/// The other pads of lidarodometry: harnesses for the poses and for the map's poses, and the pad to
/// which samples of the IMU are sent.
struct SidePads {
  explicit SidePads(Course* c)
      : poses(gst_harness_new_with_element(c->element(), nullptr, "odometry")),
        map(gst_harness_new_with_element(c->element(), nullptr, "map")),
        imu(gst_element_request_pad_simple(c->element(), "imu")) {
    c->trace()->Watch(poses->sinkpad);
    c->trace()->Watch(map->sinkpad);
  }

  Harness poses, map;
  gst::PadPtr imu;
};

void OdometryCourse(Course& c) {
  const SidePads pads(&c);
  c.Ask();
  c.Tag();
  c.Begin(kCornerCaps);
  BeginImu(pads.imu.get());
  for (unsigned i = 0; i < 4; ++i) {
    gst_pad_chain(pads.imu.get(), StillnessAt(i * kCornerPeriod).release());
    c.Push("with samples", ScanAt(CornerFrom(i), i * kCornerPeriod));
  }
  c.Ask();
  c.Unknown();
  c.Gap(400 * GST_MSECOND, GST_MSECOND);
  c.Push("without samples", ScanAt(CornerFrom(4), 4 * kCornerPeriod));
  c.Push("a slice", SliceOf(ScanAt(CornerFrom(5), 5 * kCornerPeriod), {7, 0, 2, 0}));
  c.Push("the other slice", SliceOf(ScanAt(CornerFrom(5), 5 * kCornerPeriod), {7, 1, 2, 0}));
  c.Push("a slice", SliceOf(ScanAt(CornerFrom(6), 6 * kCornerPeriod), {8, 0, 2, 0}));
  c.Push("of the next scan", SliceOf(ScanAt(CornerFrom(7), 7 * kCornerPeriod), {9, 0, 2, 0}));
  c.Push("cut", ScanAt(gst::BufferPtr(gst_buffer_new_memdup("cut", 3)), 7 * kCornerPeriod));
  c.Set("post-messages", "false");
  c.Push("in silence", ScanAt(CornerFrom(8), 8 * kCornerPeriod));
  c.Set("post-messages", "true");
  c.Push("a slice", SliceOf(ScanAt(CornerFrom(9), 9 * kCornerPeriod), {10, 0, 2, 0}));
  c.Flush();
  c.Push("behind a flush", ScanAt(CornerFrom(9), 9 * kCornerPeriod));
  for (unsigned i = 10; i < 12; ++i) c.Push("lost", ScanAt(FarWall(), i * kCornerPeriod));
  c.Push("found", ScanAt(CornerFrom(12), 12 * kCornerPeriod));
  c.Push("lost again", ScanAt(FarWall(), 13 * kCornerPeriod));
  c.Push("a slice", SliceOf(ScanAt(CornerFrom(14), 14 * kCornerPeriod), {15, 0, 2, 0}));
  c.SetCaps(std::string(kCornerCaps) + ",frame-id=os");
  c.Push("of other caps", ScanAt(CornerFrom(15), 15 * kCornerPeriod));
  c.PushSegment(GST_FORMAT_TIME, 1'600 * GST_MSECOND);
  auto late = ScanAt(CornerFrom(16), 16 * kCornerPeriod);
  late->mini_object.flags |= GST_BUFFER_FLAG_DISCONT | GST_BUFFER_FLAG_CORRUPTED;
  c.Push("in a segment", std::move(late));
  c.Push("a slice", SliceOf(ScanAt(CornerFrom(17), 17 * kCornerPeriod), {18, 0, 2, 0}));
  c.End();
  c.Stop();
  c.Begin(kCornerCaps);
  for (unsigned i = 0; i < 2; ++i)
    c.Push("in a second run", ScanAt(CornerFrom(i), i * kCornerPeriod));
  c.Push("without times", CornerFrom(2));
  c.SetCaps("application/x-pointcloud2,width=0,height=1,point-step=4,fields=(string)\"x:F32:0\"");
  c.End();
}

/// The bytes of buffers are not compared, because the last digits of poses differ between machines.
const std::size_t kOdometryCourses =
    AddGoldenCourses("OdometryGoldenCourses", {{"odometry", "lidarodometry", OdometryCourse}},
                     GOLDEN_COURSES_FOLDER, false);

}  // namespace
}  // namespace lidar::test

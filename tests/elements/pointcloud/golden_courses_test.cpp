// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what elements output, send and post in scripted runs with golden files.
#include <gtest/gtest.h>

#include <limits>

#include "gst/common/coordinate_frames.h"
#include "gst/lidar/cloud_info.h"
#include "src/base/byte_writer.h"
#include "tests/support/golden_course.h"

namespace lidar::test {
namespace {

using Numbers = std::vector<float>;

constexpr const char* kXyz = "x:F32:0,y:F32:4,z:F32:8";

std::string CapsText(guint width, guint height, bool with_model, const char* fields = kXyz,
                     guint step = 12) {
  gst::CloudInfo info;
  info.width = width;
  info.height = height;
  info.point_step = step;
  info.fields = *PointFields::Parse(fields);
  info.framerate_n = 10;
  info.is_dense = true;
  if (with_model) {
    info.sensor_model.emplace();
    info.sensor_model->columns_per_scan = 8;
    info.sensor_model->beams.assign(height, {1, 10, 0});
  }
  const gst::CapsPtr caps(info.ToCaps());
  gst_caps_set_simple(caps.get(), GST_LIDAR_FRAME_ID, G_TYPE_STRING, "os", nullptr);
  const gst::StringPtr text(gst_caps_to_string(caps.get()));
  return text.get();
}

gst::BufferPtr Floats(const Numbers& numbers) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const float v : numbers) w.LeF32(v);
  return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
}

gst::BufferPtr Text(const std::string& text) {
  if (text.empty()) return gst::BufferPtr(gst_buffer_new());
  return gst::BufferPtr(gst_buffer_new_memdup(text.data(), text.size()));
}

/// Returns `count` points on the x axis, one metre apart, beginning at x = `first`.
gst::BufferPtr Row(std::size_t count, float first) {
  Numbers numbers;
  for (std::size_t i = 0; i < count; ++i) {
    numbers.insert(numbers.end(), {first + static_cast<float>(i), 0, 0});
  }
  return Floats(numbers);
}

struct Stamp {
  GstClockTime ms = 0;
  GstClockTime lasts_ms = 100;
  GstLidarSlice slice{0, 0, 1, 0};
};

gst::BufferPtr At(gst::BufferPtr buffer, const Stamp& stamp) {
  GST_BUFFER_PTS(buffer.get()) = stamp.ms * GST_MSECOND;
  GST_BUFFER_DURATION(buffer.get()) = stamp.lasts_ms * GST_MSECOND;
  gst_lidar_buffer_set_slice(buffer.get(), &stamp.slice);
  gst_lidar_buffer_set_capture_time(buffer.get(), (1'000 + stamp.ms) * GST_MSECOND);
  return buffer;
}

gst::BufferPtr WithPose(gst::BufferPtr buffer) {
  const GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  gst_lidar_buffer_set_pose(buffer.get(), &pose);
  return buffer;
}

gst::BufferPtr With(gst::BufferPtr buffer, GstBufferFlags flag) {
  buffer->mini_object.flags |= static_cast<guint>(flag);
  return buffer;
}

/// Pushes clouds of every kind through a filter.
void FilterCourse(Course& c) {
  c.Ask();
  c.Tag();
  c.Begin(CapsText(4, 2, true));
  c.Unknown();
  c.Gap(0, GST_MSECOND);
  c.Push("a cloud", At(Row(8, 1), {}));
  c.Push("a cloud with a pose", WithPose(At(Row(8, 1), {100, 100, {1, 0, 1, 0}})));
  c.Push("a slice", At(Row(8, 2), {200, 50, {2, 1, 2, 3}}));
  c.Push("flags", With(With(At(Row(8, 1), {300, 50, {3, 0, 1, 0}}), GST_BUFFER_FLAG_DISCONT),
                       GST_BUFFER_FLAG_CORRUPTED));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Numbers odd(24, 0);
  odd[3] = kNan;
  odd[6] = 2;
  odd[9] = std::numeric_limits<float>::infinity();
  odd[12] = 3;
  odd[13] = -4;
  c.Push("missing points", At(Floats(odd), {400, 100, {4, 0, 1, 0}}));
  c.Push("no return at all", At(Floats(Numbers(24, 0)), {500, 100, {5, 0, 1, 0}}));
  c.Push("no times", Row(8, 1));
  c.Gap(600 * GST_MSECOND, GST_MSECOND);
  c.Ask();
  c.SetCaps(CapsText(2, 1, false));
  c.Push("of other caps", At(Row(2, 1), {700, 100, {7, 0, 1, 0}}));
  c.SetCaps(CapsText(2, 1, false, "x:F32:0,y:F32:4,z:F32:8,intensity:F32:16", 20));
  c.Push("of other fields", At(Floats({1, 0, 0, 9, 5, 4, 0, 0, 8, 6}), {800}));
  c.Flush();
  c.Push("behind a flush", At(Floats({1, 0, 0, 9, 5, 4, 0, 0, 8, 6}), {900}));
  c.Push("of another size", At(Row(3, 1), {1'000}));
  c.End();
  c.Stop();
}

/// Pushes slices in any order through an assembler. Some of them are cut off.
void AssemblerCourse(Course& c, const std::string& caps, std::size_t points) {
  const auto slice = [&](guint scan, guint index, guint slices = 4) {
    auto made = At(Row(points, static_cast<float>(10 * scan + index)),
                   {100 * scan + 25 * index, 24, {scan, index, slices, 2 * index + 1}});
    // The times of slice 0 differ from the times that follow from the other slices.
    if (index == 0) GST_BUFFER_PTS(made.get()) += 2 * GST_MSECOND;
    if (index == 0)
      gst_lidar_buffer_set_capture_time(made.get(), (1'003 + 100 * scan) * GST_MSECOND);
    return made;
  };
  c.Ask();
  c.Tag();
  c.Begin(caps);
  for (const guint i : {0U, 1U, 2U, 3U}) c.Push("in order", slice(1, i));
  c.Ask();
  for (const guint i : {3U, 1U, 0U, 2U}) c.Push("in disorder", slice(2, i));
  for (const guint i : {1U, 2U}) c.Push("a part", slice(3, i));
  c.Gap(325 * GST_MSECOND, 25 * GST_MSECOND);
  for (const guint i : {0U, 3U}) c.Push("of the next", slice(4, i));
  c.Push("late", slice(3, 0));
  c.Push("twice", slice(4, 3));
  c.Push("of a scan of other slices", slice(4, 0, 3));
  c.Push("out of range", slice(5, 4));
  c.Push("a third scan", slice(6, 2));
  auto bare = slice(6, 3);
  GST_BUFFER_DURATION(bare.get()) = GST_CLOCK_TIME_NONE;
  GST_BUFFER_PTS(bare.get()) = GST_CLOCK_TIME_NONE;
  c.Push("without times", std::move(bare));
  c.Push("a whole scan", slice(7, 0, 1));
  c.Gap(725 * GST_MSECOND, 25 * GST_MSECOND);
  c.Unknown();
  c.Push("before a segment", slice(8, 1));
  c.PushSegment(GST_FORMAT_TIME, 800 * GST_MSECOND);
  c.Push("behind a segment", slice(8, 2));
  c.Flush();
  c.Push("behind a flush", slice(9, 0));
  c.Push("after a restart of the sender", slice(0, 0));
  c.Push("without a meta", Row(points, 5));
  c.Push("without a meta", Row(points, 6));
  c.Push("of another size", At(Row(points + 1, 1), {900, 25, {1, 1, 4, 0}}));
  c.Push("before the end", slice(10, 2));
  c.End();
  c.Stop();
  c.Begin(caps);
  c.Push("in a second run", slice(11, 2));
  c.End();
}

/// Pushes clouds as a stream of bytes. Its buffers may end in the middle of a cloud.
void ParseBytesCourse(Course& c) {
  c.Ask();
  c.Tag();
  c.PushEvent("stream", gst_event_new_stream_start("bytes"));
  c.SetCaps(CapsText(2, 1, false));
  c.PushSegment(GST_FORMAT_BYTES);
  auto whole = Row(2, 1);
  GST_BUFFER_DTS(whole.get()) = 5;
  c.Push("a whole one", std::move(whole));
  c.Push("a half", Row(1, 3));
  c.Push("a half and one", Row(3, 4));
  c.Unknown();
  c.Ask();
  c.Ask(GST_FORMAT_BYTES);
  c.Push("behind a gap", With(Row(1, 3), GST_BUFFER_FLAG_DISCONT));
  c.Push("its rest", Row(1, 4));
  c.PushUpstream("seek",
                 gst_event_new_seek(1, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                                    250 * GST_MSECOND, GST_SEEK_TYPE_SET, 600 * GST_MSECOND));
  c.Flush();
  c.PushSegment(GST_FORMAT_BYTES, 72);
  c.Push("a fourth", Row(2, 7));
  c.PushEvent("segment done", gst_event_new_segment_done(GST_FORMAT_BYTES, 96));
  c.SetCaps(CapsText(2, 1, false, "z:F32:0,y:F32:4,x:F32:8"));
  c.Push("of other fields", Row(2, 8));
  c.Push("cut short", Row(1, 9));
  c.End();
  c.Stop();
}

/// Pushes clouds in files, with and without timestamps.
void ParseFilesCourse(Course& c) {
  const std::string ply =
      "ply\nformat ascii 1.0\ncomment capture time [s since 1970-01-01T00:00:00Z]: "
      "7.000000005\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar ring\nend_header\n1 2 3 4\n5 6 7 8\n";
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 2\nPOINTS 4\nDATA ascii\n1 2 3 1\n4 5 6 2\n7 8 9 3\n1 1 1 4\n";
  c.PushEvent("stream", gst_event_new_stream_start("files"));
  c.PushSegment(GST_FORMAT_BYTES);
  c.Push("PLY", Text(ply));
  c.Ask();
  c.PushEvent("stream", gst_event_new_stream_start("more files"));
  c.PushSegment(GST_FORMAT_BYTES);
  c.Push("PCD", Text(pcd));
  c.Push("nothing", Text(""));
  c.PushEvent("stream", gst_event_new_stream_start("still more files"));
  c.PushSegment(GST_FORMAT_BYTES);
  c.Push("PLY", Text(ply));
  c.Push("nothing", Text(""));
  c.Flush();
  c.PushSegment(GST_FORMAT_TIME, GST_SECOND);
  c.Push("with times", At(Text(ply), {1'500, 70, {9, 0, 1, 3}}));
  c.Push("with flags", With(At(Text(ply), {1'600, 70, {10, 0, 1, 3}}), GST_BUFFER_FLAG_DISCONT));
  c.PushEvent("segment done", gst_event_new_segment_done(GST_FORMAT_TIME, 1'700 * GST_MSECOND));
  c.Push("damaged", Text(pcd.substr(0, pcd.size() - 6)));
  c.End();
  c.Stop();
  c.Begin("application/x-pointcloud2,height=2,point-step=12,framerate=25/1,fields=(string)\"" +
          std::string(kXyz) + "\"");
  c.Push("points", At(Row(4, 1), {0}));
  c.Push("more points", At(Row(6, 1), {100}));
  c.Push("an odd number of points", At(Row(3, 1), {200}));
}

/// Writes clouds into files.
void FilesCourse(Course& c) {
  constexpr const char* kFields =
      "x:F32:0,y:F32:4,z:F32:8,a:I8:12,b:U8:13,c:I16:14,d:U16:16,e:I32:20,f:U32:24,g h:F64:28";
  const auto cloud = [](float z) {
    std::vector<std::uint8_t> bytes;
    ByteWriter w(&bytes);
    for (const float x : {1.25F, 0.0F}) {
      for (const float v : {x, -2 * x, x * z}) w.LeF32(v);
      w.U8(0x81);
      w.U8(0x82);
      w.Le16(0x8384);
      w.Le16(0x8586);
      w.Le16(0xFFFF);
      w.Le32(0x8788'898A);
      w.Le32(0x8B8C'8D8E);
      w.Le64(0x3FB9'9999'9999'999A);
    }
    return gst::BufferPtr(gst_buffer_new_memdup(bytes.data(), bytes.size()));
  };
  c.Tag();
  for (const guint height : {1U, 2U}) {
    c.Begin(CapsText(2 / height, height, false, kFields, 36));
    c.Push("a cloud", At(cloud(1), {}));
    c.Set("binary", "false");
    c.Push("as text", At(cloud(2), {100}));
    c.Push("without a time of capture", cloud(3));
    c.Push("a point that is not finite", cloud(std::numeric_limits<float>::infinity()));
    c.Push("a slice", With(At(cloud(1), {200, 50, {2, 0, 2, 0}}), GST_BUFFER_FLAG_DISCONT));
    c.Gap(250 * GST_MSECOND, GST_MSECOND);
    c.Set("binary", "true");
    c.Unknown();
    c.Ask();
    c.Flush();
    c.Push("behind a flush", cloud(4));
    c.Push("of another size", Row(1, 1));
    c.SetCaps("application/x-pointcloud2,width=1,height=1,point-step=1");
    c.End();
    c.Stop();
  }
}

/// Pushes the clouds of two sensors through a merger. Each step waits until the merger has pushed
/// all that it can.
void MergeCourse(Course& c) {
  const Harness second(gst_harness_new_with_element(c.element(), "sink_1", nullptr));
  const auto begin = [&](const std::string& caps) {
    gst_pad_push_event(second->srcpad, gst_event_new_stream_start("second"));
    gst_harness_set_src_caps_str(second.get(), caps.c_str());
    gst_pad_push_event(second->srcpad, NewSegment());
  };
  const auto both = [&](const std::string& what, gst::BufferPtr one, gst::BufferPtr other) {
    EXPECT_EQ(gst_pad_push(second->srcpad, other.release()), GST_FLOW_OK) << what;
    c.PushUntil(what, std::move(one), "buffer");
  };
  gst_harness_set_live(c.harness(), FALSE);
  gst_harness_set_live(second.get(), FALSE);
  c.Ask();
  const std::string caps = CapsText(2, 1, false);
  c.Begin(caps);
  begin(caps);
  both("at once", At(Row(2, 1), {0}), At(Row(2, 5), {0}));
  both("the second is later", At(Row(2, 1), {100}), At(Row(2, 5), {180}));
  both("the first is later", At(Row(2, 1), {290}), At(Row(2, 5), {210, 90}));
  EXPECT_EQ(gst_pad_push(second->srcpad, At(Row(2, 6), {300, 50}).release()), GST_FLOW_OK);
  c.Push("of a later turn", At(Row(2, 1), {400}));
  EXPECT_EQ(gst_pad_push(second->srcpad, At(Row(2, 7), {410}).release()), GST_FLOW_OK);
  c.Await("of the same", "buffer");
  both("with a pose", WithPose(At(Row(2, 1), {500})), At(Row(2, 5), {500}));
  both("without times", Row(2, 1), Row(2, 5));
  both("slices", At(Row(2, 1), {600, 50, {6, 0, 2, 0}}), At(Row(2, 5), {600, 50, {6, 1, 2, 0}}));
  both("slices again", At(Row(2, 1), {650, 50, {6, 1, 2, 0}}), At(Row(2, 5), {650}));
  gst_pad_push_event(second->srcpad, gst_event_new_gap(800 * GST_MSECOND, 100 * GST_MSECOND));
  c.PushUntil("beside a gap", At(Row(2, 1), {800}), "buffer");
  gst_harness_set_src_caps_str(
      second.get(), CapsText(1, 1, false, "intensity:F32:0,x:F32:4,y:F32:8,z:F32:12", 16).c_str());
  both("of another layout", At(Row(2, 1), {900}), At(Floats({9, 1, 2, 3}), {900}));
  gst_child_proxy_set(GST_CHILD_PROXY(c.element()), "sink_1::transform", "10,0,0,0,0,180", nullptr);
  both("turned", At(Row(2, 1), {1'000}), At(Floats({9, 1, 2, 3}), {1'000}));
  gst_child_proxy_set(GST_CHILD_PROXY(c.element()), "sink_1::transform", "", nullptr);
  for (GstHarness* h : {c.harness(), second.get()})
    gst_pad_push_event(h->srcpad, gst_event_new_flush_start());
  for (GstHarness* h : {c.harness(), second.get()})
    gst_pad_push_event(h->srcpad, gst_event_new_flush_stop(TRUE));
  c.PushSegment(GST_FORMAT_TIME, 2 * GST_SECOND);
  gst_pad_push_event(second->srcpad, NewSegment());
  both("behind a flush", At(Row(2, 1), {2'000}), At(Floats({9, 1, 2, 3}), {10}));
  gst_pad_push_event(second->srcpad, gst_event_new_eos());
  c.PushUntil("alone", At(Row(2, 1), {2'100}), "buffer");
  gst_pad_push_event(c.harness()->srcpad, gst_event_new_eos());
  c.Await("ended", "event eos");
  c.Stop();
  c.Begin(caps);
  begin(caps);
  both("in a second run", At(Row(2, 1), {0}), At(Row(2, 5), {0}));
  both("slices", At(Row(2, 1), {100, 50, {6, 0, 2, 0}}), At(Row(2, 5), {100}));
  EXPECT_EQ(gst_pad_push(second->srcpad, At(Row(2, 1), {200}).release()), GST_FLOW_OK);
  c.PushUntil("of another size", At(Row(3, 1), {200}), "event eos");
}

const std::size_t kCourses = AddGoldenCourses(
    "GoldenCourses",
    {
        {"filter", "pointcloudfilter", FilterCourse},
        {"filter_far", "pointcloudfilter min-range=1.5 max-range=6 invalid=remove", FilterCourse},
        {"filter_zero", "pointcloudfilter max-range=6 invalid=zero", FilterCourse},
        {"filter_nan", "pointcloudfilter crop-box=2,-9,-9,5,9,9 invalid=nan", FilterCourse},
        {"filter_inside", "pointcloudfilter crop-box=2,-9,-9,5,9,9 crop-inside=true", FilterCourse},
        {"filter_thin", "pointcloudfilter beam-step=2 column-step=3", FilterCourse},
        {"filter_voxels", "pointcloudfilter voxel-size=2 invalid=remove", FilterCourse},
        {"filter_pose", "pointcloudfilter apply-pose=true", FilterCourse},
        {"filter_moved", "pointcloudfilter transform=1,2,3,0,0,0 frame-id=lidar", FilterCourse},
        {"filter_fields", "pointcloudfilter fields=z,x:F64", FilterCourse},
        {"filter_frame", "pointcloudfilter target-frame=map tf-timeout=0", FilterCourse},
        {"assembler", "scanassembler max-wait=30000000",
         [](Course& c) { AssemblerCourse(c, CapsText(2, 2, true), 4); }},
        {"assembler_plain", "scanassembler",
         [](Course& c) { AssemblerCourse(c, CapsText(2, 2, false), 4); }},
        {"assembler_points", "scanassembler",
         [](Course& c) { AssemblerCourse(c, CapsText(3, 1, false), 3); }},
        {"merge", "pointcloudmerge", MergeCourse, {"sink_0"}},
        {"parse_bytes", "pointcloudparse", ParseBytesCourse},
        {"parse_bytes_at_20", "pointcloudparse framerate=20/1", ParseBytesCourse},
        {"parse_files", "pointcloudparse", ParseFilesCourse},
        {"parse_files_at_20", "pointcloudparse framerate=20/1", ParseFilesCourse},
        {"pcd", "pcdenc", FilesCourse},
        {"ply", "plyenc", FilesCourse},
    },
    GOLDEN_COURSES_FOLDER);

}  // namespace
}  // namespace lidar::test

// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what coders output, send and post in scripted runs with golden files.
#include <gtest/gtest.h>

#ifdef HAVE_DRACO
#include <draco/core/draco_version.h>
#endif

#include "gst/common/coordinate_frames.h"
#include "src/base/byte_writer.h"
#include "tests/elements/coders/coder_harness.h"
#include "tests/elements/coders/stopped_clock.h"
#include "tests/support/golden_course.h"

namespace lidar::gst {
namespace {

using test::Course;

constexpr guint kCourseSlices = 4;
constexpr guint kCourseColumns = 32;  // columns per slice
constexpr guint kCourseBeams = 8;
constexpr guint kCourseStep = 22;

CloudInfo CourseInfo() {
  CloudInfo info;
  info.width = kCourseColumns;
  info.height = kCourseBeams;
  info.point_step = kCourseStep;
  info.fields =
      *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16,ring:U16:20");
  info.framerate_n = 10;
  SensorModel model;
  model.columns_per_scan = kCourseSlices * kCourseColumns;
  for (guint i = 0; i < kCourseBeams; ++i) model.beams.push_back({0, 4.0 - i, 0});
  info.sensor_model = model;
  return info;
}

std::string CourseCaps(const CloudInfo& info) {
  const CapsPtr caps(info.ToCaps());
  gst_caps_set_simple(caps.get(), GST_LIDAR_FRAME_ID, G_TYPE_STRING, "os", nullptr);
  const StringPtr text(gst_caps_to_string(caps.get()));
  return text.get();
}

/// Returns a slice of walls and gaps. They are computed from integers, and are the same in each
/// scan.
BufferPtr CourseSlice(guint scan, guint index) {
  const CloudInfo info = CourseInfo();
  std::vector<std::uint32_t> ranges;
  for (guint beam = 0; beam < kCourseBeams; ++beam)
    for (guint i = 0; i < kCourseColumns; ++i) {
      const guint column = index * kCourseColumns + i;
      ranges.push_back(column % 29 < 3 ? 0 : 4'000 + 37 * column + 210 * beam + column * beam % 13);
    }
  const RangeProjection projection(*info.sensor_model);
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (guint k = 0; k < ranges.size(); ++k) {
    const guint beam = k / kCourseColumns;
    const auto at = projection.Point(beam, index * kCourseColumns + k % kCourseColumns, ranges[k]);
    for (const float v : at) w.LeF32(ranges[k] == 0 ? 0 : v);
    w.LeF32(static_cast<float>(ranges[k] == 0 ? 0 : 3 * beam + k % 7));
    w.Le32(ranges[k]);
    w.Le16(static_cast<std::uint16_t>(beam));
  }
  BufferPtr buffer(gst_buffer_new_memdup(bytes.data(), bytes.size()));
  const GstLidarSlice meta{scan, index, kCourseSlices, kCourseColumns * index};
  gst_lidar_buffer_set_slice(buffer.get(), &meta);
  GST_BUFFER_PTS(buffer.get()) = (100 * scan + 25 * index) * GST_MSECOND;
  GST_BUFFER_DURATION(buffer.get()) = 25 * GST_MSECOND;
  gst_lidar_buffer_set_capture_time(buffer.get(),
                                    GST_BUFFER_PTS(buffer.get()) + 7 * GST_SECOND + scan);
  return buffer;
}

GstEvent* KeyUnit() {
  return gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM,
                              gst_structure_new_empty("GstForceKeyUnit"));
}

GstEvent* TargetOf(guint bps) {
  GstLidarTargetBitrate target{};
  target.bitrate = bps;
  return gst_lidar_event_new_target_bitrate(&target);
}

void PushScan(Course& c, const char* what, guint scan) {
  for (guint i = 0; i < kCourseSlices; ++i) c.Push(what, CourseSlice(scan, i));
}

void EncoderCourse(Course& c) {
  const test::StoppedClock clock;
  c.Ask();
  c.Tag();
  c.Begin(CourseCaps(CourseInfo()));
  PushScan(c, "at first", 0);
  c.Ask();
  c.Unknown();
  c.Gap(100 * GST_MSECOND, GST_MSECOND);
  c.Push("behind a skipped slice", CourseSlice(1, 1));
  auto marked = CourseSlice(1, 2);
  marked->mini_object.flags |= GST_BUFFER_FLAG_DISCONT | GST_BUFFER_FLAG_CORRUPTED;
  c.Push("with flags", std::move(marked));
  auto bare = CourseSlice(1, 3);
  GST_BUFFER_PTS(bare.get()) = GST_BUFFER_DURATION(bare.get()) = GST_CLOCK_TIME_NONE;
  c.Push("without times", std::move(bare));
  c.Push("no returns", [] {
    auto nothing = CourseSlice(2, 0);
    gst_buffer_memset(nothing.get(), 0, 0, gst_buffer_get_size(nothing.get()));
    return nothing;
  }());
  c.Push("without a meta",
         BufferPtr(gst_buffer_copy_region(CourseSlice(2, 1).get(), GST_BUFFER_COPY_MEMORY, 0,
                                          static_cast<gsize>(-1))));
  GstLidarSlicesReceived received{5, 1, {}};
  received.slices[0] = {1, 2};
  c.PushUpstream("received", gst_lidar_event_new_slices_received(&received));
  c.Push("acknowledged", CourseSlice(3, 2));
  c.PushUpstream("key unit", KeyUnit());
  c.Push("behind a request", CourseSlice(3, 3));
  // If there are two receivers, slices do not refer to other slices.
  GstLidarSlicesReceived other_received{6, 0, {}};
  c.PushUpstream("second receiver", gst_lidar_event_new_slices_received(&other_received));
  c.Set("max-error", "0.2");
  PushScan(c, "coarser", 4);
  c.Set("quantization-step", "0.05");
  PushScan(c, "with a step", 5);
  c.Set("quantization-step", "0");
  c.PushUpstream("target", TargetOf(40'000));
  for (guint scan = 6; scan < 12; ++scan) PushScan(c, "to a bitrate", scan);
  c.PushUpstream("no target", TargetOf(0));
  c.Set("bitrate", "300000");
  for (guint scan = 12; scan < 15; ++scan) PushScan(c, "to the own bitrate", scan);
  CloudInfo other = CourseInfo();
  other.framerate_n = 20;
  c.SetCaps(CourseCaps(other));
  PushScan(c, "at another rate", 15);
  other.sensor_model.reset();
  c.SetCaps(CourseCaps(other));
  PushScan(c, "without a model", 16);
  c.Flush();
  PushScan(c, "behind a flush", 17);
  c.PushSegment(GST_FORMAT_TIME, 1'800 * GST_MSECOND);
  c.Push("in a segment", CourseSlice(18, 0));
  c.Push("of another size", BufferPtr(gst_buffer_new_allocate(nullptr, 100, nullptr)));
  c.End();
  c.Stop();
  c.Begin(CourseCaps(CourseInfo()));
  PushScan(c, "in a second run", 0);
  c.SetCaps("application/x-pointcloud2,width=1,height=1,point-step=4,fields=(string)\"a:U8:0\"");
  c.End();
}

struct CodedCourse {
  std::string caps;
  std::vector<BufferPtr> slices;
};

CodedCourse CodedBy(const std::string& encoder) {
  const ElementPtr element(gst_parse_launch(encoder.c_str(), nullptr));
  const Harness h(gst_harness_new_with_element(element.get(), "sink", "src"));
  gst_harness_set_src_caps_str(h.get(), CourseCaps(CourseInfo()).c_str());
  CodedCourse coded;
  for (guint scan = 0; scan < 6; ++scan)
    for (guint i = 0; i < kCourseSlices; ++i)
      gst_pad_push(h->srcpad, CourseSlice(scan, i).release());
  while (GstBuffer* slice = gst_harness_try_pull(h.get())) coded.slices.emplace_back(slice);
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  const StringPtr text(gst_caps_to_string(caps.get()));
  coded.caps = text.get();
  return coded;
}

void DecoderCourse(Course& c, const std::string& encoder) {
  const CodedCourse coded = CodedBy(encoder);
  ASSERT_EQ(coded.slices.size(), 24U);
  const auto slice = [&](std::size_t i) {
    return BufferPtr(gst_buffer_copy_deep(coded.slices[i].get()));
  };
  c.Set("max-decode-load", "0");
  c.Ask();
  c.Tag();
  c.Begin(coded.caps);
  for (std::size_t i = 0; i < 5; ++i) c.Push("in order", slice(i));
  c.Ask();
  c.Unknown();
  c.Gap(125 * GST_MSECOND, GST_MSECOND);
  auto behind = slice(7);
  behind->mini_object.flags |= GST_BUFFER_FLAG_DISCONT | GST_BUFFER_FLAG_CORRUPTED;
  c.Push("behind a loss", std::move(behind));
  auto bare = slice(8);
  GST_BUFFER_PTS(bare.get()) = GST_BUFFER_DURATION(bare.get()) = GST_CLOCK_TIME_NONE;
  c.Push("without times", std::move(bare));
  auto cut = slice(9);
  gst_buffer_resize(cut.get(), 0, 11);
  c.Push("cut short", std::move(cut));
  c.Push("nothing", BufferPtr(gst_buffer_new()));
  c.Push("behind damage", slice(10));
  c.Push("without a meta",
         BufferPtr(gst_buffer_copy_region(coded.slices[11].get(), GST_BUFFER_COPY_MEMORY, 0,
                                          static_cast<gsize>(-1))));
  c.PushUpstream("key unit", KeyUnit());
  c.Flush();
  c.Push("behind a flush", slice(12));
  c.PushSegment(GST_FORMAT_TIME, 300 * GST_MSECOND);
  c.Push("in a segment", slice(13));
  c.SetCaps(coded.caps + ",a-note=1");
  c.Push("of other caps", slice(14));
  c.End();
  c.Stop();
  c.Set("max-points", "255");
  c.Begin(coded.caps);
  c.Push("with too many points", slice(15));
  c.SetCaps("application/x-other");
  c.End();
}

/// Returns true if this coder's slices must have the sizes in the golden files. The sizes of
/// Draco's slices differ between its releases.
bool HasTheirSizes([[maybe_unused]] const std::string& name) {
#ifdef HAVE_DRACO
  if (name.rfind("draco", 0) == 0) return std::string(draco::kDracoVersion) == "1.5.5";
#endif
  return true;
}

std::vector<test::ScriptedCourse> CoderScripts() {
  std::vector<test::ScriptedCourse> scripts;
  for (const CoderCase& coder : OurCoders()) {
    const std::string encoder = std::string(coder.encoder) + " max-error=0.02 ";
    const std::string name = coder.name;
    if (!HasTheirSizes(name)) continue;
    scripts.push_back({name + "_enc", encoder + "error-check=3", EncoderCourse});
    scripts.push_back({name + "_enc_thin",
                       encoder + "degradation-preference=maintain-framerate threads=2 "
                                 "intensity-bits=0 error-check=2",
                       EncoderCourse});
    scripts.push_back(
        {name + "_dec", coder.decoder, [encoder](Course& c) { DecoderCourse(c, encoder); }});
  }
  return scripts;
}

const std::size_t kCoderCourses =
    test::AddGoldenCourses("CoderGoldenCourses", CoderScripts(), GOLDEN_COURSES_FOLDER, false);

}  // namespace
}  // namespace lidar::gst

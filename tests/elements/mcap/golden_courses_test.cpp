// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares what mcapsink and mcapsrc output, send and post in scripted runs with golden files.
#include "tests/support/files.h"
#include "tests/support/golden_course.h"

#include <filesystem>

namespace lidar::test {
namespace {

constexpr const char* kRecordedCaps =
    "application/x-pointcloud2,width=2,height=1,point-step=12,fields=(string)\"x:F32:0,y:F32:4,"
    "z:F32:8\",framerate=10/1,is-bigendian=false,is-dense=true,frame-id=os";
constexpr const char* kTallCaps =
    "application/x-pointcloud2,width=1,height=2,point-step=12,fields=(string)\"x:F32:0,y:F32:4,"
    "z:F32:8\",framerate=10/1,is-bigendian=false,is-dense=true,frame-id=os";
constexpr const char* kPoseCaps = "application/x-odometry,frame-id=odom,child-frame-id=os";

/// Changes into a temporary folder. So the property location, and messages that contain it, have no
/// path that differs between runs.
class WorkingFolder {
 public:
  WorkingFolder() { std::filesystem::current_path(folder_.path()); }
  ~WorkingFolder() { std::filesystem::current_path(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
  const TempFolder folder_;
};

gst::BufferPtr Stamped(gsize size, guint8 value, GstClockTime ms) {
  gst::BufferPtr buffer(gst_buffer_new_allocate(nullptr, size, nullptr));
  gst_buffer_memset(buffer.get(), 0, value, size);
  GST_BUFFER_PTS(buffer.get()) = ms * GST_MSECOND;
  gst_lidar_buffer_set_capture_time(buffer.get(), (1'000 + ms) * GST_MSECOND + 3);
  return buffer;
}

gst::BufferPtr Cloud(GstClockTime ms) { return Stamped(24, static_cast<guint8>(ms / 100), ms); }
gst::BufferPtr PoseBuffer(GstClockTime ms) { return Stamped(64, 0, ms); }

/// The second stream of a recorder.
class SecondStream {
 public:
  explicit SecondStream(GstElement* recorder)
      : h_(gst_harness_new_with_element(recorder, "sink_1", nullptr)) {}
  void Begin(const char* caps) const {
    gst_pad_push_event(h_->srcpad, gst_event_new_stream_start("second"));
    gst_harness_set_src_caps_str(h_.get(), caps);
    gst_pad_push_event(h_->srcpad, NewSegment());
  }
  void Push(gst::BufferPtr buffer) const {
    EXPECT_EQ(gst_pad_push(h_->srcpad, buffer.release()), GST_FLOW_OK);
  }
  void End() const { gst_pad_push_event(h_->srcpad, gst_event_new_eos()); }

 private:
  Harness h_;
};

void SinkCourse(Course& c) {
  const WorkingFolder folder;
  const SecondStream second(c.element());
  c.Begin(kRecordedCaps);
  second.Begin(kPoseCaps);
  second.Push(PoseBuffer(50));
  for (GstClockTime ms = 0; ms < 300; ms += 100) c.Push("a cloud", Cloud(ms));
  c.SetCaps(kTallCaps);
  c.Push("of other caps", Cloud(300));
  c.SetCaps(kRecordedCaps);
  c.Push("of the first caps", Cloud(400));
  c.Flush();
  c.Push("behind a flush", Cloud(10));
  c.PushSegment(GST_FORMAT_TIME, 50 * GST_MSECOND);
  c.Push("in a segment", Cloud(100));
  auto bare = Cloud(0);
  GST_BUFFER_PTS(bare.get()) = GST_CLOCK_TIME_NONE;
  c.Push("without a time", std::move(bare));
  c.End();
  second.End();
  c.Flush();
  c.Push("behind the end", Cloud(700));
  c.Stop();
  c.Set("location", "more-%02d.mcap");
  c.Set("max-file-duration", "200000000");
  c.Set("max-files", "2");
  c.Begin(kRecordedCaps);
  for (GstClockTime ms = 0; ms < 900; ms += 100) c.Push("in a second run", Cloud(ms));
  c.End();
  c.Flush();
  c.Push("behind the end", Cloud(900));
  c.Push("of another size", Stamped(23, 0, 900));
  for (const char* caps : {"text/x-raw,format=utf8", kRecordedCaps}) c.SetCaps(caps);
  c.Push("of the caps before", Cloud(900));
  c.Stop();
  std::vector<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator("."))
    files.push_back(file.path().filename().string());
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) c.AddLine(file);
}

/// Records clouds and poses. The poses have a pause of 700 ms.
void RecordTwoStreams(const char* location) {
  const gst::ElementPtr recorder(
      gst_parse_launch(("mcapsink chunk-size=1024 compression=none chunk-duration=300000000 "
                        "location=" +
                        std::string(location))
                           .c_str(),
                       nullptr));
  {
    const Harness first(gst_harness_new_with_element(recorder.get(), "sink_0", nullptr));
    const SecondStream second(recorder.get());
    gst_harness_set_src_caps_str(first.get(), kRecordedCaps);
    second.Begin(kPoseCaps);
    for (GstClockTime ms = 0; ms < 1'200; ms += 100) {
      if (ms == 900) gst_harness_set_src_caps_str(first.get(), kTallCaps);
      EXPECT_EQ(gst_harness_push(first.get(), Cloud(ms).release()), GST_FLOW_OK);
      if (ms < 200 || ms > 800) second.Push(PoseBuffer(ms + 20));
    }
    gst_element_set_state(recorder.get(), GST_STATE_NULL);
  }
}

GstEvent* SeekTo(double rate, int flags, GstClockTime from_ms, GstClockTime to_ms) {
  GstEvent* seek = gst_event_new_seek(rate, GST_FORMAT_TIME, static_cast<GstSeekFlags>(flags),
                                      GST_SEEK_TYPE_SET, static_cast<gint64>(from_ms * GST_MSECOND),
                                      GST_SEEK_TYPE_SET, static_cast<gint64>(to_ms * GST_MSECOND));
  return seek;
}

void SrcCourse(Course& c) {
  const WorkingFolder folder;
  RecordTwoStreams("drive.mcap");
  c.trace()->TakeAddedPads();
  c.Ask();
  c.Play("at first", "event eos", 2);
  c.Ask();
  c.Send("seek", SeekTo(2, GST_SEEK_FLAG_FLUSH, 110, 350), "event eos", 2);
  c.Ask();
  constexpr int kSegment = GST_SEEK_FLAG_SEGMENT;
  c.Send("a segment", SeekTo(1, GST_SEEK_FLAG_FLUSH | kSegment, 0, 150), "event segment-done", 2);
  c.Send("the next", SeekTo(1, kSegment, 850, 950), "event segment-done", 2);
  c.Send("backwards", SeekTo(-1, GST_SEEK_FLAG_FLUSH, 0, 100), "event eos", 2);
  c.Stop();
  c.Set("topic", "/odometry");
  c.Play("one topic in a second run", "event eos");
  c.Stop();
  c.Set("topic", "/nothing");
  gst_element_set_state(c.element(), GST_STATE_PLAYING);
  c.Stop();
  {
    std::fstream file("drive.mcap", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(2'000);
    file << "damage";
  }
  c.Set("topic", "");
  c.Play("damaged", "event eos", 2);
  c.Stop();
  std::filesystem::resize_file("drive.mcap", std::filesystem::file_size("drive.mcap") - 100);
  c.Play("cut short", "event eos", 2);
}

const std::size_t kMcapCourses = AddGoldenCourses(
    "McapGoldenCourses",
    {{"sink", "mcapsink location=drive.mcap compression=none", SinkCourse, {"sink_0", nullptr}},
     {"src", "mcapsrc location=drive.mcap", SrcCourse, {nullptr, nullptr}}},
    GOLDEN_COURSES_FOLDER);

}  // namespace
}  // namespace lidar::test

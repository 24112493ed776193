// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of pointcloudview: each property has an effect, and an element that was stopped or flushed
// draws like a new one.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "src/base/byte_writer.h"
#include "tests/support/own_properties.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

constexpr const char* kTwoBeams =
    "application/x-pointcloud2,width=6,height=2,point-step=16,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\",framerate=10/1";

/// A pointcloudview with small pictures, unless the properties set other sizes.
class ViewRun {
 public:
  explicit ViewRun(const std::string& properties) {
    const gst::ElementPtr element(
        gst_parse_launch(("pointcloudview width=160 height=90 " + properties).c_str(), nullptr));
    h_.reset(gst_harness_new_with_element(element.get(), "sink", "src"));
    gst_harness_set_sink_caps_str(h_.get(), "video/x-raw,format=RGB");
    trace_.emplace(h_.get());
  }
  ~ViewRun() {
    trace_->Stop();
    trace_.reset();
  }
  ViewRun(const ViewRun&) = delete;
  ViewRun& operator=(const ViewRun&) = delete;

  void Begin() { trace_->Begin(kTwoBeams); }
  Lines Take() { return trace_->Take(); }
  Lines TakeBuffers() { return trace_->TakeBuffers(); }
  void Flush() { trace_->Flush(); }
  void Stop() {
    trace_->Stop();
    trace_->Take();
  }
  /// Pushes a slice of two beams. If `drives` is true, it has the pose of a sensor that drives
  /// along x.
  void Push(const GstLidarSlice& slice, bool drives = true, float ahead_m = 5) {
    std::vector<std::uint8_t> bytes;
    ByteWriter w(&bytes);
    for (int beam = 0; beam < 2; ++beam)
      for (int i = 0; i < 6; ++i)
        for (const int v : {3 * i, 2 * i - 5, 3 * beam + i % 3 - 2, 10 * i + 40 * beam})
          w.LeF32(static_cast<float>(v) + (v == 3 * i ? ahead_m : 0.0F));
    gst::BufferPtr cloud(gst_buffer_new_memdup(bytes.data(), bytes.size()));
    const GstClockTime time = slice.scan_id * 100 * GST_MSECOND;
    GST_BUFFER_PTS(cloud.get()) = time;
    gst_lidar_buffer_set_slice(cloud.get(), &slice);
    gst_lidar_buffer_set_capture_time(cloud.get(), GST_SECOND + time);
    const GstLidarPose pose{{1.0 * slice.scan_id, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
    if (drives) gst_lidar_buffer_set_pose(cloud.get(), &pose);
    EXPECT_EQ(gst_pad_push(h_->srcpad, cloud.release()), GST_FLOW_OK);
  }
  void PushScan(guint scan) { Push({scan, 0, 1, 0}); }
  /// Makes downstream request pictures of another size.
  void Resize(const char* caps) { gst_harness_set_sink_caps_str(h_.get(), caps); }

 private:
  Harness h_;
  std::optional<RunTrace> trace_;
};

struct ViewEffect {
  const char* others;  // properties without which there is no effect
  const char* property;
  const char* value;
};

const ViewEffect kViewEffects[] = {
    {"", "view", "range"},       {"", "color-by", "ring"}, {"view=top", "map", "true"},
    {"", "width", "96"},         {"", "height", "64"},     {"view=top", "extent", "40"},
    {"", "eye-x", "-20"},        {"", "eye-y", "3"},       {"", "eye-z", "5"},
    {"", "target-x", "8"},       {"", "target-y", "3"},    {"", "target-z", "2"},
    {"", "field-of-view", "40"}, {"", "point-size", "7"},  {"color-max=3", "color-min", "-1"},
    {"", "color-max", "3"},
};

std::string ChangeOf(const ViewEffect& e) { return std::string(e.property) + "=" + e.value; }

Lines PicturesOf(const std::string& properties) {
  ViewRun run(properties);
  run.Begin();
  for (guint scan = 0; scan < 2; ++scan) run.PushScan(scan);
  return run.Take();
}

class ViewEachProperty : public ::testing::TestWithParam<ViewEffect> {};
TEST_P(ViewEachProperty, ChangesThePicture) {
  const std::string others = GetParam().others;
  const std::string changed =
      std::string(GetParam().property) == "width" || std::string(GetParam().property) == "height"
          ? ChangeOf(GetParam())
          : others + " " + ChangeOf(GetParam());
  EXPECT_NE(PicturesOf(changed), PicturesOf(others)) << GetParam().property;
}
INSTANTIATE_TEST_SUITE_P(Of, ViewEachProperty, ::testing::ValuesIn(kViewEffects));

TEST(ViewColors, AreAutomaticWhereTheyWouldEndBelowTheirBegin) {
  EXPECT_EQ(PicturesOf("color-min=5"), PicturesOf(""));
}

TEST(ViewProperties, AreAllInTheTable) { ExpectEachPropertyIn(kViewEffects, "pointcloudview"); }

/// Leaves much state behind: a map, a warning, and an incomplete picture.
void DrawMuch(ViewRun* run) {
  for (guint scan = 0; scan < 5; ++scan) run->PushScan(scan);
  run->Push({5, 0, 1, 0}, false);
  run->Push({6, 0, 1, 0}, true, 30);
  run->Push({7, 0, 3, 0});
}

TEST(ViewSecondRun, IsAsTheFirst) {
  for (const char* view : {"view=top map=true", "map=true", "view=range", "color-by=intensity"}) {
    ViewRun run(view);
    Lines first;
    for (int i = 0; i < 3; ++i) {
      run.Begin();
      DrawMuch(&run);
      const Lines lines = run.Take();
      if (first.empty()) first = lines;
      EXPECT_EQ(lines, first) << view;
      EXPECT_EQ(HasLine(lines, "message warning The clouds have no poses"),
                std::string(view).find("map") != std::string::npos);
      run.Stop();
    }
  }
}

TEST(ViewFlush, LeavesNothingOfThePictureThatWasBegun) {
  ViewRun run("view=top");
  run.Begin();
  run.PushScan(0);
  const Lines alone = run.TakeBuffers();
  run.Push({0, 0, 2, 0}, true, 25);
  run.Flush();
  run.TakeBuffers();
  run.PushScan(0);
  EXPECT_EQ(run.TakeBuffers(), alone);
}

TEST(ViewSize, IsWhatDownstreamWantsAlsoWhileItPlays) {
  constexpr const char* kSmall = "video/x-raw,format=RGB,width=96,height=64";
  ViewRun small("");
  small.Resize(kSmall);
  small.Begin();
  small.PushScan(1);
  ViewRun run("");
  run.Begin();
  run.PushScan(0);
  run.TakeBuffers();
  run.Resize(kSmall);
  run.PushScan(1);
  EXPECT_EQ(run.TakeBuffers(), small.TakeBuffers());
}

}  // namespace
}  // namespace lidar::test

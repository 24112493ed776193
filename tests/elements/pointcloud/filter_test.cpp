// SPDX-License-Identifier: LGPL-2.1-or-later
#include <array>

#include "gst/common/buffer_map.h"
#include "src/base/byte_writer.h"
#include "tests/elements/pointcloud/filter_fixture.h"
#include "tests/support/element_stats.h"

namespace lidar::gst {
namespace {

TEST_F(Filter, ConvertsDoublesAndByteOrderAndChoosesFields) {
  Start("fields=x,y,z,ring:U16",
        CloudCaps("x:F64:0,y:F64:8,z:F64:16,t:F64:24,ring:I32:32", 36, 1, 1, ",is-bigendian=true"));
  std::vector<std::uint8_t> point;
  ByteWriter w(&point);
  for (const double v : {1.5, -2.5, 3.25, 9.0}) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof v);
    w.Be64(bits);
  }
  w.Be32(17);
  ASSERT_EQ(Push(point), GST_FLOW_OK);
  EXPECT_EQ(Info()->fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,ring:U16:12");
  const BufferPtr out(gst_harness_pull(h_.get()));
  const BufferMap map(out.get(), GST_MAP_READ);
  ByteReader r(map.view());
  EXPECT_EQ(map.size(), 14U);
  EXPECT_EQ(r.LeF32(), 1.5F);
  EXPECT_EQ(r.LeF32(), -2.5F);
  EXPECT_EQ(r.LeF32(), 3.25F);
  EXPECT_EQ(r.Le16(), 17U);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(out.get()), 77U);
}

TEST_F(Filter, WithoutSettingsCloudsAreAsTheyWere) {
  Start("", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 16, 2, 1));
  std::vector<std::uint8_t> bytes(32);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  ASSERT_EQ(Push(bytes), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(h_.get()));
  const BufferMap map(out.get(), GST_MAP_READ);
  EXPECT_EQ(std::vector<std::uint8_t>(map.data(), map.data() + map.size()), bytes);
  EXPECT_EQ(Info()->point_step, 16U);
}

TEST_F(Filter, SlicesKeepTheirPlaceAndModelsTheirBeams) {
  CloudInfo info;
  info.width = 4;
  info.height = 2;
  info.point_step = 12;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = 512;
  info.sensor_model->beams = {{1, 10, 0}, {-1, -10, 4}};
  const CapsPtr caps(info.ToCaps());
  const StringPtr text(gst_caps_to_string(caps.get()));
  Start("beam-step=2", text.get());
  ASSERT_EQ(Push(std::vector<std::uint8_t>(96, 1), 8), GST_FLOW_OK);
  ASSERT_TRUE(Info()->sensor_model);
  EXPECT_EQ(Info()->sensor_model->beams.size(), 1U);
  gst_buffer_unref(gst_harness_pull(h_.get()));
  // A new value of a property takes effect with the next cloud.
  g_object_set(h_->element, "column-step", 2, nullptr);
  ASSERT_EQ(Push(std::vector<std::uint8_t>(96, 1), 8), GST_FLOW_OK);
  EXPECT_FALSE(Info()->sensor_model);
  EXPECT_EQ(Info()->width, 2U);
  const BufferPtr out(gst_harness_pull(h_.get()));
  GstLidarSlice slice{};
  gst_lidar_buffer_get_slice(out.get(), &slice);
  EXPECT_EQ(slice.first_column, 4U);
}

TEST_F(Filter, AModelGoesWherePointsAreNoLongerWhereItSays) {
  CloudInfo info;
  info.width = 4;
  info.height = 2;
  info.point_step = 12;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = 512;
  info.sensor_model->beams = {{1, 10, 0}, {-1, -10, 4}};
  const CapsPtr caps(info.ToCaps());
  const StringPtr text(gst_caps_to_string(caps.get()));
  for (const char* moves : {"transform=1,0,0,0,0,0", "column-step=2", "invalid=remove"}) {
    Start(moves, text.get());
    ASSERT_EQ(Push(std::vector<std::uint8_t>(96, 1)), GST_FLOW_OK);
    EXPECT_FALSE(Info()->sensor_model) << moves;
  }
  for (const char* stays : {"max-range=50", "crop-box=-9,-9,-9,9,9,9", "invalid=nan"}) {
    Start(stays, text.get());
    ASSERT_EQ(Push(std::vector<std::uint8_t>(96, 1)), GST_FLOW_OK);
    EXPECT_TRUE(Info()->sensor_model) << stays;
  }
}

TEST_F(Filter, CloudsAreDenseAsTheyWereUnlessPointsAreBlankedOrRemoved) {
  for (const bool dense : {false, true}) {
    const std::string caps = CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1,
                                       std::string(",is-dense=") + (dense ? "true" : "false"));
    for (const auto& [settings, is_dense] :
         std::vector<std::pair<std::string, bool>>{{"", dense},
                                                   {"beam-step=2", dense},
                                                   {"fields=x,y,z", dense},
                                                   {"max-range=50", false},
                                                   {"transform=1,0,0,0,0,0", false},
                                                   {"crop-box=-9,-9,-9,9,9,9", false},
                                                   {"voxel-size=0.1", false},
                                                   {"max-range=50 invalid=remove", true}}) {
      Start(settings, caps);
      ASSERT_EQ(Push(std::vector<std::uint8_t>(24, 1)), GST_FLOW_OK);
      EXPECT_EQ(Info()->is_dense, is_dense) << settings << " " << dense;
    }
  }
}

TEST_F(Filter, CountsOnThroughAChangeOfItsSettings) {
  Start("invalid=remove max-range=1", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  std::vector<std::uint8_t> far_away;
  ByteWriter w(&far_away);
  for (int i = 0; i < 6; ++i) w.LeF32(7);
  for (const double range : {1.0, 2.0, 3.0}) {
    g_object_set(h_->element, "max-range", range, nullptr);
    ASSERT_EQ(Push(far_away), GST_FLOW_OK);
  }
  EXPECT_EQ(test::StatOf(h_->element, "points-removed"), 6U);
}

TEST_F(Filter, SendsCapsOnceWhileTheyStayTheSame) {
  Start("", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Push(std::vector<std::uint8_t>(12, 1)), GST_FLOW_OK);
  int caps = 0;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    caps += GST_EVENT_TYPE(event.get()) == GST_EVENT_CAPS ? 1 : 0;
  EXPECT_EQ(caps, 1);
}

// When a pipeline stops, its elements stop one after another, beginning with the sink. Upstream
// elements may still push meanwhile.
TEST_F(Filter, ASinkThatStopsIsNoError) {
  Start("", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1));
  gst_pad_set_active(h_->sinkpad, FALSE);
  EXPECT_EQ(Push(std::vector<std::uint8_t>(12)), GST_FLOW_FLUSHING);
}

TEST_F(Filter, ACloudOfWhichNothingIsLeftIsAGap) {
  Start("invalid=remove max-range=1", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  std::vector<std::uint8_t> near_and_far;
  ByteWriter w(&near_and_far);
  for (const float v : {0.5F, 0.0F, 0.0F, 5.0F, 0.0F, 0.0F}) w.LeF32(v);
  ASSERT_EQ(Push(near_and_far), GST_FLOW_OK);
  EXPECT_EQ(Info()->width, 1U);
  EXPECT_TRUE(Info()->is_dense);
  std::vector<std::uint8_t> far_away;
  ByteWriter v(&far_away);
  for (int i = 0; i < 6; ++i) v.LeF32(7);
  ASSERT_EQ(Push(far_away), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 1U);
  int gaps = 0;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    gaps += GST_EVENT_TYPE(event.get()) == GST_EVENT_GAP ? 1 : 0;
  EXPECT_EQ(gaps, 1);
  EXPECT_EQ(test::StatOf(h_->element, "points-removed"), 3U);
}

TEST_F(Filter, ASliceBetweenTheColumnsThatStayIsAGap) {
  Start("column-step=4", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  ASSERT_EQ(Push(std::vector<std::uint8_t>(24, 1), 4), GST_FLOW_OK);
  ASSERT_EQ(Push(std::vector<std::uint8_t>(24, 1), 6), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 1U);
  EXPECT_EQ(Info()->width, 1U);
}

TEST_F(Filter, CountsOverChangesOfItsSettings) {
  Start("apply-pose=true", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  const std::vector<std::uint8_t> points(24, 1);
  ASSERT_EQ(Push(points), GST_FLOW_OK);
  g_object_set(h_->element, "column-step", 2, nullptr);
  ASSERT_EQ(Push(points), GST_FLOW_OK);
  EXPECT_EQ(test::StatOf(h_->element, "clouds-without-pose"), 2U);
  g_object_set(h_->element, "apply-pose", FALSE, "column-step", 1, "min-range", 1.0, nullptr);
  ASSERT_EQ(Push(points), GST_FLOW_OK);
  EXPECT_EQ(test::StatOf(h_->element, "points-removed"), 2U);
  g_object_set(h_->element, "min-range", 0.0, nullptr);
  ASSERT_EQ(Push(points), GST_FLOW_OK);
  EXPECT_EQ(test::StatOf(h_->element, "points-removed"), 2U);
  EXPECT_EQ(test::StatOf(h_->element, "clouds-without-pose"), 2U);
}

TEST_F(Filter, PutsCloudsWhereTheirPoseSays) {
  Start("apply-pose=true transform=0,0,100,0,0,0", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  std::vector<std::uint8_t> points;
  ByteWriter w(&points);
  for (const float v : {1.0F, 2.0F, 3.0F, 0.0F, 0.0F, 0.0F}) w.LeF32(v);
  ASSERT_EQ(Push(points), GST_FLOW_OK);  // this cloud has no pose
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 0U);
  GstBuffer* buffer = gst_buffer_new_memdup(points.data(), points.size());
  const GstLidarPose pose{{10, 20, 30}, {0, 0, 1, 0}, GST_LIDAR_TRACKING_OK, {}};
  gst_lidar_buffer_set_pose(buffer, &pose);
  ASSERT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(h_.get()));
  std::array<float, 6> moved{};
  ASSERT_EQ(gst_buffer_extract(out.get(), 0, moved.data(), sizeof moved), sizeof moved);
  EXPECT_EQ(moved, (std::array<float, 6>{9, 18, 133, 0, 0, 0}));
  GstLidarPose left{};
  EXPECT_FALSE(gst_lidar_buffer_get_pose(out.get(), &left));
  EXPECT_EQ(test::StatOf(h_->element, "clouds-without-pose"), 1U);
}

TEST_F(Filter, NoGapComesBeforeTheCaps) {
  Start("", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  ASSERT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_gap(0, GST_SECOND)));
  ASSERT_EQ(Push(std::vector<std::uint8_t>(24)), GST_FLOW_OK);
  ASSERT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_gap(0, GST_SECOND)));
  std::vector<std::string> names;
  while (const lidar::gst::EventPtr event{gst_harness_try_pull_event(h_.get())})
    names.emplace_back(GST_EVENT_TYPE_NAME(event.get()));
  EXPECT_EQ(names, (std::vector<std::string>{"stream-start", "caps", "segment", "gap"}));
}

TEST_F(Filter, HoldsTagsBackThroughAFlushUntilTheFirstCloud) {
  Start("", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  gst_harness_push_event(h_.get(), gst_event_new_tag(gst_tag_list_new_empty()));
  test::Flush(h_.get());
  ASSERT_EQ(Push(std::vector<std::uint8_t>(24)), GST_FLOW_OK);
  std::vector<std::string> names;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    names.emplace_back(GST_EVENT_TYPE_NAME(event.get()));
  EXPECT_EQ(names, (std::vector<std::string>{"stream-start", "flush-start", "flush-stop", "caps",
                                             "tag", "segment"}));
}

/// Flushes the element when it pushes its tag event, which is in the middle of the events that it
/// pushes.
GstPadProbeReturn FlushAtTags(GstPad*, GstPadProbeInfo* info, gpointer harness) {
  if (GST_EVENT_TYPE(gst_pad_probe_info_get_event(info)) != GST_EVENT_TAG) return GST_PAD_PROBE_OK;
  gst_harness_push_event(static_cast<GstHarness*>(harness), gst_event_new_flush_start());
  gst_harness_push_event(static_cast<GstHarness*>(harness), gst_event_new_flush_stop(TRUE));
  return GST_PAD_PROBE_REMOVE;
}

TEST_F(Filter, MayBeFlushedByWhatItsEventsCause) {
  Start("", CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  gst_harness_push_event(h_.get(), gst_event_new_tag(gst_tag_list_new_empty()));
  gst_harness_push_event(h_.get(), test::NewSegment());
  gst_pad_add_probe(h_->sinkpad, GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM, FlushAtTags, h_.get(),
                    nullptr);
  Push(std::vector<std::uint8_t>(24));
  gst_harness_push_event(h_.get(), test::NewSegment());
  EXPECT_EQ(Push(std::vector<std::uint8_t>(24)), GST_FLOW_OK);
}

TEST_F(Filter, ABoxBeginsBelowItsEndAlongEachAxis) {
  const std::string caps = CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1);
  for (const char* box : {"5,0,0,1,1,1", "0,5,0,1,1,1", "0,0,5,1,1,1"}) {
    Start(std::string("crop-box=") + box, caps);
    EXPECT_NE(Error(), "") << box;
  }
  Start("crop-box=1,1,1,1,1,1", caps);
  EXPECT_EQ(Error(), "");
}

TEST_F(Filter, SaysWhatIsWrong) {
  const std::string caps = CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1);
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"transform=1,2,3", "transform must be 16 numbers, or x, y, z, roll, pitch, yaw"},
      {"crop-box=1,2,3", "crop-box must be six numbers: the least x, y, z, then the largest"},
      {"crop-box=1,2,3,4,5,6,7",
       "crop-box must be six numbers: the least x, y, z, then the largest"},
      {"crop-box=5,0,0,1,1,1", "crop-box must be six numbers: the least x, y, z, then the largest"},
      {"apply-pose=true target-frame=map", "apply-pose and target-frame cannot be set together"},
      {"fields=x,q", "there is no field q; the cloud has x:F32:0,y:F32:4,z:F32:8"},
      {"fields=x,x", "there are two fields x"},
      {"fields=x max-range=3",
       "these settings need x, y and z as F32 side by side, but the fields are x:F32:0"},
  };
  for (const auto& [properties, why] : wrong) {
    Start(properties, caps);
    EXPECT_EQ(Error(), "These clouds cannot be filtered: " + why + ".");
    EXPECT_NE(Push(std::vector<std::uint8_t>(12)), GST_FLOW_OK);
  }
  Start("", caps);
  EXPECT_EQ(Push(std::vector<std::uint8_t>(13)), GST_FLOW_ERROR);
}

}  // namespace
}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that each property has an effect, and that each counter counts.
#include <gtest/gtest.h>

#include <set>

#include "src/base/byte_writer.h"
#include "tests/support/own_properties.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

constexpr const char* kCaps =
    "application/x-pointcloud2,width=4,height=2,point-step=13,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:U8:12\",framerate=10/1,frame-id=lidar";

struct Effect {
  const char* element;  // the element, with the properties without which there is no effect
  const char* property;
  const char* value;
};

/// Returns a cloud with a pose. Its eight points are 1 to 8 m away.
gst::BufferPtr Cloud() {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (int i = 1; i <= 8; ++i) {
    for (const float v : {static_cast<float>(i), 0.0F, 0.0F}) w.LeF32(v);
    w.U8(static_cast<std::uint8_t>(i));
  }
  gst::BufferPtr cloud(gst_buffer_new_memdup(bytes.data(), bytes.size()));
  GST_BUFFER_PTS(cloud.get()) = 0;
  GST_BUFFER_DURATION(cloud.get()) = 100 * GST_MSECOND;
  const GstLidarSlice whole{0, 0, 1, 0};
  gst_lidar_buffer_set_slice(cloud.get(), &whole);
  const GstLidarPose pose{{1, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  gst_lidar_buffer_set_pose(cloud.get(), &pose);
  return cloud;
}

Lines TraceOf(const Effect& effect, bool with_property) {
  const gst::ElementPtr element(gst_parse_launch(effect.element, nullptr));
  const Harness h(gst_harness_new_with_element(element.get(), "sink", "src"));
  RunTrace trace(h.get());
  if (with_property)
    gst_util_set_object_arg(G_OBJECT(element.get()), effect.property, effect.value);
  trace.Begin(kCaps);
  for (int i = 0; i < 2; ++i) gst_pad_push(h->srcpad, Cloud().release());
  return trace.Take();
}

const Effect kEffects[] = {
    {"pointcloudfilter", "fields", "x,y,z"},
    {"pointcloudfilter", "beam-step", "2"},
    {"pointcloudfilter", "column-step", "2"},
    {"pointcloudfilter", "min-range", "1.5"},
    {"pointcloudfilter", "max-range", "3"},
    {"pointcloudfilter", "apply-pose", "true"},
    {"pointcloudfilter", "target-frame", "map"},
    {"pointcloudfilter", "frame-id", "os"},
    {"pointcloudfilter target-frame=map", "tf-timeout", "1"},
    {"pointcloudfilter", "transform", "1,0,0,0,0,0"},
    {"pointcloudfilter", "crop-box", "2,-1,-1,5,1,1"},
    {"pointcloudfilter crop-box=2,-1,-1,5,1,1", "crop-inside", "true"},
    {"pointcloudfilter", "voxel-size", "10"},
    {"pointcloudfilter max-range=3", "invalid", "nan"},
    {"pointcloudparse", "framerate", "20/1"},
    {"scanassembler", "max-wait", "1"},
    {"pcdenc", "binary", "false"},
    {"plyenc", "binary", "false"},
};

class EachProperty : public ::testing::TestWithParam<Effect> {};
TEST_P(EachProperty, ChangesWhatComesOutOrIsSaid) {
  EXPECT_NE(TraceOf(GetParam(), true), TraceOf(GetParam(), false)) << GetParam().property;
}
INSTANTIATE_TEST_SUITE_P(Of, EachProperty, ::testing::ValuesIn(kEffects));

TEST(Properties, AreAllInTheTable) {
  std::set<std::string> tried;
  std::set<std::string> elements;
  for (const Effect& effect : kEffects) {
    const std::string text = effect.element;
    const std::string name = text.substr(0, text.find(' '));
    tried.insert(name + " " + effect.property);
    elements.insert(name);
  }
  for (const std::string& element : elements)
    for (const std::string& name : OwnWritableProperties(element))
      EXPECT_EQ(tried.count(element + " " + name), 1U) << element << " " << name;
}

TEST(Properties, OfAFilterTakeEffectWhileItPlays) {
  for (const Effect& effect : kEffects) {
    if (std::string(effect.element).rfind("pointcloudfilter", 0) != 0) continue;
    const gst::ElementPtr element(gst_parse_launch(effect.element, nullptr));
    const Harness h(gst_harness_new_with_element(element.get(), "sink", "src"));
    RunTrace trace(h.get());
    trace.Begin(kCaps);
    gst_pad_push(h->srcpad, Cloud().release());
    trace.Take();
    gst_pad_push(h->srcpad, Cloud().release());
    Lines before = trace.Take();
    gst_util_set_object_arg(G_OBJECT(element.get()), effect.property, effect.value);
    gst_pad_push(h->srcpad, Cloud().release());
    Lines after = trace.Take();
    // The statistics, which count the clouds.
    for (Lines* lines : {&before, &after}) lines->pop_back();
    EXPECT_NE(after, before) << effect.property;
  }
}

}  // namespace
}  // namespace lidar::test

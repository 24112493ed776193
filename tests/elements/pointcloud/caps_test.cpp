// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of caps that an element refuses. They cause one error with the reason, even if they are
// sent repeatedly. If accepted caps come in between, they cause another error.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "gst/common/refs.h"
#include "tests/support/element_bus.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

class RefusedCapsOf : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, RefusedCapsOf,
                         ::testing::Values("pointcloudparse", "scanassembler", "pcdenc", "plyenc",
                                           "pointcloudview"));

constexpr const char* kCloud = "application/x-pointcloud2,point-step=16,width=10,height=1,";

/// Pushes three buffers with the caps `caps`. Returns the errors that the element posts.
std::vector<std::string> ErrorsOf(const char* element, const std::string& caps) {
  const test::Harness h(gst_harness_new(element));
  const test::ElementBus bus(h->element);
  gst_harness_set_src_caps_str(h.get(), caps.c_str());
  for (int i = 0; i < 3; ++i)
    EXPECT_NE(gst_harness_push(h.get(), gst_buffer_new_allocate(nullptr, 160, nullptr)),
              GST_FLOW_OK);
  return bus.Texts(GST_MESSAGE_ERROR);
}

TEST_P(RefusedCapsOf, AnElementAreOneErrorThatNamesTheReason) {
  const std::array<std::array<std::string, 2>, 2> cases = {
      {{"is-bigendian=true,fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"", "little-endian"},
       {"fields=(string)\"x:F16:0,y:F32:4,z:F32:8\"", "x:F16:0"}}};
  for (const auto& [caps, why] : cases) {
    const auto errors = ErrorsOf(GetParam(), kCloud + caps);
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_NE(errors[0].find(why), std::string::npos) << errors[0];
  }
}

class CapsRefusedAgain : public RefusedCapsOf {};
INSTANTIATE_TEST_SUITE_P(All, CapsRefusedAgain,
                         ::testing::Values("pointcloudparse", "scanassembler", "pcdenc", "plyenc",
                                           "pointcloudfilter", "pointcloudview"));

TEST_P(CapsRefusedAgain, AreAnotherErrorAfterAcceptedCaps) {
  const test::Harness h(gst_harness_new(GetParam()));
  const test::ElementBus bus(h->element);
  for (const char* type : {"F16", "F32", "F16"})
    gst_harness_set_src_caps_str(
        h.get(),
        (std::string(kCloud) + "fields=(string)\"x:" + type + ":0,y:F32:4,z:F32:8\"").c_str());
  EXPECT_EQ(bus.Texts(GST_MESSAGE_ERROR).size(), 2U);
}

}  // namespace
}  // namespace lidar::gst

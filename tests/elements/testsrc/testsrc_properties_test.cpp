// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that each property of lidartestsrc has an effect.
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/files.h"
#include "tests/support/own_properties.h"
#include "tests/support/run_trace.h"

namespace lidar::test {
namespace {

const std::string kDrivenWay =
    ::testing::TempDir() + "testsrc_way_" + std::to_string(getpid()) + ".tum";

struct SourceEffect {
  const char* property;
  std::string value;
};

const SourceEffect kSourceEffects[] = {
    {"model", "vlp-16"},
    {"mode", "512x20"},
    {"scene", "tunnel"},
    {"speed", "5"},
    {"roughness", "0"},
    {"noise", "0.1"},
    {"mixed-pixels", "true"},
    {"seed", "7"},
    {"slices-per-scan", "1"},
    {"channels", "ring"},
    {"trajectory-location", kDrivenWay},
    {"imu", "true"},
    {"is-live", "true"},
};

/// Returns everything that a source outputs and writes to files during a few slices.
Lines LinesOf(const std::string& properties) {
  const std::string launch = "lidartestsrc num-buffers=4 " + properties;
  const gst::ElementPtr element(gst_parse_launch(launch.c_str(), nullptr));
  const Harness h(gst_harness_new_with_element(element.get(), nullptr, "src"));
  gst_harness_use_systemclock(h.get());
  RunTrace trace(h.get());
  trace.TakeAddedPads();
  SetPlaying(h.get());
  for (bool ended = false; !ended;) {
    const gst::EventPtr event(gst_harness_pull_event(h.get()));
    if (!event) break;
    ended = GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
  }
  Lines lines = trace.Take();
  lines.push_back("latency " + std::to_string(gst_harness_query_latency(h.get())));
  trace.Stop();
  lines.push_back(ReadFile(kDrivenWay));
  std::filesystem::remove(kDrivenWay);
  return lines;
}

class SourceEachProperty : public ::testing::TestWithParam<SourceEffect> {};
TEST_P(SourceEachProperty, ChangesWhatComesOut) {
  static const Lines usual = LinesOf("model=os0-32 mode=512x10");
  const auto& [property, value] = GetParam();
  const Lines changed = LinesOf("model=os0-32 mode=512x10 " + std::string(property) + "=" + value);
  EXPECT_TRUE(HasLine(changed, "event eos"));
  EXPECT_NE(changed, usual) << property;
}
INSTANTIATE_TEST_SUITE_P(Of, SourceEachProperty, ::testing::ValuesIn(kSourceEffects));

TEST(SourceProperties, AreAllInTheTable) { ExpectEachPropertyIn(kSourceEffects, "lidartestsrc"); }

}  // namespace
}  // namespace lidar::test

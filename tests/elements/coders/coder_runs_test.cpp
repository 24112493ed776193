// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that a coder that was stopped behaves like a new coder when it starts again.
#include <gtest/gtest.h>

#include <regex>

#include "tests/elements/coders/coder_harness.h"
#include "tests/elements/coders/stopped_clock.h"
#include "tests/support/run_trace.h"

namespace lidar::gst {
namespace {

using test::Lines;
using test::RunTrace;

constexpr guint kRunSlices = 4;
constexpr guint kRunColumns = 512 / kRunSlices;

CapsPtr RoomCaps() { return CapsPtr(OrganisedInfo(test::RoomSensor(), kRunColumns).ToCaps()); }

/// Pushes the slices of two and a half scans.
void PushScans(GstHarness* h, guint first_scan) {
  for (guint i = 0; i < 5 * kRunSlices / 2; ++i) {
    const guint index = i % kRunSlices;
    gst_pad_push(h->srcpad, OrganisedBuffer(test::RoomSensor(), kRunColumns,
                                            {first_scan + i / kRunSlices, index, kRunSlices,
                                             kRunColumns * index}));
  }
}

void Acknowledge(GstHarness* h, guint receiver, guint scan) {
  GstLidarSlicesReceived received{receiver, kRunSlices, {}};
  for (guint i = 0; i < kRunSlices; ++i) received.slices[i] = {scan, i};
  gst_pad_push_event(h->sinkpad, gst_lidar_event_new_slices_received(&received));
}

/// Creates much state in an encoder: references, a target bitrate, warnings, counts, and an
/// incomplete scan.
void EncodeMuch(GstHarness* h) {
  PushScans(h, 0);
  Acknowledge(h, 1, 1);
  PushScans(h, 3);
  GstLidarTargetBitrate target{};
  target.bitrate = 150'000;
  gst_pad_push_event(h->sinkpad, gst_lidar_event_new_target_bitrate(&target));
  PushScans(h, 6);
}

/// Creates much state in a decoder: references for later slices, counts, and a damaged slice.
void DecodeMuch(GstHarness* h, const std::vector<BufferPtr>& slices) {
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (i % 7 == 5) continue;  // this slice is lost; slices that refer to it are dropped
    BufferPtr slice(gst_buffer_copy_deep(slices[i].get()));
    if (i == 3) gst_buffer_resize(slice.get(), 0, 20);
    gst_pad_push(h->srcpad, slice.release());
  }
}

/// Removes the values of durations and ages, because they depend on the clock.
Lines WithoutClock(Lines lines) {
  static const std::regex kClock("(encode-time|decode-time|age)=\\([a-z0-9]+\\)[0-9]+");
  for (std::string& line : lines) line = std::regex_replace(line, kClock, "$1");
  return lines;
}

/// Runs an element twice, and expects that both runs are equal.
template <class Run>
void ExpectTheSameAgain(GstHarness* h, const GstCaps* caps, GstState between, const Run& run) {
  RunTrace trace(h);
  const StringPtr text(gst_caps_to_string(caps));
  trace.Begin(text.get());
  run();
  const Lines first = WithoutClock(trace.Take());
  EXPECT_GE(first.size(), 10U);
  gst_element_set_state(h->element, between);
  trace.Take();
  trace.Begin(text.get());
  run();
  const Lines second = WithoutClock(trace.Take());
  EXPECT_EQ(second, first);
}

class SecondRunOf : public ::testing::TestWithParam<CoderCase> {
 protected:
  static Harness Alone(const std::string& element) {
    const ElementPtr made(gst_parse_launch(element.c_str(), nullptr));
    return Harness(gst_harness_new_with_element(made.get(), "sink", "src"));
  }
  static std::string EncoderText(const char* more = "") {
    return std::string(GetParam().encoder) + " max-error=0.05 error-check=3 " +
           (std::string(GetParam().encoder).rfind("lidarenc", 0) == 0
                ? "key-interval=0 fields=ring keep-order=true "
                : "") +
           more;
  }

 private:
  const test::StoppedClock clock_;
};

TEST_P(SecondRunOf, AnEncoderIsAsItsFirst) {
  for (const GstState between : {GST_STATE_READY, GST_STATE_NULL}) {
    const Harness h = Alone(EncoderText());
    ExpectTheSameAgain(h.get(), RoomCaps().get(), between, [&] { EncodeMuch(h.get()); });
  }
}

TEST_P(SecondRunOf, ADecoderIsAsItsFirst) {
  std::vector<BufferPtr> slices;
  CapsPtr coded;
  {
    const Harness h = Alone(EncoderText());
    SetCaps(h.get(), OrganisedInfo(test::RoomSensor(), kRunColumns));
    EncodeMuch(h.get());
    while (GstBuffer* slice = gst_harness_try_pull(h.get())) slices.emplace_back(slice);
    coded.reset(gst_pad_get_current_caps(h->sinkpad));
  }
  ASSERT_GE(slices.size(), 20U);
  for (const GstState between : {GST_STATE_READY, GST_STATE_NULL}) {
    const Harness h = Alone(GetParam().decoder);
    ExpectTheSameAgain(h.get(), coded.get(), between, [&] { DecodeMuch(h.get(), slices); });
  }
}
INSTANTIATE_TEST_SUITE_P(All, SecondRunOf, ::testing::ValuesIn(OurCoders()),
                         [](const auto& coder) { return coder.param.name; });

}  // namespace
}  // namespace lidar::gst

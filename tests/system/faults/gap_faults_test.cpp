// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the elements in real time over links with gaps. The traces are short versions of those that
// the simulation uses for hours.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "src/link/trace_maker.h"
#include "tests/system/faults/fixture.h"

namespace lidar::test {
namespace {

constexpr int kScansPerSecond = 10;
constexpr seconds kTraceLength{10};
constexpr seconds kWithGaps{13};

std::string Drive() {
  return link::MakeDriveTrace(
      {3, kTraceLength, DataRate::BitsPerSecond(6e6), DataRate::BitsPerSecond(2e5)});
}
std::string Gaps(milliseconds gap, milliseconds every) {
  return link::MakeGapTrace(
      {DataRate::BitsPerSecond(4e6), DataRate::BitsPerSecond(2e5), gap, every, kTraceLength});
}

struct GapCase {
  const char* name;
  std::string trace;
  double complete;  // least fraction of the scans that must be complete
  bool srtp = false;
};
void PrintTo(const GapCase& c, std::ostream* out) { *out << c.name; }

class Gap : public Faults, public ::testing::WithParamInterface<GapCase> {};
TEST_P(Gap, CostsWhatItTookAndTheStreamIsBackAtOnce) {
  if (GetParam().srtp) options_ = "srtp-key=" + std::string(60, '5');
  Start();
  const std::uint64_t before = receiver_->accounts().complete;
  // The trace may end in a gap, so capacity is added after it.
  link_.SetCapacity(GetParam().trace + "13 6\n");
  std::this_thread::sleep_for(kWithGaps);
  ExpectRecovery(GetParam().name, seconds(1));
  const auto complete = static_cast<double>(receiver_->accounts().complete - before);
  EXPECT_GE(complete, GetParam().complete * kScansPerSecond * kWithGaps.count());
  std::printf("  %.0f of %d scans complete\n", complete,
              static_cast<int>(kScansPerSecond * kWithGaps.count()));
  // The link cannot find slices in encrypted packets, so it has no counts to compare with.
  if (!GetParam().srtp) ExpectBooksAgree();
  EXPECT_EQ(receiver_->foreign(), 0U);
  EXPECT_EQ(sender_->pipeline().Error() + receiver_->pipeline().Error(), "");
}
INSTANTIATE_TEST_SUITE_P(
    Traces, Gap,
    ::testing::Values(GapCase{"a drive with handovers", Drive(), 0.6},
                      GapCase{"a drive with handovers, SRTP", Drive(), 0.6, true},
                      GapCase{"gap of 100 ms every 0.6 s",
                              Gaps(milliseconds(100), milliseconds(600)), 0.6},
                      GapCase{"gap of 1 s every 3 s", Gaps(seconds(1), seconds(3)), 0.4}));

TEST_F(Faults, ALinkOfZeroCapacityIsWaitedFor) {
  Start();
  const std::uint64_t memory = AllocatedBytes();
  link_.SetCapacity("0 6\n0.5 0\n12.5 6\n");
  std::this_thread::sleep_for(milliseconds(12'500));
  ExpectRecovery("no capacity for 12 s", seconds(2));
  EXPECT_GT(sender_->pipeline().Stat("net", "feedback-timeouts"), 0U);
  EXPECT_LT(AllocatedBytes(), memory + (20U << 20));
  ExpectBooksAgree();
}

/// Streams of a LiDAR and of a camera that share a screamsink.
struct TwoStreams {
  TwoStreams()
      : receiver("screamsrc name=net port=" + std::to_string(port) +
                 " pt-map=\"application/x-rtp-pt-map,96=(string)\\\"application/x-rtp,"
                 "media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO\\\","
                 "97=(string)\\\"application/x-rtp,media=video,clock-rate=90000,"
                 "encoding-name=H264\\\"\" "
                 "net. ! application/x-rtp,media=application ! rtplidardepay name=depay ! "
                 "dracodec ! fakesink sync=false async=false "
                 "net. ! application/x-rtp,media=video ! rtph264depay ! h264parse ! "
                 "fakesink name=video sync=false async=false"),
        link(port),
        sender("screamsink name=net max-bitrate=20000000 sink_0::priority=2 port=" +
               std::to_string(link.port()) +
               " lidartestsrc is-live=true model=os0-32 mode=512x10 ! dracoenc max-error=0.05 ! "
               "rtplidarpay ! net.sink_0 "
               "videotestsrc name=camera is-live=true ! "
               "video/x-raw,width=320,height=240,framerate=15/1 ! queue ! "
               "openh264enc complexity=low rate-control=bitrate gop-size=30 ! "
               "bitrateadapter min=100000 max=2000000 ! h264parse ! "
               "rtph264pay pt=97 config-interval=-1 ! net.sink_1") {}
  void Play() {
    receiver.SetState(GST_STATE_PLAYING);
    sender.SetState(GST_STATE_PLAYING);
  }
  std::uint64_t scans() const { return receiver.Stat("depay", "scans-complete"); }
  std::uint64_t frames() const { return receiver.Stat("video", "rendered"); }

  std::uint16_t port = FreePort();
  Pipeline receiver;
  FaultLink link;
  Pipeline sender;
};

TEST(GapFaults, ACameraThatStopsInAGapLeavesTheLidarItsShareAndComesBack) {
  TwoStreams streams;
  streams.Play();
  std::this_thread::sleep_for(seconds(3));
  EXPECT_GT(streams.frames(), 10U);
  streams.link.SetCapacity(Gaps(milliseconds(300), seconds(2)));
  // The link is within the first gap after this time.
  std::this_thread::sleep_for(milliseconds(1'900));
  const auto camera = streams.sender.Child("camera");
  gst_element_set_state(camera.get(), GST_STATE_PAUSED);
  const std::uint64_t scans = streams.scans();
  std::this_thread::sleep_for(seconds(4));
  const std::uint64_t frames = streams.frames();
  EXPECT_GE(streams.scans() - scans, 20U);
  gst_element_set_state(camera.get(), GST_STATE_PLAYING);
  std::this_thread::sleep_for(seconds(3));
  EXPECT_GE(streams.frames() - frames, 15U);
  EXPECT_EQ(streams.sender.Error() + streams.receiver.Error(), "");
}

}  // namespace
}  // namespace lidar::test

// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests faults of the machine at one end. This end runs in a process of its own, so that the fault
// does not affect the test.
#include <gtest/gtest.h>

#include <cstdio>
#include <thread>

#include "tests/system/faults/child_end.h"
#include "tests/system/faults/ends.h"
#include "tests/system/faults/fault_link.h"

namespace lidar::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Expects that every slice that was sent passed the link and was received.
void ExpectNothingLost(ChildEnd* sender, ChildEnd* receiver, const FaultLink& link) {
  std::this_thread::sleep_for(milliseconds(500));
  const ChildReport s = sender->Finish();
  std::this_thread::sleep_for(milliseconds(300));
  const ChildReport r = receiver->Report();
  EXPECT_EQ(r.received, s.sent);
  EXPECT_EQ(r.lost + r.bad, 0U);
  EXPECT_EQ(r.received, link.counts().slices_whole);
  EXPECT_EQ(r.clouds, r.received);
}

struct Step {
  const char* side;
  int seconds;
};
class ClockStep : public ::testing::TestWithParam<Step> {};
TEST_P(ClockStep, OfAnHourCostsNothing) {
  const std::uint16_t port = FreePort();
  FaultLink link(port);
  ChildEnd receiver("receive", port);
  ChildEnd sender("send", link.port());
  ASSERT_NE(receiver.NextCloud(seconds(10)), milliseconds::max());
  std::this_thread::sleep_for(milliseconds(500));
  ChildEnd& end = std::string(GetParam().side) == "receiver" ? receiver : sender;
  const std::int64_t before = end.Report().wall_clock;
  end.StepClock(GetParam().seconds);
  // Checks that the step has changed the clock of the end.
  EXPECT_NEAR(static_cast<double>(end.Report().wall_clock - before), 1e6 * GetParam().seconds, 1e6);
  const auto time = receiver.NextCloud(seconds(3));
  EXPECT_LT(time, milliseconds(500));
  std::printf("recovery: clock of the %-8s steps by %+5d s %12lld ms\n", GetParam().side,
              GetParam().seconds, static_cast<long long>(time.count()));
  const std::uint64_t reports = sender.Report().feedback;
  std::this_thread::sleep_for(seconds(2));
  EXPECT_GT(sender.Report().feedback, reports + 20);
  ExpectNothingLost(&sender, &receiver, link);
  EXPECT_TRUE(sender.Close());
  EXPECT_TRUE(receiver.Close());
}
INSTANTIATE_TEST_SUITE_P(EitherSide, ClockStep,
                         ::testing::Values(Step{"receiver", 3'600}, Step{"receiver", -3'600},
                                           Step{"sender", 3'600}, Step{"sender", -3'600}));

TEST(ClockStepInAGap, CostsNoMoreThanTheGap) {
  for (const int step : {3'600, -3'600}) {
    const std::uint16_t port = FreePort();
    FaultLink link(port);
    ChildEnd receiver("receive", port);
    ChildEnd sender("send", link.port());
    ASSERT_NE(receiver.NextCloud(seconds(10)), milliseconds::max());
    std::this_thread::sleep_for(milliseconds(500));
    link.SetCapacity("0 0\n1 6\n");
    std::this_thread::sleep_for(milliseconds(500));
    receiver.StepClock(step);
    sender.StepClock(-step);
    std::this_thread::sleep_for(milliseconds(500));
    const auto time = receiver.NextCloud(seconds(3));
    EXPECT_LT(time, seconds(1));
    std::printf("recovery: both clocks step in a gap of 1 s %24lld ms\n",
                static_cast<long long>(time.count()));
    const std::uint64_t reports = sender.Report().feedback;
    std::this_thread::sleep_for(seconds(2));
    EXPECT_GT(sender.Report().feedback, reports + 20);
    EXPECT_TRUE(sender.Close());
    EXPECT_TRUE(receiver.Close());
  }
}

struct Flood {
  const char* name;
  bool is_rtp;
  bool srtp;
};
/// Floods the receiver with garbage for ten seconds, and checks how much CPU time and memory it
/// uses.
void Suffer(FaultLink* link, ChildEnd* receiver, const Flood& flood) {
  Fault fault;
  fault.garbage_ratio = 100;
  fault.valid_garbage = flood.is_rtp;
  const std::uint64_t packets = link->counts().packets;
  const auto cpu = receiver->CpuTime();
  const auto start = std::chrono::steady_clock::now();
  link->Set(fault);
  std::this_thread::sleep_for(seconds(10));
  link->Set({});
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  const double load = std::chrono::duration<double>(receiver->CpuTime() - cpu) / time;
  const auto memory = static_cast<double>(receiver->PeakMemory());
  std::printf("garbage x100 (%s): %.0f real and %.0f other packets/s, %.0f %% of a core, %.0f MB\n",
              flood.name, static_cast<double>(link->counts().packets - packets) / time.count(),
              static_cast<double>(link->counts().garbage) / time.count(), 100 * load, memory / 1e6);
  EXPECT_GT(link->counts().garbage, 50 * (link->counts().packets - packets));
  EXPECT_LT(load, 1);
  EXPECT_LT(memory, 100e6);
}

class Garbage : public ::testing::TestWithParam<Flood> {};
TEST_P(Garbage, AtAHundredTimesTheRateCostsLessThanACoreAndHidesNothing) {
  const std::uint16_t port = FreePort();
  FaultLink link(port);
  const std::string options = GetParam().srtp ? "srtp-key=" + std::string(60, '5') : "";
  ChildEnd receiver("receive", port, options);
  SentSlices sent;
  SendingEnd sender(&sent, link.port(), options);
  sender.pipeline().SetState(GST_STATE_PLAYING);
  ASSERT_NE(receiver.NextCloud(seconds(10)), milliseconds::max());
  std::this_thread::sleep_for(seconds(1));
  Suffer(&link, &receiver, GetParam());
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_TRUE(sender.pipeline().Finish(seconds(5)));
  std::this_thread::sleep_for(milliseconds(300));
  const ChildReport r = receiver.Report();
  std::printf("  %llu slices sent, %llu shown; the kernel dropped %llu datagrams\n",
              static_cast<unsigned long long>(sender.slices_sent()),
              static_cast<unsigned long long>(r.received),
              static_cast<unsigned long long>(r.dropped_by_kernel));
  // The kernel drops datagrams if the receive buffer is full. If it dropped none, the receiver has
  // received each slice.
  if (r.dropped_by_kernel == 0) {
    EXPECT_EQ(r.received, sender.slices_sent());
  }
  EXPECT_GE(static_cast<double>(r.received), 0.9 * static_cast<double>(sender.slices_sent()));
  EXPECT_EQ(r.clouds, r.received);
  EXPECT_TRUE(receiver.Close());
}
INSTANTIATE_TEST_SUITE_P(Floods, Garbage,
                         ::testing::Values(Flood{"random bytes", false, false},
                                           Flood{"RTP of random streams", true, false},
                                           Flood{"random bytes, SRTP", false, true},
                                           Flood{"RTP of random streams, SRTP", true, true}));

/// The elements of a second LiDAR, and their pad of a sink that already plays.
struct Branch {
  explicit Branch(Pipeline* pipeline) : owner(pipeline), net(pipeline->Child("net")) {
    bin = gst_parse_bin_from_description(
        "lidartestsrc is-live=true model=os0-32 mode=512x10 seed=9 ! dracoenc max-error=0.05 ! "
        "rtplidarpay name=second",
        TRUE, nullptr);
    gst_bin_add(GST_BIN(owner->get()), bin);
    pad.reset(gst_element_request_pad_simple(net.get(), "sink_%u"));
    const gst::PadPtr from(gst_element_get_static_pad(bin, "src"));
    gst_pad_link(from.get(), pad.get());
    gst_element_sync_state_with_parent(bin);
  }
  /// Removes the second LiDAR. Returns the number of slices that it has sent.
  std::uint64_t Remove() {
    gst_element_set_state(bin, GST_STATE_PAUSED);
    // Waits, because a slice may still be in the encoder.
    std::this_thread::sleep_for(milliseconds(200));
    const std::uint64_t sent = owner->Stat("second", "slices-sent");
    gst_element_set_state(bin, GST_STATE_NULL);
    gst_element_release_request_pad(net.get(), pad.get());
    gst_bin_remove(GST_BIN(owner->get()), bin);
    return sent;
  }
  Pipeline* owner;
  gst::ElementPtr net;
  GstElement* bin = nullptr;
  gst::PadPtr pad;
};

/// A receiver that adds a depayloader for each new stream.
struct ReceiverOfAll {
  explicit ReceiverOfAll(std::uint16_t port)
      : pipeline("pipeline.( screamsrc name=net eos-on-bye=false port=" + std::to_string(port) +
                 " pt-map=\"application/x-rtp-pt-map,96=(string)\\\"application/x-rtp,"
                 "media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO\\\"\" )") {
    g_signal_connect(pipeline.Child("net").get(), "pad-added",
                     G_CALLBACK(+[](GstElement* element, GstPad* pad, ReceiverOfAll* self) {
                       self->OnPad(GST_BIN(GST_OBJECT_PARENT(element)), pad);
                     }),
                     this);
  }
  void OnPad(GstBin* parent, GstPad* pad) {
    const std::string name = "depay" + std::to_string(streams);
    GstElement* bin = gst_parse_bin_from_description(
        ("rtplidardepay name=" + name + " ! dracodec ! fakesink sync=false async=false").c_str(),
        TRUE, nullptr);
    gst_bin_add(parent, bin);
    gst_element_sync_state_with_parent(bin);
    const gst::PadPtr sink(gst_element_get_static_pad(bin, "sink"));
    gst_pad_link(pad, sink.get());
    ++streams;
  }
  std::uint64_t Stat(int stream, const char* name) const {
    return pipeline.Stat(("depay" + std::to_string(stream)).c_str(), name);
  }
  std::atomic<int> streams{0};
  Pipeline pipeline;
};

TEST(Pads, AddedAndRemovedWhilePlayingDisturbNoOtherStream) {
  const std::uint16_t port = FreePort();
  ReceiverOfAll receiver(port);
  receiver.pipeline.SetState(GST_STATE_PLAYING);
  SentSlices sent;
  SendingEnd sender(&sent, port);
  sender.pipeline().SetState(GST_STATE_PLAYING);
  std::this_thread::sleep_for(seconds(1));
  for (int round = 1; round <= 3; ++round) {
    Branch second(&sender.pipeline());
    for (int i = 0; i < 1'000 && sender.pipeline().Stat("second", "slices-sent") < 60; ++i)
      std::this_thread::sleep_for(milliseconds(10));
    const std::uint64_t second_sent = second.Remove();
    EXPECT_GE(second_sent, 60U);
    std::this_thread::sleep_for(milliseconds(300));
    ASSERT_EQ(receiver.streams, round + 1);
    EXPECT_EQ(receiver.Stat(round, "slices-received"), second_sent);
  }
  EXPECT_TRUE(sender.pipeline().Finish(seconds(5)));
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(receiver.Stat(0, "slices-received"), sender.slices_sent());
  EXPECT_EQ(receiver.Stat(0, "slices-lost"), 0U);
  EXPECT_EQ(sender.pipeline().Error() + receiver.pipeline.Error(), "");
}

}  // namespace
}  // namespace lidar::test

// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests several streams: their shares of the rate, whose turn it is, frames and late packets.
#include "src/scream/streams.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

class StreamsTest : public ::testing::Test {
 protected:
  StreamId Add(double priority, double min, double max) {
    return streams_.Add({priority, Mbps(min), Mbps(1), Mbps(max)});
  }
  double Target(StreamId id) { return streams_.Find(id)->target_bitrate().bits_per_second() / 1e6; }

  Parameters parameters_;
  Streams streams_{parameters_};
};

TEST_F(StreamsTest, ShareByPriorityAboveTheirMinimum) {
  const StreamId a = Add(3, 1, 100), b = Add(1, 1, 100);
  streams_.Allocate(kStart, Mbps(10));
  EXPECT_NEAR(Target(a), 7, 1e-3);
  EXPECT_NEAR(Target(b), 3, 1e-3);
}

TEST_F(StreamsTest, WhatAFullStreamLeavesGoesToTheOthers) {
  const StreamId a = Add(3, 0, 2), b = Add(1, 0, 100), c = Add(1, 0, 100);
  streams_.Allocate(kStart, Mbps(10));
  EXPECT_NEAR(Target(a), 2, 1e-3);
  EXPECT_NEAR(Target(b), 4, 1e-3);
  EXPECT_NEAR(Target(c), 4, 1e-3);
}

TEST_F(StreamsTest, AStarvedStreamKeepsItsMinimum) {
  const StreamId a = Add(1, 2, 100), b = Add(100, 1, 100);
  streams_.Allocate(kStart, Mbps(1));
  EXPECT_NEAR(Target(a), 2, 1e-9);
  EXPECT_NEAR(Target(b), 1, 1e-9);
}

TEST_F(StreamsTest, ASilentStreamLeavesItsShareToTheOthers) {
  const StreamId a = Add(1, 1, 100), b = Add(1, 1, 100);
  streams_.Allocate(kStart, Mbps(10));
  EXPECT_NEAR(Target(b), 5, 1e-3);
  streams_.Allocate(kStart + 2s, Mbps(10));  // No stream has sent yet, so both may start.
  EXPECT_NEAR(Target(a), 5, 1e-3);
  streams_.Find(a)->OnQueued(kStart + 2s, {1, DataSize::Bytes(1000), true, 0});
  streams_.Allocate(kStart + 2s, Mbps(10));
  EXPECT_NEAR(Target(a), 10, 1e-3);
  EXPECT_NEAR(Target(b), 1, 1e-3);
}

TEST_F(StreamsTest, WhatStreamsNeedComesBeforeTheirShares) {
  const StreamId a = Add(1, 0, 100), b = Add(1, 0, 100);
  streams_.Find(a)->Configure({1, Mbps(0), Mbps(1), Mbps(100), Mbps(6)});
  streams_.Allocate(kStart, Mbps(10));
  EXPECT_NEAR(Target(a), 8, 1e-3);
  EXPECT_NEAR(Target(b), 2, 1e-3);
}

TEST_F(StreamsTest, APathThatCannotCarryWhatStreamsNeedSharesItDownToTheMinima) {
  const StreamId a = Add(1, 1, 100), b = Add(1, 0, 100);
  streams_.Find(a)->Configure({1, Mbps(1), Mbps(1), Mbps(100), Mbps(5)});
  streams_.Find(b)->Configure({1, Mbps(0), Mbps(1), Mbps(100), Mbps(4)});
  streams_.Allocate(kStart, Mbps(5));
  EXPECT_NEAR(Target(a), 3, 1e-3);
  EXPECT_NEAR(Target(b), 2, 1e-3);
  streams_.Allocate(kStart, Mbps(0.5));
  EXPECT_NEAR(Target(a), 1, 1e-3);
  EXPECT_NEAR(Target(b), 0, 1e-3);
}

TEST_F(StreamsTest, TakeTurnsByTheirTargets) {
  const StreamId a = Add(3, 0, 100), b = Add(1, 0, 100);
  streams_.Allocate(kStart, Mbps(8));
  for (int i = 0; i < 400; ++i)
    for (const StreamId id : {a, b})
      streams_.Find(id)->OnQueued(kStart, {1, DataSize::Bytes(1000), false, 0});
  int turns[2] = {0, 0};
  for (int i = 0; i < 100; ++i) {
    const StreamId id = *streams_.Next();
    ++turns[id];
    streams_.OnSent(kStart, id, 1, DataSize::Bytes(1000));
  }
  EXPECT_NEAR(turns[a], 75, 1);
  EXPECT_NEAR(turns[b], 25, 1);
}

TEST_F(StreamsTest, TakeTurnsByTheirTargetsEvenWithOnePacketAtATime) {
  const StreamId a = Add(3, 0, 100), b = Add(1, 0, 100);
  streams_.Allocate(kStart, Mbps(8));
  const auto queue = [&](StreamId id) {
    streams_.OnQueued(streams_.Find(id));
    streams_.Find(id)->OnQueued(kStart, {1, DataSize::Bytes(1000), false, 0});
  };
  queue(a);
  queue(b);
  int turns[2] = {0, 0};
  for (int i = 0; i < 100; ++i) {
    const StreamId id = *streams_.Next();
    ++turns[id];
    streams_.OnSent(kStart, id, 1, DataSize::Bytes(1000));
    queue(id);
  }
  EXPECT_NEAR(turns[a], 75, 1);
  EXPECT_NEAR(turns[b], 25, 1);
}

TEST_F(StreamsTest, ASilentStreamNeedsNothing) {
  const StreamId a = Add(1, 1, 100), b = Add(1, 0, 100), c = Add(3, 0, 100);
  streams_.Find(a)->Configure({1, Mbps(1), Mbps(1), Mbps(100), Mbps(5)});
  streams_.Find(b)->Configure({1, Mbps(0), Mbps(1), Mbps(100), Mbps(4)});
  streams_.Allocate(kStart, Mbps(5));
  for (const StreamId id : {a, c})
    streams_.Find(id)->OnQueued(kStart + 2s, {1, DataSize::Bytes(1000), true, 0});
  streams_.Allocate(kStart + 2s, Mbps(5));
  EXPECT_NEAR(Target(a), 5, 1e-3);
  EXPECT_NEAR(Target(c), 0, 1e-3);
}

TEST_F(StreamsTest, ASilentStreamIsNoPartOfTheirSums) {
  const StreamId a = Add(1, 1, 20);
  streams_.Find(Add(1, 5, 50))->Configure({1, Mbps(5), Mbps(1), Mbps(50), Mbps(8)});
  streams_.Allocate(kStart, Mbps(30));
  EXPECT_NEAR(streams_.needed_bitrate().bits_per_second(), 9e6, 1);
  streams_.Find(a)->OnQueued(kStart + 2s, {1, DataSize::Bytes(1000), true, 0});
  streams_.Allocate(kStart + 2s, Mbps(10));
  EXPECT_NEAR(streams_.min_bitrate().bits_per_second(), 1e6, 1);
  EXPECT_NEAR(streams_.needed_bitrate().bits_per_second(), 1e6, 1);
  EXPECT_NEAR(streams_.max_bitrate().bits_per_second(), 20e6, 1);
  EXPECT_NEAR(streams_.target_bitrate().bits_per_second(), 10e6, 1);
}

TEST_F(StreamsTest, AStrictOneGoesFirstHoweverMuchWaits) {
  const StreamId a = Add(100, 1, 100), b = Add(1, 0, 1);
  StreamConfig audio{1, Mbps(0.1), Mbps(0.1), Mbps(0.2), Mbps(0), true};
  streams_.Find(b)->Configure(audio);
  streams_.Allocate(kStart, Mbps(10));
  EXPECT_NEAR(Target(b), 0.2, 1e-3);
  EXPECT_NEAR(Target(a), 9.8, 1e-3);
  for (int i = 0; i < 100; ++i)
    streams_.Find(a)->OnQueued(kStart, {1, DataSize::Bytes(1000), false, 0});
  for (int i = 0; i < 20; ++i) {
    streams_.OnSent(kStart, a, 1, DataSize::Bytes(1000));
    streams_.OnQueued(streams_.Find(b));
    streams_.Find(b)->OnQueued(kStart, {2, DataSize::Bytes(200), true, 0});
    ASSERT_EQ(streams_.Next(), b);
    streams_.OnSent(kStart, b, 2, DataSize::Bytes(200));
    ASSERT_EQ(streams_.Next(), a);
  }
}

TEST_F(StreamsTest, AStrictOneLeavesTheOthersWhatTheyNeed) {
  const StreamId a = Add(1, 1, 100), b = Add(1, 0, 10);
  streams_.Find(a)->Configure({1, Mbps(1), Mbps(1), Mbps(100), Mbps(4)});
  streams_.Find(b)->Configure({1, Mbps(0.1), Mbps(0.1), Mbps(10), Mbps(0), true});
  streams_.Allocate(kStart, Mbps(6));
  EXPECT_NEAR(Target(a), 4, 1e-3);
  EXPECT_NEAR(Target(b), 2, 1e-3);
}

class StreamTest : public ::testing::Test {
 protected:
  /// Queues a frame of `packets` packets of 1000 bytes.
  void Frame(Time now, int packets, std::uint32_t timestamp) {
    for (int i = 0; i < packets; ++i)
      stream_.OnQueued(now, {1, DataSize::Bytes(1000), i + 1 == packets, timestamp});
  }
  Parameters parameters_;
  Stream stream_{parameters_, {1, Mbps(0), Mbps(4), Mbps(50)}};
};

TEST_F(StreamTest, LateFramesAreDroppedWhole) {
  Frame(kStart, 3, 1);
  Frame(kStart + 100ms, 2, 2);
  EXPECT_EQ(stream_.LatePackets(kStart + 200ms, DataRate::Infinite()), 0U);
  EXPECT_EQ(stream_.LatePackets(kStart + 201ms, DataRate::Infinite()), 3U);
  EXPECT_EQ(stream_.LatePackets(kStart + 301ms, DataRate::Infinite()), 5U);
}

TEST_F(StreamTest, AFrameThatHasBegunGoesOutToItsEnd) {
  Frame(kStart, 3, 1);
  Frame(kStart + 100ms, 2, 2);
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  EXPECT_EQ(stream_.LatePackets(kStart + 301ms, DataRate::Infinite()), 0U);
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  EXPECT_EQ(stream_.LatePackets(kStart + 301ms, DataRate::Infinite()), 2U);
}

/// Scans of four slices. The slices are 25 ms apart, and each has two packets.
class ScanTest : public StreamTest {
 protected:
  void Scan(Time now, std::uint32_t scan) {
    for (std::uint32_t slice = 0; slice < 4; ++slice)
      for (int i = 0; i < 2; ++i)
        stream_.OnQueued(now + slice * 25ms,
                         {1, DataSize::Bytes(1000), i == 1, 4 * scan + slice, scan});
  }
};

TEST_F(ScanTest, IsDroppedWholeWhereTheMiddleOfItsCaptureIsLate) {
  Scan(kStart, 1);
  Scan(kStart + 100ms, 2);
  EXPECT_EQ(stream_.LatePackets(kStart + 237ms, DataRate::Infinite()), 0U);
  EXPECT_EQ(stream_.LatePackets(kStart + 238ms, DataRate::Infinite()), 8U);
  EXPECT_EQ(stream_.LatePackets(kStart + 338ms, DataRate::Infinite()), 16U);
}

TEST_F(ScanTest, IsJudgedByItsOwnSizeWhileTheNextOneBegins) {
  Scan(kStart, 1);
  stream_.OnQueued(kStart + 100ms, {1, DataSize::Bytes(1000), false, 8, 2});
  // 8000 bytes at 0.64 Mbit/s take 100 ms.
  EXPECT_EQ(stream_.LatePackets(kStart + 137ms, Mbps(0.64)), 0U);
  EXPECT_EQ(stream_.LatePackets(kStart + 138ms, Mbps(0.64)), 8U);
}

TEST_F(ScanTest, IsNotBegunWhereItsLastSliceWouldBeLate) {
  Scan(kStart - 100ms, 0);
  for (int i = 0; i < 8; ++i) stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  Scan(kStart, 1);
  // 8000 bytes at 0.32 Mbit/s take 200 ms. The scan is late 200 ms after the middle of its capture.
  EXPECT_EQ(stream_.LatePackets(kStart + 38ms, Mbps(0.32)), 8U);
  EXPECT_EQ(stream_.LatePackets(kStart + 37ms, Mbps(0.32)), 0U);
}

TEST_F(ScanTest, SlicesThatFollowADroppedOneOfTheirScanGoTheSameWay) {
  Scan(kStart, 1);
  stream_.OnDropped(kStart, 2);
  EXPECT_EQ(stream_.LatePackets(kStart + 1ms, DataRate::Infinite()), 6U);
  Scan(kStart + 100ms, 2);
  EXPECT_EQ(stream_.LatePackets(kStart + 101ms, DataRate::Infinite()), 6U);
}

TEST_F(ScanTest, SlicesThatFollowADroppedOneGoTheSameWayBehindARepairPacket) {
  const auto queue = [this](std::uint32_t slice) {
    stream_.OnQueued(kStart, {1, DataSize::Bytes(1000), false, slice, 1});
  };
  queue(0);
  stream_.OnQueued(kStart, {2, DataSize::Bytes(500), false, 77, {}});
  queue(1);
  stream_.OnDropped(kStart, 2);
  EXPECT_EQ(stream_.LatePackets(kStart + 1ms, DataRate::Infinite()), 1U);
}

TEST_F(ScanTest, SlicesThatFollowOneWhichAnotherPathDeliveredAreSent) {
  Scan(kStart, 1);
  for (int i = 0; i < 2; ++i) stream_.OnUnneeded(kStart);
  EXPECT_EQ(stream_.LatePackets(kStart + 1ms, DataRate::Infinite()), 0U);
  EXPECT_EQ(stream_.statistics(kStart).packets_dropped, 2U);
  EXPECT_EQ(stream_.queued(), DataSize::Bytes(6000));
}

TEST_F(StreamTest, TheRestOfAFrameThatStuckIsLateAndTheYoungerFrameBehindItIsNot) {
  Frame(kStart, 3, 1);
  Frame(kStart + 900ms, 2, 2);
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  EXPECT_EQ(stream_.LatePackets(kStart + 999ms, DataRate::Infinite()), 0U);
  EXPECT_EQ(stream_.LatePackets(kStart + 1000ms, DataRate::Infinite()), 2U);
}

TEST_F(StreamTest, TheEndOfAFrameThatStuckStaysForReceiversThatReportAtIt) {
  parameters_.feedback_interval = 400ms;
  Frame(kStart, 3, 1);
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  EXPECT_EQ(stream_.LatePackets(kStart + 1000ms, DataRate::Infinite()), 1U);
  EXPECT_EQ(stream_.LatePackets(kStart + 2000ms, DataRate::Infinite()), 2U);
}

TEST_F(ScanTest, GoesOutToItsEndForALittleLongerOnceItHasBegun) {
  Scan(kStart, 1);
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  // One slice was sent; three slices are still queued.
  EXPECT_EQ(stream_.LatePackets(kStart + 1050ms, DataRate::Infinite()), 0U);
  EXPECT_EQ(stream_.LatePackets(kStart + 1051ms, DataRate::Infinite()), 6U);
}

TEST_F(StreamTest, TheFramePeriodIsMeasured) {
  for (int i = 0; i < 100; ++i) {
    Frame(kStart + i * 100ms, 1, static_cast<std::uint32_t>(i));
    stream_.OnDropped(kStart, 1);
  }
  EXPECT_NEAR(Milliseconds(stream_.frame_period()), 100, 1);
}

TEST_F(StreamTest, AQueueThatOutlastsTheFramePeriodLowersTheRate) {
  for (int i = 0; i < 20; ++i) Frame(kStart + i * 20ms, 1, static_cast<std::uint32_t>(i));
  EXPECT_DOUBLE_EQ(stream_.queue_compensation(), 0.5);
}

/// Sends frames of one packet each. First twenty frames are queued together and then removed. Then
/// four more frames are queued and removed one by one.
double RateAdjustFactorAfterBacklog(Duration period) {
  const Parameters parameters;
  Stream stream(parameters, {1, Mbps(0), Mbps(4), Mbps(50)});
  Time now = kStart;
  std::uint32_t timestamp = 0;
  const auto frame = [&] {
    stream.OnQueued(now, {1, DataSize::Bytes(1000), true, timestamp++});
    now += period;
  };
  for (int i = 0; i < 20; ++i) frame();
  stream.OnSuddenBacklog();
  stream.OnDropped(now, 20);
  for (int i = 0; i < 4; ++i) {
    frame();
    stream.OnDropped(now, 1);
  }
  return stream.queue_compensation();
}

/// After a sudden backlog was sent, the draft would lower the rate for another half a second. The
/// window would grow beyond the link in that time.
TEST(StreamAfterSuddenBacklog, AQueueThatIsGoneLowersTheRateNoMore) {
  EXPECT_LT(RateAdjustFactorAfterBacklog(20ms), 0.05);
  EXPECT_GT(RateAdjustFactorAfterBacklog(100ms), 0.4);  // This is the period of whole scans.
}

TEST_F(StreamTest, FramesAboveTheNominalSizeAreCompensated) {
  for (int i = 0; i < 500; ++i) {
    Frame(kStart + i * 20ms, 11, static_cast<std::uint32_t>(i));  // The nominal size is 10.
    stream_.OnDropped(kStart, 11);
  }
  EXPECT_NEAR(stream_.queue_compensation(), 0.1, 1e-3);
}

TEST_F(StreamTest, APauseIsNoFramePeriod) {
  Frame(kStart, 1, 1);
  Frame(kStart + 500ms, 1, 2);  // This may be a pause, too.
  EXPECT_NEAR(Seconds(stream_.frame_period()), 0.068, 1e-6);
  Frame(kStart + 3s, 1, 3);
  EXPECT_NEAR(Seconds(stream_.frame_period()), 0.068, 1e-6);
  Frame(kStart + 3100ms, 1, 4);
  EXPECT_NEAR(Seconds(stream_.frame_period()), 0.0712, 1e-6);
}

TEST_F(StreamTest, ANewSourceThatSendsMarkersIsTheMedia) {
  Frame(kStart, 2, 1);
  EXPECT_FALSE(stream_.OnQueued(kStart, {2, DataSize::Bytes(1000), false, 7}));
  EXPECT_TRUE(stream_.OnQueued(kStart, {2, DataSize::Bytes(1000), true, 7}));
  EXPECT_FALSE(stream_.OnQueued(kStart, {2, DataSize::Bytes(1000), false, 8}));
  EXPECT_TRUE(stream_.OnQueued(kStart, {2, DataSize::Bytes(1000), true, 8}));
}

TEST_F(StreamTest, ARepairPacketBeginsNoScan) {
  stream_.OnQueued(kStart, {1, DataSize::Bytes(1000), true, 6, 6});
  stream_.OnQueued(kStart, {2, DataSize::Bytes(1000), false, 0, 7});
  stream_.OnQueued(kStart, {1, DataSize::Bytes(1000), true, 7, 7});
  for (int i = 0; i < 2; ++i) stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  EXPECT_TRUE(stream_.at_start());
  EXPECT_EQ(stream_.LatePackets(kStart + 300ms, DataRate::Infinite()), 1U);
}

TEST_F(StreamTest, ARepairPacketWithinAFrameIsNoPartOfIt) {
  Stream without(parameters_, stream_.config());
  for (std::uint32_t frame = 1; frame <= 20; ++frame) {
    const Time now = kStart + frame * 100ms;
    for (const bool marker : {false, true}) {
      const QueuedPacket packet{1, DataSize::Bytes(20'000), marker, frame};
      without.OnQueued(now, packet);
      EXPECT_EQ(stream_.OnQueued(now, packet), marker);
      for (const std::uint32_t timestamp : {frame, 1000 + frame})
        EXPECT_FALSE(stream_.OnQueued(now, {2, DataSize::Bytes(20'000), false, timestamp}));
    }
    stream_.OnSent(now, 1, DataSize::Bytes(20'000));
    EXPECT_FALSE(stream_.at_start()) << "its second packet begins no frame";
    for (int i = 0; i < 5; ++i) stream_.OnSent(now, 1, DataSize::Bytes(20'000));
    for (int i = 0; i < 2; ++i) without.OnSent(now, 1, DataSize::Bytes(20'000));
  }
  EXPECT_DOUBLE_EQ(stream_.queue_compensation(), without.queue_compensation());
  EXPECT_EQ(stream_.frame_period(), without.frame_period());
}

TEST_F(StreamTest, IsActiveUntilItIsKnownToBeSilent) {
  EXPECT_TRUE(stream_.active(kStart));
  stream_.NoteTime(kStart);
  EXPECT_FALSE(stream_.active(kStart + 1s));
  Frame(kStart + 1s, 2, 1);
  stream_.OnDropped(kStart + 5s, 2);
  EXPECT_TRUE(stream_.active(kStart + 5900ms)) << "its encoder has only just been too slow";
  stream_.OnDropped(kStart + 6s, 0);
  EXPECT_FALSE(stream_.active(kStart + 6s));
}

TEST_F(StreamTest, RepairPacketsOfAnotherSourceAreNoFrames) {
  Frame(kStart, 3, 1);
  stream_.OnQueued(kStart, {2, DataSize::Bytes(500), false, 77});
  EXPECT_TRUE(stream_.Owns(2));
  Frame(kStart + 100ms, 2, 2);
  EXPECT_EQ(stream_.LatePackets(kStart + 201ms, DataRate::Infinite()), 4U);
}

}  // namespace
}  // namespace lidar::scream

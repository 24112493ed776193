// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests streams at the limits of their settings: sums of rates, turns, backlogs, frames.
#include <gtest/gtest.h>

#include "src/scream/streams.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

class Limits : public ::testing::Test {
 protected:
  StreamId Add(const StreamConfig& config) { return streams_.Add(config); }
  double Target(StreamId id) { return streams_.Find(id)->target_bitrate().bits_per_second() / 1e6; }
  /// Adds a stream whose target is 8 Mbit/s, or 1000 bytes per millisecond.
  StreamId AddAt8Mbps() {
    const StreamId id = Add({1, Mbps(0), Mbps(1), Mbps(100)});
    streams_.Allocate(kStart, Mbps(8));
    return id;
  }
  void Queue(StreamId id, Time now, int packets, std::uint32_t timestamp = 7) {
    for (int i = 0; i < packets; ++i)
      streams_.Find(id)->OnQueued(now, {1, DataSize::Bytes(1000), i + 1 == packets, timestamp});
  }
  /// Returns how many of the next `packets` packets to be sent belong to `stream`.
  int TurnsOf(StreamId stream, int packets) {
    int turns = 0;
    for (int i = 0; i < packets; ++i) {
      const StreamId id = *streams_.Next();
      turns += id == stream ? 1 : 0;
      streams_.OnSent(kStart, id, 1, DataSize::Bytes(1000));
    }
    return turns;
  }
  static double InMbps(DataRate rate) { return rate.bits_per_second() / 1e6; }

  Parameters parameters_;
  Streams streams_{parameters_};
};

TEST_F(Limits, TheMaximumOfAllIsNoMoreThanIsSet) {
  Add({1, Mbps(1), Mbps(2), Mbps(10)});
  Add({1, Mbps(3), Mbps(3), Mbps(20)});
  EXPECT_NEAR(InMbps(streams_.max_bitrate()), 30, 1e-6);
  EXPECT_NEAR(InMbps(streams_.start_bitrate()), 5, 1e-6);
  parameters_.max_total_bitrate = Mbps(12);
  EXPECT_NEAR(InMbps(streams_.max_bitrate()), 12, 1e-6);
  parameters_.max_total_bitrate = Mbps(2);  // less than the sum of the two minima
  EXPECT_NEAR(InMbps(streams_.max_bitrate()), 4, 1e-6);
}

TEST_F(Limits, AMaximumBelowTheMinimumIsTheMinimum) {
  const StreamId a = Add({1, Mbps(5), Mbps(5), Mbps(2)});
  streams_.Allocate(kStart, Mbps(20));
  EXPECT_NEAR(Target(a), 5, 1e-3);
  EXPECT_NEAR(InMbps(streams_.max_bitrate()), 5, 1e-6);
}

TEST_F(Limits, AllAtTheirMaximumLeaveTheRest) {
  const StreamId a = Add({5, Mbps(0), Mbps(1), Mbps(2)});
  const StreamId b = Add({1, Mbps(1), Mbps(1), Mbps(3)});
  streams_.Allocate(kStart, Mbps(20));
  EXPECT_NEAR(Target(a), 2, 1e-3);
  EXPECT_NEAR(Target(b), 3, 1e-3);
}

TEST_F(Limits, ASilentStreamHasWhatItNeedsToComeBack) {
  const StreamId a = Add({1, Mbps(1), Mbps(1), Mbps(10)});
  const StreamId b = Add({1, Mbps(1), Mbps(1), Mbps(10), Mbps(3)});
  streams_.Allocate(kStart, Mbps(10));
  Queue(a, kStart + 2s, 1);
  streams_.Allocate(kStart + 2s, Mbps(6));
  EXPECT_NEAR(Target(a), 6, 1e-3);
  EXPECT_NEAR(Target(b), 3, 1e-3);
}

TEST_F(Limits, AStreamIsSilentAfterASecondWithoutPackets) {
  const StreamId a = Add({1, Mbps(1), Mbps(1), Mbps(10)});
  Queue(a, kStart, 1);
  EXPECT_TRUE(streams_.Find(a)->active(kStart + 9s));  // One packet of the stream is still queued.
  streams_.OnSent(kStart + 9s, a, 1, DataSize::Bytes(1000));
  EXPECT_TRUE(streams_.Find(a)->active(kStart + 9s + 999ms));
  EXPECT_FALSE(streams_.Find(a)->active(kStart + 10s));
}

TEST_F(Limits, OnlyTheLongestBacklogsMakeRoom) {
  const StreamId a = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  const StreamId b = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  // Each stream gets 8 Mbit/s: 20,000 bytes in a frame of 20 ms.
  streams_.Allocate(kStart, Mbps(16));
  Queue(a, kStart, 120);  // a backlog of 120 ms
  Queue(b, kStart, 59);   // a backlog of 59 ms, less than half
  streams_.LeaveRoomForBacklogs(kStart);
  // Stream a has a backlog of 100,000 bytes. To send it within 200 ms takes 4 Mbit/s.
  EXPECT_NEAR(Target(a), 4, 1e-3);
  EXPECT_NEAR(Target(b), 8, 1e-3);
}

TEST_F(Limits, AFrameIsNoBacklogAndWhatIsNeededStays) {
  const StreamId a = AddAt8Mbps();
  Queue(a, kStart, 20);
  streams_.LeaveRoomForBacklogs(kStart);
  EXPECT_NEAR(Target(a), 8, 1e-3);
  Queue(a, kStart, 200);
  streams_.LeaveRoomForBacklogs(kStart);
  EXPECT_NEAR(Target(a), 0, 1e-3);
  streams_.Find(a)->Configure({1, Mbps(0), Mbps(1), Mbps(100), Mbps(3)});
  streams_.Allocate(kStart, Mbps(8));
  streams_.LeaveRoomForBacklogs(kStart);
  EXPECT_NEAR(Target(a), 3, 1e-3);
}

/// At 8 Mbit/s, 100,000 bytes are a frame of 100 ms. Half of the frame is still queued after 50 ms.
TEST_F(Limits, WhatIsLeftOfAWholeScanIsABacklogWhenTheNextOneComes) {
  const StreamId a = AddAt8Mbps();
  Queue(a, kStart, 1, 1);
  Queue(a, kStart + 100ms, 99, 2);
  EXPECT_EQ(streams_.Find(a)->backlog(kStart + 100ms), DataSize());
  EXPECT_EQ(streams_.Find(a)->backlog(kStart + 150ms), DataSize::Bytes(50'000));
  EXPECT_EQ(streams_.Find(a)->backlog(kStart + 300ms), DataSize::Bytes(100'000));
  // The next scan must be smaller than the target allows, by the size of the backlog. 50,000 bytes
  // in 100 ms are 4 Mbit/s.
  EXPECT_NEAR(InMbps(streams_.Find(a)->backlog_rate(kStart + 150ms)), 4, 1e-3);
  streams_.LeaveRoomForBacklogs(kStart + 100ms);
  EXPECT_NEAR(Target(a), 8, 1e-3);
  streams_.LeaveRoomForBacklogs(kStart + 150ms);
  EXPECT_NEAR(Target(a), 4, 1e-3);
}

/// The queue of `scans` is the longest, but most of it is sent before the next scan is queued.
TEST_F(Limits, AScanThatIsLeavingIsNotTheLongestBacklog) {
  const StreamId scans = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  const StreamId frames = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  streams_.Allocate(kStart, Mbps(16));
  Queue(scans, kStart, 1, 1);
  Queue(scans, kStart + 100ms, 99, 2);
  Queue(frames, kStart + 100ms, 60);  // The queue exceeds one frame by 40 ms.
  streams_.LeaveRoomForBacklogs(kStart + 101ms);
  EXPECT_NEAR(Target(scans), 8, 1e-3);
  EXPECT_NEAR(Target(frames), 8 - 1.6, 1e-3);
}

TEST_F(Limits, AScanThatIsBeingQueuedIsNoBacklogYet) {
  const StreamId a = AddAt8Mbps();
  Queue(a, kStart, 1, 1);
  Queue(a, kStart + 100ms, 1, 2);
  for (int i = 0; i < 50; ++i)
    streams_.Find(a)->OnQueued(kStart + 200ms, {1, DataSize::Bytes(1000), false, 3});
  EXPECT_EQ(streams_.Find(a)->backlog(kStart + 201ms), DataSize());
}

TEST_F(Limits, WhatIsLeftOfAShortFrameIsNoBacklog) {
  const StreamId a = AddAt8Mbps();
  Queue(a, kStart, 1, 1);
  Queue(a, kStart + 20ms, 19, 2);
  EXPECT_EQ(streams_.Find(a)->backlog(kStart + 40ms), DataSize());
}

TEST_F(Limits, TheStreamWithTheHighestTargetSetsThePeriod) {
  const StreamId slow = Add({9, Mbps(0), Mbps(1), Mbps(100)});
  const StreamId fast = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  for (int i = 0; i < 3; ++i) Queue(slow, kStart + 100ms * i, 1, static_cast<std::uint32_t>(i));
  for (int i = 0; i < 9; ++i) Queue(fast, kStart + 30ms * i, 1, static_cast<std::uint32_t>(i));
  streams_.Find(slow)->OnDropped(kStart + 200ms, 3);
  streams_.Find(fast)->OnDropped(kStart + 240ms, 9);
  streams_.Allocate(kStart + 240ms, Mbps(10));
  EXPECT_NEAR(Seconds(streams_.frame_period()), 0.1, 1e-6);
  streams_.Find(slow)->Configure({0.1, Mbps(0), Mbps(1), Mbps(100)});
  streams_.Allocate(kStart + 240ms, Mbps(10));
  EXPECT_NEAR(Seconds(streams_.frame_period()), 0.03, 1e-6);
  // A stream that is silent does not count, even if its needed rate is high.
  streams_.Find(slow)->Configure({1, Mbps(0), Mbps(1), Mbps(100), Mbps(20)});
  streams_.Find(fast)->OnQueued(kStart + 1300ms, {1, DataSize::Bytes(1000), false, 99});
  streams_.Allocate(kStart + 1300ms, Mbps(10));
  EXPECT_NEAR(Seconds(streams_.frame_period()), 0.03, 1e-6);
}

TEST_F(Limits, SumsWhatWaitsAndTellsTheOldest) {
  const StreamId a = Add({}), b = Add({});
  EXPECT_TRUE(streams_.empty());
  Queue(a, kStart, 2);
  Queue(b, kStart + 10ms, 3);
  EXPECT_FALSE(streams_.empty());
  EXPECT_EQ(streams_.queued().bytes(), 5000);
  EXPECT_EQ(streams_.media_qdelay(kStart + 30ms), 30ms);
  streams_.OnSent(kStart + 30ms, a, 1, DataSize::Bytes(1000));
  streams_.OnSent(kStart + 30ms, a, 1, DataSize::Bytes(1000));
  EXPECT_EQ(streams_.media_qdelay(kStart + 30ms), 20ms);
  EXPECT_EQ(streams_.queued().bytes(), 3000);
  EXPECT_EQ(streams_.Owner(1), a);
  EXPECT_FALSE(streams_.Owner(2));
  streams_.Remove(a);
  EXPECT_EQ(streams_.Find(a), nullptr);
  EXPECT_EQ(streams_.Owner(1), b);
  EXPECT_NE(streams_.Add({}), a);
}

TEST_F(Limits, WhoWasIdleGetsNoCreditForIt) {
  const StreamId a = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  const StreamId b = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  streams_.Allocate(kStart, Mbps(8));
  Queue(a, kStart, 60);
  for (int i = 0; i < 30; ++i) streams_.OnSent(kStart, a, 1, DataSize::Bytes(1000));
  streams_.OnQueued(streams_.Find(b));
  Queue(b, kStart, 30);
  EXPECT_NEAR(TurnsOf(b, 20), 10, 1);
}

TEST_F(Limits, TheFirstOfEqualStreamsGoesFirst) {
  const StreamId a = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  Queue(Add({1, Mbps(0), Mbps(1), Mbps(100)}), kStart, 1);
  Queue(a, kStart, 1);
  EXPECT_EQ(streams_.Next(), a);
}

TEST_F(Limits, WhatAStrictStreamSendsCostsNobodyATurn) {
  const StreamId a = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  const StreamId b = Add({1, Mbps(0), Mbps(1), Mbps(100)});
  const StreamId audio = Add({1, Mbps(0.1), Mbps(0.1), Mbps(0.2), Mbps(0), true});
  streams_.Allocate(kStart, Mbps(10));
  Queue(a, kStart, 60);
  for (int i = 0; i < 5; ++i) streams_.OnSent(kStart, a, 1, DataSize::Bytes(1000));
  Queue(audio, kStart, 10);
  for (int i = 0; i < 10; ++i) streams_.OnSent(kStart, audio, 3, DataSize::Bytes(1000));
  streams_.OnQueued(streams_.Find(b));
  Queue(b, kStart, 30);
  EXPECT_NEAR(TurnsOf(b, 20), 10, 1);
}

class ScanGroups : public ::testing::Test {
 protected:
  void Slice(Time now, std::uint32_t scan, std::uint32_t slice) {
    for (int i = 0; i < 2; ++i)
      stream_.OnQueued(now, {1, DataSize::Bytes(1000), i == 1, 4 * scan + slice, scan});
  }
  void Scan(Time now, std::uint32_t scan) {
    for (std::uint32_t slice = 0; slice < 4; ++slice) Slice(now + slice * 25ms, scan, slice);
  }
  Parameters parameters_;
  Stream stream_{parameters_, {1, Mbps(0), Mbps(4), Mbps(50)}};
};

TEST_F(ScanGroups, AScanIsNotBegunWhereItWouldBeLateAlsoOnceTheNextIsQueued) {
  Scan(kStart, 1);
  Slice(kStart + 100ms, 2, 0);
  // 8000 bytes at 0.3 Mbit/s take 213 ms. This is too late for scan 1, but not for scan 2.
  EXPECT_EQ(stream_.LatePackets(kStart + 100ms, Mbps(0.3)), 8U);
  EXPECT_EQ(stream_.LatePackets(kStart + 100ms, Mbps(1)), 0U);
}

TEST_F(ScanGroups, WhatHasBegunMayStayFiveTimesAsLong) {
  Scan(kStart, 1);
  for (int i = 0; i < 2; ++i) stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  EXPECT_EQ(stream_.LatePackets(kStart + 1050ms, DataRate::Infinite()), 0U);
  EXPECT_EQ(stream_.LatePackets(kStart + 1051ms, DataRate::Infinite()), 6U);
}

TEST_F(ScanGroups, CountsWhatItSendsAndDrops) {
  Scan(kStart, 1);
  stream_.OnSent(kStart, 1, DataSize::Bytes(1000));
  stream_.OnDropped(kStart, 3);
  const StreamStatistics s = stream_.statistics(kStart);
  EXPECT_EQ(s.packets_sent, 1U);
  EXPECT_EQ(s.bytes_sent.bytes(), 1000);
  EXPECT_EQ(s.packets_dropped, 3U);
  EXPECT_EQ(s.queued.bytes(), 4000);
  EXPECT_EQ(stream_.queued().bytes(), 4000);
}

}  // namespace
}  // namespace lidar::scream

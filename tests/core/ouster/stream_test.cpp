// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests what the stream adds to parser and batcher: times, packets of other sensors, and IMU
// packets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "src/base/byte_writer.h"
#include "src/base/crc.h"
#include "src/ouster/imu_packet.h"
#include "src/ouster/sensor_stream.h"
#include "tests/core/ouster/captures.h"

namespace lidar::ouster {
namespace {

using namespace std::chrono_literals;

TEST(ClockMapper, FollowsTheFastestPacketAndNotTheJitter) {
  ClockMapper mapper(ClockMapper::Mode::kFollow);
  std::uint64_t sensor = 5'000'000'000;
  Time arrival{100s};
  const Duration jitter[] = {3ms, 0ms, 7ms, 1ms, 20ms};
  for (int i = 0; i < 1000; ++i, sensor += 1'600'000, arrival += 1600us) {
    mapper.Observe(sensor, arrival + jitter[i % 5]);
    if (i < 8) continue;
    const Duration error = mapper.Map(sensor) - arrival;
    EXPECT_GE(error, -1us) << i;
    EXPECT_LE(error, 10us) << i;
  }
}

TEST(ClockMapper, TimesRiseWhileFasterPacketsSetTheOffset) {
  ClockMapper mapper(ClockMapper::Mode::kFollow);
  // The first three packets were delayed by 5 ms in a socket.
  Time last{};
  for (int i = 0; i < 20; ++i) {
    const Duration sampled = std::chrono::seconds(5) + i * 1600us;
    const auto sensor = static_cast<std::uint64_t>(sampled.count());
    mapper.Observe(sensor, Time(sampled + (i < 3 ? 5ms : 0ms)));
    EXPECT_GT(mapper.Map(sensor), last) << i;
    last = mapper.Map(sensor);
    if (i > 10) {
      EXPECT_EQ(last, Time(sampled)) << i;
    }
  }
}

TEST(ClockMapper, OfAFileHoldsTheOffsetOfTheFirstPacketUntilAClockJumps) {
  ClockMapper mapper(ClockMapper::Mode::kHold);
  const std::uint64_t second = 1'000'000'000;
  mapper.Observe(5 * second, Time{std::chrono::seconds(100)});
  // Each further packet arrives with a delay that is 1 ms less than that of the packet before it.
  for (std::uint64_t i = 1; i < 9; ++i) {
    const Time arrival = Time{std::chrono::seconds(100 + i)} - Duration{1'000'000} * i;
    EXPECT_FALSE(mapper.WouldJump((5 + i) * second, arrival));
    mapper.Observe((5 + i) * second, arrival);
    EXPECT_EQ(mapper.Map((5 + i) * second), Time{std::chrono::seconds(100 + i)});
  }
  // A difference of 1 s is no jump.
  EXPECT_FALSE(mapper.WouldJump(20 * second, Time{std::chrono::seconds(116)}));
  EXPECT_TRUE(mapper.WouldJump(20 * second, Time{std::chrono::seconds(116)} + Duration{1}));
  EXPECT_TRUE(mapper.WouldJump(20 * second, Time{std::chrono::seconds(114)} - Duration{1}));
  mapper.Observe(20 * second, Time{std::chrono::seconds(200)});
  EXPECT_EQ(mapper.Map(20 * second), Time{std::chrono::seconds(200)});
}

TEST(ClockMapper, FollowsAClockThatDrifts) {
  ClockMapper mapper(ClockMapper::Mode::kFollow);
  // The sensor's clock is too fast by 100 ppm for a minute, and then too slow by 100 ppm for a
  // minute.
  double sensor = 1e9;
  Time arrival{10s};
  for (int i = 0; i < 120'000; ++i) {
    sensor += i < 60'000 ? 1'000'100 : 999'900;
    arrival += 1ms;
    mapper.Observe(static_cast<std::uint64_t>(sensor), arrival);
    const Duration error = mapper.Map(static_cast<std::uint64_t>(sensor)) - arrival;
    ASSERT_LE(error, 1us) << i;
    ASSERT_GE(error, -1ms) << i;
  }
}

/// Maps the times of packets that are sent every millisecond from `from` to `until`. Each packet
/// arrives after `delay`. Returns the error of the last time.
Duration ErrorAfter(ClockMapper* mapper, Duration from, Duration until, Duration delay) {
  Duration error{};
  for (Duration t = from; t < until; t += 1ms) {
    const auto sensor = static_cast<std::uint64_t>(t.count());
    mapper->Observe(sensor, Time(t + delay));
    error = mapper->Map(sensor) - Time(t);
  }
  return error;
}

TEST(ClockMapper, RemembersTheFastestPacketOfTheWindowBefore) {
  ClockMapper mapper(ClockMapper::Mode::kFollow);
  EXPECT_EQ(ErrorAfter(&mapper, 0s, 4s, 0ms), 0ms);
  // In this window all packets are slow, but the fast packets of the window before still count.
  EXPECT_EQ(ErrorAfter(&mapper, 4s, 8s, 10ms), 0ms);
  // After this window the fast packets are forgotten. The offset then rises at the largest drift
  // that clocks may have.
  const Duration error = ErrorAfter(&mapper, 8s, 16s, 10ms);
  EXPECT_GT(error, 2ms);
  EXPECT_LT(error, 4ms);
}

TEST(ClockMapper, KeepsItsOffsetToAClockThatIsPutForward) {
  ClockMapper mapper(ClockMapper::Mode::kFollow);
  EXPECT_EQ(ErrorAfter(&mapper, 0s, 1s, 0ms), 0ms);
  mapper.Shift(100ms);
  EXPECT_EQ(ErrorAfter(&mapper, 1s, 2s, 100ms), 100ms);
}

TEST(ClockMapper, StartsOverWhenAClockJumps) {
  ClockMapper mapper(ClockMapper::Mode::kFollow);
  mapper.Observe(1'000'000'000, Time{50s});
  EXPECT_FALSE(mapper.WouldJump(1'001'000'000, Time{50s + 900ms}));
  EXPECT_TRUE(mapper.WouldJump(77, Time{50s + 1ms}));
  mapper.Observe(77, Time{50s + 1ms});
  EXPECT_EQ(mapper.Map(77), Time{50s + 1ms});
}

class Stream : public ::testing::Test {
 protected:
  std::vector<TimedSlice> Run(SensorStream* stream, Duration shift = 0ms,
                              std::uint64_t sensor_shift_ns = 0) {
    std::vector<TimedSlice> out;
    for (std::size_t i = 0; i < packets_.size(); ++i) {
      auto packet = packets_[i];
      for (std::uint32_t c = 0; c < 16; ++c) {
        std::uint8_t* at = &packet[32 + c * metadata_.format.column_size()];
        std::uint64_t t = 0;
        std::memcpy(&t, at, sizeof t);
        t += sensor_shift_ns;
        std::memcpy(at, &t, sizeof t);
      }
      const Duration due = 1562500ns * static_cast<std::int64_t>(i + 1) + shift;
      stream->Push({packet.data(), packet.size()}, {Time(due), Time(kUtcStart + due)});
      while (auto slice = stream->Pop()) out.push_back(*std::move(slice));
    }
    return out;
  }
  std::unique_ptr<SensorStream> Make(const StreamOptions& options = {}) {
    std::string error;
    auto stream = SensorStream::Create(metadata_, options, &error);
    EXPECT_TRUE(stream) << error;
    return stream;
  }
  std::uint64_t FirstTimestamp() const {
    return LidarPacket::Parse({packets_[0].data(), packets_[0].size()}, metadata_.format)
        ->Column(0)
        .timestamp;
  }

  static constexpr Duration kUtcStart = std::chrono::hours(24 * 365 * 55);
  Metadata metadata_ = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  std::vector<std::vector<std::uint8_t>> packets_ =
      test::LoadPackets("OS-1-128_v2.3.0_1024x10_lb_n3.pcap", metadata_);
};

TEST_F(Stream, SlicesHaveTheTimeOfTheirFirstColumn) {
  auto stream = Make();
  const auto slices = Run(stream.get());
  ASSERT_EQ(slices.size(), 24U);
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const Duration expected = 12500us * static_cast<std::int64_t>(i);
    EXPECT_NEAR(Seconds(slices[i].local.time_since_epoch() - expected), 0, 5e-4) << i;
    EXPECT_EQ(slices[i].utc - Time(kUtcStart), slices[i].local.time_since_epoch());
  }
  EXPECT_FALSE(stream->has_synchronised_clock());
}

TEST_F(Stream, ArrivalTimesAreThoseOfTheFirstPacket) {
  StreamOptions options;
  options.times = TimeSource::kArrival;
  auto stream = Make(options);
  const auto slices = Run(stream.get());
  for (std::size_t i = 0; i < slices.size(); ++i)
    EXPECT_EQ(slices[i].local, Time(1562500ns * static_cast<std::int64_t>(8 * i + 1)));
}

TEST_F(Stream, ASensorOnPtpGivesTrueUtc) {
  metadata_.timestamp_mode = "TIME_FROM_PTP_1588";
  auto stream = Make();
  // PTP has TAI, which is 37 s ahead of UTC. The packets arrive after 3 ms.
  const Duration start = kUtcStart + 37s - Duration(static_cast<std::int64_t>(FirstTimestamp()));
  const auto slices = Run(stream.get(), 3ms, static_cast<std::uint64_t>(start.count()));
  EXPECT_TRUE(stream->has_synchronised_clock());
  EXPECT_EQ(slices[0].utc, Time(kUtcStart));
}

TEST_F(Stream, AClockThatOnlyClaimsToBeSynchronisedIsNotBelieved) {
  metadata_.timestamp_mode = "TIME_FROM_PTP_1588";
  auto stream = Make();
  const auto slices = Run(stream.get());
  EXPECT_FALSE(stream->has_synchronised_clock());
  EXPECT_NEAR(Seconds(slices[0].utc - Time(kUtcStart)), 0, 5e-4);
}

TEST_F(Stream, TimesNeverGoBackWhenTheSensorsClockDoes) {
  auto stream = Make();
  auto slices = Run(stream.get(), 0ms, 3'600'000'000'000);
  const auto again = Run(stream.get(), 300ms);
  slices.insert(slices.end(), again.begin(), again.end());
  for (std::size_t i = 1; i < slices.size(); ++i) {
    EXPECT_GE(slices[i].local, slices[i - 1].local) << i;
    EXPECT_LE(slices[i].local - slices[i - 1].local, 40ms) << i;
  }
  EXPECT_EQ(stream->stats().clock_jumps, 1U);
  for (const TimedSlice& slice : again) EXPECT_EQ(slice.slice.after_gap, &slice == &again.front());
  stream->Restart();  // As after a pause, the next time may be any time.
  Run(stream.get(), 10s, 7'200'000'000'000);
  EXPECT_EQ(stream->stats().clock_jumps, 1U);
}

/// Packets are delayed by up to 60 ms, which is longer than the duration of a slice.
TEST_F(Stream, TimesNeverGoBackWhateverTheJitterAndSlicesEndWithTheirLastPacket) {
  for (const TimeSource times : {TimeSource::kSensor, TimeSource::kArrival}) {
    StreamOptions options;
    options.times = times;
    auto stream = Make(options);
    Time last{};
    std::uint32_t random = 7;
    Time arrival{};
    std::size_t slices = 0;
    for (std::size_t i = 0; i < packets_.size(); ++i) {
      random = random * 1'664'525 + 1'013'904'223;
      const Duration sent = 1562500ns * static_cast<std::int64_t>(i + 1);
      arrival = std::max(arrival, Time(sent + 1ms * (i < 4 ? 60 : random >> 28)));
      const Time utc = arrival + kUtcStart;
      stream->Push({packets_[i].data(), packets_[i].size()}, {arrival, utc});
      while (auto slice = stream->Pop()) {
        EXPECT_GE(slice->local, last);
        EXPECT_EQ(slice->completed, utc);
        last = slice->local;
        ++slices;
      }
    }
    EXPECT_EQ(slices, 24U);
  }
}

TEST_F(Stream, BeginsWithAPacketThatHasATime) {
  for (std::size_t p = 0; p < 8; ++p)
    for (std::uint32_t c = 0; c < 16; ++c) test::Invalidate(metadata_.format, c, &packets_[p]);
  auto stream = Make();
  for (int run = 0; run < 2; ++run) {
    const auto slices = Run(stream.get(), run * 500ms);
    ASSERT_GE(slices.size(), 22U);
    EXPECT_EQ(slices[0].slice.index, 1U);
    EXPECT_LT(slices.back().local, Time(run * 500ms + 300ms));
    stream->Restart();
    while (stream->Pop()) {
    }
  }
}

TEST_F(Stream, KnowsNoTimeFromARestartToTheNextPacket) {
  auto stream = Make();
  EXPECT_FALSE(stream->knows_time());
  Run(stream.get());
  EXPECT_TRUE(stream->knows_time());
  stream->Restart();
  EXPECT_FALSE(stream->knows_time());
}

TEST_F(Stream, PacketsThatDoNotFitAreCountedAndLeftOut) {
  auto stream = Make();
  const Arrival now{Time{1s}, Time{1s}};
  auto packet = packets_[0];
  EXPECT_EQ(stream->Push({packet.data(), packet.size() - 1}, now), PacketVerdict::kWrongSize);
  EXPECT_EQ(stream->Push({packet.data(), 48}, now), PacketVerdict::kImu);
  packet[kStandardHeader.init_id] ^= 1;
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kNewInitId);
  stream->AcceptNewInitId();
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kLidar);
  packet[kStandardHeader.serial] ^= 1;
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kForeign);
  EXPECT_EQ(stream->batcher().stats().packets, 1U);
  EXPECT_EQ(stream->stats().wrong_size, 1U);
  EXPECT_EQ(stream->stats().foreign, 1U);
}

TEST_F(Stream, ChecksumsOfAnotherSensorAreNotAskedOfItsOwn) {
  auto stream = Make();
  auto foreign = packets_[0];
  auto own = packets_[1];
  const std::size_t body = foreign.size() - 8;
  foreign[kStandardHeader.serial] ^= 1;
  const std::uint64_t crc = Crc64({foreign.data(), body});
  std::memcpy(&foreign[body], &crc, sizeof crc);
  std::memset(&own[body], 0, sizeof crc);
  const Arrival now{Time{1s}, Time{1s}};
  EXPECT_EQ(stream->Push({foreign.data(), foreign.size()}, now), PacketVerdict::kForeign);
  EXPECT_EQ(stream->Push({own.data(), own.size()}, now), PacketVerdict::kLidar);
}

TEST_F(Stream, PacketsWithoutASerialNumberGoByTheirSender) {
  auto stream = Make();
  const Sender ours{1};
  const Sender theirs{2};
  const std::vector<std::uint8_t> imu(metadata_.imu_packet_size());
  const auto push = [&](const std::vector<std::uint8_t>& bytes, const Sender& sender) {
    return stream->Push({bytes.data(), bytes.size()}, {Time{1s}, Time{1s}, sender});
  };
  EXPECT_EQ(push(packets_[0], ours), PacketVerdict::kLidar);
  EXPECT_EQ(push(imu, ours), PacketVerdict::kImu);
  EXPECT_EQ(push(imu, theirs), PacketVerdict::kForeign);
  // This packet has the sensor's serial number, so the sensor now has another address.
  EXPECT_EQ(push(packets_[1], theirs), PacketVerdict::kLidar);
  EXPECT_EQ(push(imu, theirs), PacketVerdict::kImu);
}

TEST_F(Stream, APacketOfAnotherSizeIsForeignWhereItSaysSo) {
  auto stream = Make();
  auto packet = packets_[0];
  packet.resize(packet.size() / 2);
  const Arrival now{Time{1s}, Time{1s}};
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kWrongSize);
  packet[kStandardHeader.serial] ^= 1;
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kForeign);
  auto no_lidar = packet;
  no_lidar[0] ^= 0x40;  // the type of the packet
  EXPECT_EQ(stream->Push({no_lidar.data(), no_lidar.size()}, now), PacketVerdict::kWrongSize);
  std::fill_n(packet.begin() + kStandardHeader.serial, 5, std::uint8_t{0});
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kWrongSize);
}

TEST_F(Stream, AnEmptyPacketIsNoneOfAnImuThatIsOff) {
  metadata_.imu_profile = ImuProfile::kOff;
  auto stream = Make();
  EXPECT_EQ(stream->Push({}, {Time{1s}, Time{1s}}), PacketVerdict::kWrongSize);
}

TEST_F(Stream, TheInitIdTellsTheSerialNumberThatOldMetadataLacks) {
  metadata_.serial = 0;
  auto stream = Make();
  const Arrival now{Time{1s}, Time{1s}};
  auto packet = packets_[0];
  packet[kStandardHeader.init_id] ^= 1;
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kNewInitId);
  EXPECT_EQ(stream->Push({packets_[0].data(), packets_[0].size()}, now), PacketVerdict::kLidar);
  packet[kStandardHeader.serial] ^= 1;
  EXPECT_EQ(stream->Push({packet.data(), packet.size()}, now), PacketVerdict::kForeign);
}

TEST(Legacy, TheFirstSenderHeardIsTheSensorUntilItFallsSilent) {
  const Metadata m = test::LoadMetadata("OS-1-32-G_v2.1.1_1024x10.json");
  const auto packets = test::LoadPackets("OS-1-32-G_v2.1.1_1024x10.pcap", m);
  std::string error;
  const auto stream = SensorStream::Create(m, {}, &error);
  const auto push = [&](std::size_t i, Time time, const Sender& sender) {
    return stream->Push({packets[i].data(), packets[i].size()}, {time, time, sender});
  };
  EXPECT_EQ(push(0, Time{1s}, {1}), PacketVerdict::kLidar);
  EXPECT_EQ(push(1, Time{1001ms}, {2}), PacketVerdict::kForeign);
  EXPECT_EQ(push(1, Time{1002ms}, {1}), PacketVerdict::kLidar);
  EXPECT_EQ(push(2, Time{2500ms}, {2}), PacketVerdict::kLidar);
  // After a seek, a packet of the first sender may follow.
  stream->Reposition();
  EXPECT_EQ(push(3, Time{1500ms}, {1}), PacketVerdict::kLidar);
}

TEST(Imu, ReadsLegacyPacketsInSiUnits) {
  const Metadata m = test::LoadMetadata("crc_test.json");
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  w.Le64(1);
  w.Le64(2);
  w.Le64(3);
  for (const float v : {0.0F, 0.0F, 1.0F, 180.0F, 0.0F, -90.0F}) w.LeF32(v);
  const auto samples = ParseImuPacket({bytes.data(), bytes.size()}, m);
  ASSERT_TRUE(samples);
  ASSERT_EQ(samples->size(), 1U);
  EXPECT_EQ((*samples)[0].timestamp, 3U);
  EXPECT_FLOAT_EQ((*samples)[0].acceleration[2], 9.80665F);
  EXPECT_FLOAT_EQ((*samples)[0].angular_velocity[0], 3.14159265F);
  EXPECT_FLOAT_EQ((*samples)[0].angular_velocity[2], -1.57079633F);
  EXPECT_FALSE(ParseImuPacket({bytes.data(), 47}, m));
}

TEST(Imu, ReadsAccelGyroPacketsAndLeavesOutInvalidSamples) {
  Metadata m = test::LoadMetadata("crc_test.json");
  m.imu_profile = ImuProfile::kAccel32Gyro32Nmea;
  m.imu_measurements_per_packet = 3;
  ASSERT_EQ(m.imu_packet_size(), 32U + 100 + 3 * 36 + 32);
  std::vector<std::uint8_t> bytes(132);
  ByteWriter w(&bytes);
  for (std::uint16_t i = 0; i < 3; ++i) {
    w.Le64(1000U + i);
    w.Le16(i);
    w.Le16(i == 1 ? 0 : 1);
    for (int axis = 0; axis < 6; ++axis) w.LeF32(static_cast<float>(i * 10 + axis));
  }
  w.Zeros(32);
  const auto samples = ParseImuPacket({bytes.data(), bytes.size()}, m);
  ASSERT_TRUE(samples);
  ASSERT_EQ(samples->size(), 2U);
  EXPECT_EQ((*samples)[1].timestamp, 1002U);
  EXPECT_EQ((*samples)[1].acceleration, (std::array<float, 3>{20, 21, 22}));
  EXPECT_EQ((*samples)[1].angular_velocity, (std::array<float, 3>{23, 24, 25}));
}

}  // namespace
}  // namespace lidar::ouster

// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that `ouster-replay` sends, in each profile, what its scanner measured, and that it sends
// the packets of a capture.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <utility>

#include "src/base/byte_reader.h"
#include "src/base/crc.h"
#include "src/ouster/imu_packet.h"
#include "src/ouster/lidar_packet.h"
#include "src/ouster/pcap_writer.h"
#include "src/ouster/sensor_stream.h"
#include "src/tools/bench/ouster_replay/pcap_stream.h"
#include "src/tools/bench/ouster_replay/player.h"
#include "src/tools/bench/ouster_replay/synth_stream.h"
#include "src/tools/common/event_loop.h"
#include "tests/support/files.h"

namespace lidar::tools {
namespace {

using ouster::Channel;
using ouster::Profile;

constexpr auto kStandard = ouster::HeaderType::kStandard;
constexpr const char* kModel = "os1-32";
synth::Returns Scan(const ouster::Metadata& metadata) {
  const std::uint32_t columns = metadata.model.columns_per_scan;
  synth::ScannerConfig config;
  config.sensor = *synth::MakeSensor(kModel, columns);
  config.period = metadata.scan_period();
  config.speed_mps = 12;
  config.seed = 1;
  config.second_returns = metadata.format.has_second_return();
  synth::Scanner scanner(config);
  synth::Returns returns;
  scanner.Cast(0, {0, columns}, &returns);
  return returns;
}

/// The points of the first scan, and the offsets of their fields.
struct Points {
  std::vector<std::uint8_t> bytes;
  PointFields fields;
  std::uint32_t step = 0;

  template <class T>
  T Get(std::size_t point, const char* field) const {
    T value{};
    std::memcpy(&value, &bytes[point * step + fields.Find(field)->offset], sizeof value);
    return value;
  }
};

Points ReadBack(const ouster::Metadata& metadata, const SynthOptions& options) {
  ouster::StreamOptions read;
  read.slices_per_scan = 1;
  if (metadata.format.has_second_return()) read.points.returns = ouster::Return::kBoth;
  for (const auto& [channel, name] :
       std::map<Channel, const char*>{{Channel::kSignal, "signal"}, {Channel::kNearIr, "near-ir"}})
    if (ouster::LayoutOf(metadata.format.profile).Find(channel) != nullptr)
      read.points.channels.emplace_back(name);
  std::string error;
  const auto stream = ouster::SensorStream::Create(metadata, read, &error);
  EXPECT_TRUE(stream) << error;
  SynthStream sensor(options, metadata);
  for (;;) {
    const auto packet = sensor.Next();
    stream->Push({packet->bytes.data(), packet->bytes.size()}, {Time{packet->due}, {}});
    if (auto slice = stream->Pop()) {
      EXPECT_EQ(slice->slice.missing_columns, 0U);
      return {std::move(slice->slice.points), stream->writer().fields(),
              stream->writer().point_step()};
    }
  }
}

struct Case {
  Profile profile;
  ouster::HeaderType header = ouster::HeaderType::kStandard;
  const char* mode = "512x10";
  std::uint32_t columns_per_packet = 16;
};
class SynthProfiles : public ::testing::TestWithParam<Case> {};

TEST_P(SynthProfiles, CarryWhatTheScannerSaw) {
  SynthOptions options;
  options.model = kModel;
  const ouster::Metadata m = MakeSynthMetadata(
      options,
      {GetParam().mode, GetParam().profile, GetParam().header, GetParam().columns_per_packet});
  const Points points = ReadBack(m, options);
  const bool dual = m.format.has_second_return();
  const synth::Returns truth = Scan(m);
  const std::uint32_t unit = m.format.range_unit_mm();
  const bool has_signal = points.fields.Find("signal") != nullptr;
  std::size_t first = 0;
  std::size_t second = 0;
  for (std::size_t i = 0; i < truth.range_mm.size(); ++i) {
    const std::uint32_t range = truth.range_mm[i] / unit * unit;
    ASSERT_EQ(points.Get<std::uint32_t>(i, "range"), range) << i;
    ASSERT_EQ(points.Get<float>(i, "intensity"), range == 0 ? 0 : truth.reflectivity[i]) << i;
    if (has_signal) {
      ASSERT_EQ(points.Get<std::uint16_t>(i, "signal"), truth.signal[i]) << i;
    }
    first += range != 0 ? 1 : 0;
    if (!dual) continue;
    const std::uint32_t range2 = truth.range2_mm[i] / unit * unit;
    ASSERT_EQ(points.Get<std::uint32_t>(i, "range2"), range2) << i;
    ASSERT_EQ(points.Get<float>(i, "intensity2"), range2 == 0 ? 0 : truth.reflectivity2[i]) << i;
    second += range2 != 0 ? 1 : 0;
  }
  EXPECT_GT(first, 5000U);
  EXPECT_EQ(second > 50U, dual);
}

INSTANTIATE_TEST_SUITE_P(
    All, SynthProfiles,
    ::testing::Values(Case{Profile::kLegacy}, Case{Profile::kRng19Rfl8Sig16Nir16},
                      Case{Profile::kRng19Rfl8Sig16Nir16Dual}, Case{Profile::kRng15Rfl8Nir8},
                      Case{Profile::kRng15Rfl8Nir8Dual},
                      Case{Profile::kFusaRng15Rfl8Nir8Dual, ouster::HeaderType::kFusa},
                      Case{Profile::kRng15Rfl8Win8}, Case{Profile::kRng15Rfl8Nir8Zone16},
                      Case{Profile::kRng19Rfl8Sig16Nir16Zone16},
                      Case{Profile::kRng19Rfl8Sig16Zone16Dual},
                      Case{Profile::kRng19Rfl8Sig16Nir16Rgb16},
                      Case{Profile::kRng19Rfl8Sig16Nir16Rgb16Dual}, Case{Profile::kFiveWordPixel},
                      Case{Profile::kRng19Rfl8Sig16Nir16, ouster::HeaderType::kFusa},
                      Case{Profile::kRng15Rfl8Nir8, kStandard, "1024x20"},
                      Case{Profile::kLegacy, kStandard, "2048x10"},
                      Case{Profile::kRng19Rfl8Sig16Nir16Dual, kStandard, "4096x5"},
                      Case{Profile::kRng19Rfl8Sig16Nir16, kStandard, "512x20", 8},
                      Case{Profile::kRng15Rfl8Nir8Dual, kStandard, "1024x5", 64}));

/// A capture of two scans and of one packet without a payload.
class Capture : public test::FolderTest {
 protected:
  void SetUp() override { Write(0); }
  void Write(std::uint16_t first_frame) {
    SynthOptions options;
    options.model = kModel;
    SynthFormat format;
    format.mode = "512x10";
    metadata_ = MakeSynthMetadata(options, format);
    SynthStream sensor(options, metadata_);
    std::string error;
    const auto writer = ouster::PcapWriter::Open(path(), &error);
    ASSERT_TRUE(writer) << error;
    for (int lidar = 0; lidar < kRound;) {
      auto packet = sensor.Next();
      lidar += packet->imu ? 0 : 1;
      if (!packet->imu) AddFrames(first_frame, &packet->bytes);
      ASSERT_TRUE(
          writer->Write(Time{packet->due}, 7502, {packet->bytes.data(), packet->bytes.size()}));
    }
    ASSERT_TRUE(writer->Write(Time{}, 7503, {}));
    ASSERT_TRUE(writer->Close());
  }
  std::string path() const { return folder_ + "/a.pcap"; }
  static void AddFrames(std::uint16_t frames, std::vector<std::uint8_t>* packet) {
    const std::size_t at = ouster::kStandardHeader.frame_id;
    const auto frame = static_cast<std::uint16_t>((*packet)[at] + frames);
    std::memcpy(&(*packet)[at], &frame, sizeof frame);
    const std::size_t body = packet->size() - 8;
    const std::uint64_t crc = Crc64({packet->data(), body});
    std::memcpy(&(*packet)[body], &crc, sizeof crc);
  }

  struct Sent {
    ouster::PacketHeader header;
    std::uint64_t time_ns = 0;
    Duration due{};
  };
  /// Returns the next lidar packet, and expects its CRC to be right.
  Sent Next(PcapStream* stream) {
    auto packet = stream->Next();
    for (; packet->imu; packet = stream->Next()) {
      const ByteView imu{packet->bytes.data(), packet->bytes.size()};
      imu_times_ns_.push_back(ouster::ParseImuPacket(imu, metadata_)->front().timestamp);
    }
    const ByteView bytes{packet->bytes.data(), packet->bytes.size()};
    ByteReader crc(bytes.data + bytes.size - 8, 8);
    EXPECT_EQ(crc.Le64(), Crc64({bytes.data, bytes.size - 8}));
    const auto lidar = ouster::LidarPacket::Parse(bytes, metadata_.format);
    return {lidar->header(), lidar->Column(0).timestamp, packet->due};
  }

  static constexpr int kRound = 64;  // in packets
  ouster::Metadata metadata_;
  std::vector<std::uint64_t> imu_times_ns_;
};

TEST_F(Capture, GoesOnInEachRoundAsOneSensor) {
  PcapStream::Options options;
  options.speed = 2;
  options.serial = 9;
  PcapStream stream(path(), metadata_, options);
  stream.Restart({7, 1'000'000});
  const auto step = static_cast<std::uint64_t>(metadata_.packet_interval().count() / 2);
  std::vector<Sent> sent;
  for (unsigned i = 0; i < 3 * kRound; ++i) {
    sent.push_back(Next(&stream));
    EXPECT_EQ(sent[i].header.frame_id, i / (kRound / 2));
    EXPECT_EQ(sent[i].header.init_id, 7U);
    EXPECT_EQ(sent[i].header.serial, 9U);
    EXPECT_EQ(sent[i].time_ns, 1'000'000 + i * step);
    if (i >= kRound) {
      EXPECT_EQ(sent[i].due - sent[i - kRound].due, metadata_.scan_period());
    }
  }
  ASSERT_EQ(imu_times_ns_.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(imu_times_ns_[i], 1'000'000 + i * 5'000'000);
}

/// A sensor with an azimuth window also sends columns outside the window. These columns have no
/// time.
TEST_F(Capture, HasItsTimesFromTheFirstValidColumn) {
  SynthOptions options;
  options.model = kModel;
  SynthStream sensor(options, metadata_);
  sensor.Restart({1, 5'000'000'000});
  auto packet = sensor.Next();
  while (packet->imu) packet = sensor.Next();
  constexpr std::size_t kTimeAndIdAndStatus = 12;
  std::memset(&packet->bytes[metadata_.format.packet_header_size()], 0, kTimeAndIdAndStatus);
  AddFrames(0, &packet->bytes);
  std::string error;
  const auto writer = ouster::PcapWriter::Open(path(), &error);
  ASSERT_TRUE(writer->Write(Time{}, 7502, {packet->bytes.data(), packet->bytes.size()}));
  ASSERT_TRUE(writer->Close());
  PcapStream stream(path(), metadata_, {});
  stream.Restart({7, 1'000'000});
  const auto sent = stream.Next();
  const auto lidar =
      ouster::LidarPacket::Parse({sent->bytes.data(), sent->bytes.size()}, metadata_.format);
  EXPECT_FALSE(lidar->Column(0).valid());
  EXPECT_EQ(lidar->Column(1).timestamp, 1'000'000U);
}

TEST_F(Capture, MayHaveFrameIdsThatStartOver) {
  Write(65'535);
  PcapStream stream(path(), metadata_, {});
  std::vector<Sent> sent;
  for (unsigned i = 0; i < 3 * kRound; ++i) {
    sent.push_back(Next(&stream));
    EXPECT_EQ(sent[i].header.frame_id, (65'535 + i / (kRound / 2)) % 65'536);
    if (i >= kRound) {
      EXPECT_EQ(sent[i].due - sent[i - kRound].due, 2 * metadata_.scan_period());
    }
  }
}

TEST_F(Capture, OfASensorWithoutAnImuHasNoImuPackets) {
  metadata_.imu_profile = ouster::ImuProfile::kOff;
  PcapStream::Options options;
  options.loop = false;
  PcapStream stream(path(), metadata_, options);
  int packets = 0;
  for (; const auto packet = stream.Next(); ++packets) EXPECT_FALSE(packet->imu);
  EXPECT_EQ(packets, kRound);
}

TEST_F(Capture, BeginsAnewAfterARestartAndEndsOnceIfAsked) {
  PcapStream::Options options;
  PcapStream endless(path(), metadata_, options);
  options.loop = false;
  PcapStream once(path(), metadata_, options);
  const Duration first = Next(&endless).due;
  for (int i = 0; i < kRound; ++i) Next(&endless);
  while (once.Next()) continue;
  for (PcapStream* stream : {&endless, &once}) {
    stream->Restart({8, 5});
    const Sent sent = Next(stream);
    EXPECT_EQ(sent.header.frame_id, 0U);
    EXPECT_EQ(sent.header.init_id, 8U);
    EXPECT_EQ(sent.header.serial, metadata_.serial);
    EXPECT_EQ(sent.time_ns, 5U);
    EXPECT_EQ(sent.due, first);
  }
}

TEST(CaptureOfAccelGyro, HasTheNewSensorInItsImuPackets) {
  const test::TempFolder folder;
  const std::string path = folder.path() + "/a.pcap";
  ouster::Metadata metadata = MakeSynthMetadata({}, {});
  metadata.imu_profile = ouster::ImuProfile::kAccel32Gyro32Nmea;
  metadata.imu_measurements_per_packet = 1;
  SynthStream sensor({}, metadata);
  auto lidar = sensor.Next();
  while (lidar->imu) lidar = sensor.Next();
  std::string error;
  const auto writer = ouster::PcapWriter::Open(path, &error);
  ASSERT_TRUE(writer->Write(Time{}, 7502, {lidar->bytes.data(), lidar->bytes.size()}));
  const std::vector<std::uint8_t> imu(metadata.imu_packet_size());
  ASSERT_TRUE(writer->Write(Time{}, 7503, {imu.data(), imu.size()}));
  ASSERT_TRUE(writer->Close());
  PcapStream::Options options;
  options.serial = 9;
  PcapStream stream(path, metadata, options);
  stream.Restart({7, 0});
  stream.Next();
  const auto sent = stream.Next();
  ASSERT_TRUE(sent->imu);
  const auto header = [&](std::size_t at) { return static_cast<unsigned>(sent->bytes[at]); };
  EXPECT_EQ(header(ouster::kStandardHeader.init_id), 7U);
  EXPECT_EQ(header(ouster::kStandardHeader.serial), 9U);
  stream.Next();
  const auto again = stream.Next();
  ASSERT_TRUE(again->imu);
  EXPECT_EQ(again->bytes[ouster::kStandardHeader.frame_id], 1U) << "of the second round";
}

/// A sensor that sends `count` packets at once.
class FewPackets final : public PacketStream {
 public:
  explicit FewPackets(int count) : count_(count) {}
  void Restart(const Start&) override {}
  std::optional<OutPacket> Next() override {
    if (count_-- <= 0) return std::nullopt;
    return OutPacket{{}, false, {1}};
  }

 private:
  int count_;
};

TEST(PlayerFaults, KeepNoPacketBackAtTheEnd) {
  ReplayOptions options;
  const ouster::Metadata metadata = MakeSynthMetadata(options.synth, options.format);
  Sensor sensor(metadata, "", [&](const nlohmann::json&) { return metadata; });
  sensor.MergeFaults({{"reorder", 1}});
  Player player(options, metadata, &sensor,
                [](const ouster::Metadata&) { return std::make_unique<FewPackets>(3); });
  player.Pump(Now());
  player.Finish();
  EXPECT_EQ(player.counts().sent, 3U);
}

TEST(PlayerFaults, TakeEffectBeforeAllLatePacketsAreSent) {
  ReplayOptions options;
  const ouster::Metadata metadata = MakeSynthMetadata(options.synth, options.format);
  Sensor sensor(metadata, "", [&](const nlohmann::json&) { return metadata; });
  Player player(options, metadata, &sensor,
                [](const ouster::Metadata&) { return std::make_unique<FewPackets>(1000); });
  const Time now = Now();
  EXPECT_LE(player.Pump(now), now) << "the next packets are due at once";
  sensor.MergeFaults({{"silent", true}});
  while (player.Pump(now)) continue;
  EXPECT_GT(player.counts().sent, 0U);
  EXPECT_GT(player.counts().silenced, 900U);
  EXPECT_EQ(player.counts().sent + player.counts().silenced, 1000U);
}

/// A sensor that sends one packet now, and each further packet an hour later.
class OnePacketNow final : public PacketStream {
 public:
  void Restart(const Start&) override {}
  std::optional<OutPacket> Next() override {
    const bool first = std::exchange(first_, false);
    return OutPacket{first ? Duration{} : std::chrono::hours(1), false, {1}};
  }

 private:
  bool first_ = true;
};

TEST(PlayerFaults, KeepNoPacketBackForAfterARestart) {
  ReplayOptions options;
  const ouster::Metadata metadata = MakeSynthMetadata(options.synth, options.format);
  Sensor sensor(metadata, "", [&](const nlohmann::json&) { return metadata; });
  sensor.MergeFaults({{"reorder", 1}});
  Player player(options, metadata, &sensor,
                [](const ouster::Metadata&) { return std::make_unique<OnePacketNow>(); });
  const Time now = Now();
  player.Pump(now);
  EXPECT_EQ(player.counts().sent, 0U);
  sensor.Restart();
  player.Pump(now);
  EXPECT_EQ(player.counts().sent, 1U);
}

TEST(PlayerEvents, ComeAtTimesSinceTheProgramBeganWhateverRestarts) {
  ReplayOptions options;
  const ouster::Metadata metadata = MakeSynthMetadata(options.synth, options.format);
  Sensor sensor(metadata, "", [&](const nlohmann::json&) { return metadata; });
  options.events = {{100, nlohmann::json::object(), true}, {200, {{"silent", true}}}};
  const Time begin = Now();
  Player player(options, metadata, &sensor,
                [](const ouster::Metadata&) { return std::make_unique<FewPackets>(0); });
  player.Pump(begin + std::chrono::seconds(150));
  EXPECT_FALSE(sensor.faults().silent);
  player.Pump(begin + std::chrono::seconds(250));
  EXPECT_TRUE(sensor.faults().silent);
}

}  // namespace
}  // namespace lidar::tools

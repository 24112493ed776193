// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "src/ouster/scan_batcher.h"
#include "tests/core/ouster/captures.h"

namespace lidar::ouster {
namespace {

using Packets = std::vector<std::vector<std::uint8_t>>;

/// Three consecutive scans of an OS1-128, with 64 packets per scan.
class Batcher : public ::testing::Test {
 protected:
  static constexpr std::size_t kPacketsPerScan = 64;

  std::vector<Slice> Run(const Packets& packets, std::uint32_t slices = 8) {
    std::string error;
    ScanBatcher batcher(metadata_, *PointWriter::Create(metadata_, {}, &error), {slices, 4});
    std::vector<Slice> out;
    const auto drain = [&] {
      while (auto slice = batcher.Pop()) out.push_back(*std::move(slice));
    };
    for (const auto& p : packets) {
      batcher.Push(*LidarPacket::Parse({p.data(), p.size()}, metadata_.format));
      drain();
    }
    batcher.Flush();
    drain();
    stats_ = batcher.stats();
    return out;
  }
  static void SetInitId(std::vector<std::uint8_t>* packet, std::uint8_t low_byte) {
    (*packet)[kStandardHeader.init_id] = low_byte;
  }

  Metadata metadata_ = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  const Packets packets_ = test::LoadPackets("OS-1-128_v2.3.0_1024x10_lb_n3.pcap", metadata_);
  BatcherStats stats_;
};

void ExpectSamePoints(const std::vector<Slice>& a, const std::vector<Slice>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].scan_id, b[i].scan_id);
    EXPECT_EQ(a[i].index, b[i].index);
    EXPECT_EQ(a[i].start, b[i].start);
    EXPECT_TRUE(a[i].points == b[i].points) << "slice " << i;
  }
}

TEST_F(Batcher, GivesEverySliceOnceAndInOrder) {
  const auto slices = Run(packets_);
  ASSERT_EQ(slices.size(), 24U);
  for (std::uint32_t i = 0; i < 24; ++i) {
    EXPECT_EQ(slices[i].scan_id, i / 8);
    EXPECT_EQ(slices[i].index, i % 8);
    EXPECT_EQ(slices[i].count, 8U);
    EXPECT_EQ(slices[i].first_column, i % 8 * 128);
    EXPECT_EQ(slices[i].width, 128U);
    EXPECT_EQ(slices[i].missing_columns, 0U);
    EXPECT_FALSE(slices[i].after_gap);
    if (i > 0) {
      EXPECT_NEAR(static_cast<double>(slices[i].start - slices[i - 1].start), 12.5e6, 0.2e6);
    }
  }
  EXPECT_EQ(stats_.packets, 192U);
  EXPECT_EQ(stats_.lost_packets, 0U);
}

TEST_F(Batcher, TakesNoTimeFromColumnsThatTheSensorMarksAsInvalid) {
  const auto whole = Run(packets_);
  auto packets = packets_;
  test::Invalidate(metadata_.format, 0, &packets[8]);  // the first column of slice 1
  for (std::size_t p = 16; p < 24; ++p)                // all of the third slice
    for (std::uint32_t c = 0; c < 16; ++c) test::Invalidate(metadata_.format, c, &packets[p]);
  const auto slices = Run(packets);
  ASSERT_EQ(slices.size(), whole.size());
  for (std::size_t i = 0; i < slices.size(); ++i)
    EXPECT_NEAR(static_cast<double>(slices[i].start), static_cast<double>(whole[i].start), 1e5)
        << i;
  EXPECT_EQ(stats_.incomplete_slices, 0U);
  EXPECT_EQ(stats_.duplicate_packets, 0U);
}

TEST_F(Batcher, GivesASliceWithThePacketThatCompletesIt) {
  std::string error;
  ScanBatcher batcher(metadata_, *PointWriter::Create(metadata_, {}, &error), {8, 4});
  for (std::size_t i = 0; i < packets_.size(); ++i) {
    batcher.Push(*LidarPacket::Parse({packets_[i].data(), packets_[i].size()}, metadata_.format));
    EXPECT_EQ(batcher.Pop().has_value(), i % 8 == 7) << "packet " << i;
  }
}

TEST_F(Batcher, PutsReorderedAndDuplicatedPacketsRight) {
  Packets shuffled = packets_;
  for (std::size_t i = 0; i + 3 < shuffled.size(); i += 3) std::swap(shuffled[i], shuffled[i + 2]);
  for (std::size_t i = 0; i < shuffled.size(); i += 10)
    shuffled.insert(shuffled.begin() + static_cast<std::ptrdiff_t>(i), shuffled[i]);
  const auto straight = Run(packets_);
  ExpectSamePoints(Run(shuffled), straight);
  EXPECT_EQ(stats_.lost_packets, 0U);
  EXPECT_EQ(stats_.duplicate_packets, shuffled.size() - packets_.size());
  EXPECT_EQ(stats_.late_packets, 0U);
}

TEST_F(Batcher, DuplicatesDoNotShortenTheWaitForAPacketThatIsUnderWay) {
  Packets repeated = packets_;
  // The last packet of slice 0 comes after the first packet of slice 1.
  std::swap(repeated[7], repeated[8]);
  repeated.insert(repeated.begin() + 8, 4, Packets::value_type(repeated[7]));
  const auto straight = Run(packets_);
  ExpectSamePoints(Run(repeated), straight);
  EXPECT_EQ(stats_.duplicate_packets, 4U);
  EXPECT_EQ(stats_.late_packets, 0U);
  EXPECT_EQ(stats_.incomplete_slices, 0U);
}

TEST_F(Batcher, ASliceWaitsForTheOneBeforeOfWhichNothingCameYet) {
  const auto straight = Run(packets_, 64);
  Packets swapped = packets_;
  for (std::size_t i = 5; i + 3 < swapped.size(); i += 10) std::swap(swapped[i], swapped[i + 3]);
  ExpectSamePoints(Run(swapped, 64), straight);
  EXPECT_EQ(stats_.lost_packets, 0U);
  EXPECT_EQ(stats_.late_packets, 0U);
}

TEST_F(Batcher, FillsLostColumnsWithMissingReturnsAndCountsTheirPackets) {
  Packets lossy = packets_;
  // The packet has the columns 304 to 319 of the second scan, which belong to slice 2.
  lossy.erase(lossy.begin() + 83);
  const auto whole = Run(packets_);
  const auto slices = Run(lossy);
  ASSERT_EQ(slices.size(), 24U);
  EXPECT_EQ(stats_.lost_packets, 1U);
  EXPECT_EQ(stats_.incomplete_slices, 1U);
  const Slice& hurt = slices[10];
  EXPECT_EQ(hurt.missing_columns, 16U);
  const std::size_t step = hurt.points.size() / (std::size_t{128} * 128);
  for (std::size_t i = 0; i < std::size_t{128} * 128; ++i) {
    const bool lost = i % 128 >= 48 && i % 128 < 64;
    const auto* point = &hurt.points[i * step];
    if (lost)
      EXPECT_TRUE(std::all_of(point, point + step, [](std::uint8_t b) { return b == 0; }));
    else
      EXPECT_EQ(std::memcmp(point, &whole[10].points[i * step], step), 0);
  }
}

TEST_F(Batcher, GivesASliceWithItsLastPacketAlsoWhereTheOneBeforeIsMissing) {
  Packets lossy = packets_;
  lossy.erase(lossy.begin() + 16, lossy.begin() + 24);  // all packets of slice 2
  std::string error;
  ScanBatcher batcher(metadata_, *PointWriter::Create(metadata_, {}, &error), {8, 4});
  for (std::size_t i = 0; i < 32; ++i) {
    batcher.Push(*LidarPacket::Parse({lossy[i].data(), lossy[i].size()}, metadata_.format));
    EXPECT_EQ(batcher.Pop().has_value(), i % 8 == 7) << "packet " << i;
  }
}

TEST_F(Batcher, WaitsForALostPacketNoLongerThanFourPackets) {
  Packets lossy = packets_;
  lossy.erase(lossy.begin() + 2);  // a packet of slice 0, which ends with packet 7
  std::string error;
  ScanBatcher batcher(metadata_, *PointWriter::Create(metadata_, {}, &error), {8, 4});
  for (std::size_t i = 0; i < 12; ++i) {
    batcher.Push(*LidarPacket::Parse({lossy[i].data(), lossy[i].size()}, metadata_.format));
    EXPECT_EQ(batcher.Pop().has_value(), i == 10) << "packet " << i;
  }
}

TEST_F(Batcher, APacketThatComesTooLateIsNoLoss) {
  Packets reordered = packets_;
  std::rotate(reordered.begin() + 20, reordered.begin() + 21, reordered.begin() + 40);
  const auto slices = Run(reordered);
  EXPECT_EQ(slices.size(), 24U);
  EXPECT_EQ(stats_.incomplete_slices, 1U);
  EXPECT_EQ(stats_.late_packets, 1U);
  EXPECT_EQ(stats_.lost_packets, 0U);
}

TEST_F(Batcher, LeavesOutSlicesOfWhichNothingCame) {
  Packets lossy = packets_;
  // Removes the slices 2 to 7, and the slices 0 and 1 of the next scan.
  lossy.erase(lossy.begin() + 16, lossy.begin() + 80);
  const auto slices = Run(lossy);
  ASSERT_EQ(slices.size(), 16U);
  EXPECT_EQ(slices[1].index, 1U);
  EXPECT_EQ(slices[2].scan_id, 1U);
  EXPECT_EQ(slices[2].index, 2U);
  EXPECT_TRUE(slices[2].after_gap);
  EXPECT_EQ(stats_.lost_packets, 64U);
}

TEST_F(Batcher, ThePacketInWhichAWindowBeginsIsMissed) {
  metadata_.window = {1, 256};
  Packets lossy = packets_;
  lossy.erase(lossy.begin() + 64);  // columns 0 to 15 of the second scan
  Run(lossy);
  EXPECT_EQ(stats_.lost_packets, 1U);
}

TEST_F(Batcher, JoiningOrLeavingInTheMiddleOfAScanIsNoLoss) {
  const Packets middle(packets_.begin() + 21, packets_.end() - 5);
  const auto slices = Run(middle);
  EXPECT_EQ(slices.front().index, 2U);
  EXPECT_FALSE(slices.front().after_gap);
  EXPECT_EQ(stats_.lost_packets, 0U);
  EXPECT_EQ(slices.size(), 22U);
}

TEST_F(Batcher, ANewInitIdEndsTheScanAndStartsAnother) {
  Packets restarted = packets_;
  for (std::size_t i = 70; i < restarted.size(); ++i) SetInitId(&restarted[i], 7);
  // After its restart, the sensor counts its scans from zero.
  for (std::size_t i = 70; i < restarted.size(); ++i) restarted[i][2] = restarted[i][3] = 0;
  restarted.resize(128);
  const auto slices = Run(restarted);
  EXPECT_EQ(stats_.restarts, 1U);
  EXPECT_EQ(stats_.lost_packets, 0U);
  ASSERT_EQ(slices.size(), 8U + 1 + 8);
  EXPECT_EQ(slices[8].scan_id, 1U);
  EXPECT_EQ(slices[9].scan_id, 2U);
  EXPECT_TRUE(slices[9].after_gap);
}

TEST_F(Batcher, LeavingSoonAfterARestartIsNoLoss) {
  Packets restarted(packets_.begin(), packets_.begin() + 70);
  for (std::size_t i = 64; i < restarted.size(); ++i) SetInitId(&restarted[i], 7);
  Run(restarted);
  EXPECT_EQ(stats_.restarts, 1U);
  EXPECT_EQ(stats_.lost_packets, 0U);
}

TEST_F(Batcher, OneDamagedFrameIdChangesNothing) {
  Packets damaged = packets_;
  damaged[100][3] ^= 0x40;
  const auto slices = Run(damaged);
  EXPECT_EQ(slices.size(), 24U);
  EXPECT_EQ(stats_.stray_packets, 1U);
  EXPECT_EQ(stats_.lost_packets, 1U);
  EXPECT_EQ(stats_.restarts, 0U);
}

TEST_F(Batcher, DamagedFrameIdsWithGoodOnesBetweenChangeNothing) {
  Packets damaged = packets_;
  for (const std::size_t i : {20U, 21U, 22U, 100U, 140U, 180U}) damaged[i][3] ^= 0x40;
  const auto slices = Run(damaged);
  ASSERT_EQ(slices.size(), 24U);
  EXPECT_EQ(slices.back().scan_id, 2U);
  EXPECT_EQ(stats_.packets, packets_.size());
  EXPECT_EQ(stats_.stray_packets, 6U);
  EXPECT_EQ(stats_.lost_packets, 6U);
  EXPECT_EQ(stats_.restarts, 0U);
  for (const Slice& slice : slices) EXPECT_FALSE(slice.after_gap);
}

TEST_F(Batcher, FrameIdsThatStartOverAreARestart) {
  Packets twice(packets_.begin() + 128, packets_.end());
  twice.insert(twice.end(), packets_.begin(), packets_.begin() + 64);
  const auto slices = Run(twice);
  EXPECT_EQ(stats_.restarts, 1U);
  EXPECT_EQ(stats_.stray_packets, 4U);
  EXPECT_EQ(stats_.lost_packets, 0U) << "the fourth packet counts already";
  EXPECT_EQ(slices.back().scan_id, 1U);
  EXPECT_EQ(slices.back().index, 7U);
}

TEST_F(Batcher, FrameIdsFarAheadAreARestart) {
  Packets ahead(packets_.begin(), packets_.begin() + 128);
  for (std::size_t i = kPacketsPerScan; i < ahead.size(); ++i) ahead[i][3] ^= 0x40;
  const auto slices = Run(ahead);
  EXPECT_EQ(stats_.restarts, 1U);
  EXPECT_EQ(stats_.lost_packets, 0U);
  ASSERT_EQ(slices.size(), 16U);
  EXPECT_EQ(slices.back().scan_id, 1U);
  EXPECT_EQ(slices.back().index, 7U);
}

TEST_F(Batcher, BehindAFlushThePacketsMayBeOfAnyScan) {
  std::string error;
  ScanBatcher batcher(metadata_, *PointWriter::Create(metadata_, {}, &error), {8, 4});
  Packets ahead(packets_.begin(), packets_.begin() + 2 * kPacketsPerScan);
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    if (i == kPacketsPerScan) batcher.Flush();
    if (i >= kPacketsPerScan) ahead[i][3] ^= 0x40;
    batcher.Push(*LidarPacket::Parse({ahead[i].data(), ahead[i].size()}, metadata_.format));
  }
  EXPECT_EQ(batcher.stats().stray_packets, 0U);
  EXPECT_EQ(batcher.stats().lost_packets, 0U);
  EXPECT_EQ(batcher.stats().restarts, 0U);
  std::vector<Slice> slices;
  while (auto slice = batcher.Pop()) slices.push_back(*std::move(slice));
  ASSERT_EQ(slices.size(), 16U);
  for (std::uint32_t i = 0; i < 16; ++i) {
    EXPECT_EQ(slices[i].scan_id, i / 8);
    EXPECT_EQ(slices[i].after_gap, i == 8) << i;
  }
}

TEST_F(Batcher, FrameIdsWrapAround) {
  Packets wrapping = packets_;
  for (std::size_t i = 0; i < wrapping.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(0xffff + i / kPacketsPerScan);
    std::memcpy(&wrapping[i][2], &id, sizeof id);
  }
  std::swap(wrapping[kPacketsPerScan - 1], wrapping[kPacketsPerScan]);
  ExpectSamePoints(Run(wrapping), Run(packets_));
}

TEST(Window, PadsToTheFullTurnAndCompletesWithTheLastColumnOfTheWindow) {
  const Metadata metadata = test::LoadMetadata("windowed_frame1_0.json");
  const auto packets = test::LoadPackets("windowed_frame1.pcap", metadata);
  ASSERT_EQ(metadata.window.first, 1U);
  ASSERT_EQ(metadata.window.count, 256U);
  ASSERT_EQ(packets.size(), 17U);
  std::string error;
  ScanBatcher batcher(metadata, *PointWriter::Create(metadata, {}, &error), {8, 4});
  for (const auto& p : packets)
    batcher.Push(*LidarPacket::Parse({p.data(), p.size()}, metadata.format));
  std::vector<Slice> slices;
  while (auto slice = batcher.Pop()) slices.push_back(*std::move(slice));
  ASSERT_EQ(slices.size(), 8U);
  const auto is_blank = [](const Slice& s) {
    return std::all_of(s.points.begin(), s.points.end(), [](std::uint8_t b) { return b == 0; });
  };
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(slices[i].index, i);
    EXPECT_EQ(slices[i].missing_columns, 0U);
    EXPECT_EQ(is_blank(slices[i]), i > 4) << i;
    if (i > 0) {
      EXPECT_NEAR(static_cast<double>(slices[i].start - slices[i - 1].start), 12.5e6, 0.2e6);
    }
  }
  EXPECT_EQ(batcher.stats().lost_packets, 0U);
}

/// Azimuth windows, each with its first column and its number of columns. A window may contain the
/// begin of a scan.
class AnyWindow : public ::testing::TestWithParam<std::pair<std::uint32_t, std::uint32_t>> {
 protected:
  static std::vector<Slice> Run(const Metadata& metadata, BatcherStats* stats) {
    std::string error;
    ScanBatcher batcher(metadata, *PointWriter::Create(metadata, {}, &error), {8, 4});
    std::vector<Slice> slices;
    for (const auto& p : test::LoadPackets("OS-1-128_v2.3.0_1024x10_lb_n3.pcap", metadata)) {
      batcher.Push(*LidarPacket::Parse({p.data(), p.size()}, metadata.format));
      while (auto slice = batcher.Pop()) slices.push_back(*std::move(slice));
    }
    batcher.Flush();
    while (auto slice = batcher.Pop()) slices.push_back(*std::move(slice));
    *stats = batcher.stats();
    return slices;
  }
};
INSTANTIATE_TEST_SUITE_P(All, AnyWindow,
                         ::testing::Values(std::pair(0U, 1024U), std::pair(1U, 256U),
                                           std::pair(512U, 512U), std::pair(900U, 300U),
                                           std::pair(1023U, 2U), std::pair(1000U, 24U),
                                           std::pair(600U, 1000U), std::pair(37U, 1U)));

TEST_P(AnyWindow, HasItsColumnsAsTheWholeScanHasThemAndNoOthers) {
  Metadata metadata = test::LoadMetadata("OS-1-128_v2.3.0_1024x10.json");
  BatcherStats stats;
  const auto whole = Run(metadata, &stats);
  const auto [first, count] = GetParam();
  metadata.window = {first, count};
  const auto windowed = Run(metadata, &stats);
  EXPECT_EQ(stats.lost_packets, 0U);
  EXPECT_EQ(stats.incomplete_slices, 0U);
  ASSERT_EQ(windowed.size(), whole.size());
  for (std::size_t s = 0; s < whole.size(); ++s) {
    EXPECT_EQ(windowed[s].scan_id, whole[s].scan_id);
    EXPECT_EQ(windowed[s].index, whole[s].index);
    const std::size_t beams = metadata.format.beams;
    const std::size_t step = whole[s].points.size() / beams / whole[s].width;
    std::vector<std::uint8_t> expected = whole[s].points;
    for (std::uint32_t c = 0; c < whole[s].width; ++c)
      if ((whole[s].first_column + c + 1024 - first) % 1024 >= count)
        for (std::size_t beam = 0; beam < beams; ++beam)
          std::fill_n(
              expected.begin() + static_cast<std::ptrdiff_t>((beam * whole[s].width + c) * step),
              step, std::uint8_t{0});
    EXPECT_EQ(windowed[s].points, expected) << "slice " << s;
  }
}

}  // namespace
}  // namespace lidar::ouster

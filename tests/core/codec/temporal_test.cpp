// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests slices that refer to earlier slices. The simulated links acknowledge slices, lose slices,
// or return no acknowledgements.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <functional>
#include <random>

#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"
#include "tests/core/codec/test_clouds.h"

namespace lidar::codec {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kSlices = 4;
constexpr std::uint32_t kColumns = 128;  // This is small, because some tests need many scans.
constexpr std::uint32_t kReceiver = 77;

/// The settings of a run. If `loses` returns true for a slice, the link loses that slice.
struct LinkTest {
  unsigned effort = 2;
  unsigned threads = 1;
  std::uint32_t beams = 8;
  std::uint32_t slices = kSlices;
  Duration key_interval = 10s;
  std::function<bool(std::uint32_t scan, std::uint32_t index)> loses = [](auto, auto) {
    return false;
  };
  /// The receiver acknowledges a slice `delay` scans later. Without a value, it sends no
  /// acknowledgements.
  std::optional<std::uint32_t> delay = 2;
  /// Returns the image of a scan. By default, nothing moves from scan to scan.
  std::function<RangeImage(const SensorModel&, std::uint32_t scan)> scene =
      [](const SensorModel& model, std::uint32_t scan) {
        return test::RoomScan(model, 0, kColumns, scan + 1);
      };
};

struct Sent {
  std::size_t bytes = 0;
  std::size_t plain_bytes = 0;  // the size without references
  bool is_plain = false;        // has the same bytes as without references
  bool refers = false;
  bool decoded = false;
};

/// Connects a sensor, an encoder with a reference keeper, a link and a decoder.
class Loop {
 public:
  explicit Loop(LinkTest test)
      : test_(std::move(test)),
        model_(test::RoomSensor(test_.beams)),
        format_{test::OrganisedLayout(), test_.beams, model_},
        encoder_(*SliceEncoder::Create(format_)),
        plain_(*SliceEncoder::Create(format_)),
        decoder_(format_, 1U << 20) {
    keeper_.set_key_interval(test_.key_interval);
    for (SliceEncoder* encoder : {&encoder_, &plain_}) {
      encoder->set_effort(test_.effort);
      encoder->set_threads(test_.threads);
    }
  }

  ReferenceKeeper& keeper() { return keeper_; }
  Time now() const { return Time{100ms * scan_}; }

  /// Encodes and sends the next scan, and returns its slices.
  std::vector<Sent> Scan() {
    const RangeImage whole = test_.scene(model_, scan_);
    std::vector<Sent> sent;
    for (std::uint32_t i = 0; i < test_.slices; ++i) sent.push_back(Slice(whole, i));
    ++scan_;
    Acknowledge();
    return sent;
  }
  std::vector<Sent> Scans(int count) {
    std::vector<Sent> all;
    for (int i = 0; i < count; ++i)
      for (const Sent& sent : Scan()) all.push_back(sent);
    return all;
  }

 private:
  struct Arrived {
    std::uint32_t scan;
    std::uint32_t index;
  };

  void Acknowledge() {
    while (test_.delay && !arrived_.empty() && arrived_.front().scan + *test_.delay <= scan_) {
      keeper_.OnAcknowledged(now(), kReceiver, arrived_.front().scan, arrived_.front().index);
      arrived_.pop_front();
    }
  }

  RangeImage Sector(const RangeImage& whole, std::uint32_t index) const {
    RangeImage sector;
    sector.beams = whole.beams;
    sector.columns = whole.columns / test_.slices;
    sector.first_column = index * sector.columns;
    for (std::uint32_t beam = 0; beam < whole.beams; ++beam) {
      for (std::uint32_t i = 0; i < sector.columns; ++i) {
        const std::size_t at = std::size_t{beam} * whole.columns + sector.first_column + i;
        sector.ranges.push_back(whole.ranges[at]);
        sector.intensity.push_back(whole.intensity[at]);
      }
    }
    return sector;
  }

  Sent Slice(const RangeImage& whole, std::uint32_t index) {
    const RangeImage image = Sector(whole, index);
    const auto raw = test::RawCloud(model_, image);
    const SliceSettings settings{0.02, 0, 5};
    EncodedSlice plain;
    plain_.Load({raw.data(), raw.size()}, image.first_column, true);
    EXPECT_EQ(plain_.Encode(settings, &plain), SliceResult::kEncoded);
    EncodedSlice slice;
    encoder_.Load({raw.data(), raw.size()}, image.first_column, true);
    const bool remembers = keeper_.Begin(now(), {scan_, index, test_.slices});
    encoder_.LinkBy(remembers ? &keeper_ : nullptr);
    Sent sent;
    sent.refers = encoder_.Mode().rfind("range-temporal", 0) == 0;
    EXPECT_EQ(encoder_.Encode(settings, &slice), SliceResult::kEncoded);
    sent.bytes = slice.bytes.size();
    sent.plain_bytes = plain.bytes.size();
    sent.is_plain = slice.bytes == plain.bytes;
    keeper_.OnEncoded(std::move(slice.blocks));
    if (test_.loses(scan_, index)) return sent;
    arrived_.push_back({scan_, index});
    Check(image, slice.bytes, &sent);
    return sent;
  }

  /// Decodes a slice that arrived. If it decodes, expects its ranges to be within the error.
  void Check(const RangeImage& image, const std::vector<std::uint8_t>& bytes, Sent* sent) {
    const auto shape = decoder_.Decode({bytes.data(), bytes.size()});
    sent->decoded = shape.has_value();
    if (!shape) return;
    std::vector<std::uint8_t> back(image.size() * 20);
    decoder_.Write(back.data());
    for (std::size_t i = 0; i < image.size(); ++i) {
      std::uint32_t range = 0;
      std::memcpy(&range, &back[20 * i + 16], sizeof range);
      ASSERT_EQ(range == 0, image.ranges[i] == 0) << i;
      ASSERT_NEAR(range, image.ranges[i], 20) << i;
    }
  }

  LinkTest test_;
  SensorModel model_;
  CloudFormat format_;
  SliceEncoder encoder_;
  SliceEncoder plain_;
  SliceDecoder decoder_;
  ReferenceKeeper keeper_;
  std::uint32_t scan_ = 0;
  std::deque<Arrived> arrived_;
};

std::size_t Bytes(const std::vector<Sent>& slices, std::size_t Sent::*bytes) {
  std::size_t sum = 0;
  for (const Sent& s : slices) sum += s.*bytes;
  return sum;
}
bool AllDecoded(const std::vector<Sent>& slices) {
  return std::all_of(slices.begin(), slices.end(), [](const Sent& s) { return s.decoded; });
}
bool AllPlain(const std::vector<Sent>& slices) {
  return std::all_of(slices.begin(), slices.end(), [](const Sent& s) { return s.is_plain; });
}
bool AnyRefers(const std::vector<Sent>& slices) {
  return std::any_of(slices.begin(), slices.end(), [](const Sent& s) { return s.refers; });
}

class EffortsAndThreads : public ::testing::TestWithParam<std::pair<unsigned, unsigned>> {};
TEST_P(EffortsAndThreads, SaveBitsWhereTheSensorStandsStill) {
  LinkTest test;
  test.scene = [](const SensorModel& model, std::uint32_t scan) {
    return test::RoomScan(model, 0, 256, scan + 1);
  };
  test.effort = GetParam().first;
  test.threads = GetParam().second;
  if (test.threads > 1) {
    test.slices = 1;
    test.beams = 64;
  }
  Loop loop(test);
  EXPECT_TRUE(AllDecoded(loop.Scans(6)));
  const auto later = loop.Scans(4);
  EXPECT_TRUE(AllDecoded(later));
  EXPECT_LT(static_cast<double>(Bytes(later, &Sent::bytes)),
            0.9 * static_cast<double>(Bytes(later, &Sent::plain_bytes)));
}
INSTANTIATE_TEST_SUITE_P(All, EffortsAndThreads,
                         ::testing::Values(std::pair(1U, 1U), std::pair(2U, 1U), std::pair(3U, 1U),
                                           std::pair(2U, 4U)));

TEST(Temporal, SlicesAreThePlainOnesWithoutAcknowledgements) {
  LinkTest test;
  test.delay.reset();
  EXPECT_TRUE(AllPlain(Loop(test).Scans(10)));
}

TEST(Temporal, SlicesAreThePlainOnesAtEffort0) {
  LinkTest test;
  test.effort = 0;
  EXPECT_TRUE(AllPlain(Loop(test).Scans(10)));
}

TEST(Temporal, SlicesThatArriveDecodeWhateverWasLost) {
  std::mt19937 random(5);
  LinkTest test;
  test.loses = [&](auto, auto) { return random() % 4 == 0; };
  Loop loop(test);
  const auto sent = loop.Scans(30);
  EXPECT_GT(std::count_if(sent.begin(), sent.end(), [](const Sent& s) { return s.refers; }), 60);
  // The decoder decodes each slice that arrives.
  LinkTest all;
  all.loses = [](std::uint32_t scan, std::uint32_t index) { return (scan + index) % 3 == 1; };
  Loop steady(all);
  for (std::uint32_t scan = 0; scan < 20; ++scan) {
    const auto slices = steady.Scan();
    for (std::uint32_t i = 0; i < kSlices; ++i) EXPECT_EQ(slices[i].decoded, (scan + i) % 3 != 1);
  }
}

TEST(Temporal, SlicesStandAloneOnceInAKeyInterval) {
  LinkTest test;
  test.key_interval = 1s;
  Loop loop(test);
  loop.Scans(15);
  for (std::uint32_t i = 0; i < 2; ++i) {
    // At ten scans per second, each sector is renewed once in these ten scans. The sectors are not
    // all renewed in the same scan.
    std::vector<unsigned> alone(kSlices, 0);
    for (int scan = 0; scan < 10; ++scan) {
      const auto sent = loop.Scan();
      unsigned now = 0;
      for (std::uint32_t s = 0; s < kSlices; ++s) {
        if (!sent[s].refers) ++alone[s];
        if (!sent[s].refers) ++now;
      }
      EXPECT_LT(now, kSlices);
    }
    // While the renewed slice is not acknowledged yet, the next slices of its sector stand alone,
    // too.
    for (const unsigned count : alone) EXPECT_TRUE(count >= 1 && count <= 3) << count;
  }
}

TEST(Temporal, SlicesStandAloneAfterAKeyRequest) {
  Loop loop({});
  EXPECT_TRUE(AnyRefers(loop.Scans(6)));
  loop.keeper().OnKeyRequest();
  EXPECT_FALSE(AnyRefers(loop.Scans(2)));
  EXPECT_TRUE(AnyRefers(loop.Scans(3)));
}

TEST(Temporal, SlicesAreThePlainOnesWithASecondReceiver) {
  Loop loop({});
  EXPECT_TRUE(AnyRefers(loop.Scans(6)));
  for (int scan = 0; scan < 10; ++scan) {
    loop.keeper().OnAcknowledged(loop.now(), kReceiver + 1, 0, 0);
    EXPECT_TRUE(AllPlain(loop.Scan())) << scan;
  }
  // After a while the second receiver is forgotten, so that only the first one is left.
  loop.Scans(25);
  EXPECT_TRUE(AnyRefers(loop.Scans(3)));
}

TEST(Temporal, SlicesAreThePlainOnesWhenTheReceiverHasFallenSilent) {
  std::uint32_t heard = 10;
  LinkTest test;
  test.loses = [&](std::uint32_t scan, auto) { return scan >= heard; };
  Loop loop(test);
  EXPECT_TRUE(AnyRefers(loop.Scans(10)));
  loop.Scans(25);
  EXPECT_TRUE(AllPlain(loop.Scans(10)));
  EXPECT_EQ(loop.keeper().bytes(), 0U);
}

TEST(Temporal, SlicesOfAMovingSensorAreThePlainOnes) {
  LinkTest test;
  test.scene = [](const SensorModel& model, std::uint32_t scan) {
    RangeImage image = test::RoomScan(model, 0, kColumns, scan + 1);
    for (std::uint32_t& range : image.ranges)
      if (range > 0) range += scan * 300;
    return image;
  };
  const auto sent = Loop(test).Scans(10);
  EXPECT_TRUE(AllDecoded(sent));
  EXPECT_TRUE(AllPlain(sent));
}

TEST(Temporal, SlicesFollowASensorThatStopsAndGoesOn) {
  LinkTest test;
  test.scene = [](const SensorModel& model, std::uint32_t scan) {
    RangeImage image = test::RoomScan(model, 0, kColumns, scan + 1);
    const bool moves = scan % 20 >= 10;
    for (std::uint32_t& range : image.ranges)
      if (range > 0 && moves) range += scan * 300;
    return image;
  };
  Loop loop(test);
  for (int i = 0; i < 3; ++i) {
    const auto standing = loop.Scans(10);
    EXPECT_TRUE(AllDecoded(standing));
    EXPECT_TRUE(AnyRefers(standing));
    EXPECT_TRUE(AllDecoded(loop.Scans(10)));
  }
}

TEST(Temporal, SlicesOfAChangedSceneDoNotReferToTheOldOne) {
  LinkTest test;
  test.effort = 1;
  test.delay = 4;
  test.scene = [](const SensorModel& model, std::uint32_t scan) {
    RangeImage image = test::RoomScan(model, 0, kColumns, scan + 1);
    for (std::uint32_t& range : image.ranges)
      if (range > 0 && scan >= 10) range = range / 2 + 700;
    return image;
  };
  Loop loop(test);
  loop.Scans(8);
  EXPECT_TRUE(AnyRefers(loop.Scans(2)));
  EXPECT_TRUE(AllPlain(loop.Scan())) << "it has changed";
  for (int scan = 0; scan < 2; ++scan) {
    // The receiver has not acknowledged a slice of the new scene yet.
    const auto standing = loop.Scan();
    EXPECT_TRUE(AllDecoded(standing));
    for (const Sent& sent : standing) EXPECT_EQ(sent.bytes, sent.plain_bytes + 1) << scan;
  }
  loop.Scans(4);
  const auto later = loop.Scans(2);
  EXPECT_LT(Bytes(later, &Sent::bytes), Bytes(later, &Sent::plain_bytes));
}

TEST(Temporal, MemoryIsBoundedOverALongRoundTrip) {
  LinkTest test;
  test.delay = 60;
  Loop loop(test);
  loop.keeper().OnAcknowledged(loop.now(), kReceiver, 0, 0);
  for (int i = 0; i < 50; ++i) {
    // Acknowledgements arrive all the time, but always too late.
    loop.keeper().OnAcknowledged(loop.now(), kReceiver, 4'000'000, 0);
    const auto sent = loop.Scan();
    EXPECT_TRUE(AllDecoded(sent));
    EXPECT_LE(loop.keeper().bytes(),
              kSlices * ReferenceKeeper::kMostOfSlice * (sizeof(BlockMemory) + 8 * 16 * 64));
  }
}

}  // namespace
}  // namespace lidar::codec

// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulates viewers behind links. Tests how many scans they draw, and how old these scans are.
#include "src/viewer/pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <queue>
#include <vector>

namespace lidar::viewer {
namespace {

using std::chrono::milliseconds;

constexpr Duration kScan = milliseconds(100);
constexpr std::uint32_t kSlicesOfScan = 8;
constexpr Duration kFrame = milliseconds(16);

constexpr DataRate Mbps(double n) { return DataRate::BitsPerSecond(1e6 * n); }
constexpr DataRate kStream = Mbps(2);

struct Link {
  DataRate capacity;
  Duration one_way;
};

/// A viewer with an unbounded queue before its link. Its page acknowledges slices once per frame.
class Viewer {
 public:
  explicit Viewer(const Link& link, DataRate max_bitrate = {}) : link_(link), pace_(max_bitrate) {}

  /// Simulates `time` in steps of a millisecond. A hidden page acknowledges nothing.
  void Run(Duration time, bool hidden = false) {
    for (const Time end = now_ + time; now_ < end; now_ += milliseconds(1)) {
      if (!hidden) Draw();
      while (!acks_.empty() && acks_.front().at <= now_) {
        pace_.OnDrawn(now_, acks_.front().slice);
        acks_.pop();
      }
      Sample();
    }
  }
  void set_capacity(DataRate capacity) { link_.capacity = capacity; }
  void set_one_way(Duration d) { link_.one_way = d; }
  void Forget() {
    ages_.clear();
    drawn_ = 0;
    from_ = now_;
  }

  double ScansPerSecond() const { return drawn_ / kSlicesOfScan / Seconds(now_ - from_); }
  double AgeP95() {
    if (ages_.empty()) return 1e9;
    std::sort(ages_.begin(), ages_.end());
    return Milliseconds(ages_[ages_.size() * 95 / 100]);
  }
  double Sent() const { return sent_.bits() / Seconds(now_ - from_); }
  const Pace& pace() const { return pace_; }

 private:
  struct Packet {
    SliceId slice;
    Time captured;
    Time at;  // the time of arrival
  };
  /// Takes a slice from the sensor every kScan / kSlicesOfScan. If the pace allows a scan, sends
  /// all slices of the scan.
  void Sample() {
    if (now_ >= next_) {
      if (index_ == kSlicesOfScan) {
        index_ = 0;
        ++scan_;
        taken_ = false;
      }
      next_ += kScan / kSlicesOfScan;
      ++index_;
      if (taken_) Send(index_ - 1);
    }
    if (taken_ || index_ == 0 || !pace_.MayBegin(now_)) return;
    taken_ = true;
    for (std::uint32_t i = 0; i < index_; ++i) Send(i);
  }
  void Send(std::uint32_t index) {
    const DataSize size = kStream * (kScan / kSlicesOfScan);
    free_ = std::max(free_, now_) + size / link_.capacity;
    const Time captured = next_ - kScan / kSlicesOfScan * (index_ - index);
    path_.push({{scan_, index}, captured, free_ + link_.one_way});
    pace_.OnSent(now_, {scan_, index}, size);
    sent_ += size;
  }
  void Draw() {
    if (now_ - frame_ < kFrame) return;
    frame_ = now_;
    std::optional<SliceId> newest;
    while (!path_.empty() && path_.front().at <= now_) {
      newest = path_.front().slice;
      ages_.push_back(now_ - path_.front().captured);
      ++drawn_;
      path_.pop();
    }
    if (newest) acks_.push({*newest, {}, now_ + link_.one_way});
  }

  Link link_;
  Pace pace_;
  Time now_{};
  Time from_{};
  Time next_{};
  Time frame_{};
  Time free_{};
  std::uint32_t scan_ = 0;
  std::uint32_t index_ = 0;  // the number of slices that the sensor has measured of the scan
  bool taken_ = false;
  std::queue<Packet> path_;
  std::queue<Packet> acks_;
  std::vector<Duration> ages_;
  double drawn_ = 0;
  DataSize sent_;
};

struct Case {
  const char* name;
  Link link;
  double least_scans;
  double most_age_ms;
};
class PaceBehindALink : public ::testing::TestWithParam<Case> {};
TEST_P(PaceBehindALink, SendsWholeNewestScansAndNoGrowingDelay) {
  Viewer viewer(GetParam().link);
  viewer.Run(milliseconds(500));
  for (int minute = 0; minute < 3; ++minute) {
    viewer.Forget();
    viewer.Run(std::chrono::seconds(60));
    EXPECT_GE(viewer.ScansPerSecond(), GetParam().least_scans) << minute;
    EXPECT_LE(viewer.AgeP95(), GetParam().most_age_ms) << minute;
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, PaceBehindALink,
    ::testing::Values(Case{"lan", {Mbps(100), milliseconds(1)}, 9.95, 50},
                      Case{"mbps4", {Mbps(4), milliseconds(40)}, 9.9, 120},
                      Case{"mbps4_far", {Mbps(4), milliseconds(80)}, 9.9, 160},
                      Case{"mbps1", {Mbps(1), milliseconds(40)}, 4, 500},
                      Case{"mbps1_far", {Mbps(1), milliseconds(80)}, 3.5, 550},
                      Case{"kbps256", {Mbps(0.256), milliseconds(40)}, 1, 1500}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(Pace, FollowsALinkThatGetsNarrowAndWideAgain) {
  Viewer viewer({Mbps(4), milliseconds(40)});
  viewer.Run(std::chrono::seconds(5));
  viewer.set_capacity(Mbps(1));
  viewer.Run(std::chrono::seconds(2));
  viewer.Forget();
  viewer.Run(std::chrono::seconds(20));
  EXPECT_GE(viewer.ScansPerSecond(), 4);
  EXPECT_LE(viewer.AgeP95(), 500);
  viewer.set_capacity(Mbps(4));
  viewer.Run(std::chrono::seconds(2));
  viewer.Forget();
  viewer.Run(std::chrono::seconds(20));
  EXPECT_GE(viewer.ScansPerSecond(), 9.9);
}

TEST(Pace, LearnsALongerWayWithinAMinute) {
  Viewer viewer({Mbps(4), milliseconds(40)});
  viewer.Run(std::chrono::seconds(5));
  viewer.set_one_way(milliseconds(200));
  viewer.Run(std::chrono::seconds(60));
  viewer.Forget();
  viewer.Run(std::chrono::seconds(20));
  EXPECT_GE(viewer.ScansPerSecond(), 9.5);
}

TEST(Pace, SendsAHiddenPageNothingAndGoesOnWhenItIsBack) {
  Viewer viewer({Mbps(4), milliseconds(40)});
  viewer.Run(std::chrono::seconds(2));
  viewer.Run(std::chrono::seconds(2), true);
  const DataSize kept = viewer.pace().unacknowledged();
  viewer.Run(std::chrono::seconds(60), true);
  EXPECT_EQ(viewer.pace().unacknowledged(), kept);
  EXPECT_LT(kept, DataSize::Bytes(100'000));
  viewer.Run(std::chrono::seconds(1));
  viewer.Forget();
  viewer.Run(std::chrono::seconds(5));
  EXPECT_GE(viewer.ScansPerSecond(), 9.5);
}

TEST(Pace, GivesTwoScansToAViewerThatAcknowledgesNothing) {
  Pace pace{DataRate()};
  Time now{};
  unsigned scans = 0;
  for (; pace.MayBegin(now) && scans < 10; ++scans, now += kScan)
    pace.OnSent(now, {scans, 0}, DataSize::Bytes(100));
  EXPECT_EQ(scans, Pace::kFirstScans);
}

TEST(Pace, IsLateWhereWhatWasSentTakesTooLong) {
  Pace pace{DataRate()};
  Time now{std::chrono::seconds(60)};  // The pause before this time does not count for the rate.
  EXPECT_FALSE(pace.IsLate(now));
  // At this rate, a kilobyte takes 10 ms.
  pace.OnSent(now, {1, 0}, DataSize::Bytes(1000));
  pace.OnDrawn(now += milliseconds(10), {1, 0});
  pace.OnSent(now, {2, 0}, DataSize::Bytes(10'000));
  EXPECT_FALSE(pace.IsLate(now));
  pace.OnSent(now, {2, 1}, DataSize::Bytes(2000));
  EXPECT_TRUE(pace.IsLate(now));
  pace.OnDrawn(now += milliseconds(10), {2, 0});
  EXPECT_FALSE(pace.IsLate(now));
  EXPECT_TRUE(pace.IsLate(now + Pace::kPatience + milliseconds(1)));
}

TEST(Pace, KeepsMaxBitrate) {
  Viewer viewer({Mbps(100), milliseconds(1)}, Mbps(1));
  viewer.Run(std::chrono::seconds(20));
  EXPECT_NEAR(viewer.Sent(), 1e6, 0.03e6);
}

TEST(Pace, TakesADelayOfAFrameMoreForTheSame) {
  Pace pace{DataRate()};
  Time now{milliseconds(0)};
  for (std::uint32_t scan = 1; scan <= 400; ++scan) {
    now += milliseconds(100);
    ASSERT_TRUE(pace.MayBegin(now)) << scan;
    pace.OnSent(now, {scan, 0}, DataSize::Bytes(1000));
    pace.OnDrawn(now + milliseconds(scan == 1 ? 10 : 25), {scan, 0});
    // This slice is still on the way when the next slice is sent. So none of the later slices is
    // alone on the way.
    pace.OnSent(now + milliseconds(26), {scan, 1}, DataSize::Bytes(10));
  }
  EXPECT_EQ(pace.shortest_delay(), milliseconds(10));
}

TEST(Pace, WaitsForAViewerThatOwesALittleForLong) {
  Pace pace{DataRate()};
  pace.OnSent(Time{milliseconds(10)}, {1, 0}, DataSize::Bytes(100'000));
  pace.OnDrawn(Time{milliseconds(30)}, {1, 0});
  pace.OnSent(Time{milliseconds(110)}, {2, 0}, DataSize::Bytes(10));
  EXPECT_TRUE(pace.MayBegin(Time{milliseconds(500)}));
  EXPECT_FALSE(pace.MayBegin(Time{milliseconds(110)} + Pace::kPatience + milliseconds(1)));
}

TEST(Pace, SavesNoBitsOfAPause) {
  Pace pace{Mbps(1)};
  const auto sent_at = [&](milliseconds at) {
    const Time now = Time{at};
    DataSize sent;
    for (std::uint32_t scan = 0; scan < 1'000 && pace.MayBegin(now); ++scan) {
      pace.OnSent(now, {scan, 0}, DataSize::Bytes(1000));
      pace.OnDrawn(now, {scan, 0});
      sent += DataSize::Bytes(1000);
    }
    return sent;
  };
  sent_at(milliseconds(1'000));
  EXPECT_LE(sent_at(milliseconds(60'000)), DataSize::Bytes(13'500))
      << "a tenth of a second, and one";
}

TEST(Pace, PassesOverAcknowledgementsOfWhatItHasNotSent) {
  Pace pace{DataRate()};
  pace.OnDrawn(Time{}, {7, 7});
  pace.OnSent(Time{milliseconds(1)}, {1, 0}, DataSize::Bytes(10));
  pace.OnDrawn(Time{milliseconds(2)}, {1, 1});
  EXPECT_EQ(pace.unacknowledged(), DataSize::Bytes(10));
}

}  // namespace
}  // namespace lidar::viewer

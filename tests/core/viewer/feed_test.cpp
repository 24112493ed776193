// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/feed.h"

#include <gtest/gtest.h>

namespace lidar::viewer {
namespace {

constexpr std::uint32_t kPlaces = 2;

/// Returns a slice of the robot. It refers to the slice with the same index `back` scans before it,
/// or to no slice if `back` is 0.
SharedSlice Own(std::uint32_t scan, std::uint32_t index, std::uint32_t back) {
  auto slice = std::make_shared<Slice>();
  slice->id = {scan, index};
  slice->count = kPlaces;
  codec::BlockName name{scan * 10 + index, std::nullopt};
  if (back > 0) name.reference = (scan - back) * 10 + index;
  slice->blocks = {name};
  slice->size = DataSize::Bytes(1000);
  return slice;
}
SharedSlice Recoded(std::uint32_t scan, std::uint32_t index) {
  auto slice = std::make_shared<Slice>();
  slice->id = {scan, index};
  slice->is_recoded = true;
  slice->size = DataSize::Bytes(1000);
  return slice;
}

/// A stream of slices. Take() returns the names of the slices that a feed sends: "3.1 " is a slice
/// of the robot, and "3.1r " is a re-coded slice.
class Stream {
 public:
  void Add(SharedSlice slice) { recent_.Add(std::move(slice)); }
  std::string Take(Feed* feed, bool acknowledge = true) {
    std::string text;
    now_ += std::chrono::milliseconds(10);
    for (const SharedSlice& slice : feed->Take(now_, recent_)) {
      text += std::to_string(slice->id.scan) + "." + std::to_string(slice->id.index) +
              (slice->is_recoded ? "r " : " ");
      if (acknowledge) feed->OnDrawn(now_ + std::chrono::milliseconds(5), slice->id);
    }
    return text;
  }
  void Wait(Duration time) { now_ += time; }

 private:
  RecentScans recent_;
  Time now_{};
};

TEST(Feed, GivesTheRobotsOwnSlicesAsTheyCome) {
  Stream stream;
  Feed feed{DataRate()};
  stream.Add(Own(1, 0, 0));
  EXPECT_EQ(stream.Take(&feed), "1.0 ");
  stream.Add(Own(1, 1, 0));
  EXPECT_EQ(stream.Take(&feed), "1.1 ");
  stream.Add(Own(2, 0, 1));
  EXPECT_EQ(stream.Take(&feed), "2.0 ");
  EXPECT_EQ(stream.Take(&feed), "");
  EXPECT_FALSE(feed.wants_recoded());
}

TEST(Feed, GivesRecodedSlicesUntilTheRobotsStandAlone) {
  Stream stream;
  Feed feed{DataRate()};
  stream.Add(Own(5, 0, 1));
  EXPECT_EQ(stream.Take(&feed), "");
  EXPECT_TRUE(feed.wants_recoded());
  stream.Add(Recoded(5, 0));
  EXPECT_EQ(stream.Take(&feed), "5.0r ");
  stream.Add(Own(6, 0, 1));
  stream.Add(Own(7, 0, 0));
  // It arrives in time, but belongs to a scan of which nothing was sent.
  stream.Add(Recoded(6, 0));
  EXPECT_EQ(stream.Take(&feed), "7.0 ");
  EXPECT_FALSE(feed.wants_recoded());
  stream.Add(Own(8, 0, 1));
  EXPECT_EQ(stream.Take(&feed), "8.0 ");
}

TEST(Feed, ForgetsWhatTheDecoderForgot) {
  Stream stream;
  Feed feed{DataRate()};
  std::uint32_t scan = 1;
  for (; scan <= 2'100; ++scan) {
    for (std::uint32_t index = 0; index < kPlaces; ++index) stream.Add(Own(scan, index, 0));
    ASSERT_NE(stream.Take(&feed), "");
  }
  stream.Add(Own(scan, 0, 2'000));
  EXPECT_NE(stream.Take(&feed), "");
  for (const std::uint32_t first : {1U, 20U}) {  // scans that the decoder forgot
    ++scan;
    stream.Add(Own(scan, 0, scan - first));
    EXPECT_EQ(stream.Take(&feed), "") << first;
    EXPECT_TRUE(feed.wants_recoded());
  }
}

TEST(Feed, FinishesAScanBesideTheNext) {
  Stream stream;
  Feed feed{DataRate()};
  stream.Add(Own(5, 0, 1));
  stream.Add(Own(5, 1, 1));
  stream.Take(&feed);
  stream.Add(Own(6, 0, 1));
  stream.Add(Recoded(5, 1));
  EXPECT_EQ(stream.Take(&feed), "5.1r ");
  stream.Add(Recoded(6, 0));
  stream.Add(Recoded(5, 0));
  EXPECT_EQ(stream.Take(&feed), "5.0r 6.0r ");
}

TEST(Feed, SkipsWholeScansOfAViewerThatIsSlow) {
  Stream stream;
  Feed feed{DataRate()};
  for (std::uint32_t scan = 1; scan <= 5; ++scan) {
    stream.Add(Own(scan, 0, 0));
    stream.Add(Own(scan, 1, 0));
    const std::string sent = stream.Take(&feed, false);
    EXPECT_EQ(sent.empty(), scan > Pace::kFirstScans) << scan;
  }
  EXPECT_EQ(feed.scans_skipped(), 2U);
  feed.OnDrawn(Time{std::chrono::milliseconds(60)}, {2, 1});
  EXPECT_EQ(stream.Take(&feed), "5.0 5.1 ");
  // The viewer lacks the slices of the scans 3 and 4.
  stream.Add(Own(6, 0, 2));
  EXPECT_EQ(stream.Take(&feed), "");
  EXPECT_TRUE(feed.wants_recoded());
}

TEST(Feed, GivesSlicesThatStandAloneToAViewerThatLacksSomething) {
  Stream stream;
  Feed feed{DataRate()};
  stream.Add(Own(1, 0, 0));
  stream.Take(&feed);
  feed.OnLacksReference();
  stream.Add(Own(2, 0, 1));
  stream.Add(Recoded(2, 0));
  EXPECT_EQ(stream.Take(&feed), "2.0r ");
}

TEST(Recorded, ComeInOrderAsFastAsTheyAreDrawn) {
  Feed feed{DataRate()};
  Time now{};
  std::deque<SharedSlice> waiting;
  for (std::uint32_t scan = 1; scan <= 100; ++scan) waiting.push_back(Own(scan, 0, 1));
  std::uint32_t scan = 0;
  for (const auto& slice : feed.TakeRecorded(now, &waiting)) EXPECT_EQ(slice->id.scan, ++scan);
  EXPECT_EQ(scan, Pace::kFirstScans);
  EXPECT_TRUE(feed.TakeRecorded(now, &waiting).empty());
  for (std::uint32_t drawn = 1; drawn <= 100; ++drawn) {
    now += std::chrono::milliseconds(10);
    feed.OnDrawn(now, {drawn, 0});
    for (const auto& slice : feed.TakeRecorded(now, &waiting)) EXPECT_EQ(slice->id.scan, ++scan);
    EXPECT_LT(scan - drawn, 15U);  // This is 100 ms at that rate, and the slices on the way.
  }
  EXPECT_TRUE(waiting.empty());
}

TEST(Recorded, AreFewUnderWayHoweverSmallTheyAre) {
  Feed feed{DataRate()};
  std::deque<SharedSlice> waiting;
  for (std::uint32_t i = 0; i < 5000; ++i) waiting.push_back(Own(1, i, 0));
  EXPECT_LE(feed.TakeRecorded(Time{}, &waiting).size(), 512U);
}

TEST(References, OfTheWantedSlicesComeBeforeThem) {
  // At index 0, scan 5 refers to scan 3, which refers to scan 1. At index 1, scan 5 refers to scan
  // 4, which refers to no scan.
  const std::vector<SharedSlice> slices = {Own(1, 0, 0), Own(1, 1, 0), Own(2, 0, 1), Own(2, 1, 1),
                                           Own(3, 0, 2), Own(4, 1, 0), Own(5, 0, 2), Own(5, 1, 1)};
  std::string text;
  for (const SharedSlice& slice : WithReferences(slices, 6))
    text += std::to_string(slice->id.scan) + "." + std::to_string(slice->id.index) + " ";
  EXPECT_EQ(text, "1.0 3.0 4.1 5.0 5.1 ");
}

TEST(RecentScans, AreTwoWithABoundedNumberOfSlices) {
  RecentScans recent;
  for (std::uint32_t scan = 0; scan < 5; ++scan)
    for (std::uint32_t i = 0; i < 5000; ++i) recent.Add(Own(scan, i, 0));
  recent.Add(Recoded(1, 0));
  ASSERT_EQ(recent.scans().size(), 2U);
  EXPECT_EQ(recent.scans().front().number, 3U);
  EXPECT_LE(recent.scans().back().slices.size(), 1024U);
  recent.Add(Recoded(4, 0));
  EXPECT_TRUE(recent.scans().back().slices.at(0).recoded) << "it is in the place of its own form";
}

}  // namespace
}  // namespace lidar::viewer

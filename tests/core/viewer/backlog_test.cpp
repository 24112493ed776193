// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/backlog.h"

#include <gtest/gtest.h>

namespace lidar::viewer {
namespace {

/// Returns a slice that refers to the slice `back` scans before it. If `back` is 0, the slice
/// refers to no slice. If `back` is negative, no other slice can refer to it either.
SharedSlice Make(std::uint32_t scan, std::uint32_t index, int back, std::int64_t bytes = 1000) {
  auto slice = std::make_shared<Slice>();
  slice->id = {scan, index};
  slice->size = DataSize::Bytes(bytes);
  if (back < 0) return slice;
  codec::BlockName name{scan * 10 + index, std::nullopt};
  if (back > 0) name.reference = (scan - static_cast<std::uint32_t>(back)) * 10 + index;
  slice->blocks = {name};
  return slice;
}

std::string PopAll(Backlog* backlog) {
  std::string text;
  while (const SharedSlice slice = backlog->Pop())
    text += std::to_string(slice->id.scan) + "." + std::to_string(slice->id.index) + " ";
  return text;
}

TEST(Backlog, KeepsAllSinceTheKeysThatTheStreamRefersTo) {
  Backlog backlog(1U << 20);
  for (std::uint32_t scan = 1; scan <= 6; ++scan) {
    backlog.Push(Make(scan, 0, scan == 1 || scan == 4 ? 0 : 1));
    backlog.Push(Make(scan, 1, scan == 1 || scan == 3 ? 0 : 1));
  }
  EXPECT_EQ(PopAll(&backlog), "3.1 4.0 4.1 5.0 5.1 6.0 6.1 ");
  EXPECT_TRUE(backlog.empty());
}

TEST(Backlog, ForgetsNothingForAKeyThatMayNeverBeReferredTo) {
  Backlog backlog(1U << 20);
  backlog.Push(Make(1, 0, 0));
  backlog.Push(Make(2, 0, 0));
  backlog.Push(Make(3, 0, 2));
  EXPECT_EQ(PopAll(&backlog), "1.0 2.0 3.0 ");
}

TEST(Backlog, KeepsTwoScansThatNothingRefersTo) {
  Backlog backlog(1U << 20);
  for (std::uint32_t scan = 1; scan <= 5; ++scan) backlog.Push(Make(scan, 0, -1));
  EXPECT_EQ(PopAll(&backlog), "4.0 5.0 ");
}

TEST(Backlog, SaysWhenItIsFullAndStaysBounded) {
  Backlog backlog(100'000);
  for (std::uint32_t scan = 1; scan <= 1000; ++scan) {
    backlog.Push(Make(scan, 0, 1));
    ASSERT_EQ(backlog.is_full(), scan >= 40) << scan;
  }
  EXPECT_LE(backlog.size(), 80U);
  const auto kept = static_cast<std::uint32_t>(backlog.size());
  EXPECT_EQ(backlog.Pop()->id.scan, 1001 - kept);
}

TEST(Backlog, KnowsTwoBlocksOfOneNameApartByTheirPlaces) {
  Backlog backlog(1U << 20);
  const auto alike = [](std::uint32_t scan, std::uint32_t index, std::optional<std::uint32_t> of) {
    auto slice = std::make_shared<Slice>();
    slice->id = {scan, index};
    slice->blocks = {{7, of}};
    return slice;
  };
  backlog.Push(alike(1, 0, std::nullopt));
  backlog.Push(alike(1, 1, std::nullopt));
  backlog.Push(alike(2, 0, std::nullopt));
  backlog.Push(alike(2, 1, std::nullopt));
  backlog.Push(alike(3, 0, 7));
  EXPECT_EQ(PopAll(&backlog), "1.1 2.0 2.1 3.0 ") << "the key of place 0 makes what was before go";
}

TEST(Backlog, MakesRoomForALargeSliceByAsManySmallOnesAsItTakes) {
  Backlog backlog(10'000);
  for (std::uint32_t scan = 1; scan <= 7; ++scan) backlog.Push(Make(scan, 0, scan == 1 ? 0 : 1));
  backlog.Push(Make(8, 0, 1, 6'000));
  EXPECT_EQ(PopAll(&backlog), "6.0 7.0 8.0 ");
}

TEST(Backlog, KnowsWhatIsStillWorthShowing) {
  Backlog backlog(1U << 20);
  for (std::uint32_t scan = 7; scan <= 9; ++scan) backlog.Push(Make(scan, 0, 0));
  EXPECT_FALSE(backlog.IsRecent(*Make(7, 0, 0)));
  EXPECT_TRUE(backlog.IsRecent(*Make(8, 0, 0)));
  EXPECT_TRUE(backlog.IsRecent(*Make(9, 0, 0)));
}

}  // namespace
}  // namespace lidar::viewer

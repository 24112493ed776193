// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/demand_table.h"

#include <gtest/gtest.h>

#include <array>

namespace lidar::rate {
namespace {

/// Returns a table of a scan with three slices. Each slice needs 5 bytes. `rooms` has the bytes
/// that each slice can use beyond its need.
DemandTable Table(const std::array<double, 3>& rooms = {10, 20, 60}) {
  DemandTable table;
  std::uint32_t i = 0;
  for (const double room : rooms) table.Set(i++, 3, {5, 5 + room, {}});
  return table;
}

TEST(DemandTable, SharesASurplusEvenly) {
  EXPECT_DOUBLE_EQ(Table().EvenShare(0, 24), 8);
  EXPECT_DOUBLE_EQ(Table().EvenShare(1, 24), 12);
  EXPECT_DOUBLE_EQ(Table().EvenShare(0, -30), -10);
}

TEST(DemandTable, GivesOthersWhatASliceCannotUse) {
  EXPECT_DOUBLE_EQ(Table().EvenShare(0, 40), 15);  // The slices get 10, 15 and 15 bytes.
  EXPECT_DOUBLE_EQ(Table().EvenShare(0, 70), 40);  // The slices get 10, 20 and 40 bytes.
  EXPECT_DOUBLE_EQ(Table().EvenShare(1, 70), 50);  // The slices get 20 and 50 bytes.
  EXPECT_DOUBLE_EQ(Table({60, 10, 20}).EvenShare(0, 40), 15) << "in any order";
  EXPECT_DOUBLE_EQ(Table({20, 60, 10}).EvenShare(0, 70), 40) << "in any order";
}

TEST(DemandTable, GivesAllThatItCanTakeToEverySliceWhereThereIsMore) {
  EXPECT_GE(Table().EvenShare(0, 91), 60);
  EXPECT_GE(Table().EvenShare(1, 1e9), 60);
}

TEST(DemandTable, LetsASliceThatItDoesNotKnowTakeAnything) {
  DemandTable table;
  table.Set(0, 2, {5, 15, {}});
  EXPECT_DOUBLE_EQ(table.EvenShare(0, 1000), 990);
}

TEST(DemandTable, TakesASliceThatItDoesNotKnowForTheMeanOfTheOthersHoweverOftenTheseAreSet) {
  DemandTable table;
  for (const double need : {100.0, 8.0}) table.Set(0, 3, {need, 10 * need, {0, 2 * need}});
  table.Set(1, 3, {4, 40, {0, 8}});
  EXPECT_DOUBLE_EQ(table.Sum().coarsest, 8 + 4 + 6);
  EXPECT_DOUBLE_EQ(table.Sum().finest, 80 + 40 + 60);
  EXPECT_DOUBLE_EQ(table.Sum().intensity[1], 16 + 8 + 12);
}

}  // namespace
}  // namespace lidar::rate

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/range_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace lidar {
namespace {

constexpr std::uint32_t kBeamsOfCheck = 4;
constexpr std::uint32_t kColumnsOfTurn = 32;
constexpr std::uint32_t kWidthOfSlice = 8;
constexpr std::uint32_t kStepOfPoint = 20;
constexpr const char* kFieldsOfCheck = "x:F32:4,y:F32:8,z:F32:12,range:U32:16";

SensorModel ModelOfCheck() {
  SensorModel model;
  model.columns_per_scan = kColumnsOfTurn;
  for (std::uint32_t i = 0; i < kBeamsOfCheck; ++i)
    model.beams.push_back({i % 2 == 0 ? 1.5 : -1.5, 5.0 - 3 * i, 0});
  return model;
}

/// A slice in which the position of each point agrees with its range.
class CheckedSliceOfRanges {
 public:
  explicit CheckedSliceOfRanges(std::uint32_t first_column)
      : bytes_(std::size_t{kBeamsOfCheck} * kWidthOfSlice * kStepOfPoint) {
    const RangeProjection projection(ModelOfCheck());
    for (std::uint32_t i = 0; i < kBeamsOfCheck * kWidthOfSlice; ++i) {
      const std::uint32_t range = 5'000 + 100 * i;
      const std::uint32_t column = (first_column + i % kWidthOfSlice) % kColumnsOfTurn;
      const auto at = projection.Point(i / kWidthOfSlice, column, range);
      std::memcpy(&bytes_[i * kStepOfPoint + 4], at.data(), sizeof at);
      std::memcpy(&bytes_[i * kStepOfPoint + 16], &range, sizeof range);
    }
  }
  void Move(std::uint32_t point, float by) {
    float z = 0;
    std::memcpy(&z, &bytes_[point * kStepOfPoint + 12], sizeof z);
    z += by;
    std::memcpy(&bytes_[point * kStepOfPoint + 12], &z, sizeof z);
  }
  void RemoveReturn(std::uint32_t point) {
    std::memset(&bytes_[point * kStepOfPoint], 0, kStepOfPoint);
  }
  ByteView view() const { return {bytes_.data(), bytes_.size()}; }

 private:
  std::vector<std::uint8_t> bytes_;
};

RangeCheck MakeCheck() {
  return *RangeCheck::Create(*PointFields::Parse(kFieldsOfCheck), kStepOfPoint, ModelOfCheck());
}

TEST(RangeCheckOfFields, NeedsRangesAndPositions) {
  for (const char* fields :
       {"x:F32:4,y:F32:8,z:F32:12", "x:F32:4,y:F32:8,z:F32:12,range:F32:16",
        "x:F32:4,y:F32:8,z:F32:12,range:U16:16", "range:U32:16", "x:F32:4,y:F32:8,range:U32:16",
        "x:F32:4,z:F32:8,y:F32:12,range:U32:16", "x:F64:0,y:F32:8,z:F32:12,range:U32:16"})
    EXPECT_FALSE(RangeCheck::Create(*PointFields::Parse(fields), kStepOfPoint, ModelOfCheck()))
        << fields;
}

TEST(RangeCheckOfPoints, FindsNothingWhereTheyAreAsTheirRangesSay) {
  const RangeCheck check = MakeCheck();
  EXPECT_FALSE(check.Find({nullptr, 0}, 0));
  for (const std::uint32_t first : {0U, 8U, 28U}) {
    CheckedSliceOfRanges slice(first);
    EXPECT_FALSE(check.Find(slice.view(), first)) << first;
    for (std::uint32_t i = 0; i < kBeamsOfCheck * kWidthOfSlice; i += 3) slice.RemoveReturn(i);
    EXPECT_FALSE(check.Find(slice.view(), first)) << first;
    EXPECT_TRUE(check.Find(slice.view(), first + 1)) << "they belong to other columns";
  }
}

/// The check uses four pixels, the middle pixel of each quarter. If such a pixel has no return, the
/// check uses the next pixel with a return.
TEST(RangeCheckOfPoints, FindsOneThatWasMoved) {
  const RangeCheck check = MakeCheck();
  constexpr std::uint32_t kFirst = 28;  // The slice extends beyond the end of the turn.
  for (const std::uint32_t point : {4U, 12U, 20U, 28U}) {
    for (const bool next : {false, true}) {
      CheckedSliceOfRanges slice(kFirst);
      if (next) slice.RemoveReturn(point);
      const std::uint32_t moved = point + (next ? 1 : 0);
      slice.Move(moved, 0.25F);
      const auto found = check.Find(slice.view(), kFirst);
      ASSERT_TRUE(found) << moved;
      EXPECT_EQ(found->beam, moved / kWidthOfSlice);
      EXPECT_EQ(found->column, (kFirst + moved % kWidthOfSlice) % kColumnsOfTurn);
      EXPECT_NEAR(found->distance_m, 0.25, 1e-5);
    }
  }
  CheckedSliceOfRanges nowhere(kFirst);
  nowhere.Move(4, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(check.Find(nowhere.view(), kFirst));
}

TEST(RangeCheckOfPoints, AllowsAUnitOfTheRange) {
  SensorModel model = ModelOfCheck();
  for (const std::uint32_t unit : {1U, 8U}) {
    model.range_unit_mm = unit;
    const auto check = RangeCheck::Create(*PointFields::Parse(kFieldsOfCheck), kStepOfPoint, model);
    CheckedSliceOfRanges slice(0);
    slice.Move(4, 0.9e-3F * static_cast<float>(unit));
    EXPECT_FALSE(check->Find(slice.view(), 0)) << unit;
    slice.Move(4, 0.3e-3F * static_cast<float>(unit));
    EXPECT_TRUE(check->Find(slice.view(), 0)) << unit;
  }
}

}  // namespace
}  // namespace lidar

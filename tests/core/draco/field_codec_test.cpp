// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/field_codec.h"

#include <gtest/gtest.h>

#include <numeric>

namespace lidar::draco {
namespace {

TEST(FieldCodec, RefusesAStreamOfFewerOrMoreFieldsThanTheLayoutHas) {
  FieldLayout layout;
  layout.fields = {{FieldType::kF32, 0, 1, true}, {FieldType::kU16, 4, 1, false}};
  layout.point_step = 6;
  std::vector<std::uint8_t> points(20 * layout.point_step);
  std::iota(points.begin(), points.end(), std::uint8_t{0});
  std::vector<std::uint8_t> stream;
  ASSERT_TRUE(EncodeFields({points.data(), points.size()}, layout, &stream));
  for (const std::size_t fields : {1U, 2U, 3U}) {
    FieldLayout other = layout;
    other.fields.resize(fields, {FieldType::kU8, 5, 1, false});
    std::vector<std::uint8_t> decoded;
    EXPECT_EQ(DecodeFields({stream.data(), stream.size()}, other, 20, &decoded), fields == 2)
        << fields;
    if (fields == 2) {
      EXPECT_EQ(decoded, points);
    }
  }
}

// Descriptors of points have many numbers: FPFH has 33.
TEST(FieldCodec, TakesAFieldOfAsManyNumbersAsDracoCounts) {
  for (const std::uint32_t count : {33U, 255U, 256U}) {
    FieldLayout layout;
    layout.fields = {{FieldType::kF32, 0, 1, true}, {FieldType::kU16, 4, count, false}};
    layout.point_step = 4 + 2 * count;
    std::vector<std::uint8_t> points(20 * layout.point_step);
    std::iota(points.begin(), points.end(), std::uint8_t{0});
    std::vector<std::uint8_t> stream;
    ASSERT_EQ(EncodeFields({points.data(), points.size()}, layout, &stream), count < 256) << count;
    if (count == 256) continue;
    std::vector<std::uint8_t> decoded;
    ASSERT_TRUE(DecodeFields({stream.data(), stream.size()}, layout, 20, &decoded)) << count;
    EXPECT_EQ(decoded, points);
  }
}

}  // namespace
}  // namespace lidar::draco

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/field_codec.h"

#include <draco/attributes/geometry_attribute.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <utility>

#include "ext/draco/draco_check.h"

namespace lidar::draco {
namespace {

/// Returns the begin of a stream of Draco 2.3, up to its attributes. Each point has an attribute of
/// three floats and one of a single float.
std::vector<std::uint8_t> StreamOf(bool kd_tree) {
  std::vector<std::uint8_t> stream = {
      'D', 'R', 'A', 'C', 'O', 2, 3, 0, kd_tree ? std::uint8_t{1} : std::uint8_t{0}};
  for (const int byte : {0, 0, 5, 0, 0, 0, 1, 2, 0, 9, 3, 0, 0, 4, 9, 1, 0, 1})
    stream.push_back(static_cast<std::uint8_t>(byte));
  for (const int byte : {6, 30, 0, 0, 0, 5, 0, 0, 0})
    if (kd_tree) stream.push_back(static_cast<std::uint8_t>(byte));
  return stream;
}

TEST(DracoCheck, TakesNumbersUpToTheirLimitsAndNoHeaderThatIsCutOff) {
  const DracoLimits limits{5, 2, 3};
  const auto is_taken = [&](bool kd_tree, std::size_t at, std::uint8_t byte) {
    std::vector<std::uint8_t> stream = StreamOf(kd_tree);
    stream.at(at) = byte;
    return CheckDraco({stream.data(), stream.size()}, limits).has_value();
  };
  struct Row {
    std::size_t at;
    std::vector<std::uint8_t> taken, refused;
  };
  const std::vector<Row> rows = {{0, {'D'}, {'d'}},            // magic
                                 {4, {'O'}, {'0'}},            //
                                 {5, {2}, {1, 3}},             // version
                                 {6, {3}, {2, 4}},             //
                                 {7, {0}, {1}},                // mesh
                                 {8, {}, {2, 255}},            // method
                                 {9, {0}, {1}},                // flags
                                 {10, {0}, {0x80}},            // metadata
                                 {11, {5}, {0, 6}},            // number of points
                                 {14, {0}, {1}},               //
                                 {15, {1}, {0, 2}},            // number of decoders
                                 {16, {2}, {0, 3}},            // number of attributes
                                 {18, {1, 11}, {0, 12, 255}},  // number type, first attribute
                                 {19, {1, 3}, {0, 4}},         // number count, first attribute
                                 {21, {0, 0x7F}, {0x80}},      // id of the first attribute
                                 {23, {1, 11}, {0, 12}},       // number type, second attribute
                                 {24, {1, 3}, {0, 4}},         //
                                 {26, {0, 0x7F}, {0x80}}};
  for (const bool kd_tree : {false, true}) {
    for (const Row& row : rows) {
      for (const std::uint8_t byte : row.taken)
        EXPECT_TRUE(is_taken(kd_tree, row.at, byte)) << row.at << ", " << int{byte};
      for (const std::uint8_t byte : row.refused)
        EXPECT_FALSE(is_taken(kd_tree, row.at, byte)) << row.at << ", " << int{byte};
    }
    const auto stream = StreamOf(kd_tree);
    const auto summary = CheckDraco({stream.data(), stream.size()}, limits);
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->points, 5U);
    EXPECT_EQ(summary->is_kd_tree, kd_tree);
    for (std::size_t size = 0; size < stream.size(); ++size)
      EXPECT_FALSE(CheckDraco({stream.data(), size}, limits)) << size;
  }
  EXPECT_TRUE(is_taken(false, 11, 4));
  // The header of a kd-tree has a level, the bits per coordinate, and the number of points again.
  const std::vector<Row> of_tree = {
      {11, {}, {4}}, {27, {0, 6}, {7}}, {28, {1, 32}, {0, 33}}, {29, {}, {1}}, {32, {}, {4, 6}}};
  for (const Row& row : of_tree) {
    for (const std::uint8_t byte : row.taken)
      EXPECT_TRUE(is_taken(true, row.at, byte)) << row.at << ", " << int{byte};
    for (const std::uint8_t byte : row.refused)
      EXPECT_FALSE(is_taken(true, row.at, byte)) << row.at << ", " << int{byte};
  }
}

TEST(FieldCodec, RefusesLayoutsThatNoPointHas) {
  const std::vector<std::uint8_t> points(40);
  std::vector<std::uint8_t> good;
  const auto works = [&](std::vector<FieldOfPoints> fields, std::uint32_t point_step) {
    const FieldLayout tried{std::move(fields), point_step};
    std::vector<std::uint8_t> coded, decoded;
    const bool encodes = EncodeFields({points.data(), points.size()}, tried, &coded);
    if (encodes) good = coded;
    EXPECT_EQ(DecodeFields({good.data(), good.size()}, tried, 10, &decoded), encodes);
    return encodes;
  };
  EXPECT_TRUE(works({{FieldType::kF32, 0, 1, true}}, 4));
  EXPECT_FALSE(works({}, 4));
  EXPECT_FALSE(works({{FieldType::kF32, 0, 0, true}}, 4));
  EXPECT_FALSE(works({{FieldType::kF32, 1, 1, true}}, 4));
  EXPECT_FALSE(works({{FieldType::kF32, 0, 2, true}}, 4));
  EXPECT_FALSE(works({{FieldType::kF32, 0, 1, true}}, 3));
  EXPECT_FALSE(works(
      std::vector<FieldOfPoints>(FieldLayout::kMaxFields + 1, {FieldType::kU8, 0, 1, false}), 40));
  FieldLayout layout;
  layout.fields = {{FieldType::kF32, 0, 1, true}};
  layout.point_step = 4;
  std::vector<std::uint8_t> stream;
  EXPECT_TRUE(EncodeFields({points.data(), 4}, layout, &stream));
  EXPECT_FALSE(EncodeFields({points.data(), 3}, layout, &stream)) << "no whole point";
}

TEST(FieldCodec, KeepsTheOrderOfPointsWhateverTheTypes) {
  FieldLayout layout;
  layout.fields = {{FieldType::kI16, 0, 3, true}, {FieldType::kU8, 6, 1, false}};
  layout.point_step = 7;
  std::vector<std::uint8_t> points(100 * layout.point_step);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = static_cast<std::uint8_t>(i * i * 7 + i / 11);
  std::vector<std::uint8_t> stream;
  ASSERT_TRUE(EncodeFields({points.data(), points.size()}, layout, &stream));
  std::vector<std::uint8_t> decoded;
  ASSERT_TRUE(DecodeFields({stream.data(), stream.size()}, layout, 100, &decoded));
  EXPECT_EQ(decoded, points);
  EXPECT_FALSE(DecodeFields({stream.data(), stream.size()}, layout, 99, &decoded));
  // Other decoders find the positions by the type of the attribute in Draco.
  EXPECT_EQ(stream[17], ::draco::GeometryAttribute::POSITION);
  EXPECT_EQ(stream[22], ::draco::GeometryAttribute::GENERIC);
  for (const FieldType other : {FieldType::kI32, FieldType::kF64}) {
    FieldLayout differs = layout;
    differs.fields[1].type = other;
    differs.point_step = 20;
    EXPECT_FALSE(DecodeFields({stream.data(), stream.size()}, differs, 100, &decoded));
  }
}

TEST(FieldCodec, KeepsIntegersOfAnyRange) {
  for (const FieldType type : {FieldType::kU32, FieldType::kI32}) {
    for (const std::uint32_t mask : {0xffffffU, 0xffffffffU}) {
      FieldLayout layout;
      layout.fields = {{type, 0, 2, false}};
      layout.point_step = 8;
      std::vector<std::uint8_t> points(100 * layout.point_step);
      for (std::uint32_t i = 0; i < 200; ++i) {
        const std::uint32_t value = (i * 2'654'435'761U) & mask;
        std::memcpy(points.data() + i * sizeof value, &value, sizeof value);
      }
      std::vector<std::uint8_t> stream, decoded;
      ASSERT_TRUE(EncodeFields({points.data(), points.size()}, layout, &stream));
      EXPECT_LT(stream.size(), points.size() + 100);
      ASSERT_TRUE(DecodeFields({stream.data(), stream.size()}, layout, 100, &decoded));
      EXPECT_EQ(decoded, points);
    }
  }
}

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

TEST(FieldCodec, TakesAFewEntriesOfMetadataOfTheCloudAloneWhereItIsAllowed) {
  FieldLayout layout;
  layout.fields = {{FieldType::kF32, 0, 1, true}};
  layout.point_step = 4;
  const std::vector<std::uint8_t> points(8);
  std::vector<std::uint8_t> plain;
  ASSERT_TRUE(EncodeFields({points.data(), points.size()}, layout, &plain));
  using Bytes = std::vector<std::uint8_t>;
  const auto is_taken = [&](const Bytes& metadata, bool allowed = true) {
    constexpr std::ptrdiff_t kFlags = 9;
    Bytes stream = plain;
    stream[kFlags + 1] = 0x80;
    stream.insert(stream.begin() + kFlags + 2, metadata.begin(), metadata.end());
    return CheckDraco({stream.data(), stream.size()}, {2, 1, 1, allowed}).has_value();
  };
  // Metadata are the number of attributes with metadata, the entries, and the number of nested
  // metadata. An entry has a name and a value, each after its length.
  const auto entries = [](std::uint8_t count) {
    Bytes metadata = {0, count};
    for (std::uint8_t i = 0; i < count; ++i)
      metadata.insert(metadata.end(), {2, 'i', i, 3, 0xFF, 0xFF, 0xFF});
    metadata.push_back(0);
    return metadata;
  };
  for (const std::uint8_t count : std::initializer_list<std::uint8_t>{0, 1, 16})
    EXPECT_TRUE(is_taken(entries(count))) << int{count};
  EXPECT_FALSE(is_taken(entries(17)));
  EXPECT_FALSE(is_taken(entries(1), false));
  EXPECT_FALSE(is_taken({1, 0, 0}));  // metadata of an attribute
  EXPECT_FALSE(is_taken({0, 0, 1}));  // nested metadata
}

// Descriptors of points have many numbers. FPFH has 33.
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

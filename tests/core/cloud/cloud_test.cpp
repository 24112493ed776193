// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "src/cloud/point_fields.h"
#include "src/cloud/range_grid.h"
#include "src/cloud/range_projection.h"
#include "src/cloud/sensor_model.h"

namespace lidar {
namespace {

SensorModel SmallSensor() {
  SensorModel m;
  m.columns_per_scan = 512;
  m.range_unit_mm = 8;
  m.beam_to_lidar_x_m = 0.015806;
  m.beam_to_lidar_z_m = 0.002;
  m.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0.03618, 0, 0, 0, 1};
  m.beams = {{4.23, 21.5, 24}, {1.4, 7.1, 8}, {-1.4, -7.2, -8}, {-4.21, -21.4, -24}};
  return m;
}

TEST(PointFields, RoundTripThroughTheCapsString) {
  const char* text = "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16";
  const auto fields = PointFields::Parse(text);
  ASSERT_TRUE(fields);
  EXPECT_EQ(fields->ToString(), text);
  EXPECT_TRUE(fields->HasPackedXyz());
  EXPECT_EQ(fields->MinimumStep(), 20U);
  EXPECT_TRUE(fields->Has("range", FieldType::kU32));
  EXPECT_EQ(fields->Find("ring"), nullptr);
}

TEST(PointFields, DifferInNameTypeOrPlaceOfAField) {
  const auto fields = PointFields::Parse("x:F32:0,a ~:U16:4");
  ASSERT_TRUE(fields);
  EXPECT_EQ(fields, PointFields::Parse("x:F32:0,a ~:U16:4"));
  for (const char* other : {"x:F32:0", "x:F32:0,b:U16:4", "x:F32:0,a ~:I16:4", "x:F32:0,a ~:U16:6",
                            "x:F32:0,a ~:U16:4,b:U8:6"})
    EXPECT_FALSE(fields == PointFields::Parse(other)) << other;
  std::string why;
  EXPECT_FALSE(PointFields::Parse("", &why));
  EXPECT_EQ(why, "there are no fields");
}

class BadFields : public ::testing::TestWithParam<const char*> {};
TEST_P(BadFields, AreRefused) { EXPECT_FALSE(PointFields::Parse(GetParam())); }
INSTANTIATE_TEST_SUITE_P(All, BadFields,
                         ::testing::Values("", "x", "x:F32", "x:F99:0", ":F32:0", "x:F32:-1",
                                           "x:F32:0,x:F32:4", "x:F32:4294967295", "x:F32:0,,",
                                           "x:F32:0z", "x\xff:F32:0", "x\x7f:F32:0", "x\n:F32:0"));
TEST(PointFields, MayReachTheirLimitsAndNotPassThem) {
  std::string why;
  const auto of = [&](std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
      text += (i > 0 ? ",f" : "f") + std::to_string(i) + ":U8:" + std::to_string(i);
    return PointFields::Parse(text, &why);
  };
  ASSERT_TRUE(of(PointFields::kMaxFields));
  EXPECT_EQ(of(PointFields::kMaxFields)->all().size(), PointFields::kMaxFields);
  EXPECT_FALSE(of(PointFields::kMaxFields + 1));
  EXPECT_EQ(why, "there are more than 32 fields");
  const auto at = [](const char* type, std::size_t offset) {
    return PointFields::Parse(std::string("x:") + type + ":" + std::to_string(offset));
  };
  for (const auto& [type, size] : std::vector<std::pair<const char*, std::size_t>>{{"I8", 1},
                                                                                   {"U8", 1},
                                                                                   {"I16", 2},
                                                                                   {"U16", 2},
                                                                                   {"I32", 4},
                                                                                   {"U32", 4},
                                                                                   {"F32", 4},
                                                                                   {"F64", 8}}) {
    ASSERT_TRUE(at(type, PointFields::kMaxPointStep - size)) << type;
    EXPECT_EQ(at(type, PointFields::kMaxPointStep - size)->MinimumStep(),
              PointFields::kMaxPointStep);
    EXPECT_FALSE(at(type, PointFields::kMaxPointStep - size + 1)) << type;
  }
}

TEST(PointFields, ANameHoldsNoZero) {
  EXPECT_FALSE(PointFields::Parse(std::string_view("x\0y:F32:0", 9)));
}

TEST(SensorModel, RoundTripsThroughItsBytes) {
  const SensorModel m = SmallSensor();
  const auto bytes = m.Serialise();
  const auto back = SensorModel::Parse({bytes.data(), bytes.size()});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->Serialise(), bytes);
  EXPECT_EQ(back->columns_per_scan, 512U);
  EXPECT_EQ(back->beams[3].pixel_shift, -24);
  EXPECT_NEAR(back->beams[0].altitude_deg, 21.5, 1e-6);
}

TEST(PointFields, ArePackedWhereNothingLiesBetweenThem) {
  const auto packed = [](const char* text) { return PointFields::Parse(text)->ArePacked(); };
  EXPECT_TRUE(packed("x:F32:0,y:F32:4,z:F32:8"));
  EXPECT_TRUE(packed("z:F32:8,r:U8:12,x:F32:0,y:F32:4,t:U16:13"));
  EXPECT_FALSE(packed("x:F32:0,y:F32:4,z:F32:12"));
  EXPECT_FALSE(packed("x:F32:4"));
  EXPECT_EQ(PointFields::Parse("z:F32:8,t:F64:16,r:U8:12")->MinimumStep(), 24U);
}

TEST(PointFields, CoordinatesArePackedInTheirOrderOnly) {
  const auto packed = [](const char* text) { return PointFields::Parse(text)->HasPackedXyz(); };
  EXPECT_TRUE(packed("i:U32:0,x:F32:4,y:F32:8,z:F32:12"));
  EXPECT_FALSE(packed("x:F32:0,y:F32:4,z:F32:12"));
  EXPECT_FALSE(packed("x:F32:0,y:F32:8,z:F32:12"));
  EXPECT_FALSE(packed("x:F32:4,y:F32:0,z:F32:8"));
  for (const char* other : {"x:U32:0,y:F32:4,z:F32:8", "x:F32:0,y:I32:4,z:F32:8",
                            "x:F32:0,y:F32:4,z:U32:8", "y:F32:4,z:F32:8", "x:F32:0,z:F32:8"})
    EXPECT_FALSE(packed(other)) << other;
  EXPECT_FALSE(packed("x:F32:0,y:F32:4"));
}

/// Compares each byte with docs/wire-format.md.
TEST(SensorModel, StandsOnTheWireAsDocumented) {
  SensorModel m;
  m.columns_per_scan = 0x0102;
  m.range_unit_mm = 3;
  m.beam_to_lidar_x_m = 1;
  m.beam_to_lidar_z_m = 2;
  m.beams = {{-1, 0.5, -2}};
  const auto bytes = m.Serialise();
  ASSERT_EQ(bytes.size(), 8U + 8 + 48 + 10);
  const std::vector<std::uint8_t> head = {1, 0, 1, 0, 2, 1, 3, 0, 0, 0, 0x80, 0x3F, 0, 0, 0, 0x40};
  EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + 16), head);
  const std::vector<std::uint8_t> beam = {0, 0, 0x80, 0xBF, 0, 0, 0, 0x3F, 0xFE, 0xFF};
  EXPECT_EQ(std::vector<std::uint8_t>(bytes.end() - 10, bytes.end()), beam);
}

TEST(SensorModel, TakesWhatLiesOnALimit) {
  const auto parses = [](const SensorModel& m) {
    const auto bytes = m.Serialise();
    return SensorModel::Parse({bytes.data(), bytes.size()}).has_value();
  };
  for (const double sign : {-1., 1.}) {
    for (const bool past : {false, true}) {
      SensorModel m = SmallSensor();
      m.beams[2].azimuth_deg = sign * (past ? 720.5 : 720);
      EXPECT_EQ(parses(m), !past);
      m = SmallSensor();
      m.beams[2].altitude_deg = sign * (past ? 720.5 : 720);
      EXPECT_EQ(parses(m), !past);
      m = SmallSensor();
      m.beam_to_lidar_z_m = sign * (past ? 100.5 : 100);
      EXPECT_EQ(parses(m), !past);
      m = SmallSensor();
      m.beam_to_lidar_x_m = sign * (past ? 100.5 : 100);
      EXPECT_EQ(parses(m), !past);
      m = SmallSensor();
      m.lidar_to_sensor[11] = sign * (past ? 10'001 : 10'000);
      EXPECT_EQ(parses(m), !past);
    }
  }
  SensorModel m = SmallSensor();
  m.columns_per_scan = SensorModel::kMaxColumns;
  EXPECT_TRUE(parses(m));
  m.columns_per_scan = SensorModel::kMaxColumns + 1;
  EXPECT_FALSE(parses(m));
  m = SmallSensor();
  m.range_unit_mm = RangeGrid::kMaxUnitMm;
  EXPECT_TRUE(parses(m));
  m.range_unit_mm = RangeGrid::kMaxUnitMm + 1;
  EXPECT_FALSE(parses(m)) << "coders have no such unit";
  m = SmallSensor();
  m.beams.resize(SensorModel::kMaxBeams, m.beams[0]);
  EXPECT_TRUE(parses(m));
  m.beams.push_back(m.beams[0]);
  EXPECT_FALSE(parses(m));
  m.beams.clear();
  EXPECT_FALSE(parses(m));
  m = SmallSensor();
  m.columns_per_scan = 0;
  EXPECT_FALSE(parses(m));
  m = SmallSensor();
  m.range_unit_mm = 0;
  EXPECT_FALSE(parses(m));
}

TEST(SensorModel, RefusesEveryTruncationAndForeignVersions) {
  auto bytes = SmallSensor().Serialise();
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(SensorModel::Parse({bytes.data(), n}));
  bytes.push_back(0);
  EXPECT_FALSE(SensorModel::Parse({bytes.data(), bytes.size()}));
  bytes.pop_back();
  bytes[1] = 1;  // flags of a later version of the format
  EXPECT_FALSE(SensorModel::Parse({bytes.data(), bytes.size()}));
  bytes[1] = 0;
  ASSERT_TRUE(SensorModel::Parse({bytes.data(), bytes.size()}));
  bytes[0] = 99;
  EXPECT_FALSE(SensorModel::Parse({bytes.data(), bytes.size()}));
}

TEST(SensorModel, RefusesNumbersThatAreNotFinite) {
  SensorModel m = SmallSensor();
  m.beams[1].altitude_deg = std::nan("");
  const auto bytes = m.Serialise();
  EXPECT_FALSE(SensorModel::Parse({bytes.data(), bytes.size()}));
}

// Computes one entry of the lookup table of the Ouster SDK.
std::array<double, 3> SdkPoint(const SensorModel& m, std::uint32_t beam, std::uint32_t column,
                               double r) {
  const double encoder = 2 * M_PI - 2 * M_PI * column / m.columns_per_scan;
  const double azimuth = -m.beams[beam].azimuth_deg * M_PI / 180;
  const double altitude = m.beams[beam].altitude_deg * M_PI / 180;
  const double n = std::hypot(m.beam_to_lidar_x_m, m.beam_to_lidar_z_m);
  const double x = (r - n) * std::cos(encoder + azimuth) * std::cos(altitude) +
                   m.beam_to_lidar_x_m * std::cos(encoder);
  const double y = (r - n) * std::sin(encoder + azimuth) * std::cos(altitude) +
                   m.beam_to_lidar_x_m * std::sin(encoder);
  const double z = (r - n) * std::sin(altitude) + m.beam_to_lidar_z_m;
  const Transform& t = m.lidar_to_sensor;
  return {t[0] * x + t[1] * y + t[2] * z + t[3], t[4] * x + t[5] * y + t[6] * z + t[7],
          t[8] * x + t[9] * y + t[10] * z + t[11]};
}

TEST(RangeProjection, EqualsTheSdkFormulasWithinATenthOfAMillimetre) {
  const SensorModel m = SmallSensor();
  const RangeProjection projection(m);
  for (std::uint32_t beam = 0; beam < 4; ++beam) {
    for (std::uint32_t column : {0U, 1U, 100U, 511U}) {
      for (std::uint32_t range : {500U, 12'345U, 240'000U}) {
        const auto p = projection.Point(beam, column, range);
        const auto q = SdkPoint(m, beam, column, range * 1e-3);
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(static_cast<double>(p[i]), q[i], 1e-4) << beam << " " << column;
        EXPECT_NEAR(projection.RangeOf(beam, column, p.data()), range, 0.1);
      }
    }
  }
}

using Xyz = std::array<float, 3>;

class ProjectionWindows : public ::testing::TestWithParam<ColumnWindow> {
 protected:
  /// Returns the position of the point `index`. Each point has 20 bytes.
  static Xyz PointAt(const std::vector<std::uint8_t>& points, std::size_t index) {
    Xyz p{};
    std::memcpy(p.data(), &points[index * 20], sizeof p);
    return p;
  }
};

TEST_P(ProjectionWindows, HoldThePointOfEveryRangeAndZerosForMissingOnes) {
  const RangeProjection projection(SmallSensor());
  const ColumnWindow window = GetParam();
  const std::size_t count = window.count;
  std::vector<std::uint32_t> ranges(4 * count);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    ranges[i] = i % 5 == 0 ? 0 : static_cast<std::uint32_t>(700 + 777 * i);
  std::vector<std::uint8_t> points(ranges.size() * 20, 0xAA);
  projection.Project(ranges.data(), window, points.data(), 20);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto column = static_cast<std::uint32_t>((window.first + i % count) % 512);
    const auto beam = static_cast<std::uint32_t>(i / count);
    const Xyz p = PointAt(points, i);
    EXPECT_EQ(p, ranges[i] == 0 ? Xyz{} : projection.Point(beam, column, ranges[i])) << i;
    EXPECT_EQ(std::count(&points[i * 20 + 12], &points[i * 20 + 12] + 8, 0xAA), 8) << i;
  }
}

TEST_P(ProjectionWindows, TakeWhatStandsBehindThePoints) {
  const RangeProjection projection(SmallSensor());
  const ColumnWindow window = GetParam();
  std::vector<std::uint32_t> ranges(window.count, 5'000);
  std::vector<std::uint32_t> behind(window.count);
  std::iota(behind.begin(), behind.end(), 100U);
  std::vector<std::uint8_t> points(ranges.size() * 20, 0xAA);
  projection.ProjectBeam(2, ranges.data(), window, behind.data(), points.data(), 20);
  for (std::uint32_t i = 0; i < window.count; ++i) {
    EXPECT_EQ(PointAt(points, i), projection.Point(2, (window.first + i) % 512, 5'000));
    std::uint32_t word = 0;
    std::memcpy(&word, &points[i * 20 + 12], sizeof word);
    EXPECT_EQ(word, 100 + i);
    EXPECT_EQ(std::count(&points[i * 20 + 16], &points[i * 20 + 16] + 4, 0xAA), 4) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(All, ProjectionWindows,
                         ::testing::Values(ColumnWindow{0, 512}, ColumnWindow{3, 1},
                                           ColumnWindow{510, 4}, ColumnWindow{489, 27},
                                           ColumnWindow{511, 22}));

}  // namespace
}  // namespace lidar

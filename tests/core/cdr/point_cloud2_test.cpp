// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/point_cloud2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "src/cdr/ros_types.h"
#include "tests/core/cdr/bytes.h"

namespace lidar::cdr {
namespace {

constexpr std::uint8_t kRosU8 = 2;
constexpr std::uint8_t kRosU16 = 4;
constexpr std::uint8_t kRosU32 = 6;
constexpr std::uint8_t kRosF32 = 7;
constexpr std::uint8_t kRosF64 = 8;

template <class T>
void Put(T value, bool big_endian, Bytes* out) {
  std::uint8_t bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  if (big_endian) std::reverse(bytes, bytes + sizeof value);
  out->insert(out->end(), bytes, bytes + sizeof value);
}

template <class T>
T Get(const Bytes& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Returns a layout of 18 bytes per point: x, y, z and intensity as F32, and ring as U16.
RosLayout Velodyne(std::uint32_t width, std::uint32_t height) {
  return {height,
          width,
          {{"x", 0, kRosF32, 1},
           {"y", 4, kRosF32, 1},
           {"z", 8, kRosF32, 1},
           {"intensity", 12, kRosF32, 1},
           {"ring", 16, kRosU16, 1}},
          false,
          18,
          18 * width};
}

std::optional<Bytes> Convert(const PointCloud2& cloud,
                             const std::optional<PointLayout>& wanted = {}) {
  const auto converter = PointConverter::Make(cloud.layout, wanted);
  if (!converter) return std::nullopt;
  Bytes out(converter->size(), 0xEE);
  if (!converter->Convert(cloud, out.data())) return std::nullopt;
  return out;
}

std::string FieldsOf(const RosLayout& layout) {
  std::string why;
  const auto converter = PointConverter::Make(layout, {}, &why);
  return converter ? converter->points().fields.ToString() : why;
}

TEST(PointCloud2, StandsOnTheWireAsRosHasIt) {
  const Bytes points = {1, 2, 3, 4};
  PointCloud2 cloud;
  cloud.header = {Time{} + Duration{3'000'000'005}, "os"};
  cloud.layout = {1, 1, {{"x", 0, kRosF32, 1}}, false, 4, 4};
  cloud.data = View(points);
  cloud.is_dense = true;
  const Bytes expected = {
      0, 1, 0, 0,                              // CDR_LE
      3, 0, 0, 0, 5,   0,   0, 0,              // stamp
      3, 0, 0, 0, 'o', 's', 0, 0,              // frame_id
      1, 0, 0, 0, 1,   0,   0, 0,              // height, width
      1, 0, 0, 0,                              // one field
      2, 0, 0, 0, 'x', 0,   0, 0, 0, 0, 0, 0,  // name, offset
      7, 0, 0, 0, 1,   0,   0, 0,              // datatype, count
      0, 0, 0, 0, 4,   0,   0, 0, 4, 0, 0, 0,  // is_bigendian, point_step, row_step
      4, 0, 0, 0, 1,   2,   3, 4,              // data
      1,                                       // is_dense
  };
  EXPECT_EQ(WritePointCloud2(cloud), expected);
}

TEST(PointCloud2, HasNoPointsHoweverManyRows) {
  PointCloud2 cloud;
  cloud.layout = Velodyne(0, 0xffffffff);
  cloud.layout.is_bigendian = true;
  EXPECT_EQ(Convert(cloud), Bytes());
}

TEST(PointCloud2, ComesBack) {
  Bytes points(18 * 12);
  std::iota(points.begin(), points.end(), std::uint8_t{0});
  PointCloud2 cloud;
  cloud.header = {Time{} + Duration{1'700'000'000'123'456'789}, "os_lidar"};
  cloud.layout = Velodyne(4, 3);
  cloud.data = View(points);
  const Bytes message = WritePointCloud2(cloud);
  const auto read = ReadPointCloud2(View(message));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->header.stamp, cloud.header.stamp);
  EXPECT_EQ(read->header.frame_id, "os_lidar");
  EXPECT_TRUE(read->layout == cloud.layout);
  EXPECT_EQ(Bytes(read->data.begin(), read->data.end()), points);
  EXPECT_FALSE(read->is_dense);
  EXPECT_EQ(Convert(*read), points);
}

TEST(PointCloud2, TruncatedOnesAreRefusedAtEachLength) {
  const Bytes points(18 * 2);
  PointCloud2 cloud;
  cloud.layout = Velodyne(2, 1);
  cloud.data = View(points);
  const Bytes message = WritePointCloud2(cloud);
  std::string why;
  for (std::size_t n = 0; n < message.size(); ++n)
    ASSERT_FALSE(ReadPointCloud2({message.data(), n}, &why)) << n;
  EXPECT_EQ(why, "the message is truncated or is not a PointCloud2");
  EXPECT_TRUE(ReadPointCloud2(View(message)));
}

TEST(PointCloud2, FlippedBytesNeverReadPastTheMessage) {
  const Bytes points(18 * 2);
  PointCloud2 cloud;
  cloud.layout = Velodyne(2, 1);
  cloud.data = View(points);
  const Bytes message = WritePointCloud2(cloud);
  for (std::size_t i = 0; i < message.size(); ++i) {
    for (const int value : {0x00, 0x01, 0x40, 0x7F, 0x80, 0xFF}) {
      Bytes hurt = message;
      hurt[i] = static_cast<std::uint8_t>(value);
      const auto read = ReadPointCloud2(View(hurt));
      if (!read || read->layout.width * std::uint64_t{read->layout.height} > 1000) continue;
      Convert(*read);
    }
  }
}

TEST(PointConverter, DriversLayoutsThatOurElementsTakePassAsTheyAre) {
  EXPECT_EQ(FieldsOf(Velodyne(4, 3)), "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16");
  const auto converter = PointConverter::Make(Velodyne(4, 3));
  ASSERT_TRUE(converter);
  EXPECT_TRUE(converter->copies());
  EXPECT_EQ(converter->points().point_step, 18u);
}

TEST(PointConverter, TakesThePaddingOfRowsOut) {
  PointCloud2 cloud;
  cloud.layout = {2, 1, {{"x", 0, kRosU8, 1}}, false, 2, 5};
  const Bytes points = {1, 2, 9, 9, 9, 3, 4, 9, 9, 9};
  cloud.data = View(points);
  EXPECT_EQ(Convert(cloud), (Bytes{1, 2, 3, 4}));
}

TEST(PointConverter, TakesNoPaddingThatRowStepDoesNotSay) {
  PointCloud2 cloud;
  cloud.layout = {2, 1, {{"x", 0, kRosU8, 1}}, false, 2, 4};
  const Bytes points(10);  // two rows of 5 bytes
  cloud.data = View(points);
  EXPECT_FALSE(RowStride(cloud));
  EXPECT_FALSE(Convert(cloud));
  cloud.layout.row_step = 5;
  EXPECT_EQ(RowStride(cloud), 5U);
}

TEST(PointConverter, TakesPackedRowsWhoseStepIsNotSet) {
  PointCloud2 cloud;
  cloud.layout = {2, 1, {{"x", 0, kRosU8, 1}}, false, 2, 0};
  const Bytes points = {1, 2, 3, 4};
  cloud.data = View(points);
  EXPECT_EQ(Convert(cloud), points);
}

TEST(PointConverter, RefusesDataOfAnotherLengthThanTheLayoutSays) {
  PointCloud2 cloud;
  cloud.layout = Velodyne(4, 3);
  for (const std::size_t size : {0u, 18u * 12 - 1, 18u * 12 + 1, 18u * 4}) {
    const Bytes points(size);
    cloud.data = View(points);
    EXPECT_FALSE(Convert(cloud)) << size;
  }
}

TEST(PointConverter, RefusesArraysThatEndPastTheirPoint) {
  const auto is_taken = [](std::uint32_t count, std::uint32_t step) {
    return PointConverter::Make({1, 1, {{"a", 4, kRosF64, count}}, false, step, step}).has_value();
  };
  EXPECT_TRUE(is_taken(1, 12));
  EXPECT_FALSE(is_taken(1, 11));
  EXPECT_TRUE(is_taken(3, 28));
  EXPECT_FALSE(is_taken(3, 27));
}

TEST(PointConverter, SwapsBigEndianNumbersWhereTheyStand) {
  RosLayout layout = Velodyne(1, 1);
  layout.is_bigendian = true;
  Bytes points;
  for (const float v : {1.5f, -2.f, 3.25f, 100.f}) Put(v, true, &points);
  Put(std::uint16_t{0x0102}, true, &points);
  PointCloud2 cloud;
  cloud.layout = layout;
  cloud.data = View(points);
  const auto out = Convert(cloud);
  ASSERT_TRUE(out);
  EXPECT_EQ(Get<float>(*out, 0), 1.5f);
  EXPECT_EQ(Get<float>(*out, 4), -2.f);
  EXPECT_EQ(Get<float>(*out, 12), 100.f);
  EXPECT_EQ(Get<std::uint16_t>(*out, 16), 0x0102);
}

TEST(PointConverter, MakesF32OfDoubleCoordinatesAndKeepsOtherDoubles) {
  PointCloud2 cloud;
  cloud.layout = {1,
                  1,
                  {{"timestamp", 0, kRosF64, 1},
                   {"x", 8, kRosF64, 1},
                   {"y", 16, kRosF64, 1},
                   {"z", 24, kRosF64, 1}},
                  false,
                  32,
                  32};
  Bytes points;
  for (const double v : {1.7e9 + 1. / 64, 1.25, -2.5, 1e300}) Put(v, false, &points);
  cloud.data = View(points);
  EXPECT_EQ(FieldsOf(cloud.layout), "x:F32:0,y:F32:4,z:F32:8,timestamp:F64:12");
  const auto out = Convert(cloud);
  ASSERT_TRUE(out);
  EXPECT_EQ(Get<float>(*out, 0), 1.25f);
  EXPECT_EQ(Get<float>(*out, 4), -2.5f);
  EXPECT_TRUE(std::isinf(Get<float>(*out, 8)));
  EXPECT_EQ(Get<double>(*out, 12), 1.7e9 + 1. / 64);
}

TEST(PointConverter, GivesWhatIsWanted) {
  PointCloud2 cloud;
  cloud.layout = Velodyne(1, 1);
  Bytes points;
  for (const float v : {1.f, 2.f, 3.f, 300.6f}) Put(v, false, &points);
  Put(std::uint16_t{77}, false, &points);
  cloud.data = View(points);
  const auto fields = PointFields::Parse("ring:U8:0,x:F64:2,intensity:U8:10");
  ASSERT_TRUE(fields);
  const auto out = Convert(cloud, PointLayout{*fields, 12});
  ASSERT_TRUE(out);
  EXPECT_EQ(out->size(), 12u);
  EXPECT_EQ((*out)[0], 77);
  EXPECT_EQ((*out)[1], 0);
  EXPECT_EQ(Get<double>(*out, 2), 1.);
  EXPECT_EQ((*out)[10], 255);  // the value of U8 that is nearest to 300.6
  std::string why;
  EXPECT_FALSE(PointConverter::Make(cloud.layout,
                                    PointLayout{PointFields().Add("t", FieldType::kU32), 4}, &why));
  EXPECT_EQ(why, "there is no field t");
}

/// The same fields are wanted at other offsets: without gaps, with a gap before the last field,
/// with a gap before the first field, and in another order.
TEST(PointConverter, PutsFieldsWhereTheyAreWanted) {
  PointCloud2 cloud;
  cloud.layout = {1,     2,  {{"x", 0, kRosF32, 1}, {"y", 4, kRosF32, 1}, {"i", 8, kRosF32, 1}},
                  false, 16, 32};
  Bytes points;
  for (const float v : {1.F, 2.F, 3.F, 9.F, 4.F, 5.F, 6.F, 9.F}) Put(v, false, &points);
  cloud.data = View(points);
  for (const char* wanted : {"x:F32:0,y:F32:4,i:F32:8", "x:F32:0,y:F32:4,i:F32:12",
                             "x:F32:4,y:F32:8,i:F32:12", "y:F32:0,x:F32:4,i:F32:8"}) {
    const auto fields = PointFields::Parse(wanted);
    ASSERT_TRUE(fields);
    const auto out = Convert(cloud, PointLayout{*fields, 16});
    ASSERT_TRUE(out);
    for (const std::size_t point : {0U, 1U}) {
      const auto at = [&](const char* name) {
        return Get<float>(*out, 16 * point + fields->Find(name)->offset);
      };
      const auto first = static_cast<float>(1 + 3 * point);
      EXPECT_EQ(at("x"), first) << wanted;
      EXPECT_EQ(at("y"), first + 1) << wanted;
      EXPECT_EQ(at("i"), first + 2) << wanted;
    }
  }
}

TEST(PointConverter, NotANumberIsZeroAsAnInteger) {
  PointCloud2 cloud;
  cloud.layout = {1, 1, {{"v", 0, kRosF32, 1}}, false, 4, 4};
  Bytes points;
  Put(std::numeric_limits<float>::quiet_NaN(), false, &points);
  cloud.data = View(points);
  EXPECT_EQ(Convert(cloud, PointLayout{PointFields().Add("v", FieldType::kI16), 2}), (Bytes{0, 0}));
}

TEST(PointConverter, GivesEachElementOfAnArrayANameAndTakesItBack) {
  const RosLayout layout = {
      1, 1, {{"x", 0, kRosF32, 0}, {"n", 4, kRosF32, 3}, {"r", 16, kRosU8, 1}}, false, 17, 17};
  RosLayout with_y = layout;
  with_y.fields[0].name = "v";
  const auto converter = PointConverter::Make(with_y);
  ASSERT_TRUE(converter);
  EXPECT_EQ(converter->points().fields.ToString(),
            "v:F32:0,n[0]:F32:4,n[1]:F32:8,n[2]:F32:12,r:U8:16");
  with_y.fields[0].count = 1;
  EXPECT_TRUE(ToRosLayout(converter->points(), 1, 1) == with_y);
}

TEST(PointConverter, LeavesOutWhatHasNoUsableName) {
  const RosLayout layout = {1,
                            1,
                            {{"", 0, kRosU8, 1},
                             {"a,b", 1, kRosU8, 1},
                             {"k\xC3\xA4", 2, kRosU8, 1},
                             {"v", 3, kRosU8, 1},
                             {"v", 4, kRosU8, 1},
                             {"new", 5, 9, 1},
                             {"histogram", 0, kRosU8, 4000}},
                            false,
                            8,
                            8};
  EXPECT_EQ(FieldsOf(layout), "v:U8:3");
}

TEST(PointConverter, RefusesLayoutsThatContradictThemselves) {
  RosLayout layout = Velodyne(1, 1);
  layout.point_step = 17;
  EXPECT_EQ(FieldsOf(layout), "the field ring ends past point_step 17");
  layout = Velodyne(1, 1);
  layout.fields[2].offset = 0xFFFFFFFF;
  EXPECT_EQ(FieldsOf(layout), "the field z ends past point_step 18");
  layout = Velodyne(0xFFFFFFFF, 0xFFFFFFFF);
  EXPECT_EQ(FieldsOf(layout), "width x height x point_step is above 1 GiB");
  layout = Velodyne(1, 1);
  layout.fields.clear();
  EXPECT_EQ(FieldsOf(layout), "there are no fields");
  layout.point_step = 0;
  layout.fields = {{"x", 0, kRosU32, 0}};
  EXPECT_EQ(FieldsOf(layout), "the field x ends past point_step 0");
  layout = Velodyne(1, 1);
  layout.point_step = 400;
  layout.fields = {{"a", 0, kRosU32, 32}, {"b", 128, kRosU32, 1}};
  EXPECT_EQ(FieldsOf(layout), "there are more than 32 fields");
}

TEST(PointConverter, BoundsTheCloudsOfBothSides) {
  constexpr std::uint32_t kQuarter = 1U << 28;  // a quarter of a GiB
  RosLayout layout = {1, kQuarter, {{"x", 0, kRosU8, 1}}, false, 4, 0};
  EXPECT_TRUE(PointConverter::Make(layout));
  layout.width += 1;
  EXPECT_FALSE(PointConverter::Make(layout));
  layout = {1, kQuarter, {{"x", 0, kRosU8, 1}}, false, 1, 0};
  EXPECT_TRUE(PointConverter::Make(layout, PointLayout{*PointFields::Parse("x:F32:0"), 4}));
  EXPECT_FALSE(PointConverter::Make(layout, PointLayout{*PointFields::Parse("x:F32:0"), 5}));
}

TEST(PointConverter, TakesAsManyFieldsAsAMessageMayHave) {
  for (const std::size_t count : {1024U, 1025U}) {
    PointCloud2 cloud;
    cloud.layout = {1, 1, {}, false, 1, 1};
    cloud.layout.fields.resize(count, {"x", 0, kRosU8, 1});
    const Bytes point(1);
    cloud.data = View(point);
    const Bytes message = WritePointCloud2(cloud);
    const auto read = ReadPointCloud2(View(message));
    EXPECT_EQ(read ? read->layout.fields.size() : 0U, count == 1024 ? 1024U : 0U);
  }
}

TEST(PointConverter, NamesOfSeveralArraysStayApart) {
  const auto fields = [](const char* text) {
    std::string names;
    for (const RosField& f : ToRosLayout({*PointFields::Parse(text), 20}, 3, 2).fields)
      names += f.name + "*" + std::to_string(f.count) + " ";
    return names;
  };
  EXPECT_EQ(fields("n[0]:F32:0,n[1]:F32:4,n[2]:F32:8"), "n*3 ");
  EXPECT_EQ(fields("n[0]:F32:0,m[1]:F32:4"), "n[0]*1 m[1]*1 ");
  EXPECT_EQ(fields("n[0]:F32:0,n[1]:U32:4"), "n[0]*1 n[1]*1 ");
  EXPECT_EQ(fields("n[0]:F32:0,n[1]:F32:8"), "n[0]*1 n[1]*1 ");
  EXPECT_EQ(fields("n[1]:F32:0,n[2]:F32:4"), "n[1]*1 n[2]*1 ");
  EXPECT_EQ(fields("nm:F32:0,nm[1]:F32:4"), "nm*1 nm[1]*1 ");
  EXPECT_EQ(fields("n[0]x:F32:0,n[1]:F32:4"), "n[0]x*1 n[1]*1 ");
}

TEST(PointConverter, RowsOfTheLayoutAreThoseOfTheCloud) {
  const RosLayout layout = ToRosLayout({*PointFields::Parse("x:F32:0"), 8}, 3, 2);
  EXPECT_EQ(layout.height, 2U);
  EXPECT_EQ(layout.width, 3U);
  EXPECT_EQ(layout.point_step, 8U);
  EXPECT_EQ(layout.row_step, 24U);
  EXPECT_EQ(layout.fields[0].datatype, kRosF32);
}

TEST(PointConverter, PacksPointsThatAreTooLong) {
  const RosLayout layout = {
      1,
      2,
      {{"x", 0, kRosF32, 1}, {"y", 4, kRosF32, 1}, {"z", 8, kRosF32, 1}, {"far", 2000, kRosU16, 1}},
      false,
      2048,
      4096};
  EXPECT_EQ(FieldsOf(layout), "x:F32:0,y:F32:4,z:F32:8,far:U16:12");
}

TEST(RosTypes, StandInTheOrderOfTheirEnumeration) {
  for (const RosTypeInfo& info : kRosTypes) EXPECT_EQ(InfoOf(info.type).name, info.name);
}

TEST(PointConverter, PacksPointsThatAreLargerThanOurElementsTake) {
  for (const std::uint32_t step : {PointFields::kMaxPointStep, PointFields::kMaxPointStep + 1}) {
    const RosLayout layout{1,     1,    {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}},
                           false, step, step};
    const auto converter = PointConverter::Make(layout);
    ASSERT_TRUE(converter);
    EXPECT_EQ(converter->points().point_step, step > PointFields::kMaxPointStep ? 12 : step);
  }
}

}  // namespace
}  // namespace lidar::cdr

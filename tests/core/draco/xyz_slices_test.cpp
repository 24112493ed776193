// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests slices in xyz geometry from raw points to raw points, above all unusual slices.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "ext/draco/draco_check.h"
#include "ext/draco/slice_coder.h"

namespace lidar::draco {
namespace {

using codec::EncodedSlice;
using codec::SliceResult;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kMaxPoints = 1U << 20;

/// The x, y, z and intensity of a point.
using Point = std::array<float, 4>;
using Points = std::vector<Point>;

codec::CloudFormat PlainFormat() {
  codec::CloudFormat format;
  format.layout = {*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12"), 16};
  return format;
}

double Distance(const Point& a, const Point& b) {
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i)
    squares += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
  return std::sqrt(squares);
}

struct Result {
  SliceResult result = SliceResult::kEmpty;
  EncodedSlice slice = {};
  Points points = {};
};

/// Encodes the points in xyz geometry, decodes the slice, and returns the slice and the decoded
/// points.
Result Coded(const Points& points, const SliceSettings& settings) {
  auto encoder = *SliceEncoder::Create(PlainFormat(), Geometry::kXyz);
  const auto* raw = reinterpret_cast<const std::uint8_t*>(points.data());
  encoder.Load({raw, points.size() * sizeof(Point)}, 0, settings.intensity_bits > 0);
  Result coded;
  coded.result = encoder.Encode(settings, &coded.slice);
  if (coded.result != SliceResult::kEncoded) return coded;
  SliceDecoder decoder(PlainFormat(), Geometry::kXyz, kMaxPoints);
  const auto shape = decoder.Decode({coded.slice.bytes.data(), coded.slice.bytes.size()});
  EXPECT_TRUE(shape);
  if (!shape) return coded;
  coded.points.resize(shape->width);
  decoder.Write(reinterpret_cast<std::uint8_t*>(coded.points.data()));
  return coded;
}

/// Returns the largest distance from one of `points` to the nearest of `others`.
double LargestGap(const Points& points, const Points& others) {
  double largest = 0;
  for (const Point& point : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point& other : others) nearest = std::min(nearest, Distance(point, other));
    largest = std::max(largest, nearest);
  }
  return largest;
}

/// Returns points on rings, one ring after the other, as a sensor orders them.
Points Rings(std::size_t count) {
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto angle = static_cast<float>(i % 100) * 0.0628F;
    const float radius = 5 + static_cast<float>(i / 100);
    points[i] = {radius * std::cos(angle), radius * std::sin(angle), -1.5F,
                 static_cast<float>(i % 256)};
  }
  return points;
}

struct OddCloud {
  const char* name;
  Points odd;  // points that are inserted among 500 usual points
  std::size_t kept;
};
void PrintTo(const OddCloud& c, std::ostream* out) { *out << c.name; }

class OddClouds : public ::testing::TestWithParam<std::tuple<OddCloud, unsigned>> {};

TEST_P(OddClouds, ComeBackWithinTheErrorWithoutWhatIsNoPoint) {
  const auto& [odd, level] = GetParam();
  Points points = Rings(500);
  points.insert(points.begin() + 250, odd.odd.begin(), odd.odd.end());
  SliceSettings settings;
  settings.level = level;
  settings.intensity_bits = 5;
  const Result coded = Coded(points, settings);
  ASSERT_EQ(coded.result, SliceResult::kEncoded);
  EXPECT_EQ(coded.points.size(), 500 + odd.kept);
  EXPECT_EQ(coded.slice.returns, 500 + odd.kept);
  EXPECT_LE(coded.slice.error_m, settings.max_error_m);
  Points real;
  for (const Point& p : points) {
    const bool zeros = p[0] == 0 && p[1] == 0 && p[2] == 0;
    if (!zeros && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))
      real.push_back(p);
  }
  EXPECT_LE(LargestGap(real, coded.points), coded.slice.error_m);
  EXPECT_LE(LargestGap(coded.points, real), coded.slice.error_m);
  for (const Point& p : coded.points) EXPECT_TRUE(p[3] >= 0 && p[3] <= 255 * 1.001F) << p[3];
}
INSTANTIATE_TEST_SUITE_P(
    All, OddClouds,
    ::testing::Combine(
        ::testing::Values(
            OddCloud{"Nan", {{kNan, 1, 1, 1}, {1, kNan, 1, 1}, {1, 1, kNan, 1}}, 0},
            OddCloud{"Infinity", {{kInfinity, 1, 1, 1}, {1, -kInfinity, 1, 1}}, 0},
            OddCloud{"Zeros", Points(100, Point{}), 0},
            OddCloud{"MinusZeros", Points(3, Point{-0.0F, 0, -0.0F, 9}), 0},
            OddCloud{"Duplicates", Points(300, Point{7, 7, 7, 7}), 300},
            OddCloud{"OddIntensity", {{9, 9, 9, kNan}, {8, 8, 8, -5}, {7, 7, 7, -kInfinity}}, 3},
            OddCloud{"TenKilometres", {{10'000, 0, 0, 1}}, 1}),
        ::testing::Values(0U, 7U)),
    [](const auto& c) {
      return std::string(std::get<0>(c.param).name) + std::to_string(std::get<1>(c.param));
    });

TEST(XyzSlices, OfASinglePointComeBack) {
  for (const unsigned level : {0U, 1U, 7U, 10U}) {
    SliceSettings settings;
    settings.level = level;
    const Result coded = Coded({{3, -4, 5, 6}}, settings);
    ASSERT_EQ(coded.points.size(), 1U) << level;
    EXPECT_LE(Distance(coded.points[0], {3, -4, 5}), 0.02) << level;
  }
}

TEST(XyzSlices, OfIntensitiesThatAreAllZeroComeBackAsSuch) {
  Points points = Rings(500);
  for (Point& p : points) p[3] = 0;
  for (const unsigned level : {0U, 1U, 7U, 10U}) {
    SliceSettings settings;
    settings.level = level;
    settings.intensity_bits = 5;
    const Result coded = Coded(points, settings);
    ASSERT_EQ(coded.result, SliceResult::kEncoded) << level;
    ASSERT_EQ(coded.points.size(), points.size()) << level;
    for (const Point& p : coded.points) ASSERT_EQ(p[3], 0) << level;
  }
}

TEST(XyzSlices, WithoutIntensitiesHaveNoneOfTheSliceBefore) {
  const Points points = Rings(200);
  SliceDecoder decoder(PlainFormat(), Geometry::kXyz, kMaxPoints);
  for (const unsigned bits : {5U, 0U, 5U}) {
    SliceSettings settings;
    settings.intensity_bits = bits;
    const auto bytes = Coded(points, settings).slice.bytes;
    const auto shape = decoder.Decode({bytes.data(), bytes.size()});
    ASSERT_TRUE(shape);
    Points decoded(shape->width);
    decoder.Write(reinterpret_cast<std::uint8_t*>(decoded.data()));
    const bool any = std::any_of(decoded.begin(), decoded.end(),
                                 [](const Point& point) { return point[3] > 0; });
    EXPECT_EQ(any, bits > 0);
  }
}

TEST(XyzSlices, WithoutAnyPointGiveNoStream) {
  EXPECT_EQ(Coded({}, {}).result, SliceResult::kEmpty);
  EXPECT_EQ(Coded(Points(50, Point{}), {}).result, SliceResult::kEmpty);
  EXPECT_EQ(Coded({{kNan, kNan, kNan, 0}}, {}).result, SliceResult::kEmpty);
}

TEST(XyzSlices, KeepTheErrorWhateverTheStep) {
  const Points points = Rings(700);
  for (const double step : {1e-12, 1e-7, 1e-4, 0.03, 1'000.0, 1e30}) {
    SliceSettings settings;
    settings.step_m = step;
    const Result coded = Coded(points, settings);
    if (coded.result == SliceResult::kOutOfReach) {
      EXPECT_LT(step, 1e-6) << "what Draco cannot count";
      continue;
    }
    EXPECT_LE(LargestGap(points, coded.points), settings.max_error_m) << step;
    EXPECT_LE(coded.slice.step_m, step);
  }
}

TEST(XyzSlices, ThatNoGridCanHoldAreSaidToBeOutOfReach) {
  Points points = Rings(10);
  points.push_back({10'000, 0, 0, 0});
  SliceSettings settings;
  settings.max_error_m = 0.0005;  // Floats at 10 km are a millimetre apart.
  EXPECT_EQ(Coded(points, settings).result, SliceResult::kOutOfReach);
  points.back()[0] = 3e38F;
  EXPECT_EQ(Coded(points, {}).result, SliceResult::kOutOfReach);
}

/// Returns points on a curve. Neighbouring points are one or two cells apart.
Points Line() {
  Points points(5'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto t = static_cast<float>(i) * 0.02F;
    points[i] = {t, 3 * std::sin(t), std::cos(t), 0};
  }
  return points;
}

TEST(XyzSlices, TakeTheSmallerOfDracosCodersForTheOrderGiven) {
  Points points = Line();
  std::mt19937 random(1);
  for (const bool in_order : {true, false}) {
    if (!in_order) std::shuffle(points.begin(), points.end(), random);
    const auto size = [&](unsigned level) {
      SliceSettings settings;
      settings.level = level;
      return Coded(points, settings).slice.bytes.size();
    };
    EXPECT_EQ(size(7) == size(0), in_order);
    EXPECT_LE(size(7), size(0));
  }
}

/// With fine steps, the sequential coder would need a table of all steps.
TEST(XyzSlices, OfFineStepsAreCodedInATree) {
  for (const double step : {1e-3, 1e-4, 5e-5, 1e-5}) {
    SliceSettings settings;
    settings.level = 0;
    settings.step_m = step;
    const Result coded = Coded(Rings(700), settings);
    ASSERT_EQ(coded.result, SliceResult::kEncoded) << step;
    const auto summary =
        CheckDraco({coded.slice.bytes.data(), coded.slice.bytes.size()}, {kMaxPoints});
    ASSERT_TRUE(summary) << step;
    EXPECT_EQ(summary->is_kd_tree, step < 1e-4) << step;
  }
}

/// A tree has the number of points a second time. libdraco decodes as many points as the tree says.
TEST(XyzSlices, WhoseTreeHasAnotherNumberOfPointsAreRefused) {
  SliceSettings settings;
  settings.step_m = 1e-5;
  const auto stream = Coded(Rings(700), settings).slice.bytes;
  // The offset after the header, an attribute, the level and the bits.
  constexpr std::size_t kPointsOfTree = 27;
  ASSERT_GT(stream.size(), kPointsOfTree);
  ASSERT_EQ(stream[kPointsOfTree], 700 % 256);
  for (const int more : {0, 1, -1}) {
    auto changed = stream;
    changed[kPointsOfTree] = static_cast<std::uint8_t>(changed[kPointsOfTree] + more);
    const auto summary = CheckDraco({changed.data(), changed.size()}, {kMaxPoints});
    EXPECT_EQ(summary && summary->is_kd_tree, more == 0) << more;
  }
}

TEST(XyzSlices, AreCodedByTheCoderThatWasTheSmallerOneUntilBothAreTriedAgain) {
  const Points line = Line();
  auto encoder = *SliceEncoder::Create(PlainFormat(), Geometry::kXyz);
  Points shuffled = line;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));
  const auto encode = [&](const Points& points, unsigned level) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(points.data());
    encoder.Load({raw, points.size() * sizeof(Point)}, 0, false);
    SliceSettings settings;
    settings.level = level;
    EncodedSlice slice;
    EXPECT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    return slice.bytes.size();
  };
  const std::size_t smallest = encode(line, 7);
  EXPECT_EQ(smallest, encode(line, 0));
  // The encoder codes the slices 1 to 63 with the sequential coder, and slice 64 with the kd-tree.
  for (unsigned i = 1; i < 64; ++i) ASSERT_EQ(encode(line, 7), smallest) << i;
  const std::size_t in_a_tree = encode(shuffled, 7);
  EXPECT_LT(in_a_tree, encode(shuffled, 0));
  EXPECT_EQ(encode(shuffled, 7), in_a_tree);
}

TEST(XyzSlices, OfAThinnedCloudAreThoseOfWhatWasKept) {
  const Points all = Rings(900);
  Points some;
  std::vector<bool> kept(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    kept[i] = i % 3 == 1;
    if (kept[i]) some.push_back(all[i]);
  }
  std::vector<std::vector<std::uint8_t>> coded;
  for (const bool thins : {true, false}) {
    const Points& points = thins ? all : some;
    auto encoder = *SliceEncoder::Create(PlainFormat(), Geometry::kXyz);
    const auto* raw = reinterpret_cast<const std::uint8_t*>(points.data());
    encoder.Load({raw, points.size() * sizeof(Point)}, 0, true);
    if (thins) encoder.Thin(kept);
    EXPECT_EQ(encoder.returns(), some.size());
    EncodedSlice slice;
    SliceSettings settings;
    settings.intensity_bits = 6;
    EXPECT_EQ(encoder.Encode(settings, &slice), SliceResult::kEncoded);
    coded.push_back(slice.bytes);
  }
  EXPECT_EQ(coded[0], coded[1]);
}

template <class T>
void ExpectAttribute(const ::draco::PointCloud& cloud, ::draco::GeometryAttribute::Type type,
                     const T& expected) {
  const auto* attribute = cloud.GetNamedAttribute(type);
  ASSERT_NE(attribute, nullptr);
  std::vector<float> values(expected.size());
  attribute->buffer()->Read(0, values.data(), values.size() * sizeof(float));
#ifdef __x86_64__
  EXPECT_EQ(values, expected);
#else  // Draco is built with fused multiplications there: the last bit of tens of metres may differ
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], 1e-5) << i;
#endif
}

TEST(XyzSlices, WithoutAGridAreTheirFloatsIfThoseAreNumbers) {
  for (const float odd : {3e-7F, -1e20F, kNan, kInfinity}) {
    const std::vector<float> xyz = {1, -2.5F, odd, 0.1F, -0.0F, 7};
    ::draco::GeometryAttribute attribute;
    attribute.Init(::draco::GeometryAttribute::POSITION, nullptr, 3, ::draco::DT_FLOAT32, false, 12,
                   0);
    ::draco::PointCloud points;
    points.set_num_points(2);
    const int id = points.AddAttribute(attribute, true, 2);
    points.attribute(id)->buffer()->Write(0, xyz.data(), xyz.size() * sizeof(float));
    ::draco::Encoder encoder;
    encoder.SetEncodingMethod(::draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
    ::draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodePointCloudToBuffer(points, &buffer).ok());
    const ByteView stream{reinterpret_cast<const std::uint8_t*>(buffer.data()), buffer.size()};
    XyzCloud cloud;
    EXPECT_EQ(DecodeXyz(stream, 2, &cloud), std::isfinite(odd)) << odd;
    if (std::isfinite(odd)) {
      EXPECT_EQ(cloud.xyz, xyz);
    }
    EXPECT_FALSE(DecodeXyz(stream, 1, &cloud));
  }
}

TEST(XyzSlices, AreTheFloatsThatDracoItselfDecodes) {
  Points points = Rings(3'000);
  std::mt19937 random(2);
  for (Point& p : points) p[2] += static_cast<float>(random() % 1'000) * 0.01F;
  for (const unsigned level : {0U, 1U, 4U, 7U}) {
    SliceSettings settings;
    settings.level = level;
    settings.intensity_bits = 5;
    const auto stream = Coded(points, settings).slice.bytes;
    XyzCloud cloud;
    ASSERT_TRUE(DecodeXyz({stream.data(), stream.size()}, kMaxPoints, &cloud));
    ::draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    ::draco::Decoder decoder;
    const auto draco = decoder.DecodePointCloudFromBuffer(&buffer);
    ASSERT_TRUE(draco.ok());
    ExpectAttribute(*draco.value(), ::draco::GeometryAttribute::POSITION, cloud.xyz);
    ExpectAttribute(*draco.value(), ::draco::GeometryAttribute::GENERIC, cloud.intensity);
  }
}

}  // namespace
}  // namespace lidar::draco

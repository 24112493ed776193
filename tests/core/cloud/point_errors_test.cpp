// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/point_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "src/cloud/point_math.h"

namespace lidar {
namespace {

const PointFields kXyz = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");

/// Returns points that are two metres apart, so that the nearest point of a moved point is still
/// the original one.
std::vector<DecodedPoint> Lattice() {
  std::vector<DecodedPoint> points;
  for (unsigned i = 0; i < 500; ++i) {
    points.push_back({{2 * static_cast<float>(i % 10) + 1, 2 * static_cast<float>(i / 10 % 10),
                       2 * static_cast<float>(i / 100)},
                      0});
  }
  return points;
}

/// Returns the bytes of `points` as they are in a buffer.
std::vector<std::uint8_t> Raw(const std::vector<DecodedPoint>& points) {
  std::vector<std::uint8_t> raw(12 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    std::memcpy(&raw[12 * i], points[i].position.data(), 12);
  return raw;
}

PointErrors Measure(const std::vector<DecodedPoint>& before, const std::vector<DecodedPoint>& after,
                    PointOrder order, bool thinned = false) {
  const auto raw = Raw(before);
  const auto errors = MeasureErrors({raw.data(), raw.size()}, kXyz, 12, after, order, thinned);
  EXPECT_TRUE(errors);
  return errors.value_or(PointErrors{});
}

class AnyOrder : public ::testing::TestWithParam<PointOrder> {};
INSTANTIATE_TEST_SUITE_P(All, AnyOrder,
                         ::testing::Values(PointOrder::kPixels, PointOrder::kKept,
                                           PointOrder::kAny));

TEST_P(AnyOrder, SeesOneStrayPointInEitherCloud) {
  const auto cloud = Lattice();
  auto stray = cloud;
  stray[250].position[2] += 0.75F;
  EXPECT_DOUBLE_EQ(Measure(cloud, stray, GetParam()).max_m, 0.75);
  EXPECT_DOUBLE_EQ(Measure(stray, cloud, GetParam()).max_m, 0.75);
  EXPECT_NEAR(Measure(cloud, stray, GetParam()).mean_m, 0.75 / 500, 1e-12);
  EXPECT_EQ(Measure(cloud, cloud, GetParam()).max_m, 0);
  EXPECT_EQ(Measure(cloud, cloud, GetParam()).points, 500U);
}

TEST(PointErrors, SeeAPointThatNoRawPointIsNear) {
  auto more = Lattice();
  more.push_back({{1, 0, -0.75F}, 0});
  const PointErrors errors = Measure(Lattice(), more, PointOrder::kAny);
  EXPECT_DOUBLE_EQ(errors.max_m, 0.75);
  EXPECT_EQ(errors.mean_m, 0);
  EXPECT_EQ(errors.points, 500U);
  EXPECT_EQ(errors.missing, 0U);
}

TEST(PointErrors, CountPointsThatAreGone) {
  const auto cloud = Lattice();
  const std::vector<DecodedPoint> fewer(cloud.begin(), cloud.end() - 2);
  for (const PointOrder order : {PointOrder::kKept, PointOrder::kAny}) {
    const PointErrors errors = Measure(cloud, fewer, order, true);
    EXPECT_EQ(errors.missing, 2U);
    EXPECT_EQ(errors.points, 498U);
    EXPECT_EQ(errors.max_m, 0);
  }
  EXPECT_EQ(Measure(cloud, fewer, PointOrder::kKept).missing, 2U);
  auto gap = cloud;
  gap[7] = {};
  EXPECT_EQ(Measure(cloud, gap, PointOrder::kPixels).missing, 1U);
  EXPECT_EQ(Measure(gap, cloud, PointOrder::kPixels).missing, 1U);
}

TEST(PointErrors, OfMergedPointsAreDistancesToTheOneThatStandsForThem) {
  auto cloud = Lattice();
  const auto merged = cloud;
  auto twin = cloud[99];
  twin.position[1] += 0.25F;
  cloud.push_back(twin);
  const PointErrors errors = Measure(cloud, merged, PointOrder::kAny);
  EXPECT_EQ(errors.missing, 0U);
  EXPECT_EQ(errors.points, 501U);
  EXPECT_DOUBLE_EQ(errors.max_m, 0.25);
  EXPECT_NEAR(errors.mean_m, 0.25 / 501, 1e-12);
}

TEST(PointErrors, OfAPointThatIsGoneIsTheDistanceToTheNextOneWhereTheyMayMerge) {
  const auto cloud = Lattice();
  const PointErrors errors = Measure(cloud, {cloud.begin(), cloud.end() - 1}, PointOrder::kAny);
  EXPECT_DOUBLE_EQ(errors.max_m, 2);
}

/// A lattice, and a copy of it with errors of up to 5 cm. Changed() mirrors or scales a cloud.
class PointErrorsOf : public ::testing::TestWithParam<PointOrder> {
 protected:
  static std::vector<DecodedPoint> Changed(std::vector<DecodedPoint> points, float factor) {
    for (DecodedPoint& p : points)
      for (float& c : p.position) c *= factor;
    return points;
  }
  std::vector<DecodedPoint> before_ = Lattice();
  std::vector<DecodedPoint> after_ = Lattice();
  PointErrorsOf() {
    for (std::size_t i = 0; i < after_.size(); ++i)
      after_[i].position[i % 3] += static_cast<float>(i % 7) / 128;
  }
};
INSTANTIATE_TEST_SUITE_P(All, PointErrorsOf,
                         ::testing::Values(PointOrder::kPixels, PointOrder::kKept,
                                           PointOrder::kAny));

TEST_P(PointErrorsOf, AMirroredCloudAreTheSame) {
  const PointErrors one = Measure(before_, after_, GetParam());
  const PointErrors other = Measure(Changed(before_, -1), Changed(after_, -1), GetParam());
  EXPECT_EQ(one.points, 500U);
  EXPECT_EQ(one.max_m, other.max_m);
  EXPECT_EQ(one.mean_m, other.mean_m);
  EXPECT_EQ(one.rounding_m, other.rounding_m);
  EXPECT_EQ(one.missing, other.missing);
}

TEST_P(PointErrorsOf, ACloudOfTwiceTheSizeAreTwiceAsLarge) {
  const PointErrors one = Measure(before_, after_, GetParam());
  const PointErrors other = Measure(Changed(before_, 2), Changed(after_, 2), GetParam());
  EXPECT_DOUBLE_EQ(2 * one.max_m, other.max_m);
  EXPECT_DOUBLE_EQ(2 * one.mean_m, other.mean_m);
  EXPECT_DOUBLE_EQ(2 * one.rounding_m, other.rounding_m);
}

TEST_P(PointErrorsOf, TheWayBackAreThoseOfTheWayThere) {
  const PointErrors one = Measure(before_, after_, GetParam());
  const PointErrors other = Measure(after_, before_, GetParam());
  EXPECT_DOUBLE_EQ(one.max_m, 6.0 / 128);
  EXPECT_DOUBLE_EQ(one.max_m, other.max_m);
  EXPECT_DOUBLE_EQ(one.mean_m, other.mean_m);
}

TEST(PointErrors, AreNotConfusedByAnotherOrder) {
  const auto cloud = Lattice();
  const std::vector<DecodedPoint> turned(cloud.rbegin(), cloud.rend());
  EXPECT_EQ(Measure(cloud, turned, PointOrder::kAny).max_m, 0);
  EXPECT_GT(Measure(cloud, turned, PointOrder::kKept).max_m, 1);
}

TEST(PointErrors, OfACloudOfManyNearPointsAreDistancesToTheNearest) {
  std::mt19937 random(5);
  const auto cloud = [&random] {
    std::vector<DecodedPoint> points(300);
    for (DecodedPoint& p : points)
      for (float& c : p.position) c = 1 + static_cast<float>(random() % 1'000) / 1'000;
    return points;
  };
  const auto before = cloud();
  const auto after = cloud();
  double sum = 0;
  for (const DecodedPoint& p : before) {
    double nearest = 9;
    for (const DecodedPoint& q : after)
      nearest = std::min(nearest, SquaredDistance(p.position.data(), q.position.data()));
    sum += std::sqrt(nearest);
  }
  EXPECT_NEAR(Measure(before, after, PointOrder::kAny).mean_m, sum / 300, 1e-9);
}

TEST(PointErrors, SayWhatFloatsAddFarAway) {
  std::vector<DecodedPoint> far = {{{10'000, 0, 0}, 0}};
  EXPECT_NEAR(Measure(far, far, PointOrder::kKept).rounding_m, 4 * 1.2e-7 * 10'000, 1e-4);
}

TEST(PointErrors, RangesHaveRoundingToo) {
  const auto fields = *PointFields::Parse("range:U32:0");
  const std::uint32_t range = 200'000;
  const std::vector<DecodedPoint> decoded = {{{1, 0, 0}, 200'000}};
  const auto errors = MeasureErrors({reinterpret_cast<const std::uint8_t*>(&range), sizeof range},
                                    fields, 4, decoded, PointOrder::kPixels);
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->rounding_m, 4 * 1.1920929e-7 * 200, 1e-9);
}

TEST(PointErrors, TakeRangesWhereThereAreNoPositions) {
  const auto fields = *PointFields::Parse("range:U32:0");
  const std::uint32_t ranges[] = {1'000, 0, 2'000, 3'000, 0};
  const std::vector<DecodedPoint> decoded = {
      {{1, 0, 0}, 1'004}, {}, {}, {{3, 0, 0}, 3'000}, {{4, 0, 0}, 4'000}};
  const auto errors = MeasureErrors({reinterpret_cast<const std::uint8_t*>(ranges), sizeof ranges},
                                    fields, 4, decoded, PointOrder::kPixels);
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->max_m, 0.004, 1e-9);
  EXPECT_EQ(errors->points, 2U);
  EXPECT_EQ(errors->missing, 2U) << "one is gone, and one came from nowhere";
}

TEST(PointErrors, AreNoneWhereThereIsNothingToCompare) {
  const auto cloud = Lattice();
  const auto raw = Raw(cloud);
  const ByteView view{raw.data(), raw.size()};
  const std::vector<DecodedPoint> fewer(cloud.begin(), cloud.end() - 1);
  EXPECT_FALSE(MeasureErrors(view, kXyz, 12, fewer, PointOrder::kPixels));
  const auto times = *PointFields::Parse("t:F32:0");
  for (const PointOrder order : {PointOrder::kPixels, PointOrder::kKept, PointOrder::kAny})
    EXPECT_FALSE(MeasureErrors(view, times, 12, cloud, order));
}

TEST(PointErrors, OfACloudThatIsGoneAreCountedAsMissing) {
  const PointErrors errors = Measure(Lattice(), {}, PointOrder::kAny);
  EXPECT_EQ(errors.missing, 500U);
  EXPECT_EQ(errors.points, 0U);
}

}  // namespace
}  // namespace lidar

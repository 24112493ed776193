// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/cloud_compare.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>

#include "src/tools/bench/demo/stream_comparer.h"

namespace lidar::demo {
namespace {

Cloud Organised(std::vector<float> xyz) {
  const auto width = static_cast<std::uint32_t>(xyz.size() / 6);
  return {{1, 0}, 2, width, std::move(xyz)};
}
Cloud Unorganised(std::vector<float> xyz) {
  const auto width = static_cast<std::uint32_t>(xyz.size() / 3);
  return {{1, 0}, 1, width, std::move(xyz)};
}

TEST(CloudCompare, OrganisedCloudsAreComparedPlaceByPlace) {
  const auto sent = Organised({1, 0, 0, 2, 0, 0, 0, 0, 0, 4, 0, 0});
  const auto c = Compare(sent, Organised({1, 0.03F, 0.04F, 0, 0, 0, 3, 0, 0, 4, 0, 0}), 1);
  EXPECT_EQ(c.points, 2U);
  EXPECT_EQ(c.missing, 1U);
  EXPECT_EQ(c.added, 1U);
  EXPECT_NEAR(c.max_error_m, 0.05, 1e-7);
  EXPECT_NEAR(c.sum_error_m, 0.05, 1e-7);
}

TEST(CloudCompare, PointsThatChangedPlacesAreAnErrorInAnOrganisedCloud) {
  const auto c = Compare(Organised({1, 0, 0, 2, 0, 0}), Organised({2, 0, 0, 1, 0, 0}), 0.1);
  EXPECT_EQ(c.max_error_m, 1);
}

TEST(CloudCompare, UnorganisedCloudsMayComeInAnyOrderAndWithoutZeros) {
  const auto sent = Unorganised({-1, 5, 0, 2, 0, 0, 0, 0, 0, 4, 0, -3});
  const auto c = Compare(sent, Unorganised({4, 0, -3.02F, -1.01F, 5, 0, 2, 0, 0}), 0.1);
  EXPECT_EQ(c.points, 3U);
  EXPECT_EQ(c.missing + c.added, 0U);
  EXPECT_NEAR(c.max_error_m, 0.02, 1e-6);
}

/// In PCD files, a point whose coordinates are not finite marks a missing return.
TEST(CloudCompare, PointsThatAreNotFiniteAreMissingReturns) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const std::vector<float> sent = {kNan, kNan, kNan, 2, 0, 0, kFar, 0, 0, 4, 0, 0};
  for (const auto& c :
       {Compare(Unorganised(sent), Unorganised({2, 0, 0, 4, 0, 0}), 0.1),
        Compare(Unorganised({2, 0, 0, 4, 0, 0}), Unorganised(sent), 0.1),
        Compare(Organised(sent), Organised({0, 0, 0, 2, 0, 0, 0, 0, 0, 4, 0, 0}), 1),
        Compare(Organised(sent), Organised(sent), 1)}) {
    EXPECT_EQ(c.points, 2U);
    EXPECT_EQ(c.missing, 0U);
    EXPECT_EQ(c.added, 0U);
    EXPECT_EQ(c.max_error_m, 0);
  }
}

TEST(CloudCompare, AnUnorganisedPointThatNobodySentIsAnErrorOfItsDistance) {
  const auto sent = Unorganised({1, 0, 0, 5, 0, 0});
  const auto c = Compare(sent, Unorganised({1, 0, 0, 5, 0, 0, 5, 0, 0.09F}), 0.1);
  EXPECT_EQ(c.points, 2U);
  EXPECT_EQ(c.missing + c.added, 0U);
  EXPECT_NEAR(c.max_error_m, 0.09, 1e-6);
}

TEST(CloudCompare, AnUnorganisedPointOutOfReachIsMissingHereAndAddedThere) {
  const auto c = Compare(Unorganised({1, 0, 0}), Unorganised({1, 0, 0.2F}), 0.1);
  EXPECT_EQ(c.missing, 1U);
  EXPECT_EQ(c.added, 1U);
  EXPECT_EQ(c.points, 0U);
}

TEST(CloudCompare, FramesComeOutOfAPipeAsTheyWentIn) {
  int fds[2];
  ASSERT_EQ(pipe(fds), 0);
  const auto cloud = Organised({1, 2, 3, 4, 5, 6});
  const std::string bytes = WriteFrame(cloud) + "not a frame, and long enough";
  ASSERT_EQ(write(fds[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  close(fds[1]);
  const auto read = ReadFrame(fds[0]);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->xyz, cloud.xyz);
  EXPECT_EQ(read->height, 2U);
  EXPECT_FALSE(ReadFrame(fds[0]));
  close(fds[0]);
}

TEST(CloudCompare, TheComparerMatchesSlicesOfTwoPipes) {
  int sent[2];
  int received[2];
  ASSERT_EQ(pipe(sent), 0);
  ASSERT_EQ(pipe(received), 0);
  StreamComparer comparer(sent[0], received[0], 0.1);
  const auto put = [](int fd, std::uint32_t slice, float x) {
    Cloud cloud = Organised({x, 0, 0, x, 0, 0});
    cloud.key.slice = slice;
    const std::string frame = WriteFrame(cloud);
    EXPECT_EQ(write(fd, frame.data(), frame.size()), static_cast<ssize_t>(frame.size()));
  };
  put(received[1], 1, 10.5F);
  put(received[1], 2, 20.25F);
  put(sent[1], 0, 5);
  put(sent[1], 1, 10);
  put(sent[1], 2, 20);
  close(sent[1]);
  close(received[1]);
  comparer.Finish();
  const auto results = comparer.Take();
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0].first.slice, 1U);
  EXPECT_EQ(results[0].second.max_error_m, 0.5);
  EXPECT_EQ(results[1].second.max_error_m, 0.25);
  close(sent[0]);
  close(received[0]);
}

}  // namespace
}  // namespace lidar::demo

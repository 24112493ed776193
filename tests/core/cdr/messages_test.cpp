// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/messages.h"

#include <gtest/gtest.h>

#include <numeric>

#include "src/cdr/coded_slice.h"
#include "tests/core/cdr/bytes.h"

namespace lidar::cdr {
namespace {

const Header kHeader = {Time{} + Duration{1'700'000'000'123'456'789}, "map"};

Imu AnImu() {
  Imu imu;
  imu.header = kHeader;
  imu.orientation = {0.1, 0.2, 0.3, 0.4};
  imu.angular_velocity = {1, 2, 3};
  imu.linear_acceleration = {0.5, -0.5, 9.81};
  std::iota(imu.linear_acceleration_covariance.begin(), imu.linear_acceleration_covariance.end(),
            7.);
  return imu;
}

Odometry AnOdometry() {
  Odometry o;
  o.header = kHeader;
  o.child_frame_id = "base_link";
  o.position = {10, -20, 30};
  o.orientation = {0, 0, 0.6, 0.8};
  o.linear_velocity = {5, 0, 0};
  o.angular_velocity = {0, 0, 0.25};
  std::iota(o.pose_covariance.begin(), o.pose_covariance.end(), 100.);
  return o;
}

Transforms TwoTransforms() {
  return {{kHeader, "base_link", {1, 2, 3}, {0, 0, 0, 1}},
          {{Time{}, ""}, "a", {4, 5, 6}, {0.5, 0.5, 0.5, 0.5}}};
}

TEST(Messages, ImuComesBack) {
  const Bytes bytes = WriteImu(AnImu());
  const auto imu = ReadImu(View(bytes));
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->header.stamp, kHeader.stamp);
  EXPECT_EQ(imu->header.frame_id, "map");
  EXPECT_EQ(imu->orientation, AnImu().orientation);
  EXPECT_EQ(imu->orientation_covariance[0], -1);
  EXPECT_EQ(imu->angular_velocity, AnImu().angular_velocity);
  EXPECT_EQ(imu->linear_acceleration, AnImu().linear_acceleration);
  EXPECT_EQ(imu->linear_acceleration_covariance, AnImu().linear_acceleration_covariance);
  // The message has 4 bytes of encapsulation, a header, and 37 doubles that are aligned to 8 bytes.
  EXPECT_EQ(bytes.size(), 4u + 16 + 37 * 8);
}

TEST(Messages, OdometryComesBack) {
  const Bytes bytes = WriteOdometry(AnOdometry());
  const auto o = ReadOdometry(View(bytes));
  ASSERT_TRUE(o);
  EXPECT_EQ(o->child_frame_id, "base_link");
  EXPECT_EQ(o->position, AnOdometry().position);
  EXPECT_EQ(o->orientation, AnOdometry().orientation);
  EXPECT_EQ(o->pose_covariance, AnOdometry().pose_covariance);
  EXPECT_EQ(o->linear_velocity, AnOdometry().linear_velocity);
  EXPECT_EQ(o->angular_velocity, AnOdometry().angular_velocity);
}

TEST(Messages, TransformsComeBack) {
  const Bytes bytes = WriteTransforms(TwoTransforms());
  const auto transforms = ReadTransforms(View(bytes));
  ASSERT_TRUE(transforms);
  ASSERT_EQ(transforms->size(), 2u);
  EXPECT_EQ((*transforms)[0].header.stamp, kHeader.stamp);
  EXPECT_EQ((*transforms)[0].child_frame_id, "base_link");
  EXPECT_EQ((*transforms)[1].translation, (Vector3{4, 5, 6}));
  EXPECT_EQ((*transforms)[1].rotation, (Quaternion{0.5, 0.5, 0.5, 0.5}));
}

std::vector<double> Doubles(CdrReader* r, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(r->F64());
  return values;
}

void ExpectTheHeader(CdrReader* r) {
  EXPECT_EQ(r->I32(), 1'700'000'000);
  EXPECT_EQ(r->U32(), 123'456'789U);
  EXPECT_EQ(r->Text(), "map");
}

// The members have the order of the .msg files of ROS 2.

TEST(Messages, ImuHasTheOrderOfItsDefinition) {
  Imu imu = AnImu();
  imu.angular_velocity_covariance = {11, 12, 13, 14, 15, 16, 17, 18, 19};
  const Bytes bytes = WriteImu(imu);
  CdrReader r(View(bytes));
  ExpectTheHeader(&r);
  EXPECT_EQ(Doubles(&r, 4), (std::vector{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(Doubles(&r, 9), (std::vector<double>{-1, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(Doubles(&r, 3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(Doubles(&r, 9), (std::vector<double>{11, 12, 13, 14, 15, 16, 17, 18, 19}));
  EXPECT_EQ(Doubles(&r, 3), (std::vector{0.5, -0.5, 9.81}));
  EXPECT_EQ(Doubles(&r, 9), (std::vector<double>{7, 8, 9, 10, 11, 12, 13, 14, 15}));
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0U);
  EXPECT_EQ(ReadImu(View(bytes))->angular_velocity_covariance, imu.angular_velocity_covariance);
}

TEST(Messages, OdometryHasTheOrderOfItsDefinition) {
  Odometry o = AnOdometry();
  o.twist_covariance[35] = 8;
  const Bytes bytes = WriteOdometry(o);
  CdrReader r(View(bytes));
  ExpectTheHeader(&r);
  EXPECT_EQ(r.Text(), "base_link");
  EXPECT_EQ(Doubles(&r, 3), (std::vector<double>{10, -20, 30}));
  EXPECT_EQ(Doubles(&r, 4), (std::vector<double>{0, 0, 0.6, 0.8}));
  EXPECT_EQ(Doubles(&r, 36).back(), 135.);
  EXPECT_EQ(Doubles(&r, 3), (std::vector<double>{5, 0, 0}));
  EXPECT_EQ(Doubles(&r, 3), (std::vector<double>{0, 0, 0.25}));
  EXPECT_EQ(Doubles(&r, 36).back(), 8.);
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0U);
  EXPECT_EQ(ReadOdometry(View(bytes))->twist_covariance[35], 8);
}

TEST(Messages, TransformsHaveTheOrderOfTheirDefinition) {
  const Bytes bytes = WriteTransforms(TwoTransforms());
  CdrReader r(View(bytes));
  EXPECT_EQ(r.U32(), 2U);
  ExpectTheHeader(&r);
  EXPECT_EQ(r.Text(), "base_link");
  EXPECT_EQ(Doubles(&r, 7), (std::vector<double>{1, 2, 3, 0, 0, 0, 1}));
  EXPECT_EQ(r.I32(), 0);
  EXPECT_EQ(r.U32(), 0U);
  EXPECT_EQ(r.Text(), "");
  EXPECT_EQ(r.Text(), "a");
  EXPECT_EQ(Doubles(&r, 7), (std::vector<double>{4, 5, 6, 0.5, 0.5, 0.5, 0.5}));
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0U);
}

TEST(Messages, WithoutARotationHaveNone) {
  const Quaternion none = {0, 0, 0, 1};
  EXPECT_EQ(Imu().orientation, none);
  EXPECT_EQ(Odometry().orientation, none);
  EXPECT_EQ(TransformStamped().rotation, none);
}

CodedSlice ASlice(const Bytes& data) {
  CodedSlice slice;
  slice.header = kHeader;
  slice.duration = Duration{2'000'000'003};
  slice.scan_id = 0xA1;
  slice.slice_index = 0xA2;
  slice.slice_count = 0xA3;
  slice.first_column = 0xA4;
  slice.discontinuity = true;
  slice.data = View(data);
  return slice;
}

TEST(CodedSlices, StandOnTheWireAsTheirDefinitionHasThem) {
  const Bytes data = {9, 8, 7};
  const Bytes bytes = WriteCodedSlice(ASlice(data));
  CdrReader r(View(bytes));
  ExpectTheHeader(&r);
  EXPECT_EQ(r.I32(), 2);
  EXPECT_EQ(r.U32(), 3U);
  for (const std::uint32_t number : {0xA1U, 0xA2U, 0xA3U, 0xA4U}) EXPECT_EQ(r.U32(), number);
  EXPECT_TRUE(r.Bool());
  const ByteView octets = r.Octets();
  EXPECT_EQ(Bytes(octets.begin(), octets.end()), data);
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.remaining(), 0U);
}

TEST(CodedSlices, ComeBack) {
  const Bytes data = {9, 8, 7};
  const Bytes bytes = WriteCodedSlice(ASlice(data));
  const auto slice = ReadCodedSlice(View(bytes));
  ASSERT_TRUE(slice);
  EXPECT_EQ(slice->header.stamp, kHeader.stamp);
  EXPECT_EQ(slice->duration, Duration{2'000'000'003});
  EXPECT_EQ(slice->scan_id, 0xA1U);
  EXPECT_EQ(slice->slice_index, 0xA2U);
  EXPECT_EQ(slice->slice_count, 0xA3U);
  EXPECT_EQ(slice->first_column, 0xA4U);
  EXPECT_TRUE(slice->discontinuity);
  EXPECT_EQ(Bytes(slice->data.begin(), slice->data.end()), data);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    ASSERT_FALSE(ReadCodedSlice({bytes.data(), n})) << n;
}

TEST(CodedSlices, ANegativeDurationIsNone) {
  CodedSlice slice;
  Bytes bytes = WriteCodedSlice(slice);
  EXPECT_FALSE(ReadCodedSlice(View(bytes))->duration);
  // The duration is after the stamp and an empty frame id. It has seconds, and then nanoseconds.
  EXPECT_EQ(Bytes(bytes.begin() + 20, bytes.begin() + 28),
            (Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0}));
  slice.duration = Duration{0};
  bytes = WriteCodedSlice(slice);
  EXPECT_EQ(ReadCodedSlice(View(bytes))->duration, Duration{0});
  slice.duration = Duration{-1};
  EXPECT_EQ(ReadCodedSlice(View(WriteCodedSlice(slice)))->duration, Duration{0});
  slice.duration = Duration::max();
  EXPECT_EQ(ReadCodedSlice(View(WriteCodedSlice(slice)))->duration,
            std::chrono::seconds(INT32_MAX));
  // The nanoseconds of a duration may be 999,999,999 at most.
  bytes[24] = 0x00, bytes[25] = 0xCA, bytes[26] = 0x9A, bytes[27] = 0x3B;
  EXPECT_FALSE(ReadCodedSlice(View(bytes))->duration);
  bytes[24] = 0xFF, bytes[25] = 0xC9;
  EXPECT_EQ(ReadCodedSlice(View(bytes))->duration, Duration{999'999'999});
}

TEST(Messages, StampsOutsideOfTheirRangeBecomeItsEnds) {
  Transforms t = TwoTransforms();
  t[0].header.stamp = Time{} - Duration{5};
  t[1].header.stamp = Time::max();
  const Bytes bytes = WriteTransforms(t);
  const auto read = ReadTransforms(View(bytes));
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)[0].header.stamp, Time{});
  EXPECT_EQ((*read)[1].header.stamp, Time{} + Duration{2'147'483'647'999'999'999});
}

TEST(Messages, TruncatedOnesAreRefusedAtEachLength) {
  const Bytes imu = WriteImu(AnImu());
  for (std::size_t n = 0; n < imu.size(); ++n) ASSERT_FALSE(ReadImu({imu.data(), n})) << n;
  const Bytes odometry = WriteOdometry(AnOdometry());
  for (std::size_t n = 0; n < odometry.size(); ++n)
    ASSERT_FALSE(ReadOdometry({odometry.data(), n})) << n;
  const Bytes transforms = WriteTransforms(TwoTransforms());
  for (std::size_t n = 0; n < transforms.size(); ++n)
    ASSERT_FALSE(ReadTransforms({transforms.data(), n})) << n;
}

TEST(Messages, ASequenceLongerThanItsMessageTakesNoMemory) {
  Bytes bytes = WriteTransforms(TwoTransforms());
  bytes[7] = 0x40;  // claims that there are 2^30 more transforms
  EXPECT_FALSE(ReadTransforms(View(bytes)));
}

}  // namespace
}  // namespace lidar::cdr

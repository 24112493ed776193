// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the error checks of encoders, and of clouds whose points contradict their ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "gst/lidar/gstlidarencoder.h"
#include "tests/elements/coders/checked_codec.h"

namespace lidar::gst {
namespace {

double Number(const GstStructure* s, const char* name) {
  double value = -1;
  EXPECT_TRUE(gst_structure_get_double(s, name, &value)) << name;
  return value;
}

/// Returns the distance between each point of `a` and the point of `b` with the same index. Omits
/// points of `a` whose coordinates are all zero.
std::vector<double> Distances(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<double> distances;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    if (a[i] == 0 && a[i + 1] == 0 && a[i + 2] == 0) continue;
    distances.push_back(LargestDistance({a[i], a[i + 1], a[i + 2]}, {b[i], b[i + 1], b[i + 2]}));
  }
  return distances;
}

void ExpectErrors(const GstStructure* check, const std::vector<double>& distances) {
  guint64 points = 0;
  ASSERT_TRUE(gst_structure_get_uint64(check, "points", &points));
  EXPECT_EQ(points, distances.size());
  EXPECT_NEAR(Number(check, "largest-error"), *std::max_element(distances.begin(), distances.end()),
              1e-9);
  EXPECT_NEAR(Number(check, "mean-error"),
              std::accumulate(distances.begin(), distances.end(), 0.0) /
                  static_cast<double>(distances.size()),
              1e-9);
}

TEST_P(EitherCoder, ReportsTheDistancesThatATestMeasuresInRangeGeometry) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(), "error-check=1");
  codec.SetCaps(OrganisedInfo(model, 64));
  double largest = 0;
  std::vector<double> all;
  for (guint i = 0; i < 8; ++i) {
    GstBuffer* input = OrganisedBuffer(model, 64, {3, i, 8, 64 * i});
    const auto before = PointsOf(input, 20);
    const BufferPtr output = codec.Push(input);
    const StructurePtr check = codec.PopCheck();
    ASSERT_TRUE(check);
    const auto distances = Distances(before, PointsOf(output.get(), 20));
    ExpectErrors(check.get(), distances);
    all.insert(all.end(), distances.begin(), distances.end());
    EXPECT_TRUE(Holds(check.get()));
    EXPECT_NEAR(Number(check.get(), "error-bound"), 0.02, 1e-9);
    guint slice = 99;
    EXPECT_TRUE(gst_structure_get_uint(check.get(), "slice-index", &slice));
    EXPECT_EQ(slice, i);
    largest = std::max(largest, Number(check.get(), "largest-error"));
  }
  EXPECT_EQ(Number(codec.Stats().get(), "largest-error"), largest);
  EXPECT_NEAR(Number(codec.Stats().get(), "mean-error"),
              std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size()), 1e-9);
  EXPECT_GT(largest, 0.019);
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(codec.harness()->element), "enc"));
  g_object_set(enc.get(), "max-error", 0.01, nullptr);
  codec.Push(OrganisedBuffer(model, 64, {4, 0, 8, 0}));
  EXPECT_LE(Number(codec.PopCheck().get(), "largest-error"), 0.011);
  EXPECT_EQ(Number(codec.Stats().get(), "largest-error"), largest);
  EXPECT_EQ(codec.Warnings(), 0U);
}

TEST_P(EitherCoder, ChecksAtOnceWhereMoreIsToBeCheckedThanBefore) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(), "error-check=10000");
  codec.SetCaps(OrganisedInfo(model, 64));
  for (guint i = 0; i < 4; ++i) codec.Push(OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
  while (codec.PopCheck()) {
  }
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(codec.harness()->element), "enc"));
  g_object_set(enc.get(), "error-check", 1, nullptr);
  for (guint i = 4; i < 6; ++i) codec.Push(OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
  EXPECT_TRUE(codec.PopCheck());
}

#ifdef HAVE_DRACO
CloudInfo PlainInfo(guint points) {
  CloudInfo info;
  info.width = points;
  info.point_step = 12;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
  info.framerate_n = 10;
  return info;
}

/// Returns points that are two metres apart. A decoded point is therefore always nearest to its own
/// original point.
std::vector<float> Lattice() {
  std::vector<float> xyz;
  for (unsigned i = 0; i < 500; ++i) {
    const float wobble = 0.37F * static_cast<float>(i % 13) / 13;
    xyz.insert(xyz.end(), {2 * static_cast<float>(i % 10) + 1 + wobble,
                           2 * static_cast<float>(i / 10 % 10) - wobble,
                           2 * static_cast<float>(i / 100) + 0.5F * wobble});
  }
  return xyz;
}

class XyzLevels : public ::testing::TestWithParam<const char*> {};
TEST_P(XyzLevels, ReportTheDistancesThatATestMeasures) {
  const auto before = Lattice();
  CheckedCodec codec(kDracoXyz, std::string("error-check=1 max-error=0.05 ") + GetParam());
  codec.SetCaps(PlainInfo(500));
  const BufferPtr output =
      codec.Push(gst_buffer_new_memdup(before.data(), before.size() * sizeof(float)));
  const auto after = PointsOf(output.get(), 12);
  std::vector<double> distances;
  for (std::size_t i = 0; i < before.size(); i += 3) {
    double nearest = 1e9;
    for (std::size_t k = 0; k < after.size(); k += 3) {
      nearest = std::min(nearest, LargestDistance({before[i], before[i + 1], before[i + 2]},
                                                  {after[k], after[k + 1], after[k + 2]}));
    }
    distances.push_back(nearest);
  }
  const StructurePtr check = codec.PopCheck();
  ASSERT_TRUE(check);
  ExpectErrors(check.get(), distances);
  EXPECT_TRUE(Holds(check.get()));
  EXPECT_GT(Number(check.get(), "largest-error"), 0.02);
}
INSTANTIATE_TEST_SUITE_P(All, XyzLevels,
                         ::testing::Values("compression-level=0", "compression-level=7"));
#endif

/// Checks that a decoded point is compared with its own original point. The points here are closer
/// to each other than the error, so the nearest decoded point is rarely the right one.
void ExpectPointwiseErrors(const CoderCase& coder, const std::string& properties) {
  std::vector<float> before;
  for (unsigned i = 0; i < 500; ++i) {
    const auto f = static_cast<float>(i);
    before.insert(before.end(),
                  {5 + 0.004F * f, 3 - 0.003F * f, 0.02F * static_cast<float>(i % 7)});
  }
  CheckedCodec codec(coder, "error-check=1 max-error=0.05 " + properties);
  CloudInfo info;
  info.width = 500;
  info.point_step = 12;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
  info.framerate_n = 10;
  codec.SetCaps(info);
  const BufferPtr output =
      codec.Push(gst_buffer_new_memdup(before.data(), before.size() * sizeof(float)));
  ASSERT_TRUE(output);
  const auto after = PointsOf(output.get(), gst_buffer_get_size(output.get()) / 500);
  ASSERT_EQ(after.size(), before.size());
  const StructurePtr check = codec.PopCheck();
  ASSERT_TRUE(check);
  ExpectErrors(check.get(), Distances(before, after));
}

TEST(KeptOrder, IsThatOfTheCheckedPoints) {
  ExpectPointwiseErrors(kLidarXyz, "keep-order=true");
#ifdef HAVE_DRACO
  ExpectPointwiseErrors(kDracoXyz, "compression-level=0");
#endif
}

TEST_P(EitherCoder, LooksAtEveryNthSliceOnlyWhateverTheirCaps) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(), "error-check=3");
  CloudInfo info = OrganisedInfo(model, 64);
  std::vector<guint> checked;
  for (guint i = 0; i < 8; ++i) {
    ++info.framerate_n;
    codec.SetCaps(info);
    codec.Push(OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
    if (codec.PopCheck()) checked.push_back(i);
  }
  EXPECT_EQ(checked, (std::vector<guint>{0, 3, 6}));
}

/// Returns the buffer of OrganisedBuffer(), but with all points moved by a metre in x. The ranges
/// are unchanged.
GstBuffer* MovedBuffer(const SensorModel& model, const GstLidarSlice& slice) {
  GstBuffer* buffer = OrganisedBuffer(model, 64, slice);
  BufferMap map(buffer, GST_MAP_READWRITE);
  for (gsize at = 0; at < map.size(); at += 20) {
    float x = 0;
    std::memcpy(&x, map.data() + at, sizeof x);
    if (x == 0) continue;
    x += 1;
    std::memcpy(map.data() + at, &x, sizeof x);
  }
  return buffer;
}

TEST_P(EitherCoder, WarnsWhenTheErrorIsLargerThanItMayBe) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(), "error-check=1");
  codec.SetCaps(OrganisedInfo(model, 64));
  codec.Push(OrganisedBuffer(model, 64, {0, 0, 8, 0}));
  codec.PopCheck();
  EXPECT_EQ(codec.Warnings(), 0U);
  for (guint i = 1; i < 3; ++i) {
    codec.Push(MovedBuffer(model, {0, i, 8, 64 * i}));
    const StructurePtr check = codec.PopCheck();
    ASSERT_TRUE(check);
    EXPECT_FALSE(Holds(check.get()));
    EXPECT_NEAR(Number(check.get(), "largest-error"), 1, 0.021);
  }
  // Two slices have wrong errors and ranges, but there is only one warning for the errors and one
  // for the ranges.
  EXPECT_EQ(codec.Warnings(), 2U);
  const StructurePtr stats = codec.Stats();
  guint64 failed = 0;
  EXPECT_TRUE(gst_structure_get_uint64(stats.get(), "error-checks-failed", &failed));
  EXPECT_EQ(failed, 2U);
}

TEST_P(EitherCoder, SeesAPointThatIsGone) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(), "error-check=1");
  codec.SetCaps(OrganisedInfo(model, 64));
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(codec.harness()->element), "enc"));
  GstLidarEncoderClass* klass = GST_LIDAR_ENCODER_GET_CLASS(enc.get());
  static gboolean (*decode)(GstLidarEncoder*, const guint8*, gsize, GArray*, GstLidarPointOrder*);
  decode = klass->decode;
  klass->decode = [](GstLidarEncoder* base, const guint8* data, gsize size, GArray* points,
                     GstLidarPointOrder* order) -> gboolean {
    if (!decode(base, data, size, points, order)) return FALSE;
    auto* all = reinterpret_cast<GstLidarPoint*>(points->data);
    auto* gone = std::find_if(all, all + points->len, [](const auto& p) { return p.range > 0; });
    *gone = {};
    return TRUE;
  };
  codec.Push(OrganisedBuffer(model, 64, {0, 0, 8, 0}));
  klass->decode = decode;
  const StructurePtr check = codec.PopCheck();
  ASSERT_TRUE(check);
  EXPECT_FALSE(Holds(check.get()));
  guint64 missing = 0;
  EXPECT_TRUE(gst_structure_get_uint64(check.get(), "points-missing", &missing));
  EXPECT_EQ(missing, 1U);
  EXPECT_EQ(codec.Warnings(), 1U);
}

TEST_P(EitherCoder, WarnsAgainOfErrorsThatComeBack) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(), "error-check=1");
  codec.SetCaps(OrganisedInfo(model, 64));
  for (const unsigned warnings : {2U, 3U}) {  // the first round also warns about the ranges
    for (guint i = 0; i < 2; ++i) codec.Push(MovedBuffer(model, {0, i, 8, 64 * i}));
    codec.Push(OrganisedBuffer(model, 64, {0, 2, 8, 128}));
    EXPECT_EQ(codec.Warnings(), warnings);
  }
}

TEST_P(EitherCoder, TellsHowGoodASliceIs) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam(),
                     "max-error=0.05 degradation-preference=maintain-framerate bitrate=100000");
  codec.SetCaps(OrganisedInfo(model, 64));
  const auto decoder = [&](const char* name) {
    const ElementPtr dec(gst_bin_get_by_name(GST_BIN(codec.harness()->element), "dec"));
    return Number(StatsOf(dec.get()).get(), name);
  };
  for (guint i = 0; i < 80; ++i) {
    codec.Push(OrganisedBuffer(model, 64, {i / 8, i % 8, 8, 64 * (i % 8)}));
    EXPECT_FALSE(i == 0 && decoder("keep-fraction") < 1);
  }
  EXPECT_EQ(decoder("step"), Number(codec.Stats().get(), "step"));
  EXPECT_NEAR(decoder("error-bound"), 0.05, 1e-9);
  const double keep = Number(codec.Stats().get(), "keep-fraction");
  EXPECT_LT(keep, 0.9);
  EXPECT_NEAR(decoder("keep-fraction"), keep, 1.0 / 32);
}

TEST_P(EitherCoder, KnowsBeamsThatWereThinnedFromBeamsThatAreGone) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(
      GetParam(),
      "error-check=1 intensity-bits=0 degradation-preference=maintain-framerate bitrate=60000");
  codec.SetCaps(OrganisedInfo(model, 64));
  guint64 missing = 0;
  for (guint i = 0; i < 80; ++i) {
    codec.Push(OrganisedBuffer(model, 64, {i / 8, i % 8, 8, 64 * (i % 8)}));
    const StructurePtr check = codec.PopCheck();
    if (!check) continue;
    EXPECT_TRUE(Holds(check.get()));
    guint64 here = 0;
    EXPECT_TRUE(gst_structure_get_uint64(check.get(), "points-missing", &here));
    missing += here;
  }
  EXPECT_GT(missing, 1000U);
  EXPECT_EQ(codec.Warnings(), 0U);
}

TEST_P(EitherCoder, WarnsOnceWhereACloudWasMovedAfterTheSensor) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(GetParam());
  codec.SetCaps(OrganisedInfo(model, 64));
  for (guint i = 0; i < 8; ++i) codec.Push(OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
  EXPECT_EQ(codec.Warnings(), 0U);
  CloudInfo unknown = OrganisedInfo(model, 64);
  unknown.sensor_model.reset();
  codec.SetCaps(unknown);
  codec.Push(MovedBuffer(model, {1, 0, 8, 0}));
  EXPECT_EQ(codec.Warnings(), 0U) << "of a cloud without a sensor";
  codec.SetCaps(OrganisedInfo(model, 64));
  for (guint i = 0; i < 8; ++i) codec.Push(MovedBuffer(model, {1, i, 8, 64 * i}));
  EXPECT_EQ(codec.Warnings(), 1U);
}

#ifdef HAVE_DRACO
TEST(DracoEnc, SaysNothingOfMovedCloudsInXyzGeometry) {
  const SensorModel model = test::RoomSensor();
  CheckedCodec codec(kDracoXyz, "error-check=1");
  codec.SetCaps(OrganisedInfo(model, 64));
  codec.Push(MovedBuffer(model, {0, 0, 8, 0}));
  EXPECT_TRUE(Holds(codec.PopCheck().get()));
  EXPECT_EQ(codec.Warnings(), 0U);
}
#endif

}  // namespace
}  // namespace lidar::gst

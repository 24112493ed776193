// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidarenc fields=… keep-order=true: the fields that drivers add to a point are decoded
// exactly.
#include <gtest/gtest.h>

#include "tests/elements/coders/checked_codec.h"
#include "tests/elements/coders/plain_clouds.h"

namespace lidar::gst {
namespace {

constexpr guint kDriverStep = 32;
constexpr const char* kDriverFields =
    "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,tag:U8:18,timestamp:F64:24";

CloudInfo DriverInfo(std::size_t points) {
  CloudInfo info = XyzInfo(static_cast<guint>(points));
  info.point_step = kDriverStep;
  info.fields = *PointFields::Parse(kDriverFields);
  return info;
}

std::vector<std::uint8_t> DriverCloud(const std::vector<float>& xyz) {
  std::vector<std::uint8_t> raw(xyz.size() / 3 * kDriverStep);
  for (std::size_t i = 0; i < xyz.size() / 3; ++i) {
    std::uint8_t* point = &raw[i * kDriverStep];
    const auto ring = static_cast<std::uint16_t>(i % 16);
    const double time = 1.7e9 + 1e-5 * static_cast<double>(i / 16);
    std::memcpy(point, &xyz[3 * i], 12);
    std::memcpy(point + 16, &ring, sizeof ring);
    point[18] = static_cast<std::uint8_t>(i * i % 251);
    std::memcpy(point + 24, &time, sizeof time);
  }
  return raw;
}

GstBuffer* BufferOf(const std::vector<std::uint8_t>& raw) {
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size());
  GST_BUFFER_PTS(buffer) = 0;
  GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
  return buffer;
}

CloudInfo InfoOf(GstHarness* h) {
  const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
  return *CloudInfo::FromCaps(caps.get());
}

/// Returns the bytes of the field `name` of a point, or "none" if there is no such field.
std::string FieldOf(const std::uint8_t* point, const PointFields& fields, const char* name) {
  const PointField* field = fields.Find(name);
  if (field == nullptr) return "none";
  return {point + field->offset, point + field->offset + SizeOf(field->type)};
}

/// Expects that `after` has the points of `before` in the same order, and that their fields `names`
/// are equal.
void ExpectSame(const std::vector<std::uint8_t>& before, GstBuffer* after, const CloudInfo& info,
                const std::vector<const char*>& names) {
  const PointFields driver = *PointFields::Parse(kDriverFields);
  const BufferMap map(after, GST_MAP_READ);
  ASSERT_EQ(map.size() / info.point_step, before.size() / kDriverStep);
  EXPECT_LE(LargestDistance(PointsOf(after, info.point_step),
                            [&] {
                              const BufferPtr raw(BufferOf(before));
                              return PointsOf(raw.get(), kDriverStep);
                            }()),
            0.02001);
  for (std::size_t i = 0; i < before.size() / kDriverStep; ++i)
    for (const char* name : names)
      ASSERT_EQ(FieldOf(map.data() + i * info.point_step, info.fields, name),
                FieldOf(&before[i * kDriverStep], driver, name))
          << name << " of " << i;
}

class ExactFieldsByEffort : public ::testing::TestWithParam<const char*> {};
TEST_P(ExactFieldsByEffort, ComeBackInTheirOrder) {
  const CoderCase coder{"exact", GetParam(), "lidardec"};
  CheckedCodec codec(
      coder, "max-error=0.02 error-check=1 keep-order=true fields=\" ring , timestamp,tag \"");
  for (const std::size_t points : {500U, 77U}) {
    const auto raw = DriverCloud(RandomPoints(points, 40));
    codec.SetCaps(DriverInfo(points));
    const BufferPtr output = codec.Push(BufferOf(raw));
    ASSERT_TRUE(output);
    ExpectSame(raw, output.get(), InfoOf(codec.harness()), {"ring", "timestamp", "tag"});
    // The error check compares each decoded point with the original point of the same index.
    const StructurePtr check = codec.PopCheck();
    ASSERT_TRUE(check);
    EXPECT_TRUE(Holds(check.get()));
  }
  EXPECT_EQ(codec.Warnings(), 0U);
}
INSTANTIATE_TEST_SUITE_P(All, ExactFieldsByEffort,
                         ::testing::Values("lidarenc effort=0", "lidarenc effort=3",
                                           "lidarenc effort=1 intensity-bits=0"),
                         [](const auto& c) { return "case" + std::to_string(c.index); });

TEST(ExactFields, GoThroughRtp) {
  const Harness h = Launch(
      "lidarenc effort=1 keep-order=true fields=timestamp,ring ! rtplidarpay ! rtplidardepay ! "
      "lidardec");
  const auto raw = DriverCloud(RandomPoints(500, 40));
  SetCaps(h.get(), DriverInfo(500));
  ASSERT_EQ(gst_harness_push(h.get(), BufferOf(raw)), GST_FLOW_OK);
  const BufferPtr output(gst_harness_try_pull(h.get()));
  ASSERT_TRUE(output);
  ExpectSame(raw, output.get(), InfoOf(h.get()), {"ring", "timestamp"});
  EXPECT_EQ(InfoOf(h.get()).fields.Find("tag"), nullptr);
}

TEST(ExactFields, AreNoneUnlessTheyAreNamed) {
  const Harness h = Launch("lidarenc effort=1 ! lidardec");
  SetCaps(h.get(), DriverInfo(500));
  ASSERT_EQ(gst_harness_push(h.get(), BufferOf(DriverCloud(RandomPoints(500, 40)))), GST_FLOW_OK);
  const BufferPtr output(gst_harness_try_pull(h.get()));
  ASSERT_TRUE(output);
  EXPECT_EQ(InfoOf(h.get()).fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,intensity:F32:12");
}

// Positions and intensities are coded in any case, with their own precision.
TEST(ExactFields, MayNameWhatComesAnyway) {
  const CoderCase coder{"exact", "lidarenc effort=1 intensity-bits=0", "lidardec"};
  CheckedCodec codec(coder, "fields=x,y,z,intensity,ring,ring,");
  codec.SetCaps(DriverInfo(500));
  ASSERT_TRUE(codec.Push(BufferOf(DriverCloud(RandomPoints(500, 40)))));
  EXPECT_EQ(InfoOf(codec.harness()).fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,ring:U16:12");
  EXPECT_EQ(codec.Warnings(), 0U);
}

TEST(ExactFields, ThatTheCloudLacksAreWarnedOfOnce) {
  const CoderCase coder{"exact", "lidarenc effort=1", "lidardec"};
  CheckedCodec codec(coder, "fields=channel,ring");
  for (const std::size_t points : {500U, 77U}) {
    const auto raw = DriverCloud(RandomPoints(points, 40));
    codec.SetCaps(DriverInfo(points));
    EXPECT_TRUE(codec.Push(BufferOf(raw)));
    EXPECT_EQ(codec.Warnings(), 1U);
  }
  EXPECT_NE(InfoOf(codec.harness()).fields.Find("ring"), nullptr);
}

TEST(ExactFields, OfScansThatAreCodedAsRangesAreWarnedOf) {
  const SensorModel model = test::RoomSensor();
  for (const auto& [properties, warnings] : {std::pair("keep-order=true", 1U),
                                             {"fields=range", 1U},
                                             {"", 0U},
                                             {"geometry=xyz fields=range keep-order=true", 0U}}) {
    CheckedCodec codec(kLidar, properties);
    codec.SetCaps(OrganisedInfo(model, 64));
    EXPECT_TRUE(codec.Push(OrganisedBuffer(model, 64, {0, 0, 8, 0})));
    EXPECT_EQ(codec.Warnings(), warnings) << properties;
  }
}

// The caps may be false, because a hostile sender may have made them.
TEST(ExactFields, OfOtherTypesThanTheCapsSayAreDropped) {
  const Harness enc = Launch("lidarenc effort=1 fields=ring,timestamp");
  SetCaps(enc.get(), DriverInfo(500));
  gst_harness_push(enc.get(), BufferOf(DriverCloud(RandomPoints(500, 40))));
  const BufferPtr slice(gst_harness_pull(enc.get()));
  const CapsPtr coded(gst_pad_get_current_caps(enc->sinkpad));
  for (const auto& [fields, good] :
       {std::pair("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16,timestamp:F64:18", true),
        {"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,timestamp:F64:16,ring:U16:24", false},
        {"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,ring:U16:16", false},
        {"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12", false}}) {
    const Harness dec = Launch("lidardec name=dec");
    CapsPtr caps(gst_caps_copy(coded.get()));
    gst_caps_set_simple(caps.get(), "fields", G_TYPE_STRING, fields, nullptr);
    gst_harness_set_src_caps(dec.get(), caps.release());
    EXPECT_EQ(gst_harness_push(dec.get(), gst_buffer_ref(slice.get())), GST_FLOW_OK);
    EXPECT_EQ(gst_harness_buffers_received(dec.get()), good ? 1U : 0U) << fields;
    const ElementPtr element(gst_bin_get_by_name(GST_BIN(dec->element), "dec"));
    EXPECT_EQ(test::StatOf(element.get(), "slices-dropped"), good ? 0U : 1U) << fields;
  }
}

}  // namespace
}  // namespace lidar::gst

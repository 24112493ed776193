// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of what the base classes do for a coder that is not part of this project.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "gst/lidar/gstlidardecoder.h"
#include "gst/lidar/gstlidarencoder.h"
#include "tests/elements/coders/checked_codec.h"

namespace lidar::gst {
namespace {

class ExampleCoder : public ::testing::Test {
 protected:
  static const SensorModel& Sensor() {
    static const SensorModel model = test::RoomSensor();
    return model;
  }
  static GstBuffer* Slice(guint i) {
    return OrganisedBuffer(Sensor(), 64, {i / 8, i % 8, 8, 64 * (i % 8)});
  }
};

TEST_F(ExampleCoder, KeepsToABitrateItNeverHeardOf) {
  const Harness h = Encoder(kExample, "max-error=0.5 bitrate=5000000");
  SetCaps(h.get(), OrganisedInfo(Sensor(), 64));
  double bits = 0;
  for (guint i = 0; i < 240; ++i) {
    ASSERT_EQ(gst_harness_push(h.get(), Slice(i)), GST_FLOW_OK);
    while (const BufferPtr out{gst_harness_try_pull(h.get())})
      bits += i >= 80 ? 8.0 * static_cast<double>(gst_buffer_get_size(out.get())) : 0;
  }
  EXPECT_NEAR(bits / 20 * 10, 5e6, 0.03 * 5e6);
  guint min_bps = 0;
  const ElementPtr encoder(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  g_object_get(encoder.get(), "min-bitrate", &min_bps, nullptr);
  EXPECT_GT(min_bps, 0U);
  EXPECT_LT(min_bps, 5'000'000U);
}

TEST_F(ExampleCoder, HasItsErrorsMeasured) {
  CheckedCodec codec(kExample, "error-check=1 max-error=0.03");
  codec.SetCaps(OrganisedInfo(Sensor(), 64));
  for (guint i = 0; i < 8; ++i) {
    GstBuffer* input = Slice(i);
    EXPECT_TRUE(codec.Push(input));
    const StructurePtr check = codec.PopCheck();
    ASSERT_TRUE(check);
    EXPECT_TRUE(Holds(check.get()));
    gdouble largest = 0;
    EXPECT_TRUE(gst_structure_get_double(check.get(), "largest-error", &largest));
    EXPECT_GT(largest, 0.02);
    EXPECT_LT(largest, 0.03);
  }
  EXPECT_EQ(codec.Warnings(), 0U);
}

TEST_F(ExampleCoder, MayMergePointsWithinTheBound) {
  CheckedCodec codec(kExample, "error-check=1 max-error=0.5");
  codec.SetCaps(OrganisedInfo(Sensor(), 64));
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(codec.harness()->element), "enc"));
  GstLidarEncoderClass* klass = GST_LIDAR_ENCODER_GET_CLASS(enc.get());
  static gboolean (*decode)(GstLidarEncoder*, const guint8*, gsize, GArray*, GstLidarPointOrder*);
  decode = klass->decode;
  // Merges the points of a cell into one point, as a coder of voxels would.
  klass->decode = [](GstLidarEncoder* base, const guint8* data, gsize size, GArray* points,
                     GstLidarPointOrder* order) -> gboolean {
    if (!decode(base, data, size, points, order)) return FALSE;
    const auto* first = reinterpret_cast<const GstLidarPoint*>(points->data);
    std::vector<GstLidarPoint> all(first, first + points->len);
    const auto key = [](const GstLidarPoint& p) { return std::tie(p.x, p.y, p.z); };
    std::sort(all.begin(), all.end(),
              [&](const auto& a, const auto& b) { return key(a) < key(b); });
    all.erase(std::unique(all.begin(), all.end(),
                          [&](const auto& a, const auto& b) { return key(a) == key(b); }),
              all.end());
    EXPECT_LT(all.size(), points->len);
    g_array_set_size(points, 0);
    g_array_append_vals(points, all.data(), static_cast<guint>(all.size()));
    *order = GST_LIDAR_ORDER_ANY;
    return TRUE;
  };
  EXPECT_TRUE(codec.Push(Slice(0)));
  klass->decode = decode;
  const StructurePtr check = codec.PopCheck();
  ASSERT_TRUE(check);
  EXPECT_TRUE(Holds(check.get()));
  EXPECT_EQ(codec.Warnings(), 0U);
}

TEST_F(ExampleCoder, IsWarnedOfWhereItsSlicesCannotBeDecoded) {
  CheckedCodec codec(kExample, "error-check=1");
  codec.SetCaps(OrganisedInfo(Sensor(), 64));
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(codec.harness()->element), "enc"));
  GstLidarEncoderClass* klass = GST_LIDAR_ENCODER_GET_CLASS(enc.get());
  const auto decode = klass->decode;
  klass->decode = [](GstLidarEncoder*, const guint8*, gsize, GArray*, GstLidarPointOrder*) {
    return FALSE;
  };
  codec.Push(Slice(0));
  codec.Push(Slice(1));
  klass->decode = decode;
  EXPECT_EQ(codec.Warnings(), 1U);
  EXPECT_FALSE(Holds(codec.PopCheck().get()));
}

/// A receiver would mistake an empty buffer for a lost slice.
TEST_F(ExampleCoder, SendsNoSliceWithoutBytes) {
  const Harness h = Encoder(kExample);
  SetCaps(h.get(), OrganisedInfo(Sensor(), 64));
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  GstLidarEncoderClass* klass = GST_LIDAR_ENCODER_GET_CLASS(enc.get());
  const auto encode =
      std::exchange(klass->encode, [](GstLidarEncoder*, const GstLidarEncodeSettings*, GByteArray*,
                                      GstLidarCodedSlice*) { return GST_LIDAR_ENCODE_OK; });
  EXPECT_EQ(gst_harness_push(h.get(), Slice(0)), GST_FLOW_OK);
  klass->encode = encode;
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U);
  EXPECT_EQ(test::StatOf(enc.get(), "slices-empty"), 1U);
  EXPECT_EQ(test::StatOf(enc.get(), "slices"), 0U);
  EXPECT_EQ(gst_harness_push(h.get(), Slice(1)), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 1U);
}

TEST_F(ExampleCoder, HasItsDamagedSlicesDropped) {
  const Harness enc = Encoder(kExample);
  const Harness dec = Launch("exampledec name=dec");
  SetCaps(enc.get(), OrganisedInfo(Sensor(), 64));
  const BufferPtr good(gst_harness_push_and_pull(enc.get(), Slice(0)));
  gst_harness_set_src_caps(dec.get(), gst_pad_get_current_caps(enc->sinkpad));
  const gsize size = gst_buffer_get_size(good.get());
  const ElementPtr decoder(gst_bin_get_by_name(GST_BIN(dec->element), "dec"));
  guint dropped = 0;
  for (gsize length = 0; length < size; length += 1 + size / 50, ++dropped) {
    GstBuffer* cut = gst_buffer_copy_region(good.get(), GST_BUFFER_COPY_ALL, 0, length);
    EXPECT_EQ(gst_harness_push(dec.get(), cut), GST_FLOW_OK);
  }
  EXPECT_EQ(gst_harness_buffers_received(dec.get()), 0U);
  EXPECT_EQ(test::StatOf(decoder.get(), "slices-dropped"), dropped);
  EXPECT_EQ(gst_harness_push(dec.get(), gst_buffer_ref(good.get())), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(dec.get()), 1U);
}

TEST_F(ExampleCoder, MayGiveAsManyPointsAsAreAllowedAndNoMore) {
  const Harness h = Codec(kExample);
  const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
  g_object_set(dec.get(), "max-points", 1000U, nullptr);
  SetCaps(h.get(), OrganisedInfo(Sensor(), 64));
  // Replaces the decoder's functions by functions that ignore the limit of points.
  GstLidarDecoderClass* klass = GST_LIDAR_DECODER_GET_CLASS(dec.get());
  static guint width = 0;
  const auto decode = klass->decode;
  const auto write = klass->write;
  klass->decode = [](GstLidarDecoder*, const guint8*, gsize, guint,
                     GstLidarDecodedSlice* slice) -> gboolean {
    slice->width = width;
    slice->height = 2;
    return TRUE;
  };
  klass->write = [](GstLidarDecoder*, guint8*) {};
  width = 500;
  gst_harness_push(h.get(), Slice(0));
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 1U);
  width = 501;
  gst_harness_push(h.get(), Slice(1));
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 1U);
  klass->decode = decode;
  klass->write = write;
  EXPECT_EQ(test::StatOf(dec.get(), "slices-dropped"), 1U);
}

TEST_F(ExampleCoder, ThinsPointsWhereTheFrameRateMattersMore) {
  CheckedCodec codec(kExample,
                     "max-error=0.5 bitrate=2500000 degradation-preference=maintain-framerate");
  codec.SetCaps(OrganisedInfo(Sensor(), 64));
  for (guint i = 0; i < 80; ++i) EXPECT_TRUE(codec.Push(Slice(i))) << i;
  gdouble kept = 1;
  EXPECT_TRUE(gst_structure_get_double(codec.Stats().get(), "keep-fraction", &kept));
  EXPECT_LT(kept, 0.8);
}

}  // namespace
}  // namespace lidar::gst

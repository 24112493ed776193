// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-lidarenc
 *
 * Encodes the scans of a spinning sensor slice by slice, to a bitrate and within an error: ranges,
 * predicted from neighbouring beams and coded by adaptive rANS (docs/wire-format.md).
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! lidarenc max-error=0.02 ! lidardec ! fakesink
 * ]|
 */
#include "gst/lidarcodec/gstlidarenc.h"

#include <optional>
#include <string>
#include <vector>

#include "gst/common/cloud_info.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"
#include "src/rate/error_bound.h"

namespace {

using lidar::codec::SliceResult;

/// Belongs to the streaming thread.
struct Coder {
  lidar::codec::CloudFormat format;
  std::optional<lidar::codec::SliceEncoder> encoder;
  std::optional<lidar::codec::SliceDecoder> decoder;  // for error-check
  bool with_intensity = false;
  std::string mode;
  lidar::codec::EncodedSlice slice;
};

}  // namespace

struct _GstLidarEnc {
  GstLidarEncoder parent;
  Coder* coder;
};

G_DEFINE_TYPE(GstLidarEnc, gst_lidar_enc, GST_TYPE_LIDAR_ENCODER)
GST_ELEMENT_REGISTER_DEFINE(lidarenc, "lidarenc", GST_RANK_NONE, GST_TYPE_LIDAR_ENC)

static gboolean gst_lidar_enc_set_format(GstLidarEncoder* base, const GstLidarCloudFormat* cloud,
                                         gboolean with_intensity, GstLidarCodedFormat* coded) {
  Coder& coder = *GST_LIDAR_ENC(base)->coder;
  const auto info = lidar::gst::CloudInfo::FromFormat(*cloud);
  coder = {};
  coder.format = {{info.fields, info.point_step}, info.height, info.sensor_model};
  coder.with_intensity = with_intensity != FALSE;
  coder.encoder = lidar::codec::SliceEncoder::Create(coder.format);
  coded->refusal =
      "lidarenc needs a field range:U32 and a sensor-model with as many beams and at least as many "
      "columns; dracoenc takes other clouds";
  if (!coder.encoder || info.width > info.sensor_model->columns_per_scan) return FALSE;
  const auto kept = lidar::codec::KeptFields(info.fields, coder.with_intensity, true);
  coded->caps =
      gst_lidar_coded_caps_new(GST_LIDAR_SLICE_MEDIA_TYPE, kept.ToString().c_str(), cloud);
  gst_caps_set_simple(coded->caps, "geometry", G_TYPE_STRING, "range", nullptr);
  coded->codes_ranges = TRUE;
  return TRUE;
}

static void gst_lidar_enc_load(GstLidarEncoder* base, const GstLidarRawSlice* raw,
                               GstLidarLoadedSlice* loaded) {
  Coder& coder = *GST_LIDAR_ENC(base)->coder;
  coder.encoder->Load({raw->data, raw->size}, raw->first_column, coder.with_intensity);
  coder.mode = coder.encoder->Mode();
  loaded->returns = static_cast<guint>(coder.encoder->returns());
  loaded->extent = coder.encoder->extent_m();
  loaded->rows = static_cast<guint>(coder.encoder->rows());
  loaded->has_intensity = coder.encoder->has_intensity();
  loaded->mode = coder.mode.c_str();
}

static void gst_lidar_enc_get_steps(GstLidarEncoder* base, gdouble max_error,
                                    GstLidarStepRange* steps) {
  const auto bound =
      lidar::rate::ErrorBound::Range(GST_LIDAR_ENC(base)->coder->encoder->range_unit_mm());
  *steps = {bound.FinestStep(), bound.CoarsestStep(max_error), bound.step_unit()};
}

static void gst_lidar_enc_thin(GstLidarEncoder* base, const guint8* kept, guint rows) {
  GST_LIDAR_ENC(base)->coder->encoder->Thin(std::vector<bool>(kept, kept + rows));
}

static GstLidarEncodeResult gst_lidar_enc_encode(GstLidarEncoder* base,
                                                 const GstLidarEncodeSettings* settings,
                                                 GByteArray* bytes, GstLidarCodedSlice* coded) {
  Coder& coder = *GST_LIDAR_ENC(base)->coder;
  coder.encoder->set_threads(settings->threads);
  const auto result = coder.encoder->Encode(
      {settings->max_error, settings->step, settings->intensity_bits}, &coder.slice);
  if (result == SliceResult::kEmpty) return GST_LIDAR_ENCODE_EMPTY;
  if (result == SliceResult::kOutOfReach) return GST_LIDAR_ENCODE_OUT_OF_REACH;
  const lidar::codec::EncodedSlice& slice = coder.slice;
  g_byte_array_append(bytes, slice.bytes.data(), static_cast<guint>(slice.bytes.size()));
  *coded = {static_cast<guint>(slice.returns), slice.step_m, slice.error_m};
  return GST_LIDAR_ENCODE_OK;
}

static gboolean gst_lidar_enc_decode(GstLidarEncoder* base, const guint8* data, gsize size,
                                     GArray* points, GstLidarPointOrder* order) {
  Coder& coder = *GST_LIDAR_ENC(base)->coder;
  if (!coder.decoder) {
    auto format = coder.format;
    format.layout = {*lidar::PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:U32:12"),
                     sizeof(GstLidarPoint)};
    coder.decoder.emplace(format, format.height * format.sensor_model->columns_per_scan);
  }
  const auto shape = coder.decoder->Decode({data, size});
  if (!shape) return FALSE;
  g_array_set_size(points, shape->width * shape->height);
  coder.decoder->Write(reinterpret_cast<guint8*>(points->data));
  *order = GST_LIDAR_ORDER_PIXELS;
  return TRUE;
}

static void gst_lidar_enc_reset(GstLidarEncoder* base) { *GST_LIDAR_ENC(base)->coder = {}; }

static void gst_lidar_enc_finalize(GObject* object) {
  delete GST_LIDAR_ENC(object)->coder;
  G_OBJECT_CLASS(gst_lidar_enc_parent_class)->finalize(object);
}

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS,
    GST_STATIC_CAPS(GST_LIDAR_SLICE_MEDIA_TYPE
                    ", geometry = (string) range, alignment = (string) slice"));

static void gst_lidar_enc_init(GstLidarEnc* self) { self->coder = new Coder; }

static void gst_lidar_enc_class_init(GstLidarEncClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = gst_lidar_enc_finalize;
  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(
      element, "LiDAR encoder", "Codec/Encoder/PointCloud",
      "Compresses the scans of a spinning sensor to a bitrate and within an error", "gst-lidar");
  auto* encoder = GST_LIDAR_ENCODER_CLASS(klass);
  encoder->set_format = gst_lidar_enc_set_format;
  encoder->load = gst_lidar_enc_load;
  encoder->get_steps = gst_lidar_enc_get_steps;
  encoder->thin = gst_lidar_enc_thin;
  encoder->encode = gst_lidar_enc_encode;
  encoder->decode = gst_lidar_enc_decode;
  encoder->reset = gst_lidar_enc_reset;
}

// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-lidardec
 *
 * Decodes what lidarenc encodes. A slice that is damaged or hostile is dropped and counted.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! lidarenc ! lidardec ! fakesink
 * ]|
 */
#include "gst/lidarcodec/gstlidardec.h"

#include <optional>

#include "gst/common/cloud_info.h"
#include "src/codec/slice_decoder.h"

namespace {

/// Belongs to the streaming thread.
struct Coder {
  lidar::codec::CloudFormat format;
  std::optional<lidar::codec::SliceDecoder> decoder;
};

}  // namespace

struct _GstLidarDec {
  GstLidarDecoder parent;
  Coder* coder;
};

G_DEFINE_TYPE(GstLidarDec, gst_lidar_dec, GST_TYPE_LIDAR_DECODER)
GST_ELEMENT_REGISTER_DEFINE(lidardec, "lidardec", GST_RANK_PRIMARY, GST_TYPE_LIDAR_DEC)

static gboolean gst_lidar_dec_set_format(GstLidarDecoder* base, GstCaps*,
                                         const GstLidarCloudFormat* cloud,
                                         GstLidarDecodedFormat* decoded) {
  Coder& coder = *GST_LIDAR_DEC(base)->coder;
  const auto info = lidar::gst::CloudInfo::FromFormat(*cloud);
  coder = {};
  coder.format = {{info.fields, info.point_step}, info.height, info.sensor_model};
  decoded->refusal = "they lack a sensor-model";
  decoded->is_organised = TRUE;
  return info.sensor_model.has_value();
}

static gboolean gst_lidar_dec_decode(GstLidarDecoder* base, const guint8* data, gsize size,
                                     guint max_points, GstLidarDecodedSlice* slice) {
  Coder& coder = *GST_LIDAR_DEC(base)->coder;
  if (!coder.decoder) coder.decoder.emplace(coder.format, max_points);
  const auto shape = coder.decoder->Decode({data, size});
  if (!shape) return FALSE;
  const auto& quality = coder.decoder->quality();
  *slice = {shape->width,    shape->height,          quality.step_m,
            quality.error_m, quality.intensity_bits, quality.keep_fraction};
  return TRUE;
}

static void gst_lidar_dec_write(GstLidarDecoder* base, guint8* points) {
  GST_LIDAR_DEC(base)->coder->decoder->Write(points);
}

static void gst_lidar_dec_reset(GstLidarDecoder* base) { *GST_LIDAR_DEC(base)->coder = {}; }

static GstStateChangeReturn gst_lidar_dec_change_state(GstElement* element,
                                                       GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) lidar::codec::PrepareMixing();
  return GST_ELEMENT_CLASS(gst_lidar_dec_parent_class)->change_state(element, transition);
}

static void gst_lidar_dec_finalize(GObject* object) {
  delete GST_LIDAR_DEC(object)->coder;
  G_OBJECT_CLASS(gst_lidar_dec_parent_class)->finalize(object);
}

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_SLICE_MEDIA_TYPE));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));

static void gst_lidar_dec_init(GstLidarDec* self) { self->coder = new Coder; }

static void gst_lidar_dec_class_init(GstLidarDecClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = gst_lidar_dec_finalize;
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = gst_lidar_dec_change_state;
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(
      element, "LiDAR decoder", "Codec/Decoder/PointCloud",
      "Decompresses the scans of a spinning sensor, safe on hostile input", "gst-lidar");
  auto* decoder = GST_LIDAR_DECODER_CLASS(klass);
  decoder->set_format = gst_lidar_dec_set_format;
  decoder->decode = gst_lidar_dec_decode;
  decoder->write = gst_lidar_dec_write;
  decoder->reset = gst_lidar_dec_reset;
}

// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-dracodec
 *
 * Decodes what dracoenc encodes, and plain Draco files of point clouds. A slice that is damaged or
 * hostile is dropped and counted.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! dracoenc ! dracodec ! fakesink
 * ]|
 */
#include <optional>

#include "ext/draco/slice_coder.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidardecoder.h"

namespace {

using lidar::Geometry;

/// The state of a decoder. It is used by the streaming thread only.
struct State {
  lidar::codec::CloudFormat format;
  Geometry geometry = Geometry::kXyz;
  std::optional<lidar::draco::SliceDecoder> decoder;
};

/// Returns the geometry that the caps name, or nothing if it is unknown. Caps without geometry are
/// xyz, because caps of a plain Draco file need only a media type.
std::optional<Geometry> GeometryOf(const GstCaps* caps) {
  const gchar* name = gst_structure_get_string(gst_caps_get_structure(caps, 0), "geometry");
  if (g_strcmp0(name, "range") == 0) return Geometry::kRange;
  if (name == nullptr || g_strcmp0(name, "xyz") == 0) return Geometry::kXyz;
  return std::nullopt;
}

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarDracoDec, gst_lidar_draco_dec, GST, LIDAR_DRACO_DEC, GstLidarDecoder)
struct _GstLidarDracoDec {
  GstLidarDecoder parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarDracoDec, gst_lidar_draco_dec, GST_TYPE_LIDAR_DECODER)
GST_ELEMENT_REGISTER_DEFINE(dracodec, "dracodec", GST_RANK_PRIMARY, gst_lidar_draco_dec_get_type())

static gboolean SetFormat(GstLidarDecoder* base, GstCaps* caps, const GstLidarCloudFormat* cloud,
                          GstLidarDecodedFormat* decoded) {
  State& coder = *GST_LIDAR_DRACO_DEC(base)->state;
  const auto info = lidar::gst::CloudInfo::FromFormat(*cloud);
  const auto geometry = GeometryOf(caps);
  coder = {};
  coder.format = {{info.fields, info.point_step}, info.height, info.sensor_model};
  decoded->refusal = "geometry must be xyz or range, and geometry=range needs a sensor-model";
  if (!geometry || (geometry == Geometry::kRange && !info.sensor_model)) return FALSE;
  coder.geometry = *geometry;
  decoded->is_organised = geometry == Geometry::kRange;
  return TRUE;
}

static gboolean Decode(GstLidarDecoder* base, const guint8* data, gsize size, guint max_points,
                       GstLidarDecodedSlice* slice) {
  State& coder = *GST_LIDAR_DRACO_DEC(base)->state;
  if (!coder.decoder) coder.decoder.emplace(coder.format, coder.geometry, max_points);
  const auto shape = coder.decoder->Decode({data, size});
  if (!shape) return FALSE;
  const auto quality = coder.decoder->quality();
  *slice = {shape->width,           shape->height,         quality.step_m, quality.error_m,
            quality.intensity_bits, quality.keep_fraction, FALSE};
  return TRUE;
}

static void Write(GstLidarDecoder* base, guint8* points) {
  GST_LIDAR_DRACO_DEC(base)->state->decoder->Write(points);
}

static void Reset(GstLidarDecoder* base) { *GST_LIDAR_DRACO_DEC(base)->state = {}; }

static void gst_lidar_draco_dec_init(GstLidarDracoDec* self) { self->state = new State; }

static void gst_lidar_draco_dec_class_init(GstLidarDracoDecClass* klass) {
  lidar::gst::OwnState<GstLidarDracoDec, gst_lidar_draco_dec_parent_class>(G_OBJECT_CLASS(klass));
  lidar::gst::Describe(klass,
                       {"Draco decoder", "Codec/Decoder/PointCloud",
                        "Decompresses point clouds, safe on hostile input"},
                       {{"sink", GST_PAD_SINK, GST_LIDAR_DRACO_MEDIA_TYPE},
                        {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE}});
  auto* decoder = GST_LIDAR_DECODER_CLASS(klass);
  decoder->set_format = SetFormat;
  decoder->decode = Decode;
  decoder->write = Write;
  decoder->reset = Reset;
}

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
#include <optional>

#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidardecoder.h"
#include "src/codec/cloud/exact_decoder.h"
#include "src/codec/slice_decoder.h"

namespace {

/// The state of a decoder. It is used by the streaming thread only.
struct State {
  lidar::codec::CloudFormat format;
  bool has_points = false;                                 // true for points, false for ranges
  std::optional<lidar::codec::SliceDecoder> decoder;       // only for ranges
  std::optional<lidar::codec::cloud::ExactDecoder> cloud;  // only for points
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarDec, gst_lidar_dec, GST, LIDAR_DEC, GstLidarDecoder)
struct _GstLidarDec {
  GstLidarDecoder parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarDec, gst_lidar_dec, GST_TYPE_LIDAR_DECODER)
GST_ELEMENT_REGISTER_DEFINE(lidardec, "lidardec", GST_RANK_PRIMARY, gst_lidar_dec_get_type())

static gboolean SetFormat(GstLidarDecoder* base, GstCaps* caps, const GstLidarCloudFormat* cloud,
                          GstLidarDecodedFormat* decoded) {
  State& coder = *GST_LIDAR_DEC(base)->state;
  const auto info = lidar::gst::CloudInfo::FromFormat(*cloud);
  coder = {};
  coder.format = {{info.fields, info.point_step}, info.height, info.sensor_model};
  const gchar* geometry = gst_structure_get_string(gst_caps_get_structure(caps, 0), "geometry");
  coder.has_points = g_strcmp0(geometry, "xyz") == 0;
  decoded->refusal = "geometry=range needs a sensor-model";
  decoded->is_organised = !coder.has_points;
  return coder.has_points || info.sensor_model.has_value();
}

static gboolean DecodePoints(State* state, lidar::ByteView stream, guint max_points,
                             GstLidarDecodedSlice* slice) {
  if (!state->cloud)
    state->cloud.emplace(lidar::codec::ExactFields(state->format.layout.fields), max_points);
  if (!state->cloud->Decode(stream)) return FALSE;
  const auto& geometry = state->cloud->geometry();
  slice->width = static_cast<guint>(state->cloud->size());
  slice->height = 1;
  slice->step = geometry.step_m();
  slice->error_bound = geometry.error_m();
  slice->intensity_bits = geometry.intensity_bits();
  return TRUE;
}

static gboolean Decode(GstLidarDecoder* base, const guint8* data, gsize size, guint max_points,
                       GstLidarDecodedSlice* slice) {
  State& coder = *GST_LIDAR_DEC(base)->state;
  if (coder.has_points) return DecodePoints(&coder, {data, size}, max_points, slice);
  if (!coder.decoder) coder.decoder.emplace(coder.format, max_points);
  const auto shape = coder.decoder->Decode({data, size});
  slice->lacks_reference = !shape && coder.decoder->lacks_reference();
  if (!shape) return FALSE;
  const auto& quality = coder.decoder->quality();
  *slice = {shape->width,           shape->height,         quality.step_m, quality.error_m,
            quality.intensity_bits, quality.keep_fraction, FALSE};
  return TRUE;
}

static void Write(GstLidarDecoder* base, guint8* points) {
  const State& coder = *GST_LIDAR_DEC(base)->state;
  if (coder.decoder) return coder.decoder->Write(points);
  coder.cloud->Write(coder.format.layout, points);
}

static void Reset(GstLidarDecoder* base) { *GST_LIDAR_DEC(base)->state = {}; }

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) lidar::codec::PrepareMixing();
  return GST_ELEMENT_CLASS(gst_lidar_dec_parent_class)->change_state(element, transition);
}

static void gst_lidar_dec_init(GstLidarDec* self) { self->state = new State; }

static void gst_lidar_dec_class_init(GstLidarDecClass* klass) {
  lidar::gst::OwnState<GstLidarDec, gst_lidar_dec_parent_class>(G_OBJECT_CLASS(klass));
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
  lidar::gst::Describe(klass,
                       {"LiDAR decoder", "Codec/Decoder/PointCloud",
                        "Decompresses what lidarenc makes, safe on hostile input"},
                       {{"sink", GST_PAD_SINK, GST_LIDAR_SLICE_MEDIA_TYPE},
                        {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE}});
  auto* decoder = GST_LIDAR_DECODER_CLASS(klass);
  decoder->set_format = SetFormat;
  decoder->decode = Decode;
  decoder->write = Write;
  decoder->reset = Reset;
}

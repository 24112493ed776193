// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-dracoenc
 *
 * Encodes point clouds of any kind slice by slice with Draco, to a bitrate and within an error.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! dracoenc max-error=0.02 ! dracodec ! fakesink
 * ]|
 */
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ext/draco/draco_check.h"
#include "ext/draco/slice_coder.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/properties.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidarencoder.h"
#include "src/cloud/coded_geometry.h"
#include "src/codec/range_header.h"
#include "src/rate/error_bound.h"

namespace {

using namespace lidar::gst;
using lidar::Geometry;
using lidar::codec::RangeCoder;
using lidar::codec::SliceResult;

enum class GeometryChoice : gint { kAuto, kXyz, kRange };

struct DracoSettings {
  GeometryChoice geometry = GeometryChoice::kAuto;
  RangeCoder range_coder = RangeCoder::kResidual;
  guint level = 7;

  /// Returns nothing for kAuto, which chooses ranges if the cloud has ranges.
  std::optional<Geometry> wanted_geometry() const {
    if (geometry == GeometryChoice::kAuto) return std::nullopt;
    return geometry == GeometryChoice::kRange ? Geometry::kRange : Geometry::kXyz;
  }
};

const GEnumValue kGeometries[] = {
    {Int(GeometryChoice::kAuto), "range where the caps carry ranges and a sensor model", "auto"},
    {Int(GeometryChoice::kXyz), "Plain Draco files", "xyz"},
    {Int(GeometryChoice::kRange), "Ranges of an organised scan", "range"},
    {0, nullptr, nullptr}};
const GEnumValue kCoders[] = {
    {Int(RangeCoder::kDraco), "Draco, with its own delta prediction", "draco"},
    {Int(RangeCoder::kResidual), "Prediction from neighbouring beams, then Draco", "residual"},
    {0, nullptr, nullptr}};

GType GeometryType() {
  static const GType type = RegisterEnum("GstLidarDracoEncGeometry", kGeometries);
  return type;
}

GType RangeCoderType() {
  static const GType type = RegisterEnum("GstLidarDracoEncRangeCoder", kCoders);
  return type;
}

/// The coders of a stream. They are used by the streaming thread only.
struct Coder {
  lidar::codec::CloudFormat format;
  std::optional<lidar::draco::SliceEncoder> encoder;
  std::optional<lidar::draco::SliceDecoder> decoder;  // only for error-check
  guint max_points = 0;                               // limit of `decoder`
  bool with_intensity = false;
  std::string mode;
  lidar::codec::EncodedSlice slice;
};

struct State {
  std::mutex mutex;  // guards settings
  DracoSettings settings;
  Coder coder;
};

const std::array<Property<DracoSettings>, 3> kProperties = {{
    {"geometry", "What to code: ranges or coordinates",
     EnumField<DracoSettings, GeometryChoice>{&DracoSettings::geometry, GeometryType}},
    {"range-coder", "How ranges are coded",
     EnumField<DracoSettings, RangeCoder>{&DracoSettings::range_coder, RangeCoderType}},
    {"compression-level",
     "Draco's compression level for xyz geometry: 0 is its sequential coder, 1-10 its kd-tree",
     &DracoSettings::level, 0, 10, GST_PARAM_MUTABLE_PLAYING},
}};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarDracoEnc, gst_lidar_draco_enc, GST, LIDAR_DRACO_ENC, GstLidarEncoder)
struct _GstLidarDracoEnc {
  GstLidarEncoder parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarDracoEnc, gst_lidar_draco_enc, GST_TYPE_LIDAR_ENCODER)
GST_ELEMENT_REGISTER_DEFINE(dracoenc, "dracoenc", GST_RANK_NONE, gst_lidar_draco_enc_get_type())

static Coder& CoderOf(GstLidarEncoder* base) { return GST_LIDAR_DRACO_ENC(base)->state->coder; }

static gboolean SetFormat(GstLidarEncoder* base, const GstLidarCloudFormat* cloud,
                          gboolean with_intensity, GstLidarCodedFormat* coded) {
  Coder& coder = CoderOf(base);
  const DracoSettings settings = Snapshot(*GST_LIDAR_DRACO_ENC(base)->state);
  const auto info = CloudInfo::FromFormat(*cloud);
  const auto before = std::exchange(coder, {}).encoder;
  coder.format = {{info.fields, info.point_step}, info.height, info.sensor_model};
  coder.with_intensity = with_intensity != FALSE;
  coded->refusal =
      "geometry=range needs a field range:U32 and a sensor-model with as many beams and at least "
      "as many columns; geometry=xyz needs the fields x, y and z as F32 side by side; "
      "geometry=auto chooses";
  std::optional<Geometry> geometry = settings.wanted_geometry();
  if (info.sensor_model && info.width > info.sensor_model->columns_per_scan) {
    if (geometry == Geometry::kRange) return FALSE;
    geometry = Geometry::kXyz;
  }
  coder.encoder = lidar::draco::SliceEncoder::Create(coder.format, geometry, settings.range_coder);
  if (!coder.encoder) return FALSE;
  if (before) coder.encoder->Continue(*before);  // the width may change with each cloud
  const bool range = coder.encoder->geometry() == Geometry::kRange;
  const auto kept = lidar::codec::KeptFields(info.fields, coder.with_intensity, range);
  coded->caps =
      gst_lidar_coded_caps_new(GST_LIDAR_DRACO_MEDIA_TYPE, kept.ToString().c_str(), cloud);
  gst_caps_set_simple(coded->caps, "geometry", G_TYPE_STRING, range ? "range" : "xyz", nullptr);
  coded->codes_ranges = range;
  return TRUE;
}

static void Load(GstLidarEncoder* base, const GstLidarRawSlice* raw, GstLidarLoadedSlice* loaded) {
  Coder& coder = CoderOf(base);
  loaded->level = Snapshot(*GST_LIDAR_DRACO_ENC(base)->state).level;
  coder.encoder->Load({raw->data, raw->size}, raw->first_column, coder.with_intensity);
  coder.mode = coder.encoder->Mode(loaded->level);
  coder.max_points = static_cast<guint>(raw->size / coder.format.layout.point_step);
  loaded->returns = static_cast<guint>(coder.encoder->returns());
  loaded->extent = coder.encoder->extent_m();
  loaded->rows = static_cast<guint>(coder.encoder->rows());
  loaded->has_intensity = coder.encoder->has_intensity();
  loaded->mode = coder.mode.c_str();
}

static void GetSteps(GstLidarEncoder* base, gdouble max_error, GstLidarStepRange* steps) {
  const auto& encoder = *CoderOf(base).encoder;
  const auto bound = encoder.geometry() == Geometry::kRange
                         ? lidar::rate::ErrorBound::Range(encoder.range_unit_mm())
                         : lidar::rate::ErrorBound::Xyz();
  *steps = {bound.FinestStep(), bound.CoarsestStep(max_error), bound.step_unit()};
}

static void Thin(GstLidarEncoder* base, const guint8* kept, guint rows) {
  CoderOf(base).encoder->Thin(std::vector<bool>(kept, kept + rows));
}

static GstLidarEncodeResult Encode(GstLidarEncoder* base, const GstLidarEncodeSettings* settings,
                                   GByteArray* bytes, GstLidarCodedSlice* coded) {
  Coder& coder = CoderOf(base);
  coder.encoder->set_threads(settings->threads);
  const auto result = coder.encoder->Encode(
      {{settings->max_error, settings->step, settings->intensity_bits}, settings->level},
      &coder.slice);
  if (result == SliceResult::kEmpty) return GST_LIDAR_ENCODE_EMPTY;
  if (result == SliceResult::kOutOfReach) return GST_LIDAR_ENCODE_OUT_OF_REACH;
  const lidar::codec::EncodedSlice& slice = coder.slice;
  g_byte_array_append(bytes, slice.bytes.data(), static_cast<guint>(slice.bytes.size()));
  *coded = {static_cast<guint>(slice.returns), slice.step_m, slice.error_m};
  return GST_LIDAR_ENCODE_OK;
}

static gboolean Decode(GstLidarEncoder* base, const guint8* data, gsize size, GArray* points,
                       GstLidarPointOrder* order) {
  Coder& coder = CoderOf(base);
  auto format = coder.format;
  format.layout = {*lidar::PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:U32:12"),
                   sizeof(GstLidarPoint)};
  coder.decoder.emplace(format, coder.encoder->geometry(), coder.max_points);
  const auto shape = coder.decoder->Decode({data, size});
  if (!shape) return FALSE;
  g_array_set_size(points, shape->width * shape->height);
  coder.decoder->Write(reinterpret_cast<guint8*>(points->data));
  *order = GST_LIDAR_ORDER_PIXELS;
  if (coder.encoder->geometry() == Geometry::kRange) return TRUE;
  const auto summary = lidar::draco::CheckDraco({data, size}, {coder.max_points});
  *order = summary && !summary->is_kd_tree ? GST_LIDAR_ORDER_KEPT : GST_LIDAR_ORDER_ANY;
  return TRUE;
}

static void Reset(GstLidarEncoder* base) { CoderOf(base) = {}; }

static void gst_lidar_draco_enc_init(GstLidarDracoEnc* self) { self->state = new State; }

static void gst_lidar_draco_enc_class_init(GstLidarDracoEncClass* klass) {
  ServeState<GstLidarDracoEnc, gst_lidar_draco_enc_parent_class, kProperties>(klass);
  Describe(klass,
           {"Draco encoder", "Codec/Encoder/PointCloud",
            "Compresses point clouds to a bitrate and within an error"},
           {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"src", GST_PAD_SRC,
             GST_LIDAR_DRACO_MEDIA_TYPE
             ", geometry = (string) { xyz, range }, alignment = (string) slice"}});
  auto* encoder = GST_LIDAR_ENCODER_CLASS(klass);
  encoder->set_format = SetFormat;
  encoder->load = Load;
  encoder->get_steps = GetSteps;
  encoder->thin = Thin;
  encoder->encode = Encode;
  encoder->decode = Decode;
  encoder->reset = Reset;
}

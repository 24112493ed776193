// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-lidarenc
 *
 * Encodes the scans of a spinning sensor slice by slice, to a bitrate and within an error: ranges,
 * predicted from neighbouring beams and coded as small as the machine has time for
 * (docs/wire-format.md).
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! lidarenc max-error=0.02 ! lidardec ! fakesink
 * ]|
 */
#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gst/common/cloud_info.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/gstlidarencoder.h"
#include "gst/common/properties.h"
#include "src/base/time.h"
#include "src/codec/effort_control.h"
#include "src/codec/slice_decoder.h"
#include "src/codec/slice_encoder.h"
#include "src/rate/error_bound.h"

namespace {

using namespace lidar::gst;
using lidar::codec::SliceResult;

enum class Reference : gint { kNothing, kAcknowledged };

struct LidarEncSettings {
  static constexpr gint kAutoEffort = -1;

  gint effort = kAutoEffort;
  Reference reference = Reference::kAcknowledged;
  lidar::Duration key_interval = std::chrono::seconds(10);
};

GType EffortType() {
  static const GEnumValue values[] = {
      {LidarEncSettings::kAutoEffort, "The highest that codes a slice in a quarter of its sweep",
       "auto"},
      {0, "Fastest: adaptive rANS", "0"},
      {1, "Mixed contexts, few", "1"},
      {2, "Mixed contexts, more", "2"},
      {3, "Smallest: mixed contexts, all", "3"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarEncEffort", values);
  return type;
}

GType ReferenceType() {
  static const GEnumValue values[] = {
      {Int(Reference::kNothing), "Every slice stands alone", "none"},
      {Int(Reference::kAcknowledged),
       "The newest scan that the receiver has, where the sensor stands still", "auto"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarEncReference", values);
  return type;
}

const std::array<Property<LidarEncSettings>, 3> kProperties = {{
    {"effort", "How much computing slices are worth",
     EnumField<LidarEncSettings>{&LidarEncSettings::effort, EffortType}, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"reference",
     "What slices may be predicted from; what nobody acknowledges is predicted from nothing",
     EnumField<LidarEncSettings, Reference>{&LidarEncSettings::reference, ReferenceType}, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"key-interval",
     "Each sector comes at least so often as a slice that stands alone, for those who join late; "
     "0: only when asked for [ns]",
     &LidarEncSettings::key_interval, 0, 3600e9, GST_PARAM_MUTABLE_PLAYING},
}};

/// Belongs to the streaming thread.
struct Coder {
  lidar::codec::CloudFormat format;
  double scans_per_second = 10;
  std::optional<lidar::codec::SliceEncoder> encoder;
  std::optional<lidar::codec::SliceDecoder> decoder;  // for error-check
  bool with_intensity = false;
  std::string mode;
  lidar::codec::EncodedSlice slice;
  lidar::codec::ReferenceKeeper keeper;

  lidar::codec::EffortControl effort;
  bool automatic = false;   // the loaded slice is coded at that effort
  lidar::Duration sweep{};  // of the loaded slice
  lidar::Duration spent{};  // on it, with all tries
};

struct State {
  std::mutex mutex;  // guards settings
  LidarEncSettings settings;
  Coder coder;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarEnc, gst_lidar_enc, GST, LIDAR_ENC, GstLidarEncoder)
struct _GstLidarEnc {
  GstLidarEncoder parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarEnc, gst_lidar_enc, GST_TYPE_LIDAR_ENCODER)
GST_ELEMENT_REGISTER_DEFINE(lidarenc, "lidarenc", GST_RANK_NONE, gst_lidar_enc_get_type())

static Coder& CoderOf(GstLidarEncoder* base) { return GST_LIDAR_ENC(base)->state->coder; }

static lidar::Time Now() { return lidar::Time{std::chrono::microseconds(g_get_monotonic_time())}; }

/// What the last slice left is known from now on; which of several encodings was sent is known only
/// when the next slice comes.
static void KeepBlocks(Coder& coder) {
  coder.keeper.OnEncoded(std::move(coder.slice.blocks));
  coder.slice.blocks.clear();
}

/// Lets what is loaded refer to what the receiver has.
static void Link(GstLidarEncoder* base, const GstLidarRawSlice& raw) {
  Coder& coder = CoderOf(base);
  const LidarEncSettings settings = Snapshot(*GST_LIDAR_ENC(base)->state);
  coder.keeper.set_key_interval(settings.key_interval);
  const bool remembers = settings.reference == Reference::kAcknowledged &&
                         coder.keeper.Begin(Now(), {raw.scan_id, raw.slice_index, raw.slice_count});
  coder.encoder->LinkBy(remembers ? &coder.keeper : nullptr);
}

/// How long the sensor took for `columns`.
static lidar::Duration SweepOf(const Coder& coder, guint columns) {
  return lidar::FromSeconds(columns /
                            (coder.scans_per_second * coder.format.sensor_model->columns_per_scan));
}

/// Learns from the slice before, and chooses for the next one.
static void ChooseEffort(GstLidarEncoder* base, guint columns) {
  Coder& coder = CoderOf(base);
  if (coder.automatic && coder.spent > lidar::Duration{0})
    coder.effort.OnSlice(coder.sweep, coder.encoder->returns(), coder.spent);
  coder.sweep = SweepOf(coder, columns);
  coder.spent = {};
  const gint wanted = Snapshot(*GST_LIDAR_ENC(base)->state).effort;
  coder.automatic = wanted == LidarEncSettings::kAutoEffort;
  coder.encoder->set_effort(coder.automatic ? coder.effort.effort() : static_cast<guint>(wanted));
}

static gboolean SetFormat(GstLidarEncoder* base, const GstLidarCloudFormat* cloud,
                          gboolean with_intensity, GstLidarCodedFormat* coded) {
  Coder& coder = CoderOf(base);
  const auto info = CloudInfo::FromFormat(*cloud);
  const auto effort = coder.effort;
  coder = {};
  coder.effort = effort;
  if (info.framerate_n > 0)
    coder.scans_per_second = static_cast<double>(info.framerate_n) / info.framerate_d;
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

static void Load(GstLidarEncoder* base, const GstLidarRawSlice* raw, GstLidarLoadedSlice* loaded) {
  Coder& coder = CoderOf(base);
  KeepBlocks(coder);
  ChooseEffort(base, raw->width);
  coder.encoder->Load({raw->data, raw->size}, raw->first_column, coder.with_intensity);
  Link(base, *raw);
  coder.mode = coder.encoder->Mode();
  loaded->returns = static_cast<guint>(coder.encoder->returns());
  loaded->extent = coder.encoder->extent_m();
  loaded->rows = static_cast<guint>(coder.encoder->rows());
  loaded->has_intensity = coder.encoder->has_intensity();
  loaded->mode = coder.mode.c_str();
}

static void GetSteps(GstLidarEncoder* base, gdouble max_error, GstLidarStepRange* steps) {
  const auto bound = lidar::rate::ErrorBound::Range(CoderOf(base).encoder->range_unit_mm());
  *steps = {bound.FinestStep(), bound.CoarsestStep(max_error), bound.step_unit()};
}

static void Thin(GstLidarEncoder* base, const guint8* kept, guint rows) {
  CoderOf(base).encoder->Thin(std::vector<bool>(kept, kept + rows));
}

static GstLidarEncodeResult Encode(GstLidarEncoder* base, const GstLidarEncodeSettings* settings,
                                   GByteArray* bytes, GstLidarCodedSlice* coded) {
  Coder& coder = CoderOf(base);
  coder.encoder->set_threads(settings->threads);
  const gint64 start_us = g_get_monotonic_time();
  const auto result = coder.encoder->Encode(
      {settings->max_error, settings->step, settings->intensity_bits}, &coder.slice);
  coder.spent += std::chrono::microseconds(g_get_monotonic_time() - start_us + 1);
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
  if (!coder.decoder) {
    auto format = coder.format;
    format.layout = {*lidar::PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,range:U32:12"),
                     sizeof(GstLidarPoint)};
    coder.decoder.emplace(format, format.height * format.sensor_model->columns_per_scan);
  }
  for (const auto& block : coder.keeper.references()) coder.decoder->Know(block);
  const auto shape = coder.decoder->Decode({data, size});
  if (!shape) return FALSE;
  g_array_set_size(points, shape->width * shape->height);
  coder.decoder->Write(reinterpret_cast<guint8*>(points->data));
  *order = GST_LIDAR_ORDER_PIXELS;
  return TRUE;
}

static void Reset(GstLidarEncoder* base) { CoderOf(base) = {}; }

static void Acknowledge(GstLidarEncoder* base, guint receiver, guint scan_id, guint slice_index) {
  Coder& coder = CoderOf(base);
  KeepBlocks(coder);
  coder.keeper.OnAcknowledged(Now(), receiver, scan_id, slice_index);
}

static void RequestKey(GstLidarEncoder* base) {
  Coder& coder = CoderOf(base);
  KeepBlocks(coder);
  coder.keeper.OnKeyRequest();
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) lidar::codec::PrepareMixing();
  return GST_ELEMENT_CLASS(gst_lidar_enc_parent_class)->change_state(element, transition);
}

static void gst_lidar_enc_init(GstLidarEnc* self) { self->state = new State; }

static void gst_lidar_enc_class_init(GstLidarEncClass* klass) {
  ServeState<GstLidarEnc, gst_lidar_enc_parent_class, kProperties>(klass);
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
  Describe(
      klass,
      {"LiDAR encoder", "Codec/Encoder/PointCloud",
       "Compresses the scans of a spinning sensor to a bitrate and within an error"},
      {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
       {"src", GST_PAD_SRC,
        GST_LIDAR_SLICE_MEDIA_TYPE ", geometry = (string) range, alignment = (string) slice"}});
  auto* encoder = GST_LIDAR_ENCODER_CLASS(klass);
  encoder->set_format = SetFormat;
  encoder->load = Load;
  encoder->get_steps = GetSteps;
  encoder->thin = Thin;
  encoder->encode = Encode;
  encoder->decode = Decode;
  encoder->reset = Reset;
  encoder->acknowledge = Acknowledge;
  encoder->request_key = RequestKey;
}

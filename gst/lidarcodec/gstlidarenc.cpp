// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-lidarenc
 *
 * Encodes clouds slice by slice, to a bitrate and within an error, as small as the machine has time
 * for. Organised scans with a sensor model are coded as ranges, predicted from neighbouring beams
 * (docs/wire-format.md), other clouds as beams and cells (docs/cloud-coder.md), in an order of
 * their own unless `keep-order` is set.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! lidarenc max-error=0.02 ! lidardec ! fakesink
 * ]|
 */
#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/properties.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidarencoder.h"
#include "gst/lidarcodec/lidarenc_coder.h"
#include "src/base/time.h"
#include "src/rate/error_bound.h"

namespace {

using namespace lidar::gst;

enum class GeometryChoice : gint { kAuto, kXyz };
enum class Reference : gint { kNothing, kAcknowledged };

struct LidarEncSettings {
  static constexpr gint kAutoEffort = -1;

  GeometryChoice geometry = GeometryChoice::kAuto;
  gint effort = kAutoEffort;
  Reference reference = Reference::kAcknowledged;
  lidar::Duration key_interval = std::chrono::seconds(10);
  std::string fields;
  bool keeps_order = false;
};

GType GeometryType() {
  static const GEnumValue values[] = {
      {Int(GeometryChoice::kAuto), "range where the caps carry ranges and a sensor model", "auto"},
      {Int(GeometryChoice::kXyz), "Points in any order", "xyz"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarEncGeometry", values);
  return type;
}

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

const std::array<Property<LidarEncSettings>, 6> kProperties = {{
    {"geometry", "What to code: ranges or coordinates",
     EnumField<LidarEncSettings, GeometryChoice>{&LidarEncSettings::geometry, GeometryType}},
    {"effort", "Processor time to spend on a slice, for fewer bits",
     EnumField<LidarEncSettings>{&LidarEncSettings::effort, EffortType}, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"reference",
     "What slices may be predicted from; without acknowledgements no slice is predicted from "
     "another scan",
     EnumField<LidarEncSettings, Reference>{&LidarEncSettings::reference, ReferenceType}, 0, 0,
     GST_PARAM_MUTABLE_PLAYING},
    {"key-interval",
     "Longest time between slices of a sector that a late receiver can decode alone; 0: only on "
     "request [ns]",
     &LidarEncSettings::key_interval, 0, 3600e9, GST_PARAM_MUTABLE_PLAYING},
    {"fields", "Further fields of points to code without loss, comma-separated: ring,time",
     &LidarEncSettings::fields},
    {"keep-order", "Keep the order of the points", &LidarEncSettings::keeps_order},
}};

struct State {
  std::mutex mutex;  // guards settings
  LidarEncSettings settings;

  // The members below are used by the streaming thread only.
  LidarEncCoder coder;
  bool warned_of_fields = false;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarEnc, gst_lidar_enc, GST, LIDAR_ENC, GstLidarEncoder)
struct _GstLidarEnc {
  GstLidarEncoder parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarEnc, gst_lidar_enc, GST_TYPE_LIDAR_ENCODER)
GST_ELEMENT_REGISTER_DEFINE(lidarenc, "lidarenc", GST_RANK_NONE, gst_lidar_enc_get_type())

static LidarEncCoder& CoderOf(GstLidarEncoder* base) { return GST_LIDAR_ENC(base)->state->coder; }

/// Returns what must be coded without loss: the order of the points, and the fields that the
/// settings name. Appends to `missing` the names of fields that `fields` does not have.
static lidar::codec::cloud::ExactChoice ExactChoiceOf(const LidarEncSettings& settings,
                                                      const lidar::PointFields& fields,
                                                      std::string* missing) {
  lidar::PointFields known = lidar::codec::KeptFields(fields, true, false);
  lidar::codec::cloud::ExactChoice choice;
  choice.keeps_order = settings.keeps_order;
  std::istringstream names(settings.fields);
  for (std::string name; std::getline(names >> std::ws, name, ',');) {
    name.erase(name.find_last_not_of(' ') + 1);
    const lidar::PointField* field = fields.Find(name);
    if (field == nullptr) *missing += (missing->empty() ? "" : ", ") + name;
    if (field == nullptr || known.Find(name) != nullptr) continue;
    choice.fields.push_back(*field);
    known.Add(name, field->type);
  }
  return choice;
}

/// Posts a warning, but only once, if the properties fields or keep-order cannot be followed.
static void WarnOfFields(GstLidarEncoder* base, const LidarEncSettings& settings, bool ranges,
                         const std::string& missing, const lidar::PointFields& fields) {
  State& state = *GST_LIDAR_ENC(base)->state;
  const bool is_vain = ranges && (settings.keeps_order || !settings.fields.empty());
  if ((!is_vain && missing.empty()) || std::exchange(state.warned_of_fields, true)) return;
  if (is_vain)
    GST_ELEMENT_WARNING(base, STREAM, ENCODE,
                        ("This cloud is coded as ranges, so the properties fields and keep-order "
                         "have no effect. Set geometry=xyz."),
                        (nullptr));
  else
    GST_ELEMENT_WARNING(base, STREAM, ENCODE,
                        ("The property fields names %s, which this cloud lacks.", missing.c_str()),
                        ("the cloud has %s", fields.ToString().c_str()));
}

static gboolean SetFormat(GstLidarEncoder* base, const GstLidarCloudFormat* cloud,
                          gboolean with_intensity, GstLidarCodedFormat* coded) {
  coded->refusal =
      "lidarenc needs x, y and z as F32 side by side, or a field range:U32 and a sensor-model";
  const LidarEncSettings settings = Snapshot(*GST_LIDAR_ENC(base)->state);
  auto info = CloudInfo::FromFormat(*cloud);
  if (settings.geometry == GeometryChoice::kXyz) info.sensor_model.reset();
  std::string missing;
  const auto exact = ExactChoiceOf(settings, info.fields, &missing);
  if (!CoderOf(base).SetFormat(info, with_intensity != FALSE, exact)) return FALSE;
  const bool ranges = CoderOf(base).codes_ranges();
  WarnOfFields(base, settings, ranges, missing, info.fields);
  auto kept = lidar::codec::KeptFields(info.fields, with_intensity != FALSE, ranges);
  if (!ranges)
    for (const lidar::PointField& field : exact.fields) kept.Add(field.name, field.type);
  coded->caps =
      gst_lidar_coded_caps_new(GST_LIDAR_SLICE_MEDIA_TYPE, kept.ToString().c_str(), cloud);
  gst_caps_set_simple(coded->caps, "geometry", G_TYPE_STRING, ranges ? "range" : "xyz", nullptr);
  coded->codes_ranges = ranges;
  return TRUE;
}

static void Load(GstLidarEncoder* base, const GstLidarRawSlice* raw, GstLidarLoadedSlice* loaded) {
  const LidarEncSettings settings = Snapshot(*GST_LIDAR_ENC(base)->state);
  LidarEncCoder& coder = CoderOf(base);
  const bool automatic = settings.effort == LidarEncSettings::kAutoEffort;
  coder.Load(*raw, automatic ? std::nullopt : std::optional<unsigned>(settings.effort));
  coder.Link(*raw, settings.reference == Reference::kAcknowledged, settings.key_interval);
  coder.Describe(loaded);
}

static void GetSteps(GstLidarEncoder* base, gdouble max_error, GstLidarStepRange* steps) {
  const auto bound = CoderOf(base).Bound();
  *steps = {bound.FinestStep(), bound.CoarsestStep(max_error), bound.step_unit()};
}

static void Thin(GstLidarEncoder* base, const guint8* kept, guint rows) {
  CoderOf(base).Thin(std::vector<bool>(kept, kept + rows));
}

static GstLidarEncodeResult Encode(GstLidarEncoder* base, const GstLidarEncodeSettings* settings,
                                   GByteArray* bytes, GstLidarCodedSlice* coded) {
  return CoderOf(base).Encode(*settings, bytes, coded);
}

static gboolean Decode(GstLidarEncoder* base, const guint8* data, gsize size, GArray* points,
                       GstLidarPointOrder* order) {
  const LidarEncCoder& coder = CoderOf(base);
  *order = coder.codes_ranges()  ? GST_LIDAR_ORDER_PIXELS
           : coder.keeps_order() ? GST_LIDAR_ORDER_KEPT
                                 : GST_LIDAR_ORDER_ANY;
  return CoderOf(base).Decode({data, size}, points);
}

static void Reset(GstLidarEncoder* base) {
  CoderOf(base) = {};
  GST_LIDAR_ENC(base)->state->warned_of_fields = false;
}

static void Acknowledge(GstLidarEncoder* base, guint receiver, guint scan_id, guint slice_index) {
  CoderOf(base).OnAcknowledged(receiver, scan_id, slice_index);
}

static void RequestKey(GstLidarEncoder* base) { CoderOf(base).OnKeyRequest(); }

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_NULL_TO_READY) lidar::codec::PrepareMixing();
  return GST_ELEMENT_CLASS(gst_lidar_enc_parent_class)->change_state(element, transition);
}

static void gst_lidar_enc_init(GstLidarEnc* self) { self->state = new State; }

static void gst_lidar_enc_class_init(GstLidarEncClass* klass) {
  ServeState<GstLidarEnc, gst_lidar_enc_parent_class, kProperties>(klass);
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
  Describe(klass,
           {"LiDAR encoder", "Codec/Encoder/PointCloud",
            "Compresses the clouds of any LiDAR to a bitrate and within an error"},
           {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"src", GST_PAD_SRC,
             GST_LIDAR_SLICE_MEDIA_TYPE
             ", geometry = (string) { range, xyz }, alignment = (string) slice"}});
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

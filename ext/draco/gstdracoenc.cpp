// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-dracoenc
 *
 * Encodes point clouds slice by slice, to a bitrate and within an error.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! dracoenc max-error=0.02 ! dracodec ! fakesink
 * ]|
 */
#include "ext/draco/gstdracoenc.h"

#include <memory>
#include <mutex>
#include <optional>

#include "ext/draco/enc_coder.h"
#include "ext/draco/enc_error_report.h"
#include "ext/draco/enc_model.h"
#include "ext/draco/enc_range_check.h"
#include "ext/draco/enc_settings.h"
#include "ext/draco/enc_stats.h"
#include "ext/draco/encoded_caps.h"
#include "gst/common/buffer_map.h"
#include "gst/common/cloud_info.h"
#include "gst/common/refs.h"
#include "src/rate/rate_loop.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_draco_enc_debug);
#define GST_CAT_DEFAULT gst_lidar_draco_enc_debug

namespace {

using lidar::DataRate;
using lidar::Geometry;
using lidar::codec::RangeCoder;
using lidar::rate::CodingResult;
using Settings = lidar::gst::EncSettings;
using lidar::rate::DegradationPreference;

constexpr guint kPropMinBitrate = lidar::gst::kEncPropertyCount + 1;
constexpr guint kPropStats = kPropMinBitrate + 1;

/// Of the streaming thread.
struct Stream {
  lidar::gst::CloudInfo info;
  std::optional<lidar::draco::SliceEncoder> encoder;
  std::unique_ptr<lidar::rate::RateLoop> loop;
  lidar::codec::EncodedSlice slice;
  std::optional<lidar::gst::RangeCheck> range_check;
  std::optional<lidar::gst::ErrorReport> error_report;
  std::optional<guint> scan_id;  // of the last slice
  guint scans_without_meta = 0;
  bool discont = false;
  bool warned_of_reach = false;
  bool warned_of_ranges = false;
};

struct State {
  std::mutex mutex;  // guards settings to stats; never held while pushing, posting or notifying
  Settings settings;
  std::optional<guint> event_bps;  // from the event target-bitrate
  guint min_bitrate_bps = 0;
  lidar::gst::EncStats stats;
  Stream stream;
};

}  // namespace

struct _GstLidarDracoEnc {
  GstElement parent;
  GstPad* sink;
  GstPad* src;
  State* state;
};

G_DEFINE_TYPE(GstLidarDracoEnc, gst_lidar_draco_enc, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(dracoenc, "dracoenc", GST_RANK_NONE, GST_TYPE_LIDAR_DRACO_ENC)

namespace {

Settings Snapshot(State* state) {
  std::lock_guard lock(state->mutex);
  return state->settings;
}

/// The bitrate to keep to; 0: none.
guint EffectiveBitrate(const State& state) {
  return state.event_bps.value_or(state.settings.bitrate_bps);
}

GstCaps* EncodedCaps(const Stream& stream, const Settings& settings) {
  lidar::gst::EncodedInfo encoded;
  encoded.geometry = stream.encoder->geometry();
  encoded.fields = lidar::codec::KeptFields(stream.info.fields, settings.intensity_bits > 0,
                                            encoded.geometry == Geometry::kRange);
  encoded.framerate_n = stream.info.framerate_n;
  encoded.framerate_d = stream.info.framerate_d;
  encoded.sensor_model = stream.info.sensor_model;
  return encoded.ToCaps();
}

gboolean SetCaps(GstLidarDracoEnc* self, GstCaps* caps) {
  Stream& stream = self->state->stream;
  const Settings settings = Snapshot(self->state);
  const auto info = lidar::gst::CloudInfo::FromCaps(caps);
  stream.encoder.reset();
  lidar::codec::CloudFormat format;
  if (info) {
    format = {{info->fields, info->point_step}, info->height, info->sensor_model};
    stream.encoder =
        lidar::draco::SliceEncoder::Create(format, lidar::gst::GeometryOf(settings.geometry),
                                           static_cast<RangeCoder>(settings.range_coder));
  }
  if (stream.encoder && stream.encoder->geometry() == Geometry::kRange &&
      info->width > info->sensor_model->columns_per_scan) {
    stream.encoder.reset();
  }
  if (!stream.encoder) {
    GST_ELEMENT_ERROR(
        self, STREAM, FORMAT,
        ("This cloud cannot be encoded with geometry=%s.",
         lidar::gst::GeometryName(settings.geometry)),
        ("range needs a field range:U32 and a sensor-model with at least as many columns, xyz the "
         "fields x, y and z as F32 side by side; caps are %" GST_PTR_FORMAT,
         static_cast<gpointer>(caps)));
    return FALSE;
  }
  stream.encoder->set_threads(settings.threads);
  stream.range_check.reset();
  if (stream.encoder->geometry() == Geometry::kRange)
    stream.range_check = lidar::gst::RangeCheck::Create(format);
  stream.error_report.emplace(format, stream.encoder->geometry());
  stream.info = *info;
  if (!stream.loop) {
    auto model = lidar::gst::LoadModel(GST_ELEMENT(self), settings);
    if (!model) return FALSE;
    stream.loop = std::make_unique<lidar::rate::RateLoop>(std::move(model));
  }
  const lidar::gst::CapsPtr encoded(EncodedCaps(stream, settings));
  const lidar::gst::CapsPtr current(gst_pad_get_current_caps(self->src));
  if (current && gst_caps_is_equal(current.get(), encoded.get())) return TRUE;
  return gst_pad_push_event(self->src, gst_event_new_caps(encoded.get()));
}

gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_DRACO_ENC(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const gboolean accepted = SetCaps(self, caps);
    gst_event_unref(event);
    return accepted;
  }
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    self->state->stream.scan_id.reset();
    self->state->stream.discont = true;
  }
  return gst_pad_event_default(pad, parent, event);
}

gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_DRACO_ENC(parent);
  GstLidarTargetBitrate target;
  if (!gst_lidar_event_parse_target_bitrate(event, &target))
    return gst_pad_event_default(pad, parent, event);
  GST_LOG_OBJECT(self, "target %u bit/s (%s)", target.bitrate, GST_STR_NULL(target.reason));
  {
    std::lock_guard lock(self->state->mutex);
    // 0 would mean no target at all.
    self->state->event_bps = MAX(target.bitrate, 1);
  }
  gst_event_unref(event);
  return TRUE;
}

/// The place of `buffer` in its stream; counts the scan that it starts.
lidar::rate::SlicePlace PlaceOf(GstLidarDracoEnc* self, GstBuffer* buffer, GstLidarSlice* slice) {
  Stream& stream = self->state->stream;
  if (!gst_lidar_buffer_get_slice(buffer, slice)) slice->scan_id = stream.scans_without_meta++;
  lidar::rate::SlicePlace place{slice->scan_id, slice->slice_index, slice->slice_count, 10};
  if (stream.info.framerate_n > 0) {
    place.scans_per_second = static_cast<double>(stream.info.framerate_n) / stream.info.framerate_d;
  }
  if (stream.scan_id != slice->scan_id) {
    std::lock_guard lock(self->state->mutex);
    self->state->stats.OnScan(place.scans_per_second);
  }
  stream.scan_id = slice->scan_id;
  return place;
}

/// Sends the bounds where they have moved.
void PushBounds(GstLidarDracoEnc* self) {
  const auto bounds = self->state->stream.loop->controller().TakeChangedBounds();
  if (!bounds) return;
  const auto to_bps = [](DataRate r) {
    return static_cast<guint>(CLAMP(r.bits_per_second(), 1.0, 4e9));
  };
  const GstLidarBitrateBounds event{to_bps(bounds->min), to_bps(bounds->max),
                                    to_bps(bounds->nominal)};
  {
    std::lock_guard lock(self->state->mutex);
    self->state->min_bitrate_bps = event.min_bitrate;
  }
  g_object_notify(G_OBJECT(self), "min-bitrate");
  gst_pad_push_event(self->src, gst_lidar_event_new_bitrate_bounds(&event));
}

lidar::rate::LoopResult EncodeLoaded(GstLidarDracoEnc* self, const lidar::rate::SlicePlace& place) {
  State& state = *self->state;
  lidar::rate::LoopSettings loop;
  std::optional<DataRate> target;
  unsigned level = 0;
  {
    std::lock_guard lock(state.mutex);
    const Settings& s = state.settings;
    level = s.level;
    loop = {s.max_error_m, s.step_m, s.intensity_bits,
            static_cast<DegradationPreference>(s.degradation)};
    if (const guint bps = EffectiveBitrate(state); bps > 0) target = DataRate::BitsPerSecond(bps);
  }
  const gint64 start_us = g_get_monotonic_time();
  Stream& stream = state.stream;
  lidar::gst::EncCoder coder(&*stream.encoder, level, &stream.slice);
  const auto result = stream.loop->Encode(place, loop, target, &coder);
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND;
  std::lock_guard lock(state.mutex);
  state.stats.OnSlice(result, stream.slice, time);
  return result;
}

/// Where a slice was left out: downstream should not wait for it.
GstFlowReturn PushGap(GstLidarDracoEnc* self, GstBuffer* buffer) {
  if (GST_BUFFER_PTS_IS_VALID(buffer)) {
    gst_pad_push_event(self->src,
                       gst_event_new_gap(GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer)));
  }
  self->state->stream.discont = true;
  return GST_FLOW_OK;
}

GstFlowReturn PushSlice(GstLidarDracoEnc* self, GstBuffer* input) {
  Stream& stream = self->state->stream;
  const auto& bytes = stream.slice.bytes;
  GstBuffer* output = gst_buffer_new_memdup(bytes.data(), bytes.size());
  gst_buffer_copy_into(
      output, input,
      static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS |
                                      GST_BUFFER_COPY_META),
      0, static_cast<gsize>(-1));
  if (stream.discont) GST_BUFFER_FLAG_SET(output, GST_BUFFER_FLAG_DISCONT);
  stream.discont = false;
  PushBounds(self);
  return gst_pad_push(self->src, output);
}

/// Warns once where the cloud was moved after the sensor: what range geometry sends is not moved.
void CheckRanges(GstLidarDracoEnc* self, lidar::ByteView raw, guint first_column) {
  Stream& stream = self->state->stream;
  const auto found = stream.range_check->Find(raw, first_column);
  if (!found) return;
  stream.warned_of_ranges = true;
  GST_ELEMENT_WARNING(self, STREAM, ENCODE,
                      ("The points of this cloud are not where its ranges and its sensor-model put "
                       "them; geometry=range sends the ranges. Use geometry=xyz."),
                      ("the point of beam %u, column %u is %f m away", found->beam, found->column,
                       found->distance_m));
}

void CheckErrors(GstLidarDracoEnc* self, GstBuffer* input, const GstLidarSlice& place,
                 const lidar::rate::LoopResult& result) {
  State& state = *self->state;
  Stream& stream = state.stream;
  const lidar::gst::CheckedSlice checked{place.scan_id, place.slice_index, result.max_error_m,
                                         stream.slice.error_m, result.keep_fraction < 1};
  const auto found = stream.error_report->OnSlice(GST_ELEMENT(self), Snapshot(&state).error_check,
                                                  input, stream.slice.bytes, checked);
  if (!found) return;
  std::lock_guard lock(state.mutex);
  state.stats.OnErrorCheck(found->errors, found->holds);
}

/// Loads the points of `buffer` into the encoder; false after an error message.
bool LoadBuffer(GstLidarDracoEnc* self, GstBuffer* buffer, guint first_column) {
  Stream& stream = self->state->stream;
  const lidar::gst::CloudInfo& info = stream.info;
  const lidar::gst::BufferMap map(buffer, GST_MAP_READ);
  if (!map) {
    GST_ELEMENT_ERROR(self, RESOURCE, READ, (nullptr), ("cannot map a buffer"));
    return false;
  }
  const gsize row = gsize{info.point_step} * info.height;
  if (map.size() % row != 0 || (info.width > 0 && map.size() != info.FrameSize())) {
    GST_ELEMENT_ERROR(self, STREAM, ENCODE, ("A buffer does not hold the cloud of its caps."),
                      ("%" G_GSIZE_FORMAT " bytes for %u x %u points of %u bytes", map.size(),
                       info.width, info.height, info.point_step));
    return false;
  }
  stream.encoder->Load(map.view(), first_column, Snapshot(self->state).intensity_bits > 0);
  if (stream.range_check && !stream.warned_of_ranges) CheckRanges(self, map.view(), first_column);
  return true;
}

GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_DRACO_ENC(parent);
  const lidar::gst::BufferPtr input(buffer);
  Stream& stream = self->state->stream;
  if (!stream.encoder || !stream.loop) return GST_FLOW_NOT_NEGOTIATED;
  GstLidarSlice slice;
  const auto place = PlaceOf(self, buffer, &slice);
  if (!LoadBuffer(self, buffer, slice.first_column)) return GST_FLOW_ERROR;
  const auto result = EncodeLoaded(self, place);
  if (!result.skipped && result.result == CodingResult::kOutOfReach && !stream.warned_of_reach) {
    stream.warned_of_reach = true;
    GST_ELEMENT_WARNING(
        self, STREAM, ENCODE,
        ("A cloud is too large for max-error and was left out. Raise max-error, or crop "
         "the cloud."),
        ("the longest side of its box is %f m", stream.encoder->extent_m()));
  }
  if (result.skipped || result.result != CodingResult::kEncoded) return PushGap(self, buffer);
  CheckErrors(self, buffer, slice, result);
  return PushSlice(self, buffer);
}

GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  State& state = *GST_LIDAR_DRACO_ENC(element)->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.stats = {};
    state.event_bps.reset();
    state.min_bitrate_bps = 0;
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_draco_enc_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) state.stream = {};
  return result;
}

void SetObjectProperty(GObject* object, guint id, const GValue* value, GParamSpec*) {
  State& state = *GST_LIDAR_DRACO_ENC(object)->state;
  std::lock_guard lock(state.mutex);
  lidar::gst::SetProperty(state.settings, lidar::gst::EncProperties()[id - 1], value);
}

void GetObjectProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
  State& state = *GST_LIDAR_DRACO_ENC(object)->state;
  std::lock_guard lock(state.mutex);
  if (id == kPropStats) {
    g_value_take_boxed(value, state.stats.ToStructure(EffectiveBitrate(state)));
  } else if (id == kPropMinBitrate) {
    g_value_set_uint(value, state.min_bitrate_bps);
  } else {
    lidar::gst::GetProperty(state.settings, lidar::gst::EncProperties()[id - 1], value);
  }
}

void Finalize(GObject* object) {
  delete GST_LIDAR_DRACO_ENC(object)->state;
  G_OBJECT_CLASS(gst_lidar_draco_enc_parent_class)->finalize(object);
}

GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));
GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS,
    GST_STATIC_CAPS(GST_LIDAR_DRACO_MEDIA_TYPE
                    ", geometry = (string) { xyz, range }, alignment = (string) slice"));

}  // namespace

static void gst_lidar_draco_enc_init(GstLidarDracoEnc* self) {
  self->state = new State;
  self->sink = gst_pad_new_from_static_template(&sink_template, "sink");
  gst_pad_set_chain_function(self->sink, Chain);
  gst_pad_set_event_function(self->sink, SinkEvent);
  gst_element_add_pad(GST_ELEMENT(self), self->sink);
  self->src = gst_pad_new_from_static_template(&src_template, "src");
  gst_pad_set_event_function(self->src, SrcEvent);
  gst_pad_use_fixed_caps(self->src);
  gst_element_add_pad(GST_ELEMENT(self), self->src);
}

static void gst_lidar_draco_enc_class_init(GstLidarDracoEncClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_draco_enc_debug, "dracoenc", 0, "Point-cloud encoder");
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetObjectProperty;
  object->get_property = GetObjectProperty;
  object->finalize = Finalize;
  lidar::gst::InstallProperties(object, lidar::gst::EncProperties());
  constexpr auto kReadable = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  g_object_class_install_property(
      object, kPropMinBitrate,
      g_param_spec_uint("min-bitrate", "min-bitrate",
                        "What max-error needs, measured [bit/s]; 0 before the first scan", 0,
                        G_MAXUINT, 0, kReadable));
  g_object_class_install_property(
      object, kPropStats,
      g_param_spec_boxed("stats", "stats", "Counters and the latest settings", GST_TYPE_STRUCTURE,
                         kReadable));
  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(element, "Point-cloud encoder", "Codec/Encoder/PointCloud",
                                        "Compresses point clouds to a bitrate and within an error",
                                        "gst-lidar");
  element->change_state = ChangeState;
}

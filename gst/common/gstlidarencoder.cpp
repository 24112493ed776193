// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/common/gstlidarencoder.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "gst/common/buffer_map.h"
#include "gst/common/cloud_info.h"
#include "gst/common/encoder/error_report.h"
#include "gst/common/encoder/rate_model.h"
#include "gst/common/encoder/settings.h"
#include "gst/common/encoder/stats.h"
#include "gst/common/encoder/vtable_coder.h"
#include "gst/common/message_timer.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "src/cloud/range_check.h"
#include "src/rate/rate_loop.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_encoder_debug);
#define GST_CAT_DEFAULT gst_lidar_encoder_debug

namespace {

using lidar::DataRate;
using lidar::gst::EncoderSettings;
using lidar::rate::CodingResult;
using lidar::rate::LoopResult;
using lidar::rate::SlicePlace;

/// Belongs to the streaming thread.
struct Stream {
  lidar::gst::CloudInfo info;
  std::unique_ptr<lidar::gst::VtableCoder> coder;  // null: no format yet
  std::unique_ptr<lidar::rate::RateLoop> loop;
  std::optional<lidar::RangeCheck> range_check;
  std::optional<lidar::gst::ErrorReport> error_report;
  std::optional<guint> scan_id;  // of the last slice
  guint scans_without_meta = 0;
  bool discont = false;
  bool warned_of_reach = false;
  bool warned_of_ranges = false;
  lidar::gst::MessageTimer stats_timer;
};

}  // namespace

struct _GstLidarEncoderState {
  GstPad* sink = nullptr;
  GstPad* src = nullptr;

  std::mutex mutex;  // guards settings to stats; never held while pushing, posting or notifying
  EncoderSettings settings;
  std::optional<guint> event_bps;  // from the event target-bitrate
  guint min_bitrate_bps = 0;
  lidar::gst::EncoderStats stats;

  Stream stream;
};

G_DEFINE_ABSTRACT_TYPE(GstLidarEncoder, gst_lidar_encoder, GST_TYPE_ELEMENT)

namespace {

using State = GstLidarEncoderState;

/// The bitrate to keep to; 0: none.
guint EffectiveBitrate(const State& state) {
  return state.event_bps.value_or(state.settings.bitrate_bps);
}

guint MinBitrate(GObject* object) {
  State& state = *GST_LIDAR_ENCODER(object)->state;
  std::lock_guard lock(state.mutex);
  return state.min_bitrate_bps;
}

lidar::gst::StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_ENCODER(object)->state;
  std::lock_guard lock(state.mutex);
  return state.stats.ToStructure(EffectiveBitrate(state));
}

using Settings = EncoderSettings;
const std::array<lidar::gst::Property<Settings>, 12> kProperties = {{
    {"bitrate",
     "Bitrate of the encoded slices [bit/s]; 0: constant quality at the coarsest step that "
     "max-error allows. An event target-bitrate goes before it",
     &Settings::bitrate_bps, 0, G_MAXUINT, GST_PARAM_MUTABLE_PLAYING},
    {"max-error", "Largest distance between a point and its decoded point [m]",
     &Settings::max_error_m, 1e-4, 100, GST_PARAM_MUTABLE_PLAYING},
    {"min-bitrate", "What max-error needs, measured [bit/s]; 0 before the first scan", MinBitrate},
    {"quantization-step",
     "Fixes the step of the grid [m], whatever the bitrate; max-error still holds. 0: automatic",
     &Settings::step_m, 0, 1000, GST_PARAM_MUTABLE_PLAYING},
    {"intensity-bits", "Resolution of intensities [bit]; 0: geometry only",
     &Settings::intensity_bits, 0, 8},
    {"rate-model", "Predicts the size of a slice",
     lidar::gst::EnumField<Settings, lidar::rate::RateModel>{&Settings::rate_model,
                                                             lidar::gst::RateModelType}},
    {"model-location", "File with the coefficients of the rate model; none: built-in",
     &Settings::model_location},
    {"degradation-preference", "What gives when the bitrate is below what max-error needs",
     lidar::gst::EnumField<Settings, lidar::rate::DegradationPreference>{
         &Settings::degradation, lidar::gst::DegradationPreferenceType},
     0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"threads",
     "Most threads for one buffer, where the coder can divide it: more are faster, and a little "
     "larger",
     &Settings::threads, 1, 64},
    {"error-check",
     "Decodes every n-th slice again and posts its real point errors as the element message "
     "lidar-error-check; 0: none",
     &Settings::error_check, 0, G_MAXUINT, GST_PARAM_MUTABLE_PLAYING},
    {"stats", "Counters and the latest settings", Stats},
    {"stats-interval", "Posts stats as an element message that often; 0: never [ns]",
     &Settings::stats_interval, 0, 0, GST_PARAM_MUTABLE_PLAYING},
}};

Settings Snapshot(State* state) {
  std::lock_guard lock(state->mutex);
  return state->settings;
}

/// Asks the subclass; the caps of its slices, or null after an error message.
lidar::gst::CapsPtr AskForCaps(GstLidarEncoder* self, GstCaps* caps, Stream* stream) {
  const Settings settings = Snapshot(self->state);
  std::string why;
  const auto info = lidar::gst::CloudInfo::FromCaps(caps, &why);
  GstLidarCodedFormat coded{};
  coded.refusal = why.c_str();
  if (info) {
    const std::string fields = info->fields.ToString();
    const lidar::gst::BufferPtr model(
        info->sensor_model ? lidar::gst::SensorModelToBuffer(*info->sensor_model) : nullptr);
    const GstLidarCloudFormat cloud{info->width,    info->height,      info->point_step,
                                    fields.c_str(), info->framerate_n, info->framerate_d,
                                    model.get()};
    coded.refusal = "the coder cannot take it";
    if (!GST_LIDAR_ENCODER_GET_CLASS(self)->set_format(self, &cloud, settings.intensity_bits > 0,
                                                       &coded)) {
      if (coded.caps != nullptr) gst_caps_unref(coded.caps);
      coded.caps = nullptr;
    }
  }
  if (coded.caps == nullptr) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("This cloud cannot be encoded: %s.", coded.refusal),
                      ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return nullptr;
  }
  stream->info = *info;
  if (coded.codes_ranges && info->sensor_model) {
    stream->range_check =
        lidar::RangeCheck::Create(info->fields, info->point_step, *info->sensor_model);
  }
  return lidar::gst::CapsPtr(coded.caps);
}

gboolean SetCaps(GstLidarEncoder* self, GstCaps* caps) {
  State& state = *self->state;
  Stream& stream = state.stream;
  stream.coder.reset();
  stream.range_check.reset();
  const lidar::gst::CapsPtr encoded = AskForCaps(self, caps, &stream);
  if (!encoded) return FALSE;
  stream.error_report.emplace(self, stream.info.fields, stream.info.point_step);
  if (!stream.loop) {
    auto model = lidar::gst::LoadModel(GST_ELEMENT(self), Snapshot(&state));
    if (!model) return FALSE;
    stream.loop = std::make_unique<lidar::rate::RateLoop>(std::move(model));
  }
  stream.coder = std::make_unique<lidar::gst::VtableCoder>(self);
  GST_DEBUG_OBJECT(self, "coding %" GST_PTR_FORMAT, static_cast<gpointer>(encoded.get()));
  const lidar::gst::CapsPtr current(gst_pad_get_current_caps(state.src));
  if (current && gst_caps_is_equal(current.get(), encoded.get())) return TRUE;
  return gst_pad_push_event(state.src, gst_event_new_caps(encoded.get()));
}

gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_ENCODER(parent);
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
  auto* self = GST_LIDAR_ENCODER(parent);
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
SlicePlace PlaceOf(GstLidarEncoder* self, GstBuffer* buffer, GstLidarSlice* slice) {
  Stream& stream = self->state->stream;
  if (!gst_lidar_buffer_get_slice(buffer, slice)) slice->scan_id = stream.scans_without_meta++;
  SlicePlace place{slice->scan_id, slice->slice_index, slice->slice_count, 10};
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
void PushBounds(GstLidarEncoder* self) {
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
  gst_pad_push_event(self->state->src, gst_lidar_event_new_bitrate_bounds(&event));
}

LoopResult EncodeLoaded(GstLidarEncoder* self, const SlicePlace& place) {
  State& state = *self->state;
  lidar::rate::LoopSettings loop;
  std::optional<DataRate> target;
  guint threads = 1;
  {
    std::lock_guard lock(state.mutex);
    const Settings& s = state.settings;
    loop = {s.max_error_m, s.step_m, s.intensity_bits, s.degradation};
    threads = s.threads;
    if (const guint bps = EffectiveBitrate(state); bps > 0) target = DataRate::BitsPerSecond(bps);
  }
  const gint64 start_us = g_get_monotonic_time();
  Stream& stream = state.stream;
  stream.coder->set_threads(threads);
  const LoopResult result = stream.loop->Encode(place, loop, target, stream.coder.get());
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND;
  std::lock_guard lock(state.mutex);
  state.stats.OnSlice(result, time);
  return result;
}

/// Where a slice was left out: downstream should not wait for it.
GstFlowReturn PushGap(GstLidarEncoder* self, GstBuffer* buffer) {
  if (GST_BUFFER_PTS_IS_VALID(buffer)) {
    gst_pad_push_event(self->state->src,
                       gst_event_new_gap(GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer)));
  }
  self->state->stream.discont = true;
  return GST_FLOW_OK;
}

GstFlowReturn PushSlice(GstLidarEncoder* self, GstBuffer* input) {
  Stream& stream = self->state->stream;
  const lidar::ByteView bytes = stream.coder->bytes();
  GstBuffer* output = gst_buffer_new_memdup(bytes.data, bytes.size);
  gst_buffer_copy_into(
      output, input,
      static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS |
                                      GST_BUFFER_COPY_META),
      0, static_cast<gsize>(-1));
  if (stream.discont) GST_BUFFER_FLAG_SET(output, GST_BUFFER_FLAG_DISCONT);
  stream.discont = false;
  PushBounds(self);
  return gst_pad_push(self->state->src, output);
}

/// Warns once where the cloud was moved after the sensor: the ranges that are sent are not moved.
void CheckRanges(GstLidarEncoder* self, lidar::ByteView raw, guint first_column) {
  Stream& stream = self->state->stream;
  if (!stream.range_check || stream.warned_of_ranges) return;
  const auto found = stream.range_check->Find(raw, first_column);
  if (!found) return;
  stream.warned_of_ranges = true;
  GST_ELEMENT_WARNING(self, STREAM, ENCODE,
                      ("The points of this cloud are not where its ranges and its sensor-model put "
                       "them, and ranges are what is sent. Use dracoenc geometry=xyz."),
                      ("the point of beam %u, column %u is %f m away", found->beam, found->column,
                       found->distance_m));
}

void CheckErrors(GstLidarEncoder* self, lidar::ByteView raw, const GstLidarSlice& place,
                 const LoopResult& result) {
  State& state = *self->state;
  const lidar::gst::CheckedSlice checked{place.scan_id, place.slice_index, result.max_error_m,
                                         result.slice.error_m, result.keep_fraction < 1};
  const auto found = state.stream.error_report->OnSlice(Snapshot(&state).error_check, raw,
                                                        state.stream.coder->bytes(), checked);
  if (!found) return;
  std::lock_guard lock(state.mutex);
  state.stats.OnErrorCheck(found->errors, found->holds);
}

/// Loads the points of `map` into the coder; false after an error message.
bool LoadBuffer(GstLidarEncoder* self, const lidar::gst::BufferMap& map, guint first_column) {
  Stream& stream = self->state->stream;
  const lidar::gst::CloudInfo& info = stream.info;
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
  stream.coder->Load(
      {map.data(), map.size(), static_cast<guint>(map.size() / row), info.height, first_column});
  CheckRanges(self, map.view(), first_column);
  return true;
}

void WarnOfReach(GstLidarEncoder* self) {
  Stream& stream = self->state->stream;
  if (stream.warned_of_reach) return;
  stream.warned_of_reach = true;
  GST_ELEMENT_WARNING(
      self, STREAM, ENCODE,
      ("A cloud is too large for max-error and was left out. Raise max-error, or crop the cloud."),
      ("the longest side of its box is %f m", stream.coder->loaded().extent_m));
}

/// Where stats-interval asks for it.
void PostStats(GstLidarEncoder* self) {
  if (!self->state->stream.stats_timer.IsDue(Snapshot(self->state).stats_interval)) return;
  gst_element_post_message(
      GST_ELEMENT(self),
      gst_message_new_element(GST_OBJECT(self), Stats(G_OBJECT(self)).release()));
}

GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_ENCODER(parent);
  const lidar::gst::BufferPtr input(buffer);
  Stream& stream = self->state->stream;
  if (!stream.coder) return GST_FLOW_NOT_NEGOTIATED;
  GstLidarSlice slice;
  const SlicePlace place = PlaceOf(self, buffer, &slice);
  const lidar::gst::BufferMap map(buffer, GST_MAP_READ);
  if (!LoadBuffer(self, map, slice.first_column)) return GST_FLOW_ERROR;
  const LoopResult result = EncodeLoaded(self, place);
  GST_LOG_OBJECT(self, "slice %u of scan %u: %" G_GSIZE_FORMAT " bytes, step %f m%s",
                 slice.slice_index, slice.scan_id, result.slice.bytes, result.slice.step_m,
                 result.encoded() ? "" : ", left out");
  if (!result.skipped && result.result == CodingResult::kOutOfReach) WarnOfReach(self);
  if (result.encoded()) CheckErrors(self, map.view(), slice, result);
  PostStats(self);
  return result.encoded() ? PushSlice(self, buffer) : PushGap(self, buffer);
}

GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  auto* self = GST_LIDAR_ENCODER(element);
  State& state = *self->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.stats = {};
    state.event_bps.reset();
    state.min_bitrate_bps = 0;
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_encoder_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.stream = {};
    auto* klass = GST_LIDAR_ENCODER_GET_CLASS(self);
    if (klass->reset != nullptr) klass->reset(self);
  }
  return result;
}

/// The pad templates are the subclass's, so the pads come when it is known.
void Constructed(GObject* object) {
  G_OBJECT_CLASS(gst_lidar_encoder_parent_class)->constructed(object);
  auto* self = GST_LIDAR_ENCODER(object);
  State& state = *self->state;
  auto* klass = GST_ELEMENT_GET_CLASS(self);
  state.sink = gst_pad_new_from_template(gst_element_class_get_pad_template(klass, "sink"), "sink");
  gst_pad_set_chain_function(state.sink, Chain);
  gst_pad_set_event_function(state.sink, SinkEvent);
  gst_element_add_pad(GST_ELEMENT(self), state.sink);
  state.src = gst_pad_new_from_template(gst_element_class_get_pad_template(klass, "src"), "src");
  gst_pad_set_event_function(state.src, SrcEvent);
  gst_pad_use_fixed_caps(state.src);
  gst_element_add_pad(GST_ELEMENT(self), state.src);
}

void Finalize(GObject* object) {
  delete GST_LIDAR_ENCODER(object)->state;
  G_OBJECT_CLASS(gst_lidar_encoder_parent_class)->finalize(object);
}

}  // namespace

static void gst_lidar_encoder_init(GstLidarEncoder* self) { self->state = new State; }

static void gst_lidar_encoder_class_init(GstLidarEncoderClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_encoder_debug, "lidarencoder", 0, "Point-cloud encoders");
  gst_lidar_init();
  auto* object = G_OBJECT_CLASS(klass);
  object->constructed = Constructed;
  object->finalize = Finalize;
  lidar::gst::ServeProperties<GstLidarEncoder, kProperties>(object);
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
}

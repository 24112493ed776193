// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidarencoder.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "gst/common/coder_pads.h"
#include "gst/common/properties.h"
#include "gst/common/refused_caps.h"
#include "gst/lidar/encoder/cloud_input.h"
#include "gst/lidar/encoder/error_report.h"
#include "gst/lidar/encoder/receivers.h"
#include "gst/lidar/encoder/settings.h"
#include "gst/lidar/encoder/stats.h"
#include "gst/lidar/encoder/vtable_coder.h"
#include "src/rate/rate_loop.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_encoder_debug);
#define GST_CAT_DEFAULT gst_lidar_encoder_debug

namespace {

using namespace lidar::gst;
using lidar::DataRate;
using lidar::rate::CodingResult;
using lidar::rate::LoopResult;

/// The state that only the streaming thread uses.
struct Stream {
  CloudInput input;
  std::unique_ptr<VtableCoder> coder;  // null before the first format
  std::unique_ptr<lidar::rate::RateLoop> loop;
  std::optional<ErrorReport> error_report;
  RefusedCaps refused;
  MessageTimer stats_timer;
};

}  // namespace

struct _GstLidarEncoderState {
  CoderPads pads;

  std::mutex mutex;  // guards `settings` to `stats`; not locked while pushing, posting or notifying
  EncoderSettings settings;
  std::optional<guint> event_bps;  // from the last target-bitrate event
  guint min_bitrate_bps = 0;
  EncoderStats stats;

  ReceiverEvents receivers;
  Stream stream;
};

G_DEFINE_ABSTRACT_TYPE(GstLidarEncoder, gst_lidar_encoder, GST_TYPE_ELEMENT)

using State = GstLidarEncoderState;

/// Returns the target bitrate, or 0 if there is no limit.
static guint EffectiveBitrate(const State& state) {
  return state.event_bps.value_or(state.settings.bitrate_bps);
}

static guint MinBitrate(GObject* object) {
  State& state = *GST_LIDAR_ENCODER(object)->state;
  std::lock_guard lock(state.mutex);
  return state.min_bitrate_bps;
}

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_ENCODER(object)->state;
  std::lock_guard lock(state.mutex);
  return state.stats.ToStructure(EffectiveBitrate(state));
}

using Settings = EncoderSettings;
static const std::array<Property<Settings>, 12> kProperties = {{
    {"bitrate",
     "Bitrate of the encoded slices [bit/s]; 0: constant quality at the coarsest step that "
     "max-error allows. A target-bitrate event overrides it",
     &Settings::bitrate_bps, 0, G_MAXUINT, GST_PARAM_MUTABLE_PLAYING},
    {"max-error", "Largest distance between a point and its decoded point [m]",
     &Settings::max_error_m, 1e-4, 100, GST_PARAM_MUTABLE_PLAYING},
    {"min-bitrate", "Measured bitrate that max-error needs [bit/s]; 0 before the first scan",
     MinBitrate},
    {"quantization-step",
     "Fixes the step of the grid [m], whatever the bitrate; max-error still holds. 0: automatic",
     &Settings::step_m, 0, 1000, GST_PARAM_MUTABLE_PLAYING},
    {"intensity-bits", "Resolution of intensities [bit]; 0: geometry only",
     &Settings::intensity_bits, 0, 8},
    {"rate-model", "Predicts the size of a slice",
     EnumField<Settings, lidar::rate::RateModel>{&Settings::rate_model, RateModelType}},
    {"model-location", "File with the coefficients of the rate model; NULL: built-in coefficients",
     &Settings::model_location},
    {"degradation-preference", "What to reduce when the bitrate is too low for max-error",
     EnumField<Settings, lidar::rate::DegradationPreference>{&Settings::degradation,
                                                             DegradationPreferenceType},
     0, 0, GST_PARAM_MUTABLE_PLAYING},
    {"threads",
     "Most threads for one buffer, if the coder can divide it; more threads are faster and need "
     "slightly more bits",
     &Settings::threads, 1, 64},
    {"error-check",
     "Decodes every n-th slice again and posts its real point errors as the element message "
     "lidar-error-check; 0: none",
     &Settings::error_check, 0, G_MAXUINT, GST_PARAM_MUTABLE_PLAYING},
    {"stats", "Counters and the latest settings", Stats},
    {"stats-interval", "Time between element messages with stats; 0: no messages [ns]",
     &Settings::stats_interval, 0, 0, GST_PARAM_MUTABLE_PLAYING},
}};

/// Returns the caps of the subclass's slices. If the subclass refuses the cloud, posts an error
/// message and returns null.
static CapsPtr AskForCaps(GstLidarEncoder* self, GstCaps* caps, Stream* stream) {
  const Settings settings = Snapshot(*self->state);
  std::string why;
  const auto info = CloudInfo::FromCaps(caps, &why);
  GstLidarCodedFormat coded{};
  coded.refusal = why.c_str();
  if (info) {
    const std::string fields = info->fields.ToString();
    const BufferPtr model(info->sensor_model ? SensorModelToBuffer(*info->sensor_model) : nullptr);
    const GstLidarCloudFormat cloud{info->width,    info->height,      info->point_step,
                                    fields.c_str(), info->framerate_n, info->framerate_d,
                                    model.get()};
    coded.refusal = "the coder does not accept it";
    if (!GST_LIDAR_ENCODER_GET_CLASS(self)->set_format(self, &cloud, settings.intensity_bits > 0,
                                                       &coded)) {
      if (coded.caps != nullptr) gst_caps_unref(coded.caps);
      coded.caps = nullptr;
    }
  }
  if (coded.caps == nullptr) {
    if (!stream->refused.Note(caps)) return nullptr;
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("This cloud cannot be encoded: %s.", coded.refusal),
                      ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return nullptr;
  }
  stream->refused.Reset();
  stream->input.SetFormat(*info, coded.codes_ranges != FALSE);
  return CapsPtr(coded.caps);
}

static gboolean SetCaps(GstLidarEncoder* self, GstCaps* caps) {
  State& state = *self->state;
  Stream& stream = state.stream;
  stream.coder.reset();
  const CapsPtr encoded = AskForCaps(self, caps, &stream);
  if (!encoded) return FALSE;
  if (!stream.loop) {
    auto model = LoadModel(GST_ELEMENT(self), Snapshot(state));
    if (!model) return FALSE;
    stream.error_report.emplace(self);
    stream.loop = std::make_unique<lidar::rate::RateLoop>(std::move(model));
  }
  stream.coder = std::make_unique<VtableCoder>(self);
  GST_DEBUG_OBJECT(self, "coding %" GST_PTR_FORMAT, static_cast<gpointer>(encoded.get()));
  const CapsPtr current(gst_pad_get_current_caps(state.pads.src()));
  if (current && gst_caps_is_equal(current.get(), encoded.get())) return TRUE;
  return gst_pad_push_event(state.pads.src(), gst_event_new_caps(encoded.get()));
}

static gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_ENCODER(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const gboolean accepted = SetCaps(self, caps);
    gst_event_unref(event);
    return accepted;
  }
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    self->state->stream.input.ForgetScan();
    self->state->pads.set_discont(true);
  }
  return gst_pad_event_default(pad, parent, event);
}

static gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_ENCODER(parent);
  if (GST_LIDAR_ENCODER_GET_CLASS(self)->request_key != nullptr &&
      self->state->receivers.OnEvent(event)) {
    gst_event_unref(event);
    return TRUE;
  }
  GstLidarTargetBitrate target;
  if (!gst_lidar_event_parse_target_bitrate(event, &target))
    return gst_pad_event_default(pad, parent, event);
  GST_LOG_OBJECT(self, "target %u bit/s (%s)", target.bitrate, GST_STR_NULL(target.reason));
  {
    std::lock_guard lock(self->state->mutex);
    // 0 would mean that there is no target.
    self->state->event_bps = MAX(target.bitrate, 1);
  }
  gst_event_unref(event);
  return TRUE;
}

/// Sends an event with the bounds of the bitrate if they have changed.
static void PushBounds(GstLidarEncoder* self) {
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
  gst_pad_push_event(self->state->pads.src(), gst_lidar_event_new_bitrate_bounds(&event));
}

/// Passes the reports that receivers have sent since the last slice to the subclass.
static void TellOfReceivers(GstLidarEncoder* self) {
  auto* klass = GST_LIDAR_ENCODER_GET_CLASS(self);
  if (klass->request_key == nullptr) return;  // its slices have no references
  const auto news = self->state->receivers.Take(self->state->pads.src());
  if (klass->acknowledge != nullptr)
    for (const auto& slice : news.received)
      klass->acknowledge(self, slice.receiver, slice.scan_id, slice.slice_index);
  if (news.key_requested) klass->request_key(self);
}

static LoopResult EncodeLoaded(GstLidarEncoder* self, const CloudInput::Place& place) {
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
  const LoopResult result = stream.loop->Encode(place.in_stream, loop, target, stream.coder.get());
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND;
  std::lock_guard lock(state.mutex);
  if (place.starts_scan) state.stats.OnScan(place.in_stream.scans_per_second);
  state.stats.OnSlice(result, time);
  return result;
}

static GstFlowReturn PushSlice(GstLidarEncoder* self, GstBuffer* input,
                               const GstLidarSlice& place) {
  const lidar::ByteView bytes = self->state->stream.coder->bytes();
  BufferPtr output(gst_buffer_new_memdup(bytes.data, bytes.size));
  // Adds the place in the scan if the input has no meta. Without this meta, a receiver could not
  // count lost slices, and would acknowledge the wrong scan.
  GstLidarSlice known{};
  if (!gst_lidar_buffer_get_slice(input, &known)) gst_lidar_buffer_set_slice(output.get(), &place);
  PushBounds(self);
  return self->state->pads.Push(std::move(output), input);
}

static void CheckErrors(GstLidarEncoder* self, lidar::ByteView raw, const GstLidarSlice& place,
                        const LoopResult& result) {
  State& state = *self->state;
  const CheckedSlice checked{place.scan_id, place.slice_index, result.max_error_m,
                             result.slice.error_m, result.keep_fraction < 1};
  Stream& stream = state.stream;
  const auto found = stream.error_report->OnSlice(Snapshot(state).error_check, stream.input.info(),
                                                  raw, stream.coder->bytes(), checked);
  if (!found) return;
  std::lock_guard lock(state.mutex);
  state.stats.OnErrorCheck(found->errors, found->holds);
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_ENCODER(parent);
  const BufferPtr input(buffer);
  Stream& stream = self->state->stream;
  if (!stream.coder) return GST_FLOW_NOT_NEGOTIATED;
  const CloudInput::Place place = stream.input.PlaceOf(buffer);
  const GstLidarSlice& slice = place.slice;
  const BufferMap map(buffer, GST_MAP_READ);
  const auto raw = stream.input.Read(self, map, slice);
  if (!raw) return GST_FLOW_ERROR;
  TellOfReceivers(self);
  stream.coder->Load(*raw);
  const LoopResult result = EncodeLoaded(self, place);
  GST_LOG_OBJECT(self, "slice %u of scan %u: %" G_GSIZE_FORMAT " bytes, step %f m%s",
                 slice.slice_index, slice.scan_id, result.slice.bytes, result.slice.step_m,
                 result.encoded() ? "" : ", left out");
  if (!result.skipped && result.result == CodingResult::kOutOfReach)
    stream.input.WarnOfReach(self, stream.coder->loaded().extent_m);
  if (result.encoded()) CheckErrors(self, map.view(), slice, result);
  stream.stats_timer.Post(GST_ELEMENT(self), Snapshot(*self->state).stats_interval, Stats);
  return result.encoded() ? PushSlice(self, buffer, slice) : self->state->pads.LeaveOut(buffer);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  auto* self = GST_LIDAR_ENCODER(element);
  State& state = *self->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.receivers.Forget();
    state.stats = {};
    state.event_bps.reset();
    state.min_bitrate_bps = 0;
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_encoder_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY)
    EndStream(self, GST_LIDAR_ENCODER_GET_CLASS(self));
  return result;
}

/// Makes the pads from the templates of the subclass. The templates are not yet known in init().
static void Constructed(GObject* object) {
  G_OBJECT_CLASS(gst_lidar_encoder_parent_class)->constructed(object);
  State& state = *GST_LIDAR_ENCODER(object)->state;
  state.pads.Create(object, Chain, SinkEvent);
  gst_pad_set_event_function(state.pads.src(), SrcEvent);
}

static void gst_lidar_encoder_init(GstLidarEncoder* self) { self->state = new State; }

static void gst_lidar_encoder_class_init(GstLidarEncoderClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_encoder_debug, "lidarencoder", 0, "Point-cloud encoders");
  gst_lidar_init();
  G_OBJECT_CLASS(klass)->constructed = Constructed;
  ServeState<GstLidarEncoder, gst_lidar_encoder_parent_class, kProperties>(klass);
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
}

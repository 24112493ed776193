// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidardecoder.h"

#include <ctime>
#include <mutex>
#include <optional>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/coder_pads.h"
#include "gst/common/held_events.h"
#include "gst/common/properties.h"
#include "gst/common/refused_caps.h"
#include "gst/common/stats.h"
#include "gst/lidar/cloud_info.h"
#include "src/base/load_budget.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_decoder_debug);
#define GST_CAT_DEFAULT gst_lidar_decoder_debug

namespace {

using namespace lidar::gst;

struct Settings {
  guint max_points = 1U << 20;
  gdouble max_decode_load = 0;
  lidar::Duration stats_interval{};
};

struct Counters {
  guint64 slices = 0;
  guint64 slices_dropped = 0;
  guint64 slices_unreferenced = 0;  // among the dropped slices
  guint64 slices_over_load = 0;     // among the dropped slices
  guint64 slices_thinned = 0;
  guint64 points = 0;  // includes missing returns
  guint64 bytes = 0;
  GstClockTime decode_time = 0;
  GstClockTime last_decode_time = 0;
  GstClockTime last_capture_time = GST_CLOCK_TIME_NONE;
  GstLidarDecodedSlice last{0, 0, 0, 0, 0, 1, FALSE};
};

using LastSlice = GstLidarDecodedSlice;
/// Returns the age of the last decoded slice. The clocks of the sensor and of this machine must
/// both be UTC.
guint64 AgeOf(const Counters& c) {
  if (!GST_CLOCK_TIME_IS_VALID(c.last_capture_time)) return GST_CLOCK_TIME_NONE;
  const auto now = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  return now > c.last_capture_time ? now - c.last_capture_time : 0;
}
guint64 MeanDecodeTime(const Counters& c) { return c.slices > 0 ? c.decode_time / c.slices : 0; }

const std::array<Stat<Counters>, 14> kStats = {{
    {"slices", &Counters::slices},
    {"slices-dropped", &Counters::slices_dropped},
    {"slices-unreferenced", &Counters::slices_unreferenced},
    {"slices-over-load", &Counters::slices_over_load},
    {"slices-thinned", &Counters::slices_thinned},
    {"points", &Counters::points},
    {"bytes", &Counters::bytes},
    {"step", At<&Counters::last, &LastSlice::step>},
    {"error-bound", At<&Counters::last, &LastSlice::error_bound>},
    {"intensity-bits", At<&Counters::last, &LastSlice::intensity_bits>},
    {"keep-fraction", At<&Counters::last, &LastSlice::keep_fraction>},
    {"decode-time", &Counters::last_decode_time},
    {"mean-decode-time", MeanDecodeTime},
    {"age", AgeOf},
}};

/// The state that only the streaming thread uses.
struct Stream {
  std::optional<CloudInfo> cloud;  // of the output; its width is 0 before its caps are pushed
  guint max_points = 0;
  HeldEvents held;
  RefusedCaps refused;
  MessageTimer stats_timer;
  lidar::LoadBudget load;
  bool warned_of_load = false;
  gint64 asked_at_us = 0;  // last request for a slice without references
  guint asked = 0;
};

}  // namespace

struct _GstLidarDecoderState {
  CoderPads pads;

  std::mutex mutex;  // guards settings and counters; not locked while pushing or posting
  Settings settings;
  Counters counters;

  Stream stream;
};

G_DEFINE_ABSTRACT_TYPE(GstLidarDecoder, gst_lidar_decoder, GST_TYPE_ELEMENT)

using State = GstLidarDecoderState;

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_DECODER(object)->state;
  std::lock_guard lock(state.mutex);
  return ToStructure("lidar-decoder-stats", kStats, state.counters);
}

static guint64 Age(GObject* object) {
  State& state = *GST_LIDAR_DECODER(object)->state;
  std::lock_guard lock(state.mutex);
  return AgeOf(state.counters);
}

static const std::array<Property<Settings>, 5> kProperties = {{
    {"max-points", "Most points of a slice; larger slices are dropped before memory is allocated",
     &Settings::max_points, 1, 1U << 24},
    {"max-decode-load",
     "Share of one processor's time that decoding may take; slices beyond it are dropped; 0: no "
     "limit",
     &Settings::max_decode_load, 0, 1, GST_PARAM_MUTABLE_PLAYING},
    {"age",
     "Time since the newest slice was sampled, if the clocks of sensor and receiver are "
     "synchronised; 2^64 - 1: not known [ns]",
     Age},
    {"stats", "Counters", Stats},
    {"stats-interval", "Time between element messages with stats; 0: no messages [ns]",
     &Settings::stats_interval, 0, 0, GST_PARAM_MUTABLE_PLAYING},
}};

/// Returns true if the subclass can decode `cloud`. Sets is_dense. Removes the sensor model if the
/// decoded cloud has no rows.
static bool AskSubclass(GstLidarDecoder* self, GstCaps* caps, CloudInfo* cloud,
                        GstLidarDecodedFormat* decoded) {
  const std::string fields = cloud->fields.ToString();
  const BufferPtr model(cloud->sensor_model ? SensorModelToBuffer(*cloud->sensor_model) : nullptr);
  const GstLidarCloudFormat format{0,
                                   cloud->height,
                                   cloud->point_step,
                                   fields.c_str(),
                                   cloud->framerate_n,
                                   cloud->framerate_d,
                                   model.get()};
  decoded->refusal = "they belong to another coder";
  if (!GST_LIDAR_DECODER_GET_CLASS(self)->set_format(self, caps, &format, decoded)) return false;
  // An organised slice may have missing pixels. The caps say so for all slices, because they should
  // not change from slice to slice.
  cloud->is_dense = decoded->is_organised == FALSE;
  if (!decoded->is_organised) cloud->sensor_model.reset();
  return true;
}

static gboolean SetCaps(GstLidarDecoder* self, GstCaps* caps) {
  Stream& stream = self->state->stream;
  stream.max_points = Snapshot(*self->state).max_points;
  stream.cloud = CloudInfo::FromCodedCaps(caps);
  GstLidarDecodedFormat decoded{};
  decoded.refusal = "their fields lack x, y and z as F32 side by side, or have gaps between them";
  if (stream.cloud && AskSubclass(self, caps, &*stream.cloud, &decoded)) {
    stream.refused.Reset();
    return TRUE;
  }
  stream.cloud.reset();
  if (!stream.refused.Note(caps)) return FALSE;
  GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                    ("A stream with these caps cannot be decoded: %s.", decoded.refusal),
                    ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
  return FALSE;
}

/// Pushes new caps if the size of the slice differs from the size in the last caps.
static void PushCaps(GstLidarDecoder* self, const GstLidarDecodedSlice& slice) {
  Stream& stream = self->state->stream;
  CloudInfo& cloud = *stream.cloud;
  if (slice.width == cloud.width && slice.height == cloud.height) return;
  cloud.width = slice.width;
  cloud.height = slice.height;
  const CapsPtr caps(cloud.ToCaps());
  GST_DEBUG_OBJECT(self, "giving %" GST_PTR_FORMAT, static_cast<gpointer>(caps.get()));
  stream.held.PushCapsTo(self->state->pads.src(), caps.get());
}

static gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_DECODER(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const gboolean accepted = SetCaps(self, caps);
    gst_event_unref(event);
    return accepted;
  }
  Stream& stream = self->state->stream;
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    stream.held.OnFlush();
    self->state->pads.set_discont(true);
  }
  GstPad* src = self->state->pads.src();
  if (!gst_pad_has_current_caps(src) && stream.held.Take(event)) return TRUE;
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) stream.held.PushTo(src);
  return gst_pad_event_default(pad, parent, event);
}

static void Count(State* state, const GstLidarDecodedSlice& slice, const BufferMap& in,
                  GstClockTime time, GstClockTime capture_time) {
  std::lock_guard lock(state->mutex);
  Counters& c = state->counters;
  ++c.slices;
  c.points += guint64{slice.width} * slice.height;
  c.bytes += in.size();
  c.decode_time += time;
  c.last_decode_time = time;
  c.last_capture_time = capture_time;
  c.last = slice;
  if (slice.keep_fraction < 1) ++c.slices_thinned;
}

/// Decodes a slice. Returns the decoded buffer, or null if the slice is damaged.
static BufferPtr DecodeBuffer(GstLidarDecoder* self, GstBuffer* input,
                              GstLidarDecodedSlice* slice) {
  Stream& stream = self->state->stream;
  auto* klass = GST_LIDAR_DECODER_GET_CLASS(self);
  const gint64 start_us = g_get_monotonic_time();
  const BufferMap in(input, GST_MAP_READ);
  *slice = {0, 1, 0, 0, 0, 1, FALSE};
  if (!in || !klass->decode(self, in.data(), in.size(), stream.max_points, slice)) return nullptr;
  const gsize points = gsize{slice->width} * slice->height;
  // Drops empty slices, because caps without a width would stop the elements downstream.
  if (points == 0 || points > stream.max_points) return nullptr;
  BufferPtr output(gst_buffer_new_allocate(nullptr, points * stream.cloud->point_step, nullptr));
  if (!output) return nullptr;
  {
    BufferMap out(output.get(), GST_MAP_WRITE);
    if (!out) return nullptr;
    klass->write(self, out.data());
  }
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND;
  Count(self->state, *slice, in, time, gst_lidar_buffer_get_capture_time(input));
  return output;
}

/// Requests a slice without references, unless the last request may still be answered.
static void AskForKeyUnit(GstLidarDecoder* self) {
  constexpr gint64 kInterval = G_USEC_PER_SEC / 2;
  Stream& stream = self->state->stream;
  const gint64 now = g_get_monotonic_time();
  if (stream.asked > 0 && now - stream.asked_at_us < kInterval) return;
  stream.asked_at_us = now;
  GstStructure* s = gst_structure_new("GstForceKeyUnit", "running-time", GST_TYPE_CLOCK_TIME,
                                      GST_CLOCK_TIME_NONE, "all-headers", G_TYPE_BOOLEAN, TRUE,
                                      "count", G_TYPE_UINT, ++stream.asked, nullptr);
  gst_pad_push_event(self->state->pads.sink(), gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s));
}

static GstFlowReturn DropSlice(GstLidarDecoder* self, GstBuffer* input, bool lacks_reference) {
  State& state = *self->state;
  GST_WARNING_OBJECT(self, "dropping a slice that cannot be decoded: %" GST_PTR_FORMAT,
                     static_cast<gpointer>(input));
  {
    std::lock_guard lock(state.mutex);
    ++state.counters.slices_dropped;
    if (lacks_reference) ++state.counters.slices_unreferenced;
  }
  if (lacks_reference) AskForKeyUnit(self);
  return state.pads.LeaveOut(input);
}

static lidar::Duration ThreadTime() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

/// Returns false and counts the slice if earlier slices needed more processor time than
/// max-decode-load allows. Without a limit, a hostile sender could make each byte cost
/// microseconds.
static bool MayDecode(GstLidarDecoder* self, gdouble max_load) {
  State& state = *self->state;
  const lidar::Time now{std::chrono::microseconds(g_get_monotonic_time())};
  if (max_load <= 0 || state.stream.load.Allows(max_load, now)) return true;
  {
    std::lock_guard lock(state.mutex);
    ++state.counters.slices_over_load;
  }
  if (!std::exchange(state.stream.warned_of_load, true))
    GST_ELEMENT_WARNING(self, STREAM, DECODE,
                        ("Decoding this stream takes more than max-decode-load=%g of a processor. "
                         "Slices are dropped; raise max-decode-load, or check the sender.",
                         max_load),
                        (nullptr));
  return false;
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_DECODER(parent);
  const BufferPtr input(buffer);
  Stream& stream = self->state->stream;
  if (!stream.cloud) return GST_FLOW_NOT_NEGOTIATED;
  const Settings settings = Snapshot(*self->state);
  GstLidarDecodedSlice slice{};
  BufferPtr output;
  if (MayDecode(self, settings.max_decode_load)) {
    const lidar::Duration before = ThreadTime();
    output = DecodeBuffer(self, buffer, &slice);
    // Counts the time only if there is a limit. Otherwise this time would count against a limit
    // that is set later.
    if (settings.max_decode_load > 0) stream.load.Spend(ThreadTime() - before);
  }
  stream.stats_timer.Post(GST_ELEMENT(self), settings.stats_interval, Stats);
  if (!output) return DropSlice(self, buffer, slice.lacks_reference != FALSE);
  PushCaps(self, slice);
  return self->state->pads.Push(std::move(output), buffer);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  auto* self = GST_LIDAR_DECODER(element);
  State& state = *self->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.counters = {};
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_decoder_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY)
    EndStream(self, GST_LIDAR_DECODER_GET_CLASS(self));
  return result;
}

/// Makes the pads from the templates of the subclass. The templates are not yet known in init().
static void Constructed(GObject* object) {
  G_OBJECT_CLASS(gst_lidar_decoder_parent_class)->constructed(object);
  GST_LIDAR_DECODER(object)->state->pads.Create(object, Chain, SinkEvent);
}

static void gst_lidar_decoder_init(GstLidarDecoder* self) { self->state = new State; }

static void gst_lidar_decoder_class_init(GstLidarDecoderClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_decoder_debug, "lidardecoder", 0, "Point-cloud decoders");
  gst_lidar_init();
  G_OBJECT_CLASS(klass)->constructed = Constructed;
  ServeState<GstLidarDecoder, gst_lidar_decoder_parent_class, kProperties>(klass);
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
}

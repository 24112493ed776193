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
#include "ext/draco/gstdracodec.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "ext/draco/encoded_caps.h"
#include "ext/draco/slice_coder.h"
#include "gst/common/buffer_map.h"
#include "gst/common/cloud_info.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_draco_dec_debug);
#define GST_CAT_DEFAULT gst_lidar_draco_dec_debug

namespace {

using lidar::Geometry;
using lidar::draco::SliceDecoder;

struct Settings {
  guint max_points = 1U << 20;
};

const std::array<lidar::gst::Property<Settings>, 1> kProperties = {{
    {"max-points", "Slices of more points are dropped, before anything is allocated for them",
     &Settings::max_points, 1, 1U << 24},
}};
constexpr guint kPropStats = kProperties.size() + 1;

struct Stats {
  guint64 slices = 0;
  guint64 slices_dropped = 0;
  guint64 slices_thinned = 0;
  guint64 points = 0;  // missing returns included
  guint64 bytes = 0;
  GstClockTime decode_time = 0;
  GstClockTime last_decode_time = 0;
  SliceDecoder::Quality last;
};

/// Of the streaming thread.
struct Stream {
  lidar::gst::EncodedInfo info;
  std::unique_ptr<SliceDecoder> decoder;
  SliceDecoder::Shape shape;  // of the caps last pushed
  bool discont = false;
  std::vector<lidar::gst::EventPtr> pending;  // sticky, to follow the first caps
};

struct State {
  std::mutex mutex;  // guards settings and stats; never held while pushing or posting
  Settings settings;
  Stats stats;
  Stream stream;
};

}  // namespace

struct _GstLidarDracoDec {
  GstElement parent;
  GstPad* sink;
  GstPad* src;
  State* state;
};

G_DEFINE_TYPE(GstLidarDracoDec, gst_lidar_draco_dec, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(dracodec, "dracodec", GST_RANK_PRIMARY, GST_TYPE_LIDAR_DRACO_DEC)

namespace {

guint MaxPoints(State* state) {
  std::lock_guard lock(state->mutex);
  return state->settings.max_points;
}

gboolean SetCaps(GstLidarDracoDec* self, GstCaps* caps) {
  Stream& stream = self->state->stream;
  stream.decoder.reset();
  const auto info = lidar::gst::EncodedInfo::FromCaps(caps);
  if (!info) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("The caps of this stream cannot be decoded."),
                      ("geometry must be xyz or range, and range needs a sensor-model; caps are "
                       "%" GST_PTR_FORMAT,
                       static_cast<gpointer>(caps)));
    return FALSE;
  }
  stream.info = *info;
  stream.shape = {};
  lidar::codec::CloudFormat format;
  format.layout = {info->fields, info->fields.MinimumStep()};
  format.sensor_model = info->sensor_model;
  if (info->sensor_model)
    format.height = static_cast<std::uint32_t>(info->sensor_model->beams.size());
  stream.decoder = std::make_unique<SliceDecoder>(format, info->geometry, MaxPoints(self->state));
  return TRUE;
}

void PushPending(GstLidarDracoDec* self) {
  for (auto& event : std::exchange(self->state->stream.pending, {}))
    gst_pad_push_event(self->src, event.release());
}

/// Only the data tell the size of the cloud.
bool PushCaps(GstLidarDracoDec* self, const SliceDecoder::Shape& shape) {
  Stream& stream = self->state->stream;
  if (shape.width == stream.shape.width && shape.height == stream.shape.height) return true;
  lidar::gst::CloudInfo cloud;
  cloud.width = shape.width;
  cloud.height = shape.height;
  cloud.fields = stream.info.fields;
  cloud.point_step = stream.info.fields.MinimumStep();
  // Organised clouds may always have gaps: caps should not change with them.
  cloud.is_dense = stream.info.geometry == Geometry::kXyz;
  cloud.framerate_n = stream.info.framerate_n;
  cloud.framerate_d = stream.info.framerate_d;
  if (stream.info.geometry == Geometry::kRange) cloud.sensor_model = stream.info.sensor_model;
  const lidar::gst::CapsPtr caps(cloud.ToCaps());
  if (!gst_pad_push_event(self->src, gst_event_new_caps(caps.get()))) return false;
  stream.shape = shape;
  PushPending(self);
  return true;
}

/// Sticky events have their order: caps, segment, and then the others. True where `event` has to
/// wait for caps, which come with the first slice.
bool WaitsForCaps(GstEvent* event) {
  return GST_EVENT_IS_SERIALIZED(event) && GST_EVENT_IS_STICKY(event) &&
         GST_EVENT_TYPE(event) > GST_EVENT_CAPS && GST_EVENT_TYPE(event) != GST_EVENT_EOS;
}

/// As on a pad: a later event takes the place of one of its kind.
void HoldBack(Stream* stream, GstEvent* event) {
  const GstStructure* what = gst_event_get_structure(event);
  const auto same = [&](const lidar::gst::EventPtr& held) {
    return GST_EVENT_TYPE(held.get()) == GST_EVENT_TYPE(event) &&
           (what == nullptr || gst_event_has_name(held.get(), gst_structure_get_name(what)));
  };
  auto& pending = stream->pending;
  pending.erase(std::remove_if(pending.begin(), pending.end(), same), pending.end());
  pending.emplace_back(event);
}

gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_DRACO_DEC(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    const gboolean accepted = SetCaps(self, caps);
    gst_event_unref(event);
    return accepted;
  }
  Stream& stream = self->state->stream;
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    stream.discont = true;
    const auto is_segment = [](const auto& e) {
      return GST_EVENT_TYPE(e.get()) == GST_EVENT_SEGMENT;
    };
    stream.pending.erase(std::remove_if(stream.pending.begin(), stream.pending.end(), is_segment),
                         stream.pending.end());
  }
  const bool has_caps = gst_pad_has_current_caps(self->src);
  if (!has_caps && WaitsForCaps(event)) {
    HoldBack(&stream, event);
    return TRUE;
  }
  if (!has_caps && GST_EVENT_TYPE(event) == GST_EVENT_GAP) {
    gst_event_unref(event);  // nobody downstream knows yet what the gap is in
    return TRUE;
  }
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) PushPending(self);
  return gst_pad_event_default(pad, parent, event);
}

/// The decoded slice, or null where the stream is bad.
GstBuffer* DecodeBuffer(GstLidarDracoDec* self, GstBuffer* input, SliceDecoder::Shape* shape) {
  Stream& stream = self->state->stream;
  const gint64 start_us = g_get_monotonic_time();
  const lidar::gst::BufferMap in(input, GST_MAP_READ);
  if (!in) return nullptr;
  const auto decoded = stream.decoder->Decode(in.view());
  if (!decoded) return nullptr;
  *shape = *decoded;
  const gsize points = gsize{shape->width} * shape->height;
  GstBuffer* output =
      gst_buffer_new_allocate(nullptr, points * stream.info.fields.MinimumStep(), nullptr);
  {
    lidar::gst::BufferMap out(output, GST_MAP_WRITE);
    if (!out) {
      gst_buffer_unref(output);
      return nullptr;
    }
    stream.decoder->Write(out.data());
  }
  const auto time = static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND;
  std::lock_guard lock(self->state->mutex);
  Stats& stats = self->state->stats;
  ++stats.slices;
  stats.points += points;
  stats.bytes += in.size();
  stats.decode_time += time;
  stats.last_decode_time = time;
  stats.last = stream.decoder->quality();
  if (stats.last.keep_fraction < 1) ++stats.slices_thinned;
  return output;
}

GstFlowReturn DropSlice(GstLidarDracoDec* self, GstBuffer* input) {
  GST_WARNING_OBJECT(self, "dropping a slice that cannot be decoded: %" GST_PTR_FORMAT,
                     static_cast<gpointer>(input));
  {
    std::lock_guard lock(self->state->mutex);
    ++self->state->stats.slices_dropped;
  }
  self->state->stream.discont = true;
  // Before the first caps nobody downstream knows what the gap is in.
  if (GST_BUFFER_PTS_IS_VALID(input) && gst_pad_has_current_caps(self->src)) {
    gst_pad_push_event(self->src,
                       gst_event_new_gap(GST_BUFFER_PTS(input), GST_BUFFER_DURATION(input)));
  }
  return GST_FLOW_OK;
}

GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_DRACO_DEC(parent);
  const lidar::gst::BufferPtr input(buffer);
  Stream& stream = self->state->stream;
  if (!stream.decoder) return GST_FLOW_NOT_NEGOTIATED;
  SliceDecoder::Shape shape;
  lidar::gst::BufferPtr output(DecodeBuffer(self, buffer, &shape));
  if (!output) return DropSlice(self, buffer);
  if (!PushCaps(self, shape)) return GST_FLOW_NOT_NEGOTIATED;
  gst_buffer_copy_into(
      output.get(), buffer,
      static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS |
                                      GST_BUFFER_COPY_META),
      0, static_cast<gsize>(-1));
  if (stream.discont) GST_BUFFER_FLAG_SET(output.get(), GST_BUFFER_FLAG_DISCONT);
  stream.discont = false;
  return gst_pad_push(self->src, output.release());
}

GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  State& state = *GST_LIDAR_DRACO_DEC(element)->state;
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    std::lock_guard lock(state.mutex);
    state.stats = {};
  }
  const auto result =
      GST_ELEMENT_CLASS(gst_lidar_draco_dec_parent_class)->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) state.stream = {};
  return result;
}

GstStructure* ToStructure(const Stats& s) {
  return gst_structure_new(
      "dracodec-stats", "slices", G_TYPE_UINT64, s.slices, "slices-dropped", G_TYPE_UINT64,
      s.slices_dropped, "slices-thinned", G_TYPE_UINT64, s.slices_thinned, "points", G_TYPE_UINT64,
      s.points, "bytes", G_TYPE_UINT64, s.bytes, "step", G_TYPE_DOUBLE, s.last.step_m,
      "error-bound", G_TYPE_DOUBLE, s.last.error_m, "intensity-bits", G_TYPE_UINT,
      s.last.intensity_bits, "keep-fraction", G_TYPE_DOUBLE, s.last.keep_fraction, "decode-time",
      G_TYPE_UINT64, s.last_decode_time, "mean-decode-time", G_TYPE_UINT64,
      s.slices > 0 ? s.decode_time / s.slices : 0, nullptr);
}

void SetObjectProperty(GObject* object, guint id, const GValue* value, GParamSpec*) {
  State& state = *GST_LIDAR_DRACO_DEC(object)->state;
  std::lock_guard lock(state.mutex);
  lidar::gst::SetProperty(state.settings, kProperties[id - 1], value);
}

void GetObjectProperty(GObject* object, guint id, GValue* value, GParamSpec*) {
  State& state = *GST_LIDAR_DRACO_DEC(object)->state;
  std::lock_guard lock(state.mutex);
  if (id == kPropStats) {
    g_value_take_boxed(value, ToStructure(state.stats));
  } else {
    lidar::gst::GetProperty(state.settings, kProperties[id - 1], value);
  }
}

void Finalize(GObject* object) {
  delete GST_LIDAR_DRACO_DEC(object)->state;
  G_OBJECT_CLASS(gst_lidar_draco_dec_parent_class)->finalize(object);
}

GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_DRACO_MEDIA_TYPE));
GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));

}  // namespace

static void gst_lidar_draco_dec_init(GstLidarDracoDec* self) {
  self->state = new State;
  self->sink = gst_pad_new_from_static_template(&sink_template, "sink");
  gst_pad_set_chain_function(self->sink, Chain);
  gst_pad_set_event_function(self->sink, SinkEvent);
  gst_element_add_pad(GST_ELEMENT(self), self->sink);
  self->src = gst_pad_new_from_static_template(&src_template, "src");
  gst_pad_use_fixed_caps(self->src);
  gst_element_add_pad(GST_ELEMENT(self), self->src);
}

static void gst_lidar_draco_dec_class_init(GstLidarDracoDecClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_draco_dec_debug, "dracodec", 0, "Point-cloud decoder");
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetObjectProperty;
  object->get_property = GetObjectProperty;
  object->finalize = Finalize;
  lidar::gst::InstallProperties(object, kProperties);
  g_object_class_install_property(
      object, kPropStats,
      g_param_spec_boxed("stats", "stats", "Counters", GST_TYPE_STRUCTURE,
                         static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
  auto* element = GST_ELEMENT_CLASS(klass);
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(element, "Point-cloud decoder", "Codec/Decoder/PointCloud",
                                        "Decompresses point clouds, safe on hostile input",
                                        "gst-lidar");
  element->change_state = ChangeState;
}

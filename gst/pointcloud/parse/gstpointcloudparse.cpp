// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pointcloudparse
 *
 * Makes clouds of files: PCD, PLY, LAS, KITTI or raw points. The width comes from the size of a
 * file, stamps and capture times come from the frame rate, and the segment is in time.
 *
 * |[
 * gst-launch-1.0 multifilesrc location=%06d.bin ! pointcloudparse framerate=10/1 \
 *   ! fakesink sync=true
 * ]|
 */
#include <gst/gst.h>

#include <gst/base/gstadapter.h>

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/refused_caps.h"
#include "gst/lidar/cloud_info.h"
#include "gst/pointcloud/parse/cloud_file_reader.h"
#include "gst/pointcloud/parse/cloud_stamper.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_point_cloud_parse_debug);
#define GST_CAT_DEFAULT gst_lidar_point_cloud_parse_debug

namespace {

using namespace lidar::gst;

constexpr gint kDefaultRate = 10;            // scans/s, if neither caps nor property have a rate
constexpr gsize kMaxCloud = gsize{1} << 30;  // bytes

struct Settings {
  FrameRate framerate;  // 0: use the rate in the caps
};

const std::array<Property<Settings>, 1> kProperties = {{
    {"framerate", "Clouds per second [1/s]; 0/1: from the caps, or 10/1 if the caps have none",
     &Settings::framerate},
}};

using AdapterPtr = std::unique_ptr<GstAdapter, Unref>;

struct State {
  std::mutex mutex;  // guards the settings
  Settings settings;
  CloudStamper stamper;  // its timeline has its own lock
  // The members below, and the stamper without its timeline, are used by the streaming thread only.
  std::optional<CloudInfo> info;             // read from the caps or the file; width 0: not known
  std::optional<lidar::CloudFileType> type;  // empty for raw points
  CapsPtr caps;
  guint out_width = 0;
  // The size of a file that arrives in pieces. 0: each buffer is a whole cloud.
  std::optional<gsize> file_size;
  bool discont = false;  // clouds are missing before the next cloud
  bool empty_reported = false;
  RefusedCaps refused;
  AdapterPtr adapter{gst_adapter_new()};
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarPointCloudParse, gst_lidar_point_cloud_parse, GST,
                     LIDAR_POINT_CLOUD_PARSE, GstElement)
struct _GstLidarPointCloudParse {
  GstElement parent;
  GstPad* sinkpad;
  GstPad* srcpad;
  State* state;
};

G_DEFINE_TYPE(GstLidarPointCloudParse, gst_lidar_point_cloud_parse, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(pointcloudparse, "pointcloudparse", GST_RANK_NONE,
                            gst_lidar_point_cloud_parse_get_type())

static State& StateOf(gpointer self) { return *GST_LIDAR_POINT_CLOUD_PARSE(self)->state; }

/// Returns the size of a cloud in bytes, for a stream whose buffers do not end where clouds end.
/// Returns 0 if each buffer is a whole cloud.
static gsize CloudSize(GstLidarPointCloudParse* self) {
  State& state = *self->state;
  if (!state.type && state.info->width > 0) return state.info->FrameSize();
  if (!state.file_size) {
    // filesrc knows the size of its file and sends it in blocks. multifilesrc sends whole files.
    gint64 size = 0;
    const bool known = gst_pad_peer_query_duration(self->sinkpad, GST_FORMAT_BYTES, &size);
    state.file_size = known && size > 0 ? static_cast<gsize>(size) : 0;
  }
  return *state.file_size;
}

static void PushCaps(GstLidarPointCloudParse* self, guint width) {
  State& state = *self->state;
  if (state.out_width == width) return;
  state.out_width = width;
  const FrameRate& rate = state.stamper.rate();
  CapsPtr caps(gst_caps_copy(state.caps.get()));
  gst_caps_set_simple(caps.get(), "width", G_TYPE_INT, static_cast<gint>(width), "height",
                      G_TYPE_INT, static_cast<gint>(state.info->height), "is-dense", G_TYPE_BOOLEAN,
                      state.info->is_dense, "is-bigendian", G_TYPE_BOOLEAN, FALSE, "framerate",
                      GST_TYPE_FRACTION, rate.n, rate.d, nullptr);
  gst_pad_push_event(self->srcpad, gst_event_new_caps(caps.get()));
}

static void PushSegment(GstLidarPointCloudParse* self) {
  if (auto segment = self->state->stamper.NextSegment())
    gst_pad_push_event(self->srcpad, segment.release());
}

/// Skips an empty file. A recording that was interrupted may end with empty files.
static GstFlowReturn SkipEmpty(GstLidarPointCloudParse* self) {
  State& state = *self->state;
  state.stamper.LeaveOut();
  state.discont = true;
  if (!std::exchange(state.empty_reported, true))
    GST_ELEMENT_WARNING(self, STREAM, FORMAT, ("A cloud is empty and is left out."),
                        ("It is cloud number %" G_GUINT64_FORMAT
                         ", counted from 1; further empty clouds are not reported.",
                         state.stamper.count()));
  return GST_FLOW_OK;
}

static GstFlowReturn PushCloud(GstLidarPointCloudParse* self, BufferPtr buffer) {
  State& state = *self->state;
  const gsize column = gsize{state.info->height} * state.info->point_step;
  const gsize size = gst_buffer_get_size(buffer.get());
  if (size == 0) return SkipEmpty(self);
  if (size % column != 0 || size / column > G_MAXINT) {
    GST_ELEMENT_ERROR(
        self, STREAM, FORMAT,
        ("A cloud of %" G_GSIZE_FORMAT
         " bytes cannot be divided into points of %u bytes in %u rows.",
         size, state.info->point_step, state.info->height),
        ("Check point-step and height in the caps of the source, and the format of the file."));
    return GST_FLOW_ERROR;
  }
  PushCaps(self, static_cast<guint>(size / column));
  PushSegment(self);
  GstBuffer* out = gst_buffer_make_writable(buffer.release());
  state.stamper.Stamp(out);
  // The adapter copies the flag of a buffer to every cloud in this buffer.
  gst_buffer_unset_flags(out, GST_BUFFER_FLAG_DISCONT);
  if (std::exchange(state.discont, false)) gst_buffer_set_flags(out, GST_BUFFER_FLAG_DISCONT);
  return gst_pad_push(self->srcpad, out);
}

/// Pushes the cloud of a whole file that has a header.
static GstFlowReturn PushFile(GstLidarPointCloudParse* self, const BufferPtr& file) {
  State& state = *self->state;
  std::string why = "its buffer cannot be mapped";
  std::optional<FileBuffer> read;
  if (gst_buffer_get_size(file.get()) == 0) return SkipEmpty(self);
  if (const BufferMap map(file.get(), GST_MAP_READ); map)
    read = ReadCloudFile(*state.type, map.view(), &why);
  if (!read) {
    GST_ELEMENT_ERROR(
        self, STREAM, DECODE, ("The %s file cannot be read: %s.", NameOf(*state.type), why.c_str()),
        ("It is file number %" G_GUINT64_FORMAT ", counted from 1.", state.stamper.count() + 1));
    return GST_FLOW_ERROR;
  }
  if (!state.info || state.info->height != read->info.height ||
      state.info->point_step != read->info.point_step || state.info->fields != read->info.fields) {
    state.out_width = 0;  // other caps
    state.caps.reset(read->info.ToCaps());
  }
  state.info = read->info;
  gst_buffer_copy_into(
      read->buffer.get(), file.get(),
      static_cast<GstBufferCopyFlags>(GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS), 0,
      static_cast<gsize>(-1));
  return PushCloud(self, std::move(read->buffer));
}

static GstFlowReturn PushWhole(GstLidarPointCloudParse* self, BufferPtr buffer) {
  CloudStamper& stamper = self->state->stamper;
  if (stamper.HasGone()) {
    stamper.LeaveOut();
    return GST_FLOW_OK;
  }
  return self->state->type ? PushFile(self, buffer) : PushCloud(self, std::move(buffer));
}

/// Sets the rate from the property, or from the caps if the property is not set.
static void SetRate(State* state, gint n, gint d) {
  FrameRate rate{n, d};
  {
    std::lock_guard lock(state->mutex);
    if (state->settings.framerate.n > 0) rate = state->settings.framerate;
  }
  state->stamper.SetRate(rate.n > 0 ? rate : FrameRate{kDefaultRate, 1});
}

/// Detects the file type from the content of the file.
static void GuessType(State* state, GstBuffer* buffer) {
  const BufferMap map(buffer, GST_MAP_READ);
  if (map) state->type = lidar::TypeOfCloudFile(map.view());
  if (state->type) SetRate(state, 0, 1);
}

/// Removes a cloud from the adapter. The cloud gets the time of the buffer in which it begins.
/// Further clouds in the same buffer follow at the frame rate.
static BufferPtr TakeCloud(State* state, gsize size) {
  guint64 distance = 0;
  const GstClockTime pts = gst_adapter_prev_pts(state->adapter.get(), &distance);
  BufferPtr cloud(gst_buffer_make_writable(gst_adapter_take_buffer(state->adapter.get(), size)));
  GST_BUFFER_PTS(cloud.get()) =
      GST_CLOCK_TIME_IS_VALID(pts) ? pts + state->stamper.TimeOf(distance / size) : pts;
  return cloud;
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* raw) {
  auto* self = GST_LIDAR_POINT_CLOUD_PARSE(parent);
  State& state = *self->state;
  BufferPtr buffer(raw);
  if (!state.info && !state.type && !state.refused.noted()) GuessType(&state, raw);
  if (!state.info && !state.type) {
    if (state.refused.noted()) return GST_FLOW_NOT_NEGOTIATED;
    GST_ELEMENT_ERROR(self, CORE, NEGOTIATION, ("The caps of the cloud are missing."),
                      ("The data are not a PCD, PLY, LAS or KITTI file, so set the caps "
                       "application/x-pointcloud2 with point-step and fields at the source "
                       "(property caps of multifilesrc, or a caps filter)."));
    return GST_FLOW_NOT_NEGOTIATED;
  }
  const gsize cloud = CloudSize(self);
  if (cloud > kMaxCloud) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                      ("A file of %" G_GSIZE_FORMAT " bytes is too large for one cloud.", cloud),
                      ("Set width in the caps if the file holds many clouds."));
    return GST_FLOW_ERROR;
  }
  state.stamper.SetCloudSize(cloud);
  state.discont = state.discont || GST_BUFFER_IS_DISCONT(buffer.get());
  if (cloud == 0) return PushWhole(self, std::move(buffer));
  if (GST_BUFFER_IS_DISCONT(buffer.get())) gst_adapter_clear(state.adapter.get());
  if (gst_adapter_available(state.adapter.get()) == 0 && gst_buffer_get_size(raw) == cloud)
    return PushWhole(self, std::move(buffer));
  gst_adapter_push(state.adapter.get(), buffer.release());
  GstFlowReturn flow = GST_FLOW_OK;
  while (flow == GST_FLOW_OK && gst_adapter_available(state.adapter.get()) >= cloud)
    flow = PushWhole(self, TakeCloud(&state, cloud));
  return flow;
}

static gboolean HandleCaps(GstLidarPointCloudParse* self, GstEvent* event) {
  State& state = *self->state;
  const EventPtr owner(event);
  GstCaps* caps = nullptr;
  gst_event_parse_caps(event, &caps);
  state.type = CloudFileTypeOf(caps);
  if (state.type) {
    state.refused.Reset();
    state.info.reset();
    FrameRate given;
    gst_structure_get_fraction(gst_caps_get_structure(caps, 0), "framerate", &given.n, &given.d);
    SetRate(&state, given.n, given.d);
    return TRUE;
  }
  std::string why;
  auto info = CloudInfo::FromCaps(caps, &why);
  if (!info) {
    if (state.refused.Note(caps))
      GST_ELEMENT_ERROR(self, STREAM, FORMAT,
                        ("The caps do not describe a cloud: %s.", why.c_str()),
                        ("%" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return FALSE;
  }
  state.refused.Reset();
  SetRate(&state, info->framerate_n, info->framerate_d);
  state.info = std::move(info);
  state.caps.reset(gst_caps_ref(caps));
  state.out_width = 0;
  return TRUE;
}

/// Drops the bytes that remain in the adapter, because they are not a whole cloud.
static void Drain(GstLidarPointCloudParse* self) {
  State& state = *self->state;
  const gsize left = gst_adapter_available(state.adapter.get());
  if (left > 0) {
    GST_ELEMENT_WARNING(
        self, STREAM, FORMAT,
        ("The stream ends within a cloud: %" G_GSIZE_FORMAT " bytes are left over.", left),
        ("Check that the size of the file is a multiple of width x height x point-step."));
  }
  gst_adapter_clear(state.adapter.get());
}

static gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_POINT_CLOUD_PARSE(parent);
  State& state = *self->state;
  switch (GST_EVENT_TYPE(event)) {
    case GST_EVENT_STREAM_START:
      // The next file from a concat element has its own size. It also has its own type, unless caps
      // set the type.
      state.file_size.reset();
      if (gst_pad_has_current_caps(pad)) break;
      state.type.reset();
      state.info.reset();
      break;
    case GST_EVENT_CAPS:
      return HandleCaps(self, event);
    case GST_EVENT_SEGMENT:
      gst_adapter_clear(state.adapter.get());
      state.stamper.TakeSegment(event);
      return TRUE;
    case GST_EVENT_GAP:
      if (state.out_width > 0) {
        PushSegment(self);
        break;
      }
      gst_event_unref(event);  // dropped, because no caps have been sent
      return TRUE;
    case GST_EVENT_EOS:
      Drain(self);
      PushSegment(self);
      break;
    case GST_EVENT_SEGMENT_DONE:
      if (state.stamper.times_given()) break;
      Drain(self);
      PushSegment(self);
      return gst_pad_push_event(self->srcpad, state.stamper.timeline().EndInTime(event).release());
    case GST_EVENT_FLUSH_STOP: {
      gboolean restarts = FALSE;
      gst_event_parse_flush_stop(event, &restarts);
      gst_adapter_clear(state.adapter.get());
      state.stamper.Flush(restarts != FALSE);
      break;
    }
    default:
      break;
  }
  return gst_pad_event_default(pad, parent, event);
}

static gboolean SrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_POINT_CLOUD_PARSE(parent);
  if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK) {
    if (const auto done = self->state->stamper.timeline().Seek(self->sinkpad, event)) {
      gst_event_unref(event);
      return *done;
    }
  }
  return gst_pad_event_default(pad, parent, event);
}

static gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  auto* self = GST_LIDAR_POINT_CLOUD_PARSE(parent);
  return self->state->stamper.timeline().Answer(self->sinkpad, query) ||
         gst_pad_query_default(pad, parent, query);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  const auto result = GST_ELEMENT_CLASS(gst_lidar_point_cloud_parse_parent_class)
                          ->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    State& state = StateOf(element);
    gst_adapter_clear(state.adapter.get());
    state.stamper.Reset();
    state.file_size.reset();
    state.info.reset();
    state.type.reset();
    state.caps.reset();
    state.out_width = 0;
    state.discont = false;
    state.empty_reported = false;
    state.refused.Reset();
  }
  return result;
}

static void gst_lidar_point_cloud_parse_init(GstLidarPointCloudParse* self) {
  self->state = new State;
  self->sinkpad = AddPad(self, "sink");
  gst_pad_set_chain_function(self->sinkpad, Chain);
  gst_pad_set_event_function(self->sinkpad, SinkEvent);
  self->srcpad = AddPad(self, "src");
  gst_pad_use_fixed_caps(self->srcpad);
  gst_pad_set_event_function(self->srcpad, SrcEvent);
  gst_pad_set_query_function(self->srcpad, SrcQuery);
}

static void gst_lidar_point_cloud_parse_class_init(GstLidarPointCloudParseClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_point_cloud_parse_debug, "pointcloudparse", 0,
                          "Clouds from files");
  ServeState<GstLidarPointCloudParse, gst_lidar_point_cloud_parse_parent_class, kProperties>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  Describe(
      klass,
      {"Point cloud parser", "Codec/Parser/PointCloud",
       "Makes clouds of files: PCD, PLY, LAS, KITTI, raw points"},
      {{"sink", GST_PAD_SINK,
        GST_LIDAR_CLOUD_MEDIA_TYPE "; application/x-pcd; application/x-ply; application/vnd.las"},
       {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE}});
}

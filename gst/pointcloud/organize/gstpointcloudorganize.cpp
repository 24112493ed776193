// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pointcloudorganize
 *
 * Finds out how the sensor of an organised cloud is built, and adds ranges and sensor model, so
 * that lidarenc can code clouds of any spinning sensor. Each point is checked.
 *
 * |[
 * gst-launch-1.0 ros2src topic=/points ! pointcloudorganize ! lidarenc ! fakesink
 * ]|
 */
#include <gst/gst.h>

#include <mutex>
#include <optional>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/held_events.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "gst/pointcloud/organize/cloud_organizer.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_point_cloud_organize_debug);
#define GST_CAT_DEFAULT gst_lidar_point_cloud_organize_debug

namespace {

using namespace lidar::gst;

// Clouds that may pass before the first that fits: a sensor that starts in the open sees little.
constexpr guint kPatience = 10;

struct OrganizeSettings {
  gdouble max_error_m = 0.005;
};

struct Counters {
  guint64 clouds = 0;
  guint64 dropped = 0;
  guint64 outside = 0;
  guint models = 0;
};
const std::array<Stat<Counters>, 4> kStats = {{
    {"clouds", &Counters::clouds},
    {"clouds-dropped", &Counters::dropped},
    {"points-outside", &Counters::outside},
    {"models", &Counters::models},
}};

struct State {
  std::mutex mutex;  // guards settings and counters; never held while pushing or posting
  OrganizeSettings settings;
  Counters counters;

  // Only the streaming thread uses what follows.
  std::optional<CloudInfo> info;
  CapsPtr caps;                             // of the input
  std::optional<CloudOrganizer> organizer;  // none: clouds pass as they are
  guint attempts = 0;                       // since the last cloud that fitted
  guint models_sent = 0;                    // the model that the caps have; 0: caps are due
  bool caps_sent = false;
  HeldEvents held;
};

}  // namespace

#define GST_TYPE_LIDAR_POINT_CLOUD_ORGANIZE (gst_lidar_point_cloud_organize_get_type())
G_DECLARE_FINAL_TYPE(GstLidarPointCloudOrganize, gst_lidar_point_cloud_organize, GST,
                     LIDAR_POINT_CLOUD_ORGANIZE, GstElement)

struct _GstLidarPointCloudOrganize {
  GstElement parent;
  GstPad* sinkpad;
  GstPad* srcpad;
  State* state;
};

G_DEFINE_TYPE(GstLidarPointCloudOrganize, gst_lidar_point_cloud_organize, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(pointcloudorganize, "pointcloudorganize", GST_RANK_NONE,
                            GST_TYPE_LIDAR_POINT_CLOUD_ORGANIZE)

static State& StateOf(gpointer self) { return *GST_LIDAR_POINT_CLOUD_ORGANIZE(self)->state; }

static StructurePtr ReadStats(GObject* object) {
  State& state = StateOf(object);
  const std::lock_guard lock(state.mutex);
  return ToStructure("application/x-pointcloudorganize-stats", kStats, state.counters);
}

static const std::array<Property<OrganizeSettings>, 2> kProperties = {{
    {"max-error", "Points farther than that from their beam become missing returns [m]",
     &OrganizeSettings::max_error_m, 0.001, 1, GST_PARAM_MUTABLE_PLAYING},
    {"stats", "clouds, clouds-dropped, points-outside, models", ReadStats},
}};

static bool PushCaps(GstLidarPointCloudOrganize* self, GstCaps* caps) {
  State& state = *self->state;
  // A pad that flushes keeps no caps: they stay due.
  state.caps_sent = gst_pad_push_event(self->srcpad, gst_event_new_caps(caps));
  if (!state.caps_sent) return false;
  state.held.PushTo(self->srcpad);
  return true;
}

/// Clouds pass as they are from now on.
static void GiveUp(GstLidarPointCloudOrganize* self, const std::string& why) {
  State& state = *self->state;
  state.organizer.reset();
  state.caps_sent = false;  // they may be those of the model
  GST_ELEMENT_WARNING(
      self, STREAM, FORMAT,
      ("No beams were found in the clouds, which pass as they are: %s.", why.c_str()),
      ("dracoenc geometry=xyz codes them"));
}

/// The input's caps with what was found.
static bool PushModel(GstLidarPointCloudOrganize* self) {
  State& state = *self->state;
  const CapsPtr found(state.organizer->output().ToCaps());
  const CapsPtr caps(gst_caps_copy(state.caps.get()));
  GstStructure* to = gst_caps_get_structure(caps.get(), 0);
  const GstStructure* from = gst_caps_get_structure(found.get(), 0);
  for (const char* name : {"fields", "point-step", "is-dense", "sensor-model"})
    gst_structure_set_value(to, name, gst_structure_get_value(from, name));
  if (!PushCaps(self, caps.get())) return false;
  state.models_sent = state.organizer->models();
  return true;
}

static GstFlowReturn WithoutCaps(GstLidarPointCloudOrganize* self) {
  return GST_PAD_IS_FLUSHING(self->srcpad) ? GST_FLOW_FLUSHING : GST_FLOW_NOT_NEGOTIATED;
}

/// Null where the cloud does not fit.
static BufferPtr Organize(GstLidarPointCloudOrganize* self, GstBuffer* buffer) {
  State& state = *self->state;
  std::unique_lock lock(state.mutex);
  const gdouble max_error_m = state.settings.max_error_m;
  lock.unlock();
  BufferPtr out(gst_buffer_new_allocate(nullptr, state.organizer->output().FrameSize(), nullptr));
  std::optional<CloudOrganizer::Result> result;
  {
    const BufferMap from(buffer, GST_MAP_READ);
    BufferMap to(out.get(), GST_MAP_WRITE);
    if (from && to && from.size() == state.info->FrameSize())
      result = state.organizer->Organize(from.view(), max_error_m, to.data());
  }
  lock.lock();
  ++state.counters.clouds;
  state.counters.models = state.organizer->models();
  if (!result) return nullptr;
  state.counters.outside += result->outside;
  gst_buffer_copy_into(out.get(), buffer, GST_BUFFER_COPY_METADATA, 0, static_cast<gsize>(-1));
  return out;
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* raw) {
  auto* self = GST_LIDAR_POINT_CLOUD_ORGANIZE(parent);
  State& state = *self->state;
  BufferPtr buffer(raw);
  if (!state.info) return GST_FLOW_NOT_NEGOTIATED;
  GstLidarSlice slice;
  if (state.organizer && gst_lidar_buffer_get_slice(raw, &slice) && slice.slice_count > 1)
    GiveUp(self, "they are slices; put scanassembler in front");
  if (state.organizer) {
    BufferPtr out = Organize(self, raw);
    if (!out && ++state.attempts < kPatience) {
      const std::lock_guard lock(state.mutex);
      ++state.counters.dropped;
      return GST_FLOW_OK;
    }
    if (out) {
      state.attempts = 0;
      const bool due = !state.caps_sent || state.models_sent != state.organizer->models();
      if (due && !PushModel(self)) return WithoutCaps(self);
      return gst_pad_push(self->srcpad, out.release());
    }
    GiveUp(self, "their points do not lie on lines from one origin, in even columns");
  }
  if (!state.caps_sent && !PushCaps(self, state.caps.get())) return WithoutCaps(self);
  return gst_pad_push(self->srcpad, buffer.release());
}

static gboolean SetCaps(GstLidarPointCloudOrganize* self, GstCaps* caps) {
  State& state = *self->state;
  std::string why;
  state.info = CloudInfo::FromFrameCaps(caps, &why);
  if (!state.info) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("This is no cloud to organise: %s.", why.c_str()),
                      ("caps are %" GST_PTR_FORMAT, static_cast<gpointer>(caps)));
    return FALSE;
  }
  state.caps.reset(gst_caps_ref(caps));
  state.caps_sent = false;
  state.models_sent = 0;
  state.attempts = 0;
  state.organizer.reset();
  if (state.info->sensor_model) return TRUE;  // somebody knows better
  state.organizer = CloudOrganizer::Create(*state.info, &why);
  if (!state.organizer) GiveUp(self, why);
  return TRUE;
}

/// The caps wait for the first cloud, and what has to be behind them waits, too.
static gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_POINT_CLOUD_ORGANIZE(parent);
  State& state = *self->state;
  const GstEventType type = GST_EVENT_TYPE(event);
  if (type == GST_EVENT_CAPS) {
    const EventPtr owned(event);
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    return SetCaps(self, caps);
  }
  if (type == GST_EVENT_FLUSH_STOP) state.held.OnFlush();
  if (type == GST_EVENT_EOS && !state.caps_sent && state.caps) PushCaps(self, state.caps.get());
  if (!state.caps_sent && state.held.Take(event)) return TRUE;
  return gst_pad_event_default(pad, parent, event);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  State& state = StateOf(element);
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) {
    const std::lock_guard lock(state.mutex);
    state.counters = {};
  }
  const GstStateChangeReturn result = GST_ELEMENT_CLASS(gst_lidar_point_cloud_organize_parent_class)
                                          ->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.info.reset();
    state.caps.reset();
    state.organizer.reset();
    state.held.Clear();
    state.caps_sent = false;
  }
  return result;
}

static void gst_lidar_point_cloud_organize_init(GstLidarPointCloudOrganize* self) {
  self->state = new State;
  self->sinkpad = AddPad(self, "sink");
  gst_pad_set_chain_function(self->sinkpad, Chain);
  gst_pad_set_event_function(self->sinkpad, SinkEvent);
  self->srcpad = AddPad(self, "src");
  gst_pad_use_fixed_caps(self->srcpad);
}

static void gst_lidar_point_cloud_organize_class_init(GstLidarPointCloudOrganizeClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_point_cloud_organize_debug, "pointcloudorganize", 0,
                          "Beams of organised clouds");
  ServeState<GstLidarPointCloudOrganize, gst_lidar_point_cloud_organize_parent_class, kProperties>(
      klass);
  Describe(klass,
           {"Point cloud organizer", "Filter/Analyzer/PointCloud",
            "Finds the beams of the sensor in its clouds, and adds ranges"},
           {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE}});
  GST_ELEMENT_CLASS(klass)->change_state = ChangeState;
}

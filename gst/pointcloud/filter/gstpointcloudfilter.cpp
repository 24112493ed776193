// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pointcloudfilter
 *
 * Crops, thins, moves and converts clouds.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! scanassembler \
 *   ! pointcloudfilter crop-box="-20,-20,-1,20,20,4" voxel-size=0.2 invalid=remove ! fakesink
 * ]|
 */
#include <gst/gst.h>

#include <algorithm>
#include <mutex>
#include <string_view>

#include "gst/common/coordinate_frames.h"
#include "gst/common/element_class.h"
#include "gst/common/enum_type.h"
#include "gst/common/held_events.h"
#include "gst/common/latency.h"
#include "gst/common/properties.h"
#include "gst/common/refused_caps.h"
#include "gst/common/sink_pads.h"
#include "gst/common/stats.h"
#include "gst/lidar/gstlidar.h"
#include "gst/pointcloud/filter/frame_placer.h"
#include "gst/pointcloud/filter_plan.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_point_cloud_filter_debug);
#define GST_CAT_DEFAULT gst_lidar_point_cloud_filter_debug

namespace {

using namespace lidar::gst;
using lidar::InvalidPoints;

GType InvalidType() {
  static const GEnumValue values[] = {
      {Int(InvalidPoints::kKeep), "As they come; zero where they are taken out", "keep"},
      {Int(InvalidPoints::kZero), "All fields zero", "zero"},
      {Int(InvalidPoints::kNan), "NaN in x, y and z, zero in the others", "nan"},
      {Int(InvalidPoints::kRemove), "Not in the cloud, which loses its rows", "remove"},
      {0, nullptr, nullptr},
  };
  static const GType type = RegisterEnum("GstLidarInvalidPoints", values);
  return type;
}

struct Counters {
  guint64 clouds = 0;
  guint64 points_removed = 0;
  guint64 without_pose = 0;
  guint64 without_transform = 0;
  guint64 transforms = 0;
  guint64 transforms_refused = 0;
};
const std::array<Stat<Counters>, 6> kStats = {{
    {"clouds", &Counters::clouds},
    {"points-removed", &Counters::points_removed},
    {"clouds-without-pose", &Counters::without_pose},
    {"clouds-without-transform", &Counters::without_transform},
    {"transforms", &Counters::transforms},
    {"transforms-refused", &Counters::transforms_refused},
}};

constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;

struct State {
  std::mutex mutex;  // guards settings, changed and counters
  FilterSettings settings;
  bool changed = false;  // true if the settings have changed since the plan was made
  Counters counters;
  FramePlacer placer;
  // The members below are used by the streaming thread only.
  CapsPtr caps;  // caps of the input
  std::unique_ptr<FilterPlan> plan;
  Counters before;  // counts of earlier plans
  CapsPtr pushed;
  HeldEvents held;
  RefusedCaps refused;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarPointCloudFilter, gst_lidar_point_cloud_filter, GST,
                     LIDAR_POINT_CLOUD_FILTER, GstElement)
struct _GstLidarPointCloudFilter {
  GstElement parent;
  GstPad* sinkpad;
  GstPad* srcpad;
  guint64 next_pad;  // number of the next pad tf_%u
  State* state;
};

G_DEFINE_TYPE(GstLidarPointCloudFilter, gst_lidar_point_cloud_filter, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(pointcloudfilter, "pointcloudfilter", GST_RANK_NONE,
                            gst_lidar_point_cloud_filter_get_type())

static StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_POINT_CLOUD_FILTER(object)->state;
  const TransformInbox::Counters taken = state.placer.inbox().counters();
  std::lock_guard lock(state.mutex);
  Counters counters = state.counters;
  counters.without_transform = state.placer.clouds_without();
  counters.transforms = taken.transforms;
  counters.transforms_refused = taken.refused;
  return ToStructure("point-cloud-filter-stats", kStats, counters);
}

static const std::array<Property<FilterSettings>, 15> kProperties = {{
    {"fields", "Fields to keep, each optionally with a new type: x,y,z,intensity:U8",
     &FilterSettings::fields, 0, 0, kLive},
    {"beam-step", "Keep every n-th row", &FilterSettings::beam_step, 1, 1024, kLive},
    {"column-step", "Keep every n-th column of the scan", &FilterSettings::column_step, 1, 16384,
     kLive},
    {"min-range", "Remove points nearer than this [m]", &FilterSettings::min_range, 0, 1e6, kLive},
    {"max-range", "Remove points farther than this; 0: no limit [m]", &FilterSettings::max_range, 0,
     1e6, kLive},
    {"apply-pose",
     "Move clouds into the frame in which the odometry began, by the pose that lidarodometry "
     "attached; clouds without a pose are dropped",
     &FilterSettings::apply_pose, 0, 0, kLive},
    {"target-frame",
     "Move clouds into this frame, by the transforms that arrive on the pads tf_%u; clouds without "
     "a transform are dropped",
     &FilterSettings::target_frame, 0, 0, kLive},
    {"frame-id", "Frame of the clouds; NULL: the frame in the caps, or lidar",
     &FilterSettings::frame_id, 0, 0, kLive},
    {"tf-timeout", "Longest time that a cloud waits for the transform at its time [ns]",
     &FilterSettings::tf_timeout, 0, 60e9, kLive},
    {"transform",
     "Transform of the points: 16 numbers row by row, or x, y, z [m], roll, pitch, yaw [degrees]",
     &FilterSettings::transform, 0, 0, kLive},
    {"crop-box",
     "Box of points to keep: the least x, y, z, then the largest, after the transform [m]",
     &FilterSettings::crop_box, 0, 0, kLive},
    {"crop-inside", "Remove the points inside of crop-box instead of those outside",
     &FilterSettings::crop_inside, 0, 0, kLive},
    {"voxel-size", "Keep one point in each cube of this edge; 0: all points [m]",
     &FilterSettings::voxel_size, 0, 1e3, kLive},
    {"invalid", "What replaces points without a return and removed points",
     EnumField<FilterSettings, InvalidPoints>{&FilterSettings::invalid, InvalidType}, 0, 0, kLive},
    {"stats",
     "clouds, points-removed, clouds-without-pose, clouds-without-transform, transforms, "
     "transforms-refused",
     Stats},
}};

static void NoteChange(GObject* object, GParamSpec* spec) {
  State& state = *GST_LIDAR_POINT_CLOUD_FILTER(object)->state;
  {
    std::lock_guard lock(state.mutex);
    state.changed = true;
  }
  const std::string_view name = spec->name;
  if (name == "target-frame" || name == "tf-timeout") PostNewLatency(object);
}

/// Makes a plan for the current caps and settings. If that fails, posts an error and returns false.
static bool MakePlan(GstLidarPointCloudFilter* self) {
  State& state = *self->state;
  FilterSettings settings;
  {
    std::lock_guard lock(state.mutex);
    settings = state.settings;
    state.changed = false;
  }
  std::string why;
  if (state.plan) {
    state.before.points_removed += state.plan->removed();
    state.before.without_pose += state.plan->without_pose();
  }
  state.plan = FilterPlan::Make(settings, state.caps.get(), &why);
  state.placer.SetTarget(settings.target_frame, settings.tf_timeout);
  if (state.plan)
    state.refused.Reset();
  else if (state.refused.Note(state.caps.get()))
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("These clouds cannot be filtered: %s.", why.c_str()),
                      ("%" GST_PTR_FORMAT, static_cast<gpointer>(state.caps.get())));
  return state.plan != nullptr;
}

static void PushCaps(GstLidarPointCloudFilter* self) {
  State& state = *self->state;
  GstCaps* caps = state.plan->caps();
  if (state.pushed && gst_caps_is_equal(state.pushed.get(), caps)) return;
  state.pushed.reset(gst_caps_ref(caps));
  state.held.PushCapsTo(self->srcpad, caps);
}

static void Count(State* state) {
  std::lock_guard lock(state->mutex);
  ++state->counters.clouds;
  state->counters.points_removed = state->before.points_removed + state->plan->removed();
  state->counters.without_pose = state->before.without_pose + state->plan->without_pose();
}

static void PushGap(GstLidarPointCloudFilter* self, GstBuffer* buffer) {
  if (self->state->pushed && GST_BUFFER_PTS_IS_VALID(buffer))
    gst_pad_push_event(self->srcpad,
                       gst_event_new_gap(GST_BUFFER_PTS(buffer), GST_BUFFER_DURATION(buffer)));
}

static GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* raw) {
  auto* self = GST_LIDAR_POINT_CLOUD_FILTER(parent);
  State& state = *self->state;
  const BufferPtr buffer(raw);
  if (!state.caps) return GST_FLOW_NOT_NEGOTIATED;
  bool changed = false;
  {
    std::lock_guard lock(state.mutex);
    changed = state.changed;
  }
  if ((changed || !state.plan) && !MakePlan(self)) return GST_FLOW_NOT_NEGOTIATED;
  std::optional<lidar::Transform> placed;
  const GstFlowReturn flow =
      state.placer.Place(GST_ELEMENT(self), raw, state.plan->frame(), &placed);
  if (flow != GST_FLOW_OK) return flow;
  BufferPtr out = placed ? state.plan->Apply(raw, *placed) : BufferPtr(gst_buffer_new());
  if (!out) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("A buffer does not match its caps."),
                      ("it has %" G_GSIZE_FORMAT " bytes, caps are %" GST_PTR_FORMAT,
                       gst_buffer_get_size(raw), static_cast<gpointer>(state.caps.get())));
    return GST_FLOW_ERROR;
  }
  Count(&state);
  if (gst_buffer_get_size(out.get()) == 0) {
    PushGap(self, raw);
    return GST_FLOW_OK;
  }
  PushCaps(self);
  return gst_pad_push(self->srcpad, out.release());
}

static gboolean HandleCaps(GstLidarPointCloudFilter* self, GstEvent* event) {
  const EventPtr owner(event);
  GstCaps* caps = nullptr;
  gst_event_parse_caps(event, &caps);
  self->state->caps.reset(gst_caps_ref(caps));
  return MakePlan(self);
}

static gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_POINT_CLOUD_FILTER(parent);
  State& state = *self->state;
  const GstEventType type = GST_EVENT_TYPE(event);
  if (type == GST_EVENT_CAPS) return HandleCaps(self, event);
  if (type == GST_EVENT_FLUSH_START) state.placer.inbox().Interrupt(true);
  if (type == GST_EVENT_EOS) state.held.PushTo(self->srcpad);
  if (type == GST_EVENT_FLUSH_STOP) {
    state.held.OnFlush();
    state.placer.inbox().Interrupt(false);
  }
  if (!state.pushed && state.held.Take(event)) return TRUE;
  return gst_pad_event_default(pad, parent, event);
}

/// Answers a query. The latency includes the time for which a cloud may wait for its transform.
static gboolean SrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (!gst_pad_query_default(pad, parent, query)) return FALSE;
  if (GST_QUERY_TYPE(query) != GST_QUERY_LATENCY || !ReadLatency(query).live) return TRUE;
  State& state = *GST_LIDAR_POINT_CLOUD_FILTER(parent)->state;
  std::unique_lock lock(state.mutex);
  const bool waits = !state.settings.target_frame.empty();
  const auto longest = static_cast<GstClockTime>(state.settings.tf_timeout.count());
  lock.unlock();
  if (waits) AddLatency(query, longest);
  return TRUE;
}

/// Links only the pads sink and src with each other. So queries and events of the cloud stream are
/// not forwarded to the elements that send transforms.
static GstIterator* LinksOf(GstPad* pad, GstObject* parent) {
  auto* self = GST_LIDAR_POINT_CLOUD_FILTER(parent);
  return LinkTo(pad == self->srcpad ? self->sinkpad : self->srcpad);
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* pad_template, const gchar* name,
                          const GstCaps*) {
  auto* self = GST_LIDAR_POINT_CLOUD_FILTER(element);
  GST_OBJECT_LOCK(self);
  // A pad that is requested by name gets this name. Later pads that are requested without a name
  // get higher numbers.
  guint64 number = self->next_pad;
  if (name != nullptr) g_ascii_string_to_unsigned(name + 3, 10, 0, G_MAXUINT, &number, nullptr);
  self->next_pad = std::max(self->next_pad, number + 1);
  GST_OBJECT_UNLOCK(self);
  const std::string chosen = "tf_" + std::to_string(number);
  return self->state->placer.inbox().AddPad(element, pad_template, chosen.c_str());
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  GST_LIDAR_POINT_CLOUD_FILTER(element)->state->placer.inbox().ReleasePad(element, pad);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  TransformInbox& inbox = GST_LIDAR_POINT_CLOUD_FILTER(element)->state->placer.inbox();
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED) inbox.Interrupt(false);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) inbox.Interrupt(true);
  const auto result = GST_ELEMENT_CLASS(gst_lidar_point_cloud_filter_parent_class)
                          ->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    State& state = *GST_LIDAR_POINT_CLOUD_FILTER(element)->state;
    state.caps.reset();
    state.plan.reset();
    state.pushed.reset();
    state.held.Clear();
    state.refused.Reset();
    state.before = {};
    state.placer.Clear();
    std::lock_guard lock(state.mutex);
    state.counters = {};
  }
  return result;
}

static void gst_lidar_point_cloud_filter_init(GstLidarPointCloudFilter* self) {
  self->state = new State;
  self->sinkpad = AddPad(self, "sink");
  gst_pad_set_chain_function(self->sinkpad, Chain);
  gst_pad_set_event_function(self->sinkpad, SinkEvent);
  gst_pad_set_iterate_internal_links_function(self->sinkpad, LinksOf);
  self->srcpad = AddPad(self, "src");
  gst_pad_use_fixed_caps(self->srcpad);
  gst_pad_set_query_function(self->srcpad, SrcQuery);
  gst_pad_set_iterate_internal_links_function(self->srcpad, LinksOf);
}

static void gst_lidar_point_cloud_filter_class_init(GstLidarPointCloudFilterClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_point_cloud_filter_debug, "pointcloudfilter", 0,
                          "Clouds, cropped and thinned");
  ServeState<GstLidarPointCloudFilter, gst_lidar_point_cloud_filter_parent_class, kProperties,
             NoteChange>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->request_new_pad = RequestPad;
  element->release_pad = ReleasePad;
  Describe(klass,
           {"Point cloud filter", "Filter/PointCloud", "Crops, thins, moves and converts clouds"},
           {{"sink", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE},
            {"tf_%u", GST_PAD_SINK, GST_LIDAR_TF_MEDIA_TYPE "; " GST_LIDAR_ODOMETRY_MEDIA_TYPE,
             GST_PAD_REQUEST}});
}

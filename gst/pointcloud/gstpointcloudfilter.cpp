// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pointcloudfilter
 *
 * Crops, thins, moves and converts clouds.
 *
 * |[
 * gst-launch-1.0 lidartestsrc num-buffers=80 ! scanassembler
 *   ! pointcloudfilter crop-box="-20,-20,-1,20,20,4" voxel-size=0.2 invalid=remove ! fakesink
 * ]|
 */
#include "gst/pointcloud/gstpointcloudfilter.h"

#include <mutex>
#include <utility>
#include <vector>

#include "gst/common/enum_type.h"
#include "gst/common/gstlidar.h"
#include "gst/common/properties.h"
#include "gst/common/refused_caps.h"
#include "gst/common/stats.h"
#include "gst/pointcloud/filter_plan.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_point_cloud_filter_debug);
#define GST_CAT_DEFAULT gst_lidar_point_cloud_filter_debug

namespace {

using lidar::InvalidPoints;
using lidar::gst::BufferPtr;
using lidar::gst::CapsPtr;
using lidar::gst::FilterPlan;
using lidar::gst::FilterSettings;
using lidar::gst::Int;

GType InvalidType() {
  static const GEnumValue values[] = {
      {Int(InvalidPoints::kKeep), "As they come; zero where they are taken out", "keep"},
      {Int(InvalidPoints::kZero), "All fields zero", "zero"},
      {Int(InvalidPoints::kNan), "NaN in x, y and z, zero in the others", "nan"},
      {Int(InvalidPoints::kRemove), "Not in the cloud, which loses its rows", "remove"},
      {0, nullptr, nullptr},
  };
  static const GType type = lidar::gst::RegisterEnum("GstLidarInvalidPoints", values);
  return type;
}

struct Counters {
  guint64 clouds = 0;
  guint64 points_removed = 0;
  guint64 without_pose = 0;
};
const std::array<lidar::gst::Stat<Counters>, 3> kStats = {{
    {"clouds", &Counters::clouds},
    {"points-removed", &Counters::points_removed},
    {"clouds-without-pose", &Counters::without_pose},
}};

lidar::gst::StructurePtr Stats(GObject* object);
constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;

const std::array<lidar::gst::Property<FilterSettings>, 12> kProperties = {{
    {"fields", "Fields to keep, with a type where it is to be another: x,y,z,intensity:U8",
     &FilterSettings::fields, 0, 0, kLive},
    {"beam-step", "Keep every n-th row", &FilterSettings::beam_step, 1, 1024, kLive},
    {"column-step", "Keep every n-th column of the scan", &FilterSettings::column_step, 1, 16384,
     kLive},
    {"min-range", "What is nearer goes [m]", &FilterSettings::min_range, 0, 1e6, kLive},
    {"max-range", "What is farther goes; 0: no limit [m]", &FilterSettings::max_range, 0, 1e6,
     kLive},
    {"apply-pose",
     "Clouds go to where the odometry began, by the pose that lidarodometry put on them; those "
     "without one go",
     &FilterSettings::apply_pose, 0, 0, kLive},
    {"transform",
     "Of the points: 16 numbers row by row, or x, y, z [m], roll, pitch, yaw [degrees]",
     &FilterSettings::transform, 0, 0, kLive},
    {"crop-box", "What is outside goes: the least x, y, z, then the largest, as transformed [m]",
     &FilterSettings::crop_box, 0, 0, kLive},
    {"crop-inside", "What is inside of crop-box goes, instead", &FilterSettings::crop_inside, 0, 0,
     kLive},
    {"voxel-size", "One point in each cube of this edge stays; 0: all [m]",
     &FilterSettings::voxel_size, 0, 1e3, kLive},
    {"invalid", "What becomes of points without a return, and of those that go",
     lidar::gst::EnumField<FilterSettings, InvalidPoints>{&FilterSettings::invalid, InvalidType}, 0,
     0, kLive},
    {"stats", "clouds, points-removed, clouds-without-pose", Stats},
}};

struct State {
  std::mutex mutex;  // guards settings, changed and counters
  FilterSettings settings;
  bool changed = false;  // the settings, since the plan was made
  Counters counters;
  // Only the streaming thread uses these.
  CapsPtr caps;  // of what comes
  std::unique_ptr<FilterPlan> plan;
  Counters before;  // of earlier plans
  CapsPtr pushed;
  std::vector<lidar::gst::EventPtr> pending;  // sticky, to follow the first caps
  lidar::gst::RefusedCaps refused;
};

}  // namespace

struct _GstLidarPointCloudFilter {
  GstElement parent;
  GstPad* srcpad;
  State* state;
};

G_DEFINE_TYPE(GstLidarPointCloudFilter, gst_lidar_point_cloud_filter, GST_TYPE_ELEMENT)
GST_ELEMENT_REGISTER_DEFINE(pointcloudfilter, "pointcloudfilter", GST_RANK_NONE,
                            GST_TYPE_LIDAR_POINT_CLOUD_FILTER)

namespace {

lidar::gst::StructurePtr Stats(GObject* object) {
  State& state = *GST_LIDAR_POINT_CLOUD_FILTER(object)->state;
  std::lock_guard lock(state.mutex);
  return lidar::gst::ToStructure("point-cloud-filter-stats", kStats, state.counters);
}

void NoteChange(GObject* object, GParamSpec*) {
  State& state = *GST_LIDAR_POINT_CLOUD_FILTER(object)->state;
  std::lock_guard lock(state.mutex);
  state.changed = true;
}

/// A plan for the caps and the settings of now; false and an error where there is none.
bool MakePlan(GstLidarPointCloudFilter* self) {
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
  if (!state.plan && state.refused.Note(state.caps.get()))
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("Clouds cannot be filtered so: %s.", why.c_str()),
                      ("%" GST_PTR_FORMAT, static_cast<gpointer>(state.caps.get())));
  return state.plan != nullptr;
}

void PushPending(GstLidarPointCloudFilter* self) {
  for (auto& event : std::exchange(self->state->pending, {}))
    gst_pad_push_event(self->srcpad, event.release());
}

bool PushCaps(GstLidarPointCloudFilter* self) {
  State& state = *self->state;
  GstCaps* caps = state.plan->caps();
  if (state.pushed && gst_caps_is_equal(state.pushed.get(), caps)) return true;
  state.pushed.reset(gst_caps_ref(caps));
  const bool taken = gst_pad_push_event(self->srcpad, gst_event_new_caps(caps)) != FALSE;
  PushPending(self);
  return taken;
}

void Count(State* state) {
  std::lock_guard lock(state->mutex);
  ++state->counters.clouds;
  state->counters.points_removed = state->before.points_removed + state->plan->removed();
  state->counters.without_pose = state->before.without_pose + state->plan->without_pose();
}

GstFlowReturn Chain(GstPad*, GstObject* parent, GstBuffer* raw) {
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
  BufferPtr out = state.plan->Apply(raw);
  if (!out) {
    GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("A cloud of another size than its caps say."),
                      (nullptr));
    return GST_FLOW_ERROR;
  }
  Count(&state);
  if (gst_buffer_get_size(out.get()) == 0) {
    if (state.pushed && GST_BUFFER_PTS_IS_VALID(raw))
      gst_pad_push_event(self->srcpad,
                         gst_event_new_gap(GST_BUFFER_PTS(raw), GST_BUFFER_DURATION(raw)));
    return GST_FLOW_OK;
  }
  if (!PushCaps(self))
    return GST_PAD_IS_FLUSHING(self->srcpad) ? GST_FLOW_FLUSHING : GST_FLOW_NOT_NEGOTIATED;
  return gst_pad_push(self->srcpad, out.release());
}

gboolean HandleCaps(GstLidarPointCloudFilter* self, GstEvent* event) {
  const lidar::gst::EventPtr owner(event);
  GstCaps* caps = nullptr;
  gst_event_parse_caps(event, &caps);
  self->state->caps.reset(gst_caps_ref(caps));
  return MakePlan(self);
}

gboolean SinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  auto* self = GST_LIDAR_POINT_CLOUD_FILTER(parent);
  State& state = *self->state;
  const GstEventType type = GST_EVENT_TYPE(event);
  if (type == GST_EVENT_CAPS) return HandleCaps(self, event);
  if (type == GST_EVENT_EOS) PushPending(self);
  if (type == GST_EVENT_FLUSH_STOP) state.pending.clear();
  // Caps come first, with the first cloud, and before them a gap means nothing.
  if (type == GST_EVENT_GAP && !state.pushed) {
    gst_event_unref(event);
    return TRUE;
  }
  const bool waits = GST_EVENT_IS_STICKY(event) && type > GST_EVENT_CAPS && type != GST_EVENT_EOS;
  if (state.pushed || !waits) return gst_pad_event_default(pad, parent, event);
  state.pending.emplace_back(event);
  return TRUE;
}

GstStateChangeReturn ChangeState(GstElement* element, GstStateChange transition) {
  const auto result = GST_ELEMENT_CLASS(gst_lidar_point_cloud_filter_parent_class)
                          ->change_state(element, transition);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_READY) {
    State& state = *GST_LIDAR_POINT_CLOUD_FILTER(element)->state;
    state.caps.reset();
    state.plan.reset();
    state.pushed.reset();
    state.pending.clear();
    state.refused.Reset();
    state.before = {};
    std::lock_guard lock(state.mutex);
    state.counters = {};
  }
  return result;
}

}  // namespace

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));

static void gst_lidar_point_cloud_filter_init(GstLidarPointCloudFilter* self) {
  self->state = new State;
  GstPad* sinkpad = gst_pad_new_from_static_template(&sink_template, "sink");
  gst_pad_set_chain_function(sinkpad, Chain);
  gst_pad_set_event_function(sinkpad, SinkEvent);
  gst_element_add_pad(GST_ELEMENT(self), sinkpad);
  self->srcpad = gst_pad_new_from_static_template(&src_template, "src");
  gst_pad_use_fixed_caps(self->srcpad);
  gst_element_add_pad(GST_ELEMENT(self), self->srcpad);
}

static void gst_lidar_point_cloud_filter_class_init(GstLidarPointCloudFilterClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_point_cloud_filter_debug, "pointcloudfilter", 0,
                          "Clouds, cropped and thinned");
  auto* object = G_OBJECT_CLASS(klass);
  lidar::gst::OwnState<GstLidarPointCloudFilter, gst_lidar_point_cloud_filter_parent_class>(object);
  lidar::gst::ServeProperties<GstLidarPointCloudFilter, kProperties, NoteChange>(object);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_set_static_metadata(element, "Point cloud filter", "Filter/PointCloud",
                                        "Crops, thins, moves and converts clouds", "gst-lidar");
}

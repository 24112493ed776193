// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-pointcloudmerge
 *
 * Makes one cloud of the scans of several sensors.
 *
 * |[
 * gst-launch-1.0 pointcloudmerge name=m sink_1::transform="-2,0,0,0,0,180" \
 *   ! fakesink \
 *   lidartestsrc num-buffers=80 ! scanassembler ! m. \
 *   lidartestsrc num-buffers=80 ! scanassembler ! m.
 * ]|
 */
#include <gst/base/gstaggregator.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/sink_pads.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "gst/pointcloud/filter_plan.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_point_cloud_merge_debug);
#define GST_CAT_DEFAULT gst_lidar_point_cloud_merge_debug

G_DECLARE_FINAL_TYPE(GstLidarPointCloudMergePad, gst_lidar_point_cloud_merge_pad, GST,
                     LIDAR_POINT_CLOUD_MERGE_PAD, GstAggregatorPad)

namespace {

using namespace lidar::gst;

struct MergePadSettings {
  std::string transform;
};

const std::array<Property<MergePadSettings>, 1> kPadProperties = {{
    {"transform",
     "From the sensor to the common frame: 16 numbers row by row, or x, y, z [m], roll, pitch, yaw "
     "[degrees]",
     &MergePadSettings::transform, 0, 0, GST_PARAM_MUTABLE_PLAYING},
}};

/// The settings of a sink pad, and the plan that converts its clouds to the common frame and
/// fields.
struct MergePadState {
  std::mutex mutex;  // guards the settings
  MergePadSettings settings;
  // The members below are used by the aggregating thread only.
  CapsPtr caps;
  std::unique_ptr<FilterPlan> plan;
  std::string plan_transform;
  std::string plan_fields;
  std::string own_fields;  // fields of the pad's clouds; empty if not known
};

/// The assumed duration of a scan that has none. Scans whose times differ by more are not merged.
constexpr GstClockTime kUsualScan = 100 * GST_MSECOND;

struct Head {
  GstLidarPointCloudMergePad* pad = nullptr;
  GstClockTime time = 0;  // running time
  GstClockTime duration = 0;
};

/// The merged cloud that is pushed next.
struct Merged {
  std::vector<std::uint8_t> points;
  std::string fields;  // the fields of the first pad's clouds
  GstClockTime time = GST_CLOCK_TIME_NONE;
  GstClockTime duration = 0;
  GstClockTime capture_time = GST_CLOCK_TIME_NONE;
};

struct State {
  CapsPtr pushed;
  bool slices_reported = false;
};

}  // namespace

struct _GstLidarPointCloudMergePad {
  GstAggregatorPad parent;
  MergePadState* state;
};

G_DEFINE_TYPE(GstLidarPointCloudMergePad, gst_lidar_point_cloud_merge_pad, GST_TYPE_AGGREGATOR_PAD)

// The functions of a pad must be called by the aggregating thread.

static void MergePadSetCaps(GstLidarPointCloudMergePad* pad, GstCaps* caps) {
  pad->state->caps.reset(gst_caps_ref(caps));
  pad->state->plan.reset();
  std::string ignored;
  const auto own = FilterPlan::Make({}, caps, &ignored);
  pad->state->own_fields = own ? own->fields() : "";
}

static void MergePadForget(GstLidarPointCloudMergePad* pad) {
  pad->state->caps.reset();
  pad->state->plan.reset();
  pad->state->own_fields.clear();
}

/// Converts the returns in `buffer` to the common frame and to the given fields. If that fails,
/// returns null and sets `why` to a reason for the user.
static BufferPtr MergePadRead(GstLidarPointCloudMergePad* pad, GstBuffer* buffer,
                              const std::string& fields, std::string* why) {
  MergePadState& state = *pad->state;
  FilterSettings settings;
  settings.fields = fields;
  settings.invalid = lidar::InvalidPoints::kRemove;
  {
    std::lock_guard lock(state.mutex);
    settings.transform = state.settings.transform;
  }
  *why = "the caps are missing";
  if (!state.caps) return nullptr;
  *why = "they have no timestamps; pointcloudparse adds them";
  if (GST_AGGREGATOR_PAD(pad)->segment.format != GST_FORMAT_TIME) return nullptr;
  if (!state.plan || state.plan_transform != settings.transform || state.plan_fields != fields) {
    state.plan = FilterPlan::Make(settings, state.caps.get(), why);
    state.plan_transform = settings.transform;
    state.plan_fields = fields;
  }
  if (!state.plan) return nullptr;
  *why = "a buffer does not match its caps";
  return state.plan->Apply(buffer);
}

static void gst_lidar_point_cloud_merge_pad_init(GstLidarPointCloudMergePad* self) {
  self->state = new MergePadState;
}

static void gst_lidar_point_cloud_merge_pad_class_init(GstLidarPointCloudMergePadClass* klass) {
  ServeState<GstLidarPointCloudMergePad, gst_lidar_point_cloud_merge_pad_parent_class,
             kPadProperties>(klass);
}

G_DECLARE_FINAL_TYPE(GstLidarPointCloudMerge, gst_lidar_point_cloud_merge, GST,
                     LIDAR_POINT_CLOUD_MERGE, GstAggregator)
struct _GstLidarPointCloudMerge {
  GstAggregator parent;
  State* state;
};

G_DEFINE_TYPE_WITH_CODE(GstLidarPointCloudMerge, gst_lidar_point_cloud_merge, GST_TYPE_AGGREGATOR,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_CHILD_PROXY, ServeSinkPads))
GST_ELEMENT_REGISTER_DEFINE(pointcloudmerge, "pointcloudmerge", GST_RANK_NONE,
                            gst_lidar_point_cloud_merge_get_type())

/// Returns the sink pads in the order of the element's list, with a reference to each.
static std::vector<PadPtr> Pads(GstAggregator* base) {
  std::vector<PadPtr> pads;
  GST_OBJECT_LOCK(base);
  for (GList* pad = GST_ELEMENT(base)->sinkpads; pad != nullptr; pad = pad->next)
    pads.emplace_back(GST_PAD(gst_object_ref(pad->data)));
  GST_OBJECT_UNLOCK(base);
  return pads;
}

/// Returns the fields of the first pad whose fields are known, even if this pad has no scan now.
static std::string FieldsOfFirst(const std::vector<PadPtr>& pads) {
  for (const auto& owner : pads) {
    const auto& fields = GST_LIDAR_POINT_CLOUD_MERGE_PAD(owner.get())->state->own_fields;
    if (!fields.empty()) return fields;
  }
  return "";
}

/// Returns the running time of the buffer, or 0 if the buffer has no time.
static GstClockTime RunningTime(GstAggregatorPad* pad, GstBuffer* buffer) {
  if (pad->segment.format != GST_FORMAT_TIME) return 0;
  const GstClockTime time =
      gst_segment_to_running_time(&pad->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer));
  return GST_CLOCK_TIME_IS_VALID(time) ? time : 0;
}

/// Returns the first queued buffer of each pad that has a buffer.
static std::vector<Head> Heads(const std::vector<PadPtr>& pads) {
  std::vector<Head> heads;
  for (const auto& owner : pads) {
    auto* pad = GST_AGGREGATOR_PAD(owner.get());
    const BufferPtr buffer(gst_aggregator_pad_peek_buffer(pad));
    if (!buffer) continue;
    // A duration of 0 counts as unknown. Otherwise even the newest scan would be dropped as too
    // old.
    const GstClockTime duration = GST_BUFFER_DURATION(buffer.get());
    const bool known = GST_CLOCK_TIME_IS_VALID(duration) && duration > 0;
    heads.push_back({GST_LIDAR_POINT_CLOUD_MERGE_PAD(pad), RunningTime(pad, buffer.get()),
                     known ? duration : kUsualScan});
  }
  return heads;
}

/// Drops scans that end before the newest scan begins. Returns true if there were any.
static bool DropOld(GstLidarPointCloudMerge* self, const std::vector<Head>& heads) {
  GstClockTime newest = 0;
  for (const Head& head : heads) newest = std::max(newest, head.time);
  bool dropped = false;
  for (const Head& head : heads) {
    if (head.time + head.duration > newest) continue;
    GST_DEBUG_OBJECT(self, "dropping a scan of %" GST_TIME_FORMAT, GST_TIME_ARGS(head.time));
    dropped = gst_aggregator_pad_drop_buffer(GST_AGGREGATOR_PAD(head.pad)) || dropped;
  }
  return dropped;
}

/// Warns if slices arrive. Slices are not synchronised, so merged slices would show unrelated parts
/// of the turn.
static void ReportSlices(GstLidarPointCloudMerge* self, GstBuffer* buffer) {
  GstLidarSlice slice{};
  if (self->state->slices_reported || !gst_lidar_buffer_get_slice(buffer, &slice) ||
      slice.slice_count < 2)
    return;
  self->state->slices_reported = true;
  GST_ELEMENT_WARNING(self, STREAM, FORMAT, ("Slices arrive instead of whole scans."),
                      ("Put scanassembler in front of each pad."));
}

static bool AddCloud(GstLidarPointCloudMerge* self, const Head& head, Merged* merged) {
  const BufferPtr buffer(gst_aggregator_pad_pop_buffer(GST_AGGREGATOR_PAD(head.pad)));
  if (!buffer) return true;
  // The base class converts a GAP event to an empty buffer.
  if (gst_buffer_get_size(buffer.get()) == 0 &&
      GST_BUFFER_FLAG_IS_SET(buffer.get(), GST_BUFFER_FLAG_GAP))
    return true;
  ReportSlices(self, buffer.get());
  std::string why;
  const BufferPtr cloud = MergePadRead(head.pad, buffer.get(), merged->fields, &why);
  if (!cloud) {
    GST_ELEMENT_ERROR(
        self, STREAM, FORMAT,
        ("The clouds of the pad %s cannot be merged: %s.", GST_PAD_NAME(head.pad), why.c_str()),
        (nullptr));
    return false;
  }
  const BufferMap map(cloud.get(), GST_MAP_READ);
  if (map) merged->points.insert(merged->points.end(), map.view().begin(), map.view().end());
  if (GST_CLOCK_TIME_IS_VALID(merged->time) && merged->time <= head.time) return true;
  merged->time = head.time;
  merged->duration = head.duration;
  merged->capture_time = gst_lidar_buffer_get_capture_time(buffer.get());
  return true;
}

/// Sets the time of the output if all pads had gaps, for example because filters removed all
/// points.
static void TakeTimeOfGaps(const std::vector<Head>& heads, Merged* merged) {
  const auto first = std::min_element(heads.begin(), heads.end(),
                                      [](const Head& a, const Head& b) { return a.time < b.time; });
  merged->time = first->time;
  merged->duration = first->duration;
}

/// Sends new caps if the number of points or the fields have changed since the last cloud.
static void SetCaps(GstLidarPointCloudMerge* self, const Merged& merged,
                    const lidar::PointFields& fields) {
  CloudInfo info;
  info.fields = fields;
  info.point_step = fields.MinimumStep();
  info.width = static_cast<guint>(merged.points.size() / info.point_step);
  info.is_dense = true;
  CapsPtr caps(info.ToCaps());
  if (self->state->pushed && gst_caps_is_equal(self->state->pushed.get(), caps.get())) return;
  gst_aggregator_set_src_caps(GST_AGGREGATOR(self), caps.get());
  self->state->pushed = std::move(caps);
}

/// Pushes a GAP event, so that downstream does not wait for a cloud. Before the first cloud and
/// after a flush the pad has no segment, so nothing is pushed.
static void PushGap(GstPad* pad, GstClockTime pts, GstClockTime duration) {
  const EventPtr segment(gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0));
  if (segment && GST_CLOCK_TIME_IS_VALID(pts))
    gst_pad_push_event(pad, gst_event_new_gap(pts, duration));
}

static GstFlowReturn Push(GstLidarPointCloudMerge* self, Merged merged) {
  auto* base = GST_AGGREGATOR(self);
  GstSegment& segment = GST_AGGREGATOR_PAD(base->srcpad)->segment;
  // The segment after a seek begins at the target of the seek, and its running time there is 0.
  const GstClockTime pts =
      gst_segment_position_from_running_time(&segment, GST_FORMAT_TIME, merged.time);
  if (GST_CLOCK_TIME_IS_VALID(pts)) segment.position = pts + merged.duration;
  const auto fields = lidar::PointFields::Parse(merged.fields);
  if (merged.points.empty() || !fields) {
    PushGap(base->srcpad, pts, merged.duration);
    return GST_FLOW_OK;
  }
  SetCaps(self, merged, *fields);
  GstBuffer* out = gst_buffer_new_memdup(merged.points.data(), merged.points.size());
  GST_BUFFER_PTS(out) = pts;
  GST_BUFFER_DURATION(out) = merged.duration;
  if (GST_CLOCK_TIME_IS_VALID(merged.capture_time))
    gst_lidar_buffer_set_capture_time(out, merged.capture_time);
  return gst_aggregator_finish_buffer(base, out);
}

static GstFlowReturn Aggregate(GstAggregator* base, gboolean timeout) {
  auto* self = GST_LIDAR_POINT_CLOUD_MERGE(base);
  const auto pads = Pads(base);
  auto heads = Heads(pads);
  if (heads.empty()) {
    const bool ended = std::all_of(pads.begin(), pads.end(), [](const auto& pad) {
      return gst_aggregator_pad_is_eos(GST_AGGREGATOR_PAD(pad.get())) != FALSE;
    });
    return ended ? GST_FLOW_EOS : GST_AGGREGATOR_FLOW_NEED_DATA;
  }
  // Waits for the scan of a late sensor until the latency has passed.
  while (DropOld(self, heads)) {
    if (!timeout) return GST_AGGREGATOR_FLOW_NEED_DATA;
    heads = Heads(pads);
  }
  Merged merged;
  merged.fields = FieldsOfFirst(pads);
  for (const Head& head : heads)
    if (!AddCloud(self, head, &merged)) return GST_FLOW_ERROR;
  if (!GST_CLOCK_TIME_IS_VALID(merged.time)) TakeTimeOfGaps(heads, &merged);
  return Push(self, std::move(merged));
}

static gboolean SinkEvent(GstAggregator* base, GstAggregatorPad* pad, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
    GstCaps* caps = nullptr;
    gst_event_parse_caps(event, &caps);
    MergePadSetCaps(GST_LIDAR_POINT_CLOUD_MERGE_PAD(pad), caps);
  }
  return GST_AGGREGATOR_CLASS(gst_lidar_point_cloud_merge_parent_class)
      ->sink_event(base, pad, event);
}

/// Adds the pad as a child of the element, so that gst-launch can set sink_1::transform.
static GstPad* RequestPad(GstElement* element, GstPadTemplate* pad_template, const gchar* name,
                          const GstCaps* caps) {
  GstPad* pad = GST_ELEMENT_CLASS(gst_lidar_point_cloud_merge_parent_class)
                    ->request_new_pad(element, pad_template, name, caps);
  if (pad != nullptr)
    gst_child_proxy_child_added(GST_CHILD_PROXY(element), G_OBJECT(pad), GST_PAD_NAME(pad));
  return pad;
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  gst_child_proxy_child_removed(GST_CHILD_PROXY(element), G_OBJECT(pad), GST_PAD_NAME(pad));
  GST_ELEMENT_CLASS(gst_lidar_point_cloud_merge_parent_class)->release_pad(element, pad);
}

static GstClockTime NextTime(GstAggregator* base) {
  return gst_aggregator_simple_get_next_time(base);
}

static gboolean Stop(GstAggregator* base) {
  *GST_LIDAR_POINT_CLOUD_MERGE(base)->state = State();
  for (const auto& pad : Pads(base)) MergePadForget(GST_LIDAR_POINT_CLOUD_MERGE_PAD(pad.get()));
  return TRUE;
}

static void gst_lidar_point_cloud_merge_init(GstLidarPointCloudMerge* self) {
  self->state = new State;
}

static void gst_lidar_point_cloud_merge_class_init(GstLidarPointCloudMergeClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_point_cloud_merge_debug, "pointcloudmerge", 0,
                          "Clouds of several sensors");
  OwnState<GstLidarPointCloudMerge, gst_lidar_point_cloud_merge_parent_class>(
      G_OBJECT_CLASS(klass));
  Describe(
      klass,
      {"Point cloud merger", "Filter/PointCloud",
       "Makes one cloud of the scans of several sensors"},
      {{"sink_%u", GST_PAD_SINK, GST_LIDAR_CLOUD_MEDIA_TYPE, GST_PAD_REQUEST,
        gst_lidar_point_cloud_merge_pad_get_type()},
       {"src", GST_PAD_SRC, GST_LIDAR_CLOUD_MEDIA_TYPE, GST_PAD_ALWAYS, GST_TYPE_AGGREGATOR_PAD}});
  gst_type_mark_as_plugin_api(gst_lidar_point_cloud_merge_pad_get_type(),
                              static_cast<GstPluginAPIFlags>(0));
  auto* aggregator = GST_AGGREGATOR_CLASS(klass);
  aggregator->aggregate = Aggregate;
  // Caps are sent with the clouds. The base class would send the caps of the template before.
  aggregator->negotiate = [](GstAggregator*) -> gboolean { return TRUE; };
  aggregator->sink_event = SinkEvent;
  aggregator->get_next_time = NextTime;
  aggregator->stop = Stop;
  GST_ELEMENT_CLASS(klass)->request_new_pad = RequestPad;
  GST_ELEMENT_CLASS(klass)->release_pad = ReleasePad;
}

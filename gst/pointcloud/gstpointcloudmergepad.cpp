// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/gstpointcloudmergepad.h"

#include <memory>
#include <mutex>

#include "gst/common/properties.h"
#include "gst/pointcloud/filter_plan.h"

namespace {

struct MergePadSettings {
  std::string transform;
};

const std::array<lidar::gst::Property<MergePadSettings>, 1> kProperties = {{
    {"transform",
     "From the sensor to the common frame: 16 numbers row by row, or x, y, z [m], roll, pitch, yaw "
     "[degrees]",
     &MergePadSettings::transform, 0, 0, GST_PARAM_MUTABLE_PLAYING},
}};

struct State {
  std::mutex mutex;  // guards the settings
  MergePadSettings settings;
  // Only the thread that aggregates uses these.
  lidar::gst::CapsPtr caps;
  std::unique_ptr<lidar::gst::FilterPlan> plan;
  std::string plan_transform;
  std::string plan_fields;
};

}  // namespace

struct _GstLidarPointCloudMergePad {
  GstAggregatorPad parent;
  State* state;
};

G_DEFINE_TYPE(GstLidarPointCloudMergePad, gst_lidar_point_cloud_merge_pad, GST_TYPE_AGGREGATOR_PAD)

namespace lidar::gst {

void MergePadSetCaps(GstLidarPointCloudMergePad* pad, GstCaps* caps) {
  pad->state->caps.reset(gst_caps_ref(caps));
  pad->state->plan.reset();
}

BufferPtr MergePadRead(GstLidarPointCloudMergePad* pad, GstBuffer* buffer,
                       const std::string& fields, std::string* why) {
  State& state = *pad->state;
  FilterSettings settings;
  settings.fields = fields;
  settings.invalid = InvalidPoints::kRemove;
  {
    std::lock_guard lock(state.mutex);
    settings.transform = state.settings.transform;
  }
  *why = "its caps are missing";
  if (!state.caps) return nullptr;
  if (!state.plan || state.plan_transform != settings.transform || state.plan_fields != fields) {
    state.plan = FilterPlan::Make(settings, state.caps.get(), why);
    state.plan_transform = settings.transform;
    state.plan_fields = fields;
  }
  if (!state.plan) return nullptr;
  *why = "a cloud has another size than its caps say";
  return state.plan->Apply(buffer);
}

std::optional<std::string> MergePadFields(GstLidarPointCloudMergePad* pad) {
  if (!pad->state->plan) return std::nullopt;
  return pad->state->plan->fields();
}

}  // namespace lidar::gst

static void gst_lidar_point_cloud_merge_pad_init(GstLidarPointCloudMergePad* self) {
  self->state = new State;
}

static void gst_lidar_point_cloud_merge_pad_class_init(GstLidarPointCloudMergePadClass* klass) {
  lidar::gst::ServeState<GstLidarPointCloudMergePad, gst_lidar_point_cloud_merge_pad_parent_class,
                         kProperties>(klass);
}

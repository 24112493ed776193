// SPDX-License-Identifier: LGPL-2.1-or-later
// Filters the clouds of pointcloudfilter, prepared for given caps and settings.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <optional>
#include <string>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"
#include "src/base/time.h"
#include "src/cdr/point_cloud2.h"
#include "src/cloud/point_filter.h"

namespace lidar::gst {

/// The values of the properties.
struct FilterSettings {
  std::string fields;
  std::string crop_box;
  bool crop_inside = false;
  gdouble min_range = 0;
  gdouble max_range = 0;
  gdouble voxel_size = 0;
  guint beam_step = 1;
  guint column_step = 1;
  bool apply_pose = false;
  std::string frame_id;      // frame of the clouds; empty: as in their caps
  std::string target_frame;  // frame to which clouds are moved by transforms
  Duration tf_timeout = std::chrono::milliseconds(200);
  std::string transform;
  InvalidPoints invalid = InvalidPoints::kKeep;
};

class FilterPlan {
 public:
  /// Makes a plan for clouds of `caps`. If the settings are invalid, or impossible for these
  /// clouds, returns null and sets `why` to a reason for the user.
  static std::unique_ptr<FilterPlan> Make(const FilterSettings& settings, const GstCaps* caps,
                                          std::string* why);

  /// Returns the filtered cloud, or null if the size of `buffer` contradicts the caps. If no point
  /// remains, the result is an empty buffer. `placed` is the transform to the target frame, if
  /// there is one.
  BufferPtr Apply(GstBuffer* buffer, const Transform& placed = kIdentity);
  /// Returns the caps of the cloud that Apply() returned last.
  GstCaps* caps() const { return caps_.get(); }
  /// Returns the fields of clouds from Apply(), with their types and offsets.
  std::string fields() const { return out_.fields.ToString(); }
  std::uint64_t removed() const { return filter_->removed(); }
  /// Returns the number of clouds that were dropped because they had no pose, although they need a
  /// pose.
  std::uint64_t without_pose() const { return without_pose_; }
  /// Returns the frame of the incoming clouds.
  const std::string& frame() const { return frame_; }

 private:
  void Describe(const FilteredCloud& cloud);

  CloudInfo in_;
  CloudInfo out_;
  cdr::RosLayout layout_;
  std::optional<cdr::PointConverter> converter_;
  std::optional<PointFilter> filter_;
  guint column_step_ = 1;
  bool apply_pose_ = false;
  bool drops_pose_ = false;  // true if points are moved, so that their pose is no longer valid
  std::string frame_;
  std::string out_frame_;  // empty if not known
  std::uint64_t without_pose_ = 0;
  std::vector<std::uint8_t> converted_;
  CapsPtr caps_;
};

}  // namespace lidar::gst

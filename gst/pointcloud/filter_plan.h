// SPDX-License-Identifier: LGPL-2.1-or-later
// The work of pointcloudfilter for given caps.
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

/// The properties, as they are set.
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
  std::string frame_id;      // of the clouds; empty: as their caps say
  std::string target_frame;  // frame to which transforms move the clouds
  Duration tf_timeout = std::chrono::milliseconds(200);
  std::string transform;
  InvalidPoints invalid = InvalidPoints::kKeep;
};

class FilterPlan {
 public:
  /// Returns nothing if the settings are wrong or impossible for clouds of `caps`; `why` has the
  /// reason for a user.
  static std::unique_ptr<FilterPlan> Make(const FilterSettings& settings, const GstCaps* caps,
                                          std::string* why);

  /// Returns the filtered cloud without metas, or null if `buffer` contradicts the caps. An empty
  /// cloud has no bytes. `placed` is the transform to the target frame, if there is one.
  BufferPtr Apply(GstBuffer* buffer, const Transform& placed = kIdentity);
  /// Caps of the last cloud from Apply().
  GstCaps* caps() const { return caps_.get(); }
  /// The fields of that cloud, with their types and offsets.
  std::string fields() const { return out_.fields.ToString(); }
  std::uint64_t removed() const { return filter_->removed(); }
  /// Number of clouds dropped because they lack the pose that they need.
  std::uint64_t without_pose() const { return without_pose_; }
  /// Frame of incoming clouds.
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
  bool drops_pose_ = false;  // points move out of the frame that the pose describes
  std::string frame_;
  std::string out_frame_;  // empty: not known
  std::uint64_t without_pose_ = 0;
  std::vector<std::uint8_t> converted_;
  CapsPtr caps_;
};

}  // namespace lidar::gst

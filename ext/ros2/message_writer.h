// SPDX-License-Identifier: LGPL-2.1-or-later
// Buffers as ROS 2 messages.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ext/ros2/cloud_compression.h"
#include "gst/lidar/cloud_info.h"
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "src/cdr/ros_types.h"

namespace lidar::gst {

/// A message gives the pose of the child frame in the other. An empty name means what the caps say,
/// or the usual one.
struct Frames {
  std::string frame_id;
  std::string child_frame_id;
};

/// What messages say that buffers do not.
struct MessageSettings {
  Frames frames;
  CloudCompression compression = CloudCompression::kZstd;  // of CompressedPointCloud2
  // Tracked poses have these; 0: not known.
  double position_variance = 0;     // m^2
  double orientation_variance = 0;  // rad^2
};

/// Used by the streaming thread.
class MessageWriter {
 public:
  explicit MessageWriter(cdr::RosType type) : type_(type) {}

  /// The type that buffers of `caps` become where nobody says otherwise.
  static std::optional<cdr::RosType> UsualType(const GstCaps* caps);

  /// False, and why(), where buffers of `caps` cannot be messages of the type.
  bool SetCaps(const GstCaps* caps);

  /// Gives each message of `buffer` in pieces, which live until it returns. `now` is the time of
  /// buffers that have no capture time. False where the buffer is not as its caps say.
  using Publish = std::function<void(const std::vector<ByteView>& pieces)>;
  bool Write(GstBuffer* buffer, const MessageSettings& settings, Time now, const Publish& publish);

  cdr::RosType type() const { return type_; }
  const std::string& why() const { return why_; }

 private:
  bool WriteCloud(ByteView points, const Publish& publish);
  bool PublishCloud(const cdr::PointCloud2& cloud, const Publish& publish) const;
  bool WriteImu(ByteView samples, const Publish& publish);
  bool WritePose(ByteView bytes, const Publish& publish);
  cdr::Header HeaderOf(Time stamp, const char* usual_frame) const;
  std::string ChildFrame() const;

  cdr::RosType type_;
  CloudInfo info_;
  cdr::RosLayout layout_;
  Frames from_caps_;
  MessageSettings wanted_;  // of the buffer at hand
  Time stamp_{};            // of the buffer at hand
  std::string why_;
};

}  // namespace lidar::gst

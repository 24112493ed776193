// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts buffers to ROS 2 messages.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ext/ros2/cloud_compression.h"
#include "gst/lidar/cloud_info.h"
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "src/cdr/ros_types.h"

namespace lidar::gst {

/// The frame, and the child frame whose pose a message gives. An empty name means that of the caps,
/// or the default.
struct Frames {
  std::string frame_id;
  std::string child_frame_id;
};

/// The data that a message needs in addition to its buffer.
struct MessageSettings {
  Frames frames;
  CloudCompression compression = CloudCompression::kZstd;  // of CompressedPointCloud2
  // Variances of tracked poses; 0: unknown.
  double position_variance = 0;     // m^2
  double orientation_variance = 0;  // rad^2
};

/// Used by the streaming thread.
class MessageWriter {
 public:
  /// Returns null and sets `why` if buffers of `caps` cannot be messages of `type`.
  static std::unique_ptr<MessageWriter> Make(cdr::RosType type, const GstCaps* caps,
                                             std::string* why);

  /// The default type for buffers of `caps`.
  static std::optional<cdr::RosType> UsualType(const GstCaps* caps);

  using Publish = std::function<void(const std::vector<ByteView>& pieces)>;
  /// Calls `publish` for each message of `buffer`, with pieces that are valid during the call.
  /// `now` is the time of buffers without a capture time. Returns false if the buffer contradicts
  /// its caps.
  bool Write(GstBuffer* buffer, const MessageSettings& settings, Time now, const Publish& publish);

  cdr::RosType type() const { return type_; }

 private:
  explicit MessageWriter(cdr::RosType type) : type_(type) {}
  bool TakeCaps(const GstCaps* caps, std::string* why);
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
};

}  // namespace lidar::gst

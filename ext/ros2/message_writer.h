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

/// The frame of a message, and the child frame whose pose the message contains. If a name is empty,
/// the frame in the caps is used, or else the default frame.
struct Frames {
  std::string frame_id;
  std::string child_frame_id;
};

/// The settings that determine the parts of a message that are not in the buffer.
struct MessageSettings {
  Frames frames;
  CloudCompression compression = CloudCompression::kZstd;  // of CompressedPointCloud2
  // The variances of tracked poses. 0 means unknown.
  double position_variance = 0;     // m^2
  double orientation_variance = 0;  // rad^2
};

/// Writes messages of one type. Only the streaming thread may use it.
class MessageWriter {
 public:
  /// Makes a writer. Returns null and sets `why` if buffers with `caps` cannot become messages of
  /// `type`.
  static std::unique_ptr<MessageWriter> Make(cdr::RosType type, const GstCaps* caps,
                                             std::string* why);

  /// Returns the default type of messages for buffers with `caps`.
  static std::optional<cdr::RosType> UsualType(const GstCaps* caps);

  using Publish = std::function<void(const std::vector<ByteView>& pieces)>;
  /// Calls `publish` for each message of `buffer`. The pieces are valid only during the call. If
  /// the buffer has no capture time, `now` is used. Returns false if the buffer does not match its
  /// caps.
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
  MessageSettings wanted_;  // settings for the current buffer
  Time stamp_{};            // time of the current buffer
};

}  // namespace lidar::gst

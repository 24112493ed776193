// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts ROS 2 messages to buffers and caps.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <optional>
#include <string>

#include "gst/common/refs.h"
#include "src/cdr/messages.h"
#include "src/cdr/point_cloud2.h"
#include "src/cdr/ros_types.h"

namespace lidar::gst {

/// Reads messages of one type. Only the streaming thread may use it.
class MessageReader {
 public:
  /// A function that returns the caps that downstream accepts. Null means any caps.
  using Wanted = std::function<CapsPtr()>;
  /// If `for_good` is true, transforms do not change with time.
  MessageReader(cdr::RosType type, Wanted wanted, bool for_good = false)
      : type_(type), wanted_(std::move(wanted)), for_good_(for_good) {}

  enum class Verdict {
    kBuffer,         // TakeBuffer() returns it
    kEmpty,          // a cloud without points, or a message without transforms
    kDamaged,        // why() has the reason
    kNotNegotiated,  // downstream refuses the caps; see why()
  };
  Verdict Read(ByteView message);
  /// Makes the reader query the caps of downstream again at the next cloud.
  void Renegotiate() { converter_.reset(); }

  const std::string& why() const { return why_; }
  BufferPtr TakeBuffer() { return std::move(buffer_); }
  /// Returns the caps of the buffer if they differ from the last caps, or null.
  CapsPtr TakeNewCaps() { return std::move(new_caps_); }

 private:
  Verdict ReadCloud(ByteView message);
  Verdict ReadLivox(ByteView message);
  Verdict ReadCompressed(ByteView message);
  Verdict ToBuffer(const cdr::PointCloud2& cloud);
  Verdict ReadImu(ByteView message);
  Verdict ReadOdometry(ByteView message);
  Verdict ReadTransforms(ByteView message);
  Verdict Adapt(const cdr::PointCloud2& cloud);
  Verdict SetCaps(CapsPtr caps);
  void SetStamp(Time stamp);

  cdr::RosType type_;
  Wanted wanted_;
  bool for_good_;
  std::optional<cdr::PointConverter> converter_;
  bool is_dense_ = false;
  std::string frame_id_;
  CapsPtr caps_;
  CapsPtr new_caps_;
  BufferPtr buffer_;
  std::string why_;
};

}  // namespace lidar::gst

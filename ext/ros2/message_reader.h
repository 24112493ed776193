// SPDX-License-Identifier: LGPL-2.1-or-later
// ROS 2 messages as buffers and caps.
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

/// Used by the streaming thread.
class MessageReader {
 public:
  /// `wanted` gives what downstream takes; null: anything.
  using Wanted = std::function<CapsPtr()>;
  /// `for_good`: what transforms say does not change with time.
  MessageReader(cdr::RosType type, Wanted wanted, bool for_good = false)
      : type_(type), wanted_(std::move(wanted)), for_good_(for_good) {}

  enum class Verdict {
    kBuffer,         // buffer()
    kEmpty,          // a cloud of no points, a message of no transforms
    kDamaged,        // why()
    kNotNegotiated,  // no caps of this message are what downstream takes: why()
  };
  Verdict Read(ByteView message);
  /// Downstream may take something else from now on: it is asked at the next cloud.
  void Renegotiate() { converter_.reset(); }

  const std::string& why() const { return why_; }
  BufferPtr TakeBuffer() { return std::move(buffer_); }
  /// The caps of the buffer, where they are not those of the one before.
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

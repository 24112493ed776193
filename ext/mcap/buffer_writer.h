// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the buffers of a stream to messages of a recording.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ext/mcap/message_types.h"

namespace lidar::gst {

/// A message of a recording, and its times.
struct NewMessage {
  GstClockTime after{};         // log time relative to the log time of the buffer [ns]
  GstClockTime publish_time{};  // capture time, if known [ns since 1970]
  mcap::Bytes data;
};

class BufferWriter {
 public:
  /// Returns a writer for buffers with `caps`. If `sensor_frame` is empty, the caps determine the
  /// frames. Returns NULL and sets `why`, a text for users, if such buffers cannot be recorded.
  static std::unique_ptr<BufferWriter> Make(const GstCaps* caps, const std::string& sensor_frame,
                                            std::string* why);
  virtual ~BufferWriter() = default;

  MessageType type() const { return type_; }
  /// Appends the messages of `buffer`, whose log time is `log_time`. Returns false if the buffer
  /// does not match its caps.
  virtual bool Write(GstBuffer* buffer, GstClockTime log_time, std::vector<NewMessage>* out) = 0;

 protected:
  BufferWriter(MessageType type, std::string frame_id)
      : type_(type), frame_id_(std::move(frame_id)) {}

  const MessageType type_;
  const std::string frame_id_;
};

}  // namespace lidar::gst

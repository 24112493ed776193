// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts buffers of a stream to messages.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ext/mcap/message_types.h"

namespace lidar::gst {

/// A message, and its times.
struct NewMessage {
  GstClockTime after{};         // since the buffer's own time [ns]
  GstClockTime publish_time{};  // capture time, if known [ns since 1970]
  mcap::Bytes data;
};

class BufferWriter {
 public:
  /// Returns a writer for buffers of `caps`. An empty `sensor_frame` leaves the frames to the caps.
  /// Returns NULL if the caps cannot be recorded; `why` then has the reason for a user.
  static std::unique_ptr<BufferWriter> Make(const GstCaps* caps, const std::string& sensor_frame,
                                            std::string* why);
  virtual ~BufferWriter() = default;

  MessageType type() const { return type_; }
  /// Appends the messages of `buffer`, logged at `log_time`. Returns false if the buffer
  /// contradicts its caps.
  virtual bool Write(GstBuffer* buffer, GstClockTime log_time, std::vector<NewMessage>* out) = 0;

 protected:
  BufferWriter(MessageType type, std::string frame_id)
      : type_(type), frame_id_(std::move(frame_id)) {}

  const MessageType type_;
  const std::string frame_id_;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the messages of a channel to buffers.
#pragma once
#include <gst/gst.h>

#include <memory>

#include "ext/mcap/message_types.h"
#include "gst/common/refs.h"

namespace lidar::gst {

class MessageReader {
 public:
  /// Returns a reader for the messages of `channel`, or NULL if they cannot be read.
  static std::unique_ptr<MessageReader> Make(const mcap::Schema& schema,
                                             const mcap::Channel& channel);
  virtual ~MessageReader() = default;

  /// Returns the caps of the buffer that Read() returned last. Returns NULL before the first Read()
  /// if the caps depend on the message.
  GstCaps* caps() const { return caps_.get(); }
  /// Converts `message`, which may be any bytes, to a buffer without PTS. Returns null if `message`
  /// is damaged.
  virtual BufferPtr Read(ByteView message) = 0;

 protected:
  CapsPtr caps_;
};

}  // namespace lidar::gst

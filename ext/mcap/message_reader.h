// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages of one channel as buffers.
#pragma once
#include <gst/gst.h>

#include <memory>

#include "ext/mcap/message_types.h"
#include "gst/common/refs.h"

namespace lidar::gst {

class MessageReader {
 public:
  /// Returns NULL if the messages of that channel are of an unknown type.
  static std::unique_ptr<MessageReader> Make(const mcap::Schema& schema,
                                             const mcap::Channel& channel);
  virtual ~MessageReader() = default;

  /// Caps of the last Read()'s buffer. NULL before the first Read() if they depend on the message.
  GstCaps* caps() const { return caps_.get(); }
  /// Returns null if `message`, which may be any bytes, is damaged. The buffer has no PTS.
  virtual BufferPtr Read(ByteView message) = 0;

 protected:
  CapsPtr caps_;
};

}  // namespace lidar::gst

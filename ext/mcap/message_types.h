// SPDX-License-Identifier: LGPL-2.1-or-later
// The types of messages in our recordings, and their definitions in the language of ROS 2.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>
#include <string_view>

#include "gst/common/refs.h"
#include "src/mcap/records.h"

namespace lidar::gst {

enum class MessageType { kCloud, kImu, kOdometry, kSlice };

/// Returns the schema of messages of this type, without an id.
mcap::Schema SchemaOf(MessageType type);
/// Returns the type of the messages of `channel`. Returns nothing if the schema is unknown or the
/// encoding is not CDR.
std::optional<MessageType> TypeOf(const mcap::Schema& schema, const mcap::Channel& channel);
/// Returns the type of message for buffers with `caps`, or nothing if they cannot be recorded.
std::optional<MessageType> TypeOf(const GstCaps* caps);
/// Returns true if IMU samples with `caps` have the layout that can be recorded.
bool IsOurImu(const GstCaps* caps);
/// Returns the default topic for messages of this type.
std::string_view TopicOf(MessageType type);

/// Parses the caps in a channel's metadata, which is untrusted. Returns null if `text` is not caps
/// for messages of `type`.
CapsPtr CapsOfType(const std::string& text, MessageType type);

/// A key in a channel's metadata.
constexpr const char* kQosKey = "offered_qos_profiles";  // of rosbag2; empty: default

}  // namespace lidar::gst

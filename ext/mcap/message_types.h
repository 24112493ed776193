// SPDX-License-Identifier: LGPL-2.1-or-later
// The messages in our recordings, and their definitions in ROS 2's language.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>
#include <string_view>

#include "gst/common/refs.h"
#include "src/mcap/records.h"

namespace lidar::gst {

enum class MessageType { kCloud, kImu, kOdometry, kSlice };

/// Schema of the messages of that type, without an id.
mcap::Schema SchemaOf(MessageType type);
/// Returns nothing for a schema that is not ours, or in another encoding than CDR.
std::optional<MessageType> TypeOf(const mcap::Schema& schema, const mcap::Channel& channel);
/// The message for buffers of `caps`; nothing if they cannot be recorded.
std::optional<MessageType> TypeOf(const GstCaps* caps);
/// Returns true if samples of an IMU have the layout that can be recorded.
bool IsOurImu(const GstCaps* caps);
/// Topic of messages of that type unless another is given.
std::string_view TopicOf(MessageType type);

/// Caps from the metadata of a channel, which are untrusted. Returns null if `text` is not the caps
/// of `type`.
CapsPtr CapsOfType(const std::string& text, MessageType type);

/// An entry of a channel's metadata.
constexpr const char* kQosKey = "offered_qos_profiles";  // of rosbag2; empty: its default

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts buffers to NATS messages and back. Metas become headers.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <string>

#include "ext/nats/nats_ptr.h"
#include "gst/common/refs.h"

namespace lidar::nats {

/// The position of a message among all messages that a sink sends between start and stop.
struct Place {
  std::uint64_t run = 0;  // a random number that the sink chooses at start
  std::uint64_t number = 0;
};

struct ReadMessage {
  std::string format_id;
  Place place;
  gst::BufferPtr buffer;  // without PTS
};

/// Return the subject of a format, and the subject of requests for formats.
std::string ConfigSubject(const std::string& subject, const std::string& format_id);
std::string AskSubject(const std::string& subject);
/// Returns what is wrong with `subject`, or an empty text if nothing is wrong.
std::string CheckSubject(const std::string& subject);

/// Returns the value of the headers Nats-Msg-Id and Lidar-Place.
std::string PlaceText(const Place& place);

/// Makes a message to `subject`. `reply` is the subject for the answer, or NULL. Returns null if
/// memory is short.
MessagePtr WriteMessage(const std::string& subject, const char* reply, const std::string& format_id,
                        const Place& place, GstBuffer* buffer);
/// Reads a message from any sender. Returns nothing if the message is damaged.
std::optional<ReadMessage> Read(natsMsg* message);

}  // namespace lidar::nats

// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts buffers to NATS messages: bytes, and metas as headers.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <string>

#include "ext/nats/nats_ptr.h"
#include "gst/common/refs.h"

namespace lidar::nats {

/// Position of a message in the output of one sink, from start to stop.
struct Place {
  std::uint64_t run = 0;  // random, differs from start to start
  std::uint64_t number = 0;
};

struct ReadMessage {
  std::string format_id;
  Place place;
  gst::BufferPtr buffer;  // without PTS
};

/// Return the subjects of a stream's formats, and of requests for formats.
std::string ConfigSubject(const std::string& subject, const std::string& format_id);
std::string AskSubject(const std::string& subject);
/// The fault of `subject`; empty if there is none.
std::string CheckSubject(const std::string& subject);

/// The text of the headers Nats-Msg-Id and Lidar-Place.
std::string PlaceText(const Place& place);

/// A message to `subject`; `reply` may be NULL. Returns null if memory is short.
MessagePtr WriteMessage(const std::string& subject, const char* reply, const std::string& format_id,
                        const Place& place, GstBuffer* buffer);
/// Reads any message; returns nothing if it is damaged.
std::optional<ReadMessage> Read(natsMsg* message);

}  // namespace lidar::nats

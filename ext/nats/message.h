// SPDX-License-Identifier: LGPL-2.1-or-later
// Buffers as messages of NATS: their bytes, and headers that say what a buffer has beside them.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <string>

#include "ext/nats/nats_ptr.h"
#include "gst/common/refs.h"

namespace lidar::nats {

/// Where a message stands in what one sink sends from start to stop.
struct Place {
  std::uint64_t run = 0;  // a number of that time alone
  std::uint64_t number = 0;
};

struct ReadMessage {
  std::string format_id;
  Place place;
  gst::BufferPtr buffer;  // without PTS
};

/// Subjects beside that of a stream.
std::string ConfigSubject(const std::string& subject, const std::string& format_id);
std::string AskSubject(const std::string& subject);
/// What is wrong with `subject`; empty: nothing.
std::string CheckSubject(const std::string& subject);

/// As the header Nats-Msg-Id and Lidar-Place have it.
std::string PlaceText(const Place& place);

/// A message that goes to `subject`; `reply` may be NULL. Null where memory is short.
MessagePtr WriteMessage(const std::string& subject, const char* reply, const std::string& format_id,
                        const Place& place, GstBuffer* buffer);
/// None for what is damaged. Any message may come.
std::optional<ReadMessage> Read(natsMsg* message);

}  // namespace lidar::nats

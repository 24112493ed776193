// SPDX-License-Identifier: LGPL-2.1-or-later
// The newest formats that senders published.
#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "ext/nats/nats_ptr.h"
#include "ext/nats/stream_format.h"

namespace lidar::nats {

class FormatBook {
 public:
  /// Adds the format in `text`. The last word of `subject` is the format's id. If the format is
  /// damaged, counts it instead.
  void Note(std::string_view subject, std::string_view text);
  /// Loads the format that JetStream keeps at `subject`, adds it, and returns it. Returns null if
  /// JetStream has no format there.
  StreamFormat::Ptr Fetch(jsCtx* js, const std::string& stream, const std::string& subject);
  /// Returns the format with the id `id`, or null if it is unknown.
  StreamFormat::Ptr Find(const std::string& id) const;
  std::uint64_t damaged() const { return damaged_; }

 private:
  std::deque<StreamFormat::Ptr> formats_;  // the newest first
  std::uint64_t damaged_ = 0;
};

}  // namespace lidar::nats

// SPDX-License-Identifier: LGPL-2.1-or-later
// The formats that a receiver was told of, the newest few.
#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "ext/nats/stream_format.h"

namespace lidar::nats {

class FormatBook {
 public:
  /// `subject` ends with the id. What is damaged is counted.
  void Note(std::string_view subject, std::string_view text);
  /// Null where it is not known.
  StreamFormat::Ptr Find(const std::string& id) const;
  std::uint64_t damaged() const { return damaged_; }

 private:
  std::deque<StreamFormat::Ptr> formats_;  // the newest first
  std::uint64_t damaged_ = 0;
};

}  // namespace lidar::nats

// SPDX-License-Identifier: LGPL-2.1-or-later
// The times of a capture file: its duration, and where to read after a seek.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "src/ouster/pcap_reader.h"

namespace lidar::ouster {

/// Reads the file once, as far as calls need. Times are relative to the first datagram; a datagram
/// out of order has the latest time so far.
class CaptureIndex {
 public:
  explicit CaptureIndex(std::unique_ptr<PcapReader> reader) : reader_(std::move(reader)) {}

  /// Reads up to a datagram of `time` or later, or to the end. Calls `go_on` now and then, and
  /// returns false if `go_on` does.
  bool ReadUntil(Duration time, const std::function<bool()>& go_on);

  /// The first datagram's capture time; nothing until it was read.
  std::optional<Time> first() const { return first_; }
  /// Time from the first datagram that was read to the last.
  Duration duration() const { return first_ ? last_ - *first_ : Duration{0}; }
  /// Returns the offset in the file from which a reader finds all read datagrams of `time` and
  /// later, or nothing if it must read from the front.
  std::optional<std::int64_t> OffsetBefore(Duration time) const;

 private:
  struct Entry {
    Duration time{};  // of the latest datagram before the offset
    std::int64_t offset = 0;
  };

  std::unique_ptr<PcapReader> reader_;  // null at the end
  std::optional<Time> first_;
  Time last_{};
  std::vector<Entry> entries_;
};

}  // namespace lidar::ouster

// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the duration of a capture file, and the offset at which to read on after a seek.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "src/ouster/pcap_reader.h"

namespace lidar::ouster {

/// The times of the datagrams in a capture file. The file is read only once, and only as far as the
/// calls need. Times are relative to the first datagram. They never decrease: if the capture time
/// of a datagram is earlier than the latest time so far, the datagram gets the latest time.
class CaptureIndex {
 public:
  explicit CaptureIndex(std::unique_ptr<PcapReader> reader) : reader_(std::move(reader)) {}

  /// Reads until a datagram of `time` or later, or until the end of the file. Calls `go_on` once
  /// per 256 datagrams. If `go_on` returns false, stops and returns false.
  bool ReadUntil(Duration time, const std::function<bool()>& go_on);

  /// Returns the capture time of the first datagram, or nothing if it has not been read yet.
  std::optional<Time> first() const { return first_; }
  /// Returns the time from the first to the latest datagram that has been read.
  Duration duration() const { return first_ ? last_ - *first_ : Duration{0}; }
  /// Returns an offset in the file. A reader that starts there finds all datagrams of `time` and
  /// later that have been read so far. Returns nothing if the reader must start at the front of the
  /// file.
  std::optional<std::int64_t> OffsetBefore(Duration time) const;

 private:
  struct Entry {
    Duration time{};  // time of the latest datagram before `offset`
    std::int64_t offset = 0;
  };

  std::unique_ptr<PcapReader> reader_;  // null once the end of the file is reached
  std::optional<Time> first_;
  Time last_{};
  std::vector<Entry> entries_;
};

}  // namespace lidar::ouster

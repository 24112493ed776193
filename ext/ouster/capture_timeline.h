// SPDX-License-Identifier: LGPL-2.1-or-later
// The duration of a capture and offsets in its file, for the reading thread and for threads that
// query.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "src/ouster/capture_index.h"

namespace lidar::gst {

/// The first call reads the file as far as it needs; later calls cost nothing. All threads may call
/// it.
class CaptureTimeline {
 public:
  /// `packet_interval` is used as the duration of the last packet.
  CaptureTimeline(std::string path, Duration packet_interval)
      : path_(std::move(path)), packet_interval_(packet_interval) {}

  /// Returns nothing if the file cannot be read, or after Cancel().
  std::optional<GstClockTime> duration();

  struct Place {
    Time first{};                        // capture time of the file's first packet
    std::optional<std::int64_t> offset;  // empty: the front of the file
  };
  /// Returns the place from which a reader finds all data captured at `time` and later. Returns
  /// nothing if duration() would.
  std::optional<Place> Find(Duration time);

  /// Ends a running call, and each later one, until Allow().
  void Cancel() { cancelled_ = true; }
  void Allow() { cancelled_ = false; }
  bool cancelled() const { return cancelled_; }

 private:
  bool ReadUntil(Duration time);

  const std::string path_;
  const Duration packet_interval_;
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;  // guards all below; held while reading the file
  std::optional<ouster::CaptureIndex> index_;
};

}  // namespace lidar::gst

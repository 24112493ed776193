// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the duration of a capture and offsets in its file. It is used by the reading thread and by
// threads that query the duration.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "src/ouster/capture_index.h"

namespace lidar::gst {

/// Finds times in a capture file. The file is read only once, and only as far as the calls need.
/// Any thread may call the methods.
class CaptureTimeline {
 public:
  /// `packet_interval` is the duration that the last packet counts with.
  CaptureTimeline(std::string path, Duration packet_interval)
      : path_(std::move(path)), packet_interval_(packet_interval) {}

  /// Returns the duration of the capture. Returns nothing if the file cannot be read, or after
  /// Cancel().
  std::optional<GstClockTime> duration();

  struct Place {
    Time first{};                        // capture time of the file's first packet
    std::optional<std::int64_t> offset;  // empty: start at the front of the file
  };
  /// Returns the place at which a reader must start to find all data captured at `time` and later.
  /// Returns nothing if the file cannot be read, or after Cancel().
  std::optional<Place> Find(Duration time);

  /// Makes the running call and all later calls return nothing, until Allow() is called.
  void Cancel() { cancelled_ = true; }
  void Allow() { cancelled_ = false; }
  bool cancelled() const { return cancelled_; }

 private:
  bool ReadUntil(Duration time);

  const std::string path_;
  const Duration packet_interval_;
  std::atomic<bool> cancelled_{false};
  std::mutex mutex_;  // guards all members below; held while reading the file
  std::optional<ouster::CaptureIndex> index_;
};

}  // namespace lidar::gst

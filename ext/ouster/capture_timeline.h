// SPDX-License-Identifier: LGPL-2.1-or-later
// The duration of a capture and the places in it, for the thread that asks and the one that reads.
#pragma once
#include <gst/gst.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "src/ouster/capture_index.h"

namespace lidar::gst {

/// The first question reads the file, as far as the answer needs it; later ones are free. Any
/// thread may call all of it.
class CaptureTimeline {
 public:
  /// `packet_interval` is what the last packet lasts.
  CaptureTimeline(std::string path, Duration packet_interval)
      : path_(std::move(path)), packet_interval_(packet_interval) {}

  /// Returns nothing if the file cannot be read, or Cancel() came first.
  std::optional<GstClockTime> duration();

  struct Place {
    Time first{};                        // capture time of the file's first packet
    std::optional<std::int64_t> offset;  // empty: the front
  };
  /// The place from which a reader finds all that was captured at `time` and later; nothing as
  /// above.
  std::optional<Place> Find(Duration time);

  /// Ends a question under way, and every later one, until Allow().
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

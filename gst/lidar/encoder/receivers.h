// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the reports of receivers about an encoder's slices until its streaming thread takes them.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <vector>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

/// Returns true if no element downstream has two outputs for the data of `src`, so that the data
/// reach at most one destination. A second destination would not report its losses.
bool HasOneWay(GstPad* src);

/// Events come in any thread; the streaming thread calls Take().
class ReceiverEvents {
 public:
  struct Slice {
    guint receiver = 0;
    guint scan_id = 0;
    guint slice_index = 0;
  };
  struct News {
    std::vector<Slice> received;
    bool key_requested = false;
  };
  /// Returns false if `event` is not a report of a receiver. The event stays the caller's in both
  /// cases.
  bool OnEvent(GstEvent* event);
  void Forget();
  /// Returns all reports since the last call, but no received slices if `src` leads to several
  /// destinations.
  News Take(GstPad* src);

 private:
  static constexpr std::size_t kMostSlices = 4'096;

  std::mutex mutex_;  // guards news_
  News news_;
  // Used by the streaming thread only:
  gint64 looked_at_us_ = 0;  // last look at the elements downstream
  bool one_way_ = false;
};

}  // namespace lidar::gst

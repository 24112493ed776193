// SPDX-License-Identifier: LGPL-2.1-or-later
// Stores what receivers report about the slices of an encoder, until the encoder's streaming thread
// reads it.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <vector>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

/// Returns true if the data of `src` reach at most one destination, because no element downstream
/// sends them to two pads. A second destination would not report which slices it lost.
bool HasOneWay(GstPad* src);

/// The stored reports. Any thread may call OnEvent(). Only the streaming thread may call Take().
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
  /// Stores the report in `event`. Returns false if `event` is not a report of a receiver. The
  /// caller keeps `event` in both cases.
  bool OnEvent(GstEvent* event);
  void Forget();
  /// Returns all reports since the last call. Leaves out the received slices if `src` leads to
  /// several destinations.
  News Take(GstPad* src);

 private:
  static constexpr std::size_t kMostSlices = 4'096;

  std::mutex mutex_;  // guards news_
  News news_;
  // The members below are used only by the streaming thread.
  gint64 looked_at_us_ = 0;  // last check of the elements downstream
  bool one_way_ = false;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// What receivers say of the slices of an encoder, until its streaming thread takes it over.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <vector>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

/// True where what leaves by `src` reaches one place at most: no element behind it has two outputs
/// for it. What a second place lacks, nobody would tell.
bool HasOneWay(GstPad* src);

/// Events come in any thread; Take() is for the streaming thread.
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
  /// False for other events; `event` stays the caller's.
  bool OnEvent(GstEvent* event);
  void Forget();
  /// All since the last time; nothing is received where there are several ways behind `src`.
  News Take(GstPad* src);

 private:
  static constexpr std::size_t kMostSlices = 4'096;

  std::mutex mutex_;  // guards news_
  News news_;
  // The rest belongs to the streaming thread.
  gint64 looked_at_us_ = 0;  // the way behind
  bool one_way_ = false;
};

}  // namespace lidar::gst

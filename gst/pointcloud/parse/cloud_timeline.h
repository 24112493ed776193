// SPDX-License-Identifier: LGPL-2.1-or-later
// Times and bytes of a file with clouds of equal size: seeks and queries of its parser.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <optional>

#include "gst/common/refs.h"

namespace lidar::gst {

/// Upstream uses bytes, downstream uses time. All threads may send queries and seeks.
class CloudTimeline {
 public:
  CloudTimeline() { gst_segment_init(&segment_, GST_FORMAT_TIME); }

  struct Grid {
    guint64 cloud_bytes = 0;  // 0: not known; seeks and queries then fail
    guint64 rate_n = 10;      // clouds/s
    guint64 rate_d = 1;

    /// TimeOf() returns when a cloud begins, CloudAt() the cloud at a time. Clouds count from 0.
    GstClockTime TimeOf(guint64 cloud) const {
      return gst_util_uint64_scale(cloud, rate_d * GST_SECOND, rate_n);
    }
    guint64 CloudAt(GstClockTime time) const;
  };
  void SetGrid(const Grid& grid);
  void Reset();

  /// Numbers of clouds, counted from the start of the file.
  struct Place {
    guint64 next = 0;   // number of the next cloud
    guint64 shown = 0;  // all clouds before it were pushed; a seek may repeat their bytes
  };
  /// Converts a segment in bytes to one in time that continues after the last cloud. Sets `place`
  /// to its beginning, as far as known.
  EventPtr ToTime(GstEvent* segment, Place* place);
  /// Call it when the grid has changed. Returns a segment that begins with cloud `next` and
  /// continues after the last cloud.
  EventPtr Continue(guint64 next);
  /// Converts SEGMENT_DONE to time; takes the event.
  EventPtr EndInTime(GstEvent* done) const;
  /// Notes that the last pushed cloud ends at `end`, or at the segment's stop if that is earlier.
  void NotePosition(GstClockTime end);
  /// Sets the running time to 0.
  void RestartTime();

  /// Returns true if it answered the query. `sinkpad` is where the bytes come in.
  bool Answer(GstPad* sinkpad, GstQuery* query) const;
  /// Returns nothing if the seek is not for this parser, otherwise whether upstream performed it.
  std::optional<bool> Seek(GstPad* sinkpad, GstEvent* event);

 private:
  struct Sought {
    guint32 seqnum = 0;
    GstSegment segment{};
    bool goes_on = false;  // continues after the last cloud
  };

  std::optional<GstClockTime> Duration(GstPad* sinkpad, const Grid& grid) const;
  GstClockTime Gone() const;
  void BeginAt(guint64 cloud);

  mutable std::mutex mutex_;  // guards what follows; not held while anything is pushed
  Grid grid_;
  GstSegment segment_{};          // as sent downstream
  std::optional<Sought> sought_;  // until its segment comes
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts between times and byte offsets in a file whose clouds have equal sizes. Answers the
// seeks and queries of its parser.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <optional>

#include "gst/common/refs.h"

namespace lidar::gst {

/// The timeline of a parser whose upstream uses bytes and whose downstream uses time. Any thread
/// may send queries and seeks.
class CloudTimeline {
 public:
  CloudTimeline() { gst_segment_init(&segment_, GST_FORMAT_TIME); }

  struct Grid {
    guint64 cloud_bytes = 0;  // 0: not known, so seeks and queries fail
    guint64 rate_n = 10;      // clouds/s
    guint64 rate_d = 1;

    /// TimeOf() returns the time at which a cloud begins. CloudAt() returns the cloud at a time.
    /// Clouds are numbered from 0.
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
    guint64 shown = 0;  // clouds below this number were pushed; a seek may repeat them
  };
  /// Converts a segment in bytes to a segment in time, whose running time continues after the last
  /// cloud. Sets `place` to the beginning of the segment, as far as it is known.
  EventPtr ToTime(GstEvent* segment, Place* place);
  /// Returns a segment that begins at cloud `next`. Its running time continues after the last
  /// cloud. Call this after the grid has changed.
  EventPtr Continue(guint64 next);
  /// Converts a SEGMENT_DONE event from bytes to time. Takes ownership of the event.
  EventPtr EndInTime(GstEvent* done) const;
  /// Notes that the last pushed cloud ends at `end`, or at the stop position of the segment if that
  /// is earlier.
  void NotePosition(GstClockTime end);
  /// Makes the running time start at 0 again.
  void RestartTime();

  /// Returns true if it answered the query. `sinkpad` is the pad that receives the bytes.
  bool Answer(GstPad* sinkpad, GstQuery* query) const;
  /// Performs a seek in time by a seek in bytes upstream. Returns true if upstream performed it.
  /// Returns nothing if the seek is not for this parser.
  std::optional<bool> Seek(GstPad* sinkpad, GstEvent* event);

 private:
  struct Sought {
    guint32 seqnum = 0;
    GstSegment segment{};
    bool goes_on = false;  // the seek continues after the last pushed cloud
  };

  std::optional<GstClockTime> Duration(GstPad* sinkpad, const Grid& grid) const;
  GstClockTime Gone() const;
  void BeginAt(guint64 cloud);

  mutable std::mutex mutex_;  // guards all members below; not held while an event is pushed
  Grid grid_;
  GstSegment segment_{};          // the segment that was sent downstream
  std::optional<Sought> sought_;  // set until the segment of the seek arrives
};

}  // namespace lidar::gst

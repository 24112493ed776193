// SPDX-License-Identifier: LGPL-2.1-or-later
// Merges the streams of screamtx at its src pad: chooses the events, and maps buffer times to one
// segment.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <vector>

#include "gst/scream/tx/stream.h"

namespace lidar::gst {

/// If there is a single stream, its events are sent unchanged. If there are several streams, the
/// src pad has its own events, which are valid for all streams. Only the pacing task uses the
/// merger, with the element's lock held.
class StreamMerger {
 public:
  using Streams = std::vector<std::unique_ptr<TxStream>>;

  StreamMerger() { gst_segment_init(&segment_, GST_FORMAT_UNDEFINED); }
  /// Returns the next event that is ahead of all queued packets of its stream, or NULL.
  EventPtr NextEvent(const Streams& streams);
  /// Call it after the end was sent, with empty queues. The next events then begin a new stream.
  void BeginAnew() {
    sent_start_ = merged_caps_ = false;
    segment_due_ = true;
  }
  /// Call it after a flush that went downstream and removed the segment there. The next segment is
  /// then sent.
  void ForgetSegment() { segment_due_ = true; }
  /// Returns `buffer` with its times converted to the src pad's segment.
  BufferPtr ToOutput(const TxStream& stream, BufferPtr buffer) const;

 private:
  EventPtr TakeEvent(TxStream* stream) const;
  bool Suits(const TxStream& stream, const Streams& streams, GstEvent* event) const;
  void NoteSent(bool merged, EventPtr* event);

  bool sent_start_ = false;
  bool merged_caps_ = false;
  bool segment_due_ = true;
  GstSegment segment_;
};

}  // namespace lidar::gst

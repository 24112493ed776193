// SPDX-License-Identifier: LGPL-2.1-or-later
// Merges the streams of screamtx at its src pad: chooses the events, and maps buffer times to one
// segment.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <vector>

#include "gst/scream/tx/stream.h"

namespace lidar::gst {

/// A single stream keeps its events. With several streams the src pad has its own events, which fit
/// all of them. Only the pacing task uses it, with the element's lock.
class StreamMerger {
 public:
  using Streams = std::vector<std::unique_ptr<TxStream>>;

  StreamMerger() { gst_segment_init(&segment_, GST_FORMAT_UNDEFINED); }
  /// Returns the next event whose place is before all queued packets of its stream, or NULL.
  EventPtr NextEvent(const Streams& streams);
  /// Call it after the end, with empty queues: the next events begin a new stream.
  void BeginAnew() {
    sent_start_ = merged_caps_ = false;
    segment_due_ = true;
  }
  /// Sends the next segment: a flush has removed the last one downstream.
  void ForgetSegment() { segment_due_ = true; }
  /// Returns `buffer` with its times in the src pad's segment.
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

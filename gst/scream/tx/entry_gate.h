// SPDX-License-Identifier: LGPL-2.1-or-later
// Delays input before the queues of screamtx.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <mutex>

#include "gst/scream/tx/stream.h"

namespace lidar::gst {

using TxLock = std::unique_lock<std::mutex>;

/// Live input enters at once. Other input waits for its time on the pipeline's clock and for room
/// in the queue, each stream in its own thread. All methods need the element's lock; waits release
/// it.
class EntryGate {
 public:
  explicit EntryGate(GstClock* clock) : clock_(clock) {}

  /// Lets chain functions queue packets.
  void Open() { Set(true, GST_FLOW_OK); }
  /// Ends all waits and closes the queues; chain functions return FLUSHING.
  void Close(const TxStreams& streams);
  /// Chain functions return `flow`, which came from downstream.
  void set_flow(GstFlowReturn flow) { Set(open_, flow); }
  GstFlowReturn flow() const { return flow_; }
  bool open() const { return open_; }
  void set_playing(const TxStreams& streams, bool playing);
  /// Packets have left the queue.
  void OnRoom() { changed_.notify_all(); }
  /// Wakes the thread of `stream` if it waits here.
  void Release(TxStream& stream);

  /// Returns the result of the chain function of `stream`; OK if it may queue.
  GstFlowReturn Check(const TxStream& stream) const;
  /// Waits until `first` may enter. The queue of `stream` is full while its head is older than
  /// `max_age`.
  void Wait(TxLock& lock, GstElement* element, Duration max_age, TxStream& stream,
            GstBuffer* first);

 private:
  void Set(bool open, GstFlowReturn flow);
  void WaitForRoom(TxLock& lock, Duration max_age, const TxStream& stream);
  void WaitForTime(TxLock& lock, GstElement* element, TxStream& stream, GstBuffer* first);

  GstClock* clock_;  // not owned
  std::condition_variable changed_;
  bool open_ = false;
  bool playing_ = false;
  GstFlowReturn flow_ = GST_FLOW_OK;
};

}  // namespace lidar::gst

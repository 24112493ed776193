// SPDX-License-Identifier: LGPL-2.1-or-later
// Delays input before the queues of screamtx.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <mutex>

#include "gst/scream/tx/stream.h"

namespace lidar::gst {

using TxLock = std::unique_lock<std::mutex>;

/// Lets live input into the queue at once. Other input waits, in the streaming thread of its pad,
/// for its time on the pipeline's clock and for room in the queue. Call all methods with the
/// element's lock held. A method that waits releases the lock meanwhile.
class EntryGate {
 public:
  explicit EntryGate(GstClock* clock) : clock_(clock) {}

  /// Lets chain functions queue packets.
  void Open() { Set(true, GST_FLOW_OK); }
  /// Ends all waits and closes the queues; chain functions return FLUSHING.
  void Close(const TxStreams& streams);
  /// Sets the result of the chain functions to `flow`, which a push downstream has returned.
  void set_flow(GstFlowReturn flow) { Set(open_, flow); }
  GstFlowReturn flow() const { return flow_; }
  bool open() const { return open_; }
  void set_playing(const TxStreams& streams, bool playing);
  /// Call it after packets have left the queue. Wakes the threads that wait for room.
  void OnRoom() { changed_.notify_all(); }
  /// Wakes the thread of `stream` if it waits here.
  void Release(TxStream& stream);

  /// Returns the result for the chain function of `stream`, which is OK if the function may queue.
  GstFlowReturn Check(const TxStream& stream) const;
  /// Waits until the buffer `first` may enter the queue of `stream`. The queue is full if its
  /// oldest packet has waited for `max_age` or longer.
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

// SPDX-License-Identifier: LGPL-2.1-or-later
// What may enter the queues of screamtx, and when.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <mutex>

#include "gst/scream/tx/stream.h"

namespace lidar::gst {

struct TxState;
using TxLock = std::unique_lock<std::mutex>;

/// Live input enters at once. Other input waits, each stream in its own thread, for its time on the
/// pipeline's clock and for room in the queue. Every method needs the element's lock; the waits
/// give it up.
class EntryGate {
 public:
  /// Chain functions may queue.
  void Open() { Set(true, GST_FLOW_OK); }
  /// Nobody waits or queues any more; chain functions return FLUSHING.
  void Close(TxState& state);
  /// Chain functions return `flow`, that of what is downstream.
  void set_flow(GstFlowReturn flow) { Set(open_, flow); }
  GstFlowReturn flow() const { return flow_; }
  bool open() const { return open_; }
  void set_playing(TxState& state, bool playing);
  /// Packets have left.
  void OnRoom() { changed_.notify_all(); }
  /// The thread of `stream` shall go, if it waits here.
  void Release(TxStream& stream);

  /// What the chain function of `stream` is to return before it may queue.
  GstFlowReturn Check(const TxStream& stream) const;
  /// Returns once `first` may enter.
  void Wait(TxLock& lock, GstElement* element, TxState& state, TxStream& stream, GstBuffer* first);

 private:
  void Set(bool open, GstFlowReturn flow);
  void WaitForRoom(TxLock& lock, TxState& state, const TxStream& stream);
  void WaitForTime(TxLock& lock, GstElement* element, TxStream& stream, GstBuffer* first);

  std::condition_variable changed_;
  bool open_ = false;
  bool playing_ = false;
  GstFlowReturn flow_ = GST_FLOW_OK;
};

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The task on the src pad of screamtx: takes packets out of the queues at the controller's times.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "gst/scream/tx/entry_gate.h"
#include "gst/scream/tx/gstscreamtx.h"
#include "gst/scream/tx/stream.h"

namespace lidar::gst {

struct TxState;

/// Call Start(), Stop() and Pause() without the element's lock, and the other methods with it. The
/// task pushes without the lock.
class PacingTask {
 public:
  explicit PacingTask(GstLidarScreamTx* self) : self_(self) {}

  bool Start();
  bool Stop();
  /// Pauses the task until the next Start(). Until then, chain functions return `flow`.
  void Pause(GstFlowReturn flow);

  /// Ends the task's wait, so that the task checks its conditions again.
  void Wake();
  /// Call it after a packet was queued. If the task waits for the next sending time, it is not
  /// woken, because it checks the queue at that time.
  void OnQueued() {
    if (!waits_for_pace_) Wake();
  }
  void OnSettings() {
    settings_changed_ = true;
    Wake();
  }
  /// Call it when a receiver has acknowledged packets. If some input is not live, postpones the
  /// deadline at which the stream ends even with packets in the queue.
  void OnAccepted(Time now);
  /// Call it when the stream begins anew, so that the next end of the stream is sent, too.
  void ForgetEnd();
  bool end_sent() const { return end_sent_; }

 private:
  /// The output of a round: packets, or an event.
  struct Batch {
    std::vector<BufferPtr> packets;
    std::vector<std::uint8_t> report;  // RTCP that is pushed after the packets
    EventPtr event;
    bool end = false;
    std::vector<guint32> goodbyes;
    bool unheard = false;  // the stream ends, and no receiver was heard

    bool empty() const { return packets.empty() && !event && !end; }
  };
  static void Run(gpointer self);
  void Round(TxLock& lock);
  Batch NextBatch(Time now);
  void DropLate(TxStream& stream, Time now);
  void DropUnwanted(TxStream& stream, Time now);
  BufferPtr TakePacket(TxStream& stream, Ecn ecn, Time now);
  void CollectPackets(Time now, Batch* batch);
  bool Drained(Time now);
  Time NextWake(Time now) const;
  void Wait(TxLock& lock);
  GstFlowReturn Push(Batch batch);
  TxState& state() const;

  GstLidarScreamTx* self_;
  GstClockID timer_ = nullptr;  // the current wait, not owned
  bool waits_for_pace_ = false;
  bool settings_changed_ = false;
  std::optional<Time> end_deadline_;
  bool end_sent_ = false;
};

}  // namespace lidar::gst

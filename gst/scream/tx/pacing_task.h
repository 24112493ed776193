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

/// Call Start(), Stop() and Pause() without the element's lock, other methods with it. The task
/// pushes without it.
class PacingTask {
 public:
  explicit PacingTask(GstLidarScreamTx* self) : self_(self) {}

  bool Start();
  bool Stop();
  /// Stops until the next Start(); chain functions return `flow`.
  void Pause(GstFlowReturn flow);

  /// Makes the task check its conditions again.
  void Wake();
  /// A packet was queued. A task that waits for its pace checks the queue soon enough.
  void OnQueued() {
    if (!waits_for_pace_) Wake();
  }
  void OnSettings() {
    settings_changed_ = true;
    Wake();
  }
  /// Call it when a receiver acknowledged packets. Delays the deadline of the end if input is not
  /// live.
  void OnAccepted(Time now);
  /// Call it when the stream begins anew: a new end is then sent, too.
  void ForgetEnd();
  bool end_sent() const { return end_sent_; }

 private:
  /// The output of a round: packets, or an event.
  struct Batch {
    std::vector<BufferPtr> packets;
    std::vector<std::uint8_t> report;  // RTCP that leaves with the packets
    EventPtr event;
    bool end = false;
    std::vector<guint32> goodbyes;
    bool unheard = false;  // a stream without a receiver ends

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
  GstClockID timer_ = nullptr;  // the present wait, not owned
  bool waits_for_pace_ = false;
  bool settings_changed_ = false;
  std::optional<Time> end_deadline_;
  bool end_sent_ = false;
};

}  // namespace lidar::gst

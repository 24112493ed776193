// SPDX-License-Identifier: LGPL-2.1-or-later
// Events of screamtx to the encoder of a stream: bitrates, key units, and receipts of packets.
#pragma once
#include <gst/gst.h>

#include <vector>

#include "gst/common/refs.h"
#include "gst/scream/tx/stream.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// An event that screamtx sends upstream from a sink pad.
struct PadEvent {
  PadPtr pad;
  EventPtr event;
  bool is_target = false;
};

/// Compares the state of `stream` with the events that were last sent to its encoder. Returns true
/// if an event is due.
bool EvaluateTargets(TxStream& stream, const scream::Controller& controller, bool key_unit_on_loss,
                     Time now);
bool TargetsAreDue(const TxStream& stream, Time now);
/// Appends the events that are due to `events`.
void TakeTargets(TxStream& stream, const scream::Controller& controller, Time now,
                 std::vector<PadEvent>* events);
/// Returns an event with the first target of `stream`. Later calls return null.
EventPtr FirstTarget(TxStream& stream, const scream::Controller& controller, Time now);

}  // namespace lidar::gst

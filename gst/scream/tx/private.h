// SPDX-License-Identifier: LGPL-2.1-or-later
// The inside of screamtx: what its parts share.
//
//     sink pads ── EntryGate ──▶ TxStream::queue ──▶ PacingTask ── StreamMerger ──▶ src
//                                     │ controller decides
//     rtcp_sink ──▶ controller ──▶ UpstreamReporter ──▶ events upstream, messages
//
// Threads: the sink pads' streaming threads queue packets; the pacing task on the src pad takes
// them out at the controller's times; the RTCP pad's thread gives feedback to the controller and
// finds the events that are due; the reporter's thread sends them, so that a slow encoder delays
// neither of the others. One mutex guards all that is shared; no thread holds it while pushing,
// posting, notifying or waiting.
#pragma once
#include <gst/gst.h>

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "gst/scream/feedback_peer.h"
#include "gst/scream/tx/entry_gate.h"
#include "gst/scream/tx/gstscreamtx.h"
#include "gst/scream/tx/link.h"
#include "gst/scream/tx/pacing_task.h"
#include "gst/scream/tx/sender_reports.h"
#include "gst/scream/tx/settings.h"
#include "gst/scream/tx/stream.h"
#include "gst/scream/tx/stream_merger.h"
#include "gst/scream/tx/upstream_reporter.h"
#include "src/rtcp/ccfb.h"
#include "src/scream/controller.h"

GST_DEBUG_CATEGORY_EXTERN(gst_lidar_scream_tx_debug);

namespace lidar::gst {

struct TxState {
  explicit TxState(GstLidarScreamTx* self) : pacing(self), reporter(self) {}
  ~TxState() { gst_object_unref(clock); }

  std::mutex mutex;  // guards all members but the clock
  GstClock* clock = gst_system_clock_obtain();
  TxSettings settings;
  Duration max_queue_delay{};                    // of this run
  std::optional<scream::Controller> controller;  // set from the first change to PAUSED on
  TxStreams streams;
  guint next_pad = 0;
  rtcp::CcfbParser parser;
  FeedbackPeer feedback_peer;
  guint64 malformed_rtcp = 0;
  guint64 frames_dropped = 0;     // of all streams, those of released pads included
  guint64 reports_of_others = 0;  // of packets that this link never sent
  std::shared_ptr<TxLink> link;   // null for a single link

  EntryGate gate{clock};
  StreamMerger merger;
  PacingTask pacing;
  SenderReports reports;
  UpstreamReporter reporter;
};

}  // namespace lidar::gst

struct _GstLidarScreamTx {
  GstElement parent;
  GstPad* src;
  GstPad* rtcp_sink;
  GstPad* rtcp_src;
  lidar::gst::TxState* state;
};

namespace lidar::gst {

// Call these with the lock held, except for TxNow():

/// Monotonic time, as the controller takes it.
Time TxNow(const TxState& state);
TxStream* FindStream(TxState& state, scream::StreamId id);
/// Gives the controller the changed settings of `stream`.
void Configure(TxState& state, TxStream& stream);
/// Drops the packets and events of `stream`.
void ClearQueue(TxState& state, TxStream& stream, Time now);
/// Drops packets, segments and EOS, as a flush does. Caps and other sticky events stay, because
/// upstream does not repeat them.
void FlushQueue(TxState& state, TxStream& stream, Time now);
StructurePtr StatsOf(TxState& state);

/// Makes changed settings of the element and its pads take effect soon. Call it without the lock.
void SettingsChanged(GstLidarScreamTx* self);

// input.cpp: sink pads
GstFlowReturn TxChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);
GstFlowReturn TxChainList(GstPad* pad, GstObject* parent, GstBufferList* list);
gboolean TxSinkEvent(GstPad* pad, GstObject* parent, GstEvent* event);
/// Handles the start or end of a flush of `stream`. Call it without the lock. Takes the event.
gboolean TxFlush(GstLidarScreamTx* self, TxStream& stream, GstEvent* event);
// feedback.cpp: the pad rtcp_sink
GstFlowReturn TxRtcpChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);

// pads.cpp: queries and links.
// RTP and RTCP are separate: src is linked to the sink pads, rtcp_src to rtcp_sink.
GstIterator* TxLinksOf(GstPad* pad, GstObject* parent);
gboolean TxSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event);
gboolean TxSrcQuery(GstPad* pad, GstObject* parent, GstQuery* query);
gboolean TxSinkQuery(GstPad* pad, GstObject* parent, GstQuery* query);

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal state of screamtx, which its parts share.
//
//     sink pads ── EntryGate ──▶ TxStream::queue ──▶ PacingTask ── StreamMerger ──▶ src
//                                     │ controller decides
//     rtcp_sink ──▶ controller ──▶ UpstreamReporter ──▶ events upstream, messages
//
// Threads: the streaming threads of the sink pads queue packets. The pacing task on the src pad
// removes packets from the queues at the controller's times. The thread of rtcp_sink gives feedback
// to the controller and finds the events that are due. The reporter's thread sends these events, so
// that a slow encoder does not delay the other threads. One mutex guards all shared state. No
// thread holds the mutex while it pushes, posts, notifies or waits.
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
  Duration max_queue_delay{};                    // as it was when this run began
  std::optional<scream::Controller> controller;  // exists from the first change to PAUSED on
  TxStreams streams;
  guint next_pad = 0;
  rtcp::CcfbParser parser;
  FeedbackPeer feedback_peer;
  guint64 malformed_rtcp = 0;
  guint64 frames_dropped = 0;     // of all streams, including those of released pads
  guint64 reports_of_others = 0;  // about packets that this link never sent
  std::shared_ptr<TxLink> link;   // null if this is the only link

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

/// Returns the time of the monotonic system clock, which the controller uses.
Time TxNow(const TxState& state);
TxStream* FindStream(TxState& state, scream::StreamId id);
/// Gives the changed settings of `stream` to the controller.
void Configure(TxState& state, TxStream& stream);
/// Drops all packets and events in the queue of `stream`.
void ClearQueue(TxState& state, TxStream& stream, Time now);
/// Drops packets, segments and EOS from the queue, as a flush does. Caps and other sticky events
/// stay in the queue, because upstream does not send them again.
void FlushQueue(TxState& state, TxStream& stream, Time now);
StructurePtr StatsOf(TxState& state);

/// Makes changed settings of the element and its pads take effect soon. Call it without the lock.
void SettingsChanged(GstLidarScreamTx* self);

// input.cpp: sink pads
GstFlowReturn TxChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);
GstFlowReturn TxChainList(GstPad* pad, GstObject* parent, GstBufferList* list);
gboolean TxSinkEvent(GstPad* pad, GstObject* parent, GstEvent* event);
/// Handles the FLUSH_START or FLUSH_STOP event of a flush of `stream`. Takes ownership of the
/// event. Call it without the lock.
gboolean TxFlush(GstLidarScreamTx* self, TxStream& stream, GstEvent* event);
// feedback.cpp: the pad rtcp_sink
GstFlowReturn TxRtcpChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);

// pads.cpp: queries and links.
// RTP and RTCP are separate: the sink pads are linked to src, and rtcp_sink to rtcp_src.
GstIterator* TxLinksOf(GstPad* pad, GstObject* parent);
gboolean TxSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event);
gboolean TxSrcQuery(GstPad* pad, GstObject* parent, GstQuery* query);
gboolean TxSinkQuery(GstPad* pad, GstObject* parent, GstQuery* query);

}  // namespace lidar::gst

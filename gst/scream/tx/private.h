// SPDX-License-Identifier: LGPL-2.1-or-later
// The inside of screamtx: its state, and the functions its files share.
//
// Threads: each sink pad's streaming thread queues packets; the pacing task on the src pad takes
// them out when the controller says; the RTCP pad's thread hands feedback in; the control thread
// sends events upstream and posts messages, so that a slow encoder delays neither of the others.
// One mutex guards the state; nobody holds it while pushing, posting, notifying or waiting.
#pragma once
#include <gst/gst.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "gst/scream/feedback_peer.h"
#include "gst/scream/tx/gstscreamtx.h"
#include "gst/scream/tx/settings.h"
#include "gst/scream/tx/stream.h"
#include "src/scream/controller.h"
#include "src/scream/feedback/ccfb.h"

GST_DEBUG_CATEGORY_EXTERN(gst_lidar_scream_tx_debug);

namespace lidar::gst {

struct TxState {
  std::mutex mutex;
  std::condition_variable room;     // queue space for input that is not live
  std::condition_variable control;  // work for the control thread
  TxSettings settings;
  std::optional<scream::Controller> controller;  // between READY and PAUSED
  scream::CcfbParser parser;
  FeedbackPeer feedback_peer;
  std::vector<std::unique_ptr<TxStream>> streams;
  guint next_pad = 0;

  // The pacing task
  GstClock* clock = nullptr;
  GstClockID timer = nullptr;  // what the task waits for, not owned
  bool waits_for_pace = false;
  bool settings_changed = false;
  bool running = false;  // the src pad is active
  bool playing = false;
  GstFlowReturn flow = GST_FLOW_OK;
  std::optional<Time> eos_deadline;
  bool eos_sent = false;
  // What the src pad has had
  bool sent_stream_start = false;
  bool merged_caps = false;
  GstSegment out_segment{};

  // The control thread
  std::thread control_thread;
  bool control_stop = false;
  bool estimate_due = false;
  bool stats_due = false;
  bool ecn_due = false;
  scream::TargetNotifier notifier;
  scream::EcnState ecn_state = scream::EcnState::kOff;
  scream::EcnState ecn_announced = scream::EcnState::kOff;
  guint estimated_bps = 0;
  Time next_stats{};

  guint64 malformed_rtcp = 0;
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

using TxLock = std::unique_lock<std::mutex>;

/// Monotonic; what the controller calls time. Only between READY and PAUSED.
Time TxNow(const TxState& state);
/// Takes settings of the element and the pads over, soon.
void SettingsChanged(GstLidarScreamTx* self);
/// Makes the pacing task look again at what it waits for.
void WakePacer(TxState& state);
TxStream* FindStream(TxState& state, scream::StreamId id);
/// Gives the controller what has changed for `stream`.
void Configure(TxState& state, TxStream& stream);
/// Forgets the packets of `stream`; its events too, where `events`.
void ClearQueue(TxState& state, TxStream& stream, Time now);

// tx_input.cpp: sink pads
GstFlowReturn TxChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);
GstFlowReturn TxChainList(GstPad* pad, GstObject* parent, GstBufferList* list);
gboolean TxSinkEvent(GstPad* pad, GstObject* parent, GstEvent* event);
GstFlowReturn TxRtcpChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);

// tx_pads.cpp: what pads answer
/// RTP and RTCP do not mix: src belongs to the sink pads, rtcp_src to rtcp_sink.
GstIterator* TxLinksOf(GstPad* pad, GstObject* parent);
gboolean TxSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event);
gboolean TxSrcQuery(GstPad* pad, GstObject* parent, GstQuery* query);
gboolean TxSinkQuery(GstPad* pad, GstObject* parent, GstQuery* query);

// tx_pacer.cpp: the src pad's task
void TxPace(gpointer self);
gboolean TxActivateSrc(GstPad* pad, GstObject* parent, GstPadMode mode, gboolean active);

// tx_control.cpp: what goes upstream and to the application
/// Finds out what is due; with the lock held.
void Evaluate(GstLidarScreamTx* self, Time now);
void StartControl(GstLidarScreamTx* self);
void StopControl(GstLidarScreamTx* self);
/// The event with the target of `stream`; transfer full.
GstEvent* TargetEvent(const TxState& state, const TxStream& stream, Time now, const char* reason);

// tx_stats.cpp
/// With the lock held.
StructurePtr StatsOf(TxState& state);

}  // namespace lidar::gst

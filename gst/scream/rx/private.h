// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal state of screamrx, and the functions that its files share.
//
// Threads: the sink pad's streaming thread examines packets and passes them on. The task on
// rtcp_src sends reports when they are due. One mutex guards the state. No thread holds the mutex
// while it pushes or waits.
#pragma once
#include <gst/base/gstflowcombiner.h>
#include <gst/gst.h>

#include <bitset>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "gst/scream/peer_latch.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/rx/gstscreamrx.h"
#include "gst/scream/rx/link_reports.h"
#include "gst/scream/rx/sender_view.h"
#include "src/rtcp/feedback_generator.h"

GST_DEBUG_CATEGORY_EXTERN(gst_lidar_scream_rx_debug);

namespace lidar::gst {

enum NumReportsMode { kNumReportsCount, kNumReportsEricsson };
GType NumReportsType();

struct RxSettings {
  rtcp::FeedbackConfig feedback;  // without the values of the fields below
  guint packets_per_feedback = static_cast<guint>(rtcp::FeedbackConfig{}.packets_per_feedback);
  guint ssrc = 0;
  gint num_reports = kNumReportsCount;
  bool eos_on_bye = true;
  DataSize packet_overhead = DataSize::Bytes(28);
  Duration max_age{};  // 0: no limit
  SharedStructure pt_map;
};
using RxProperties = std::array<Property<RxSettings>, 10>;
const RxProperties& RxPropertyTable();

struct RxCounters {
  guint64 foreign = 0;
  guint64 malformed = 0;
  guint64 old = 0;
  guint64 moves = 0;
  guint64 copies = 0;
  guint64 goodbyes = 0;
  guint ssrcs = 0;
};

/// The pad of an SSRC.
struct RxRoute {
  GstPad* pad = nullptr;
  guint payload_type = 0;
  guint64 number = 0;  // higher for each new route
  bool ended = false;  // by an RTCP BYE, or because another peer was accepted
};

struct RxState {
  std::mutex mutex;
  RxSettings settings;
  LinkReports reports;
  PeerLatch latch;
  SeenPackets seen;
  std::bitset<128> lidar_types;                           // payload types of LiDAR
  std::set<std::pair<std::string, guint32>> old_streams;  // address and SSRC; older than max-age
  std::map<guint32, Time> ssrcs;  // of the peer, with the time of the last packet
  bool running = false;
  RxCounters counters;
  SenderView sender;
  bool settings_changed = false;
  guint32 own_ssrc = 1;

  // The task on rtcp_src:
  GstClock* clock = nullptr;
  GstClockID timer = nullptr;  // not owned
  Time waits_until{};
  bool rtcp_started = false;
  // Requests for key units that still have to be sent: the SSRC, and the index of the link that
  // sends the request.
  std::set<std::pair<guint32, std::size_t>> key_requests;

  // The pads by SSRC, if there is a pt-map. Only the streaming thread changes `routes`, but a flush
  // reads `routes` in another thread.
  std::map<guint32, RxRoute> routes;
  guint64 routes_begun = 0;

  // Used by the streaming thread only:
  bool eos = false;
  bool src_taken = false;    // a stream of pt-map uses src
  bool src_started = false;  // the caps of src were sent
  bool routes_full = false;  // the warning about too many routes was posted
  bool warned_of_untaken = false;
  GstFlowCombiner* combiner = nullptr;
};

}  // namespace lidar::gst

struct _GstLidarScreamRx {
  GstElement parent;
  GstPad* sink;
  GstPad* src;
  GstPad* rtcp_src;
  lidar::gst::RxState* state;
};

namespace lidar::gst {

using RxLock = std::unique_lock<std::mutex>;

Time RxNow(const RxState& state);
rtcp::FeedbackConfig ToConfig(const RxSettings& settings, guint32 own_ssrc);

// input.cpp: the sink pad
GstFlowReturn RxChain(GstPad* pad, GstObject* parent, GstBuffer* buffer);
GstFlowReturn RxChainList(GstPad* pad, GstObject* parent, GstBufferList* list);

// feedback.cpp:
gboolean RxActivateRtcp(GstPad* pad, GstObject* parent, GstPadMode mode, gboolean active);
/// Handles events from downstream.
gboolean RxSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event);
/// Wakes the task if the next report is due sooner. The caller holds the lock.
void WakeFeedback(RxState& state);

// demux.cpp: streams by SSRC, with pt-map
bool HasPtMap(GstLidarScreamRx* self);
/// Posts a warning about each field of pt-map that is invalid.
void CheckPtMap(GstLidarScreamRx* self);
/// Stores which payload types of pt-map are LiDAR. The caller holds the lock.
void NoteLidarTypes(RxState& state);
/// Stores the payload type in `caps` if it is LiDAR. Call it only if there is no pt-map.
void NoteCaps(RxState& state, const GstCaps* caps);
/// Pushes the packet on the pad of its stream. Adds the pad if the stream is new. Takes ownership
/// of the buffer.
GstFlowReturn Demux(GstLidarScreamRx* self, const RtpHeader& header, GstBuffer* buffer);
/// Sends an event of the sink pad to each media pad. Takes ownership of the event.
gboolean ForwardToAll(GstLidarScreamRx* self, GstEvent* event);
void RemoveRoutes(GstLidarScreamRx* self);

}  // namespace lidar::gst

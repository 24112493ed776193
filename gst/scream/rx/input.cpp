// SPDX-License-Identifier: LGPL-2.1-or-later
// The input of screamrx: counts media packets and passes them on, and handles RTCP BYEs.
#include <algorithm>

#include "gst/common/buffer_map.h"
#include "gst/scream/rx/private.h"
#include "src/rtp/ntp_time.h"
#include "src/rtp/payload_header.h"

#define GST_CAT_DEFAULT gst_lidar_scream_rx_debug

namespace lidar::gst {
namespace {

constexpr std::size_t kMaxSsrcs = 64;
// A stream that has sent no packet for this time does not prevent EOS after the other streams have
// ended.
constexpr Duration kSsrcTimeout = std::chrono::seconds(5);
// A kernel arrival time that is older than this, or in the future, is not used, because the system
// clock has been set meanwhile.
constexpr Duration kMaxAge = std::chrono::seconds(1);
constexpr Duration kMaxApart = std::chrono::milliseconds(1);

/// The current time on two clocks: the clock of the reports, and the clock of the kernel's arrival
/// times.
struct Clocks {
  Time now{};
  GstClockTime unix_now = 0;
};

/// Reads both clocks. If the thread was interrupted between the two reads, reads both again,
/// because the kernel's arrival times would otherwise be converted to earlier times.
Clocks ReadClocks(const RxState& state) {
  Clocks clocks;
  for (int tries = 0; tries < 3; ++tries) {
    clocks.now = RxNow(state);
    clocks.unix_now = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
    if (RxNow(state) - clocks.now < kMaxApart) break;
  }
  return clocks;
}

/// Converts an arrival time of the kernel to the monotonic clock of the reports.
Time ArrivalTime(const Clocks& clocks, GstClockTime arrival) {
  if (!GST_CLOCK_TIME_IS_VALID(arrival)) return clocks.now;
  const auto age = Duration{static_cast<std::int64_t>(clocks.unix_now - arrival)};
  return age > Duration{0} && age < kMaxAge ? clocks.now - age : clocks.now;
}

ByteView PayloadOf(const BufferMap& map, const RtpHeader& header) {
  if (!map || map.size() <= header.header_size) return {};
  return {map.data() + header.header_size, map.size() - header.header_size};
}

PeerLatch::Verdict Judge(RxState& state, Time now, GstBuffer* buffer, const RtpHeader& header) {
  PeerLatch::Packet packet{SourceOf(buffer), header.ssrc, header.seq, {}, 0};
  const bool wants_lidar =
      state.lidar_types[header.payload_type] && !state.latch.HasShownSlices(packet.from);
  const bool wants_digest = state.latch.WantsDigest(packet.from);
  if (!wants_lidar && !wants_digest) return state.latch.OnPacket(now, packet);
  const BufferMap map(buffer, GST_MAP_READ);
  if (wants_lidar) packet.lidar = PayloadOf(map, header);
  if (wants_digest && map) packet.digest = DigestOf(map.view());
  return state.latch.OnPacket(now, packet);
}

/// Returns true if a slice begins in `payload` and its capture time is more than max-age away from
/// `unix_now`, in either direction. Returns nothing if no slice begins in `payload`.
std::optional<bool> BeginsOld(const RxState& state, GstClockTime unix_now, ByteView payload) {
  std::optional<bool> old;
  for (const rtp::Unit& unit : rtp::ParsePayload(payload)) {
    if (!rtp::IsSlice(unit.unit) || !rtp::StartsUnit(unit.type) || unit.info.capture_ntp == 0)
      continue;
    const auto captured = static_cast<std::int64_t>(rtp::FromNtp(unit.info.capture_ntp));
    const Duration age{static_cast<std::int64_t>(unix_now) - captured};
    old = age > state.settings.max_age || -age > state.settings.max_age;
  }
  return old;
}

/// Returns true if the packet belongs to a recording that is sent again. Only the first packet of a
/// slice has a capture time. The packets that follow it are treated like the first packet.
bool IsOld(RxState& state, GstClockTime unix_now, GstBuffer* buffer, const RtpHeader& header) {
  if (state.settings.max_age == Duration{0} || !state.lidar_types[header.payload_type])
    return false;
  const BufferMap map(buffer, GST_MAP_READ);
  const auto begins_old = BeginsOld(state, unix_now, PayloadOf(map, header));
  // An old stream is identified by its address and SSRC. If only the SSRC counted, a recording with
  // the peer's SSRC would block the peer's packets, too.
  const std::pair stream(AddressToString(SourceOf(buffer)), header.ssrc);
  if (!begins_old) return state.old_streams.count(stream) > 0;
  if (!*begins_old) state.old_streams.erase(stream);
  if (*begins_old && state.old_streams.size() < kMaxSsrcs) state.old_streams.insert(stream);
  return *begins_old;
}

/// Counts a media packet. Returns false if the packet must be dropped. The caller holds the lock.
bool Account(GstLidarScreamRx* self, const Clocks& clocks, GstBuffer* buffer,
             const RtpHeader& header) {
  RxState& state = *self->state;
  const PeerLatch::Verdict verdict = Judge(state, clocks.now, buffer, header);
  if (verdict == PeerLatch::Verdict::kForeign) {
    GST_LOG_OBJECT(self, "dropping a packet of SSRC %08x that is not from the peer", header.ssrc);
    ++state.counters.foreign;
    return false;
  }
  if (verdict == PeerLatch::Verdict::kMoved) {
    ++state.counters.moves;
    state.reports.Reset(ToConfig(state.settings, state.own_ssrc));
    state.seen = {};
    state.sender.Reset();
    state.ssrcs.clear();
    for (auto& [ssrc, route] : state.routes) route.ended = true;
    GST_INFO_OBJECT(self, "the media now comes from %s",
                    AddressToString(state.latch.peer()).c_str());
  }
  GstLidarEcn ecn = GST_LIDAR_ECN_NOT_ECT;
  GstClockTime arrival = GST_CLOCK_TIME_NONE;
  gst_lidar_buffer_get_ecn(buffer, &ecn, &arrival);
  rtcp::ReceivedPacket packet;
  packet.ssrc = header.ssrc;
  packet.seq = header.seq;
  packet.ecn = static_cast<Ecn>(ecn);
  packet.marker = header.marker;
  packet.size = DataSize::Bytes(static_cast<std::int64_t>(gst_buffer_get_size(buffer))) +
                state.settings.packet_overhead;
  if (state.seen.ShowsRestart(header.ssrc, header.seq, header.timestamp))
    state.reports.Forget(header.ssrc);
  state.reports.OnPacket(SourceOf(buffer), ArrivalTime(clocks, arrival), packet);
  // If the erased stream is not at its end, its next packet adds it again.
  if (state.ssrcs.size() >= kMaxSsrcs) state.ssrcs.erase(state.ssrcs.begin());
  state.ssrcs[header.ssrc] = clocks.now;
  const bool is_new = state.seen.Add(header.ssrc, header.seq, header.timestamp);
  if (is_new || state.latch.links() < 2) return true;
  ++state.counters.copies;
  WakeFeedback(state);
  return false;
}

enum class Fate { kPass, kDrop, kEnd };

/// Returns true if a stream has not ended. A silent stream counts as ended, because a restarted
/// sender sends no BYE for the SSRC that it had before.
bool AnyAlive(const RxState& state, Time now) {
  return std::any_of(state.ssrcs.begin(), state.ssrcs.end(),
                     [now](const auto& s) { return now - s.second < kSsrcTimeout; });
}

/// Handles RTCP that arrives on the port of the media. A BYE ends its streams. A sender report is
/// stored for the property stats. Other RTCP is passed on unread or, if there is a pt-map, dropped,
/// because no pad is meant for it. The caller holds the lock.
Fate LookAtRtcp(RxState& state, Time now, GstBuffer* buffer, const BufferMap& map) {
  const auto goodbyes = ParseBye(map.view());
  if (goodbyes.empty() && !rtcp::HasSenderReport(map.view()))
    return state.settings.pt_map ? Fate::kDrop : Fate::kPass;
  if (!state.latch.IsPeer(SourceOf(buffer))) {
    ++state.counters.foreign;
    return Fate::kDrop;
  }
  const auto report = rtcp::ParseSenderReport(map.view());
  if (report && state.ssrcs.count(report->ssrc) > 0) state.sender.OnReport(now, *report);
  bool known = false;
  for (const guint32 ssrc : goodbyes) {
    known = state.ssrcs.erase(ssrc) > 0 || known;
    const auto route = state.routes.find(ssrc);
    if (route != state.routes.end()) route->second.ended = true;
  }
  if (known) ++state.counters.goodbyes;
  const bool end = known && state.settings.eos_on_bye && !AnyAlive(state, now);
  return end ? Fate::kEnd : Fate::kDrop;
}

Fate Look(GstLidarScreamRx* self, const Clocks& clocks, GstBuffer* buffer, RtpHeader* header) {
  RxState& state = *self->state;
  if (IsRtcp(buffer)) {
    const BufferMap map(buffer, GST_MAP_READ);
    RxLock lock(state.mutex);
    if (map) return LookAtRtcp(state, clocks.now, buffer, map);
  }
  const auto read = ReadRtpHeader(buffer);
  RxLock lock(state.mutex);
  if (!read) {
    GST_DEBUG_OBJECT(self, "dropping what is no RTP");
    ++state.counters.malformed;
    return Fate::kDrop;
  }
  *header = *read;
  if (IsOld(state, clocks.unix_now, buffer, *read)) {
    ++state.counters.old;
    return Fate::kDrop;
  }
  if (!Account(self, clocks, buffer, *read)) return Fate::kDrop;
  WakeFeedback(state);
  return Fate::kPass;
}

GstFlowReturn End(GstLidarScreamRx* self) {
  GST_INFO_OBJECT(self, "every stream has said goodbye");
  self->state->eos = true;
  ForwardToAll(self, gst_event_new_eos());
  return GST_FLOW_EOS;
}

}  // namespace

GstFlowReturn RxChain(GstPad*, GstObject* parent, GstBuffer* buffer) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  BufferPtr owner(buffer);
  if (self->state->eos) return GST_FLOW_EOS;
  RtpHeader header;
  switch (Look(self, ReadClocks(*self->state), buffer, &header)) {
    case Fate::kDrop:
      return GST_FLOW_OK;
    case Fate::kEnd:
      return End(self);
    case Fate::kPass:
      break;
  }
  if (HasPtMap(self)) return Demux(self, header, owner.release());
  return gst_pad_push(self->src, owner.release());
}

GstFlowReturn RxChainList(GstPad* pad, GstObject* parent, GstBufferList* list) {
  auto* self = GST_LIDAR_SCREAM_RX(parent);
  const BufferListPtr owner(list);
  const bool demux = HasPtMap(self);
  const guint n = gst_buffer_list_length(list);
  if (demux) {
    GstFlowReturn flow = GST_FLOW_OK;
    for (guint i = 0; i < n && flow == GST_FLOW_OK; ++i)
      flow = RxChain(pad, parent, gst_buffer_ref(gst_buffer_list_get(list, i)));
    return flow;
  }
  if (self->state->eos) return GST_FLOW_EOS;
  const Clocks clocks = ReadClocks(*self->state);
  BufferListPtr passed(gst_buffer_list_new_sized(n));
  bool end = false;
  for (guint i = 0; i < n && !end; ++i) {
    RtpHeader header;
    GstBuffer* buffer = gst_buffer_list_get(list, i);
    const Fate fate = Look(self, clocks, buffer, &header);
    if (fate == Fate::kPass) gst_buffer_list_add(passed.get(), gst_buffer_ref(buffer));
    end = fate == Fate::kEnd;
  }
  GstFlowReturn flow = GST_FLOW_OK;
  if (gst_buffer_list_length(passed.get()) > 0)
    flow = gst_pad_push_list(self->src, passed.release());
  return end && flow == GST_FLOW_OK ? End(self) : flow;
}

}  // namespace lidar::gst

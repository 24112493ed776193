// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/bond.h"

#include <gst/video/video.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

#include "gst/common/sink_pads.h"
#include "gst/lidar/gstlidar.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/tx/feedback.h"
#include "gst/scream/tx/link.h"

namespace lidar::gst {

using bonding::PacketId;
using bonding::Scheduler;

constexpr DataSize kHeaders = DataSize::Bytes(28);  // UDP and IP
// Least change of a target that is sent to the encoder, relative to the target.
constexpr double kWorthTelling = 0.02;
// Least interval between key units. The interval of a single link is longer.
constexpr Duration kKeyUnitInterval = std::chrono::milliseconds(400);
constexpr Duration kWatchEvery = std::chrono::milliseconds(100);

struct BondStream {
  GstPad* sink = nullptr;
  std::vector<GstPad*> srcs;                   // one per link
  std::vector<GstLidarTargetBitrate> targets;  // as the links report them
  std::vector<std::string> reasons;            // of `targets`
  guint told = 0;                              // last target sent to the encoder [bit/s]
  std::optional<Time> key_unit_at;             // last request for a key unit
};

/// A report that came by another link than its own.
struct Misdirected {
  std::size_t owner;
  lidar::scream::CongestionFeedback report;
};
constexpr std::size_t kMaxMisdirected = 64;  // a tick of feedback

struct Kept {
  BufferPtr buffer;
  BondStream* stream;
};

/// Shared with the links, whose calls may still run when the element is finalized.
struct BondShared {
  BondShared(std::size_t links, lidar::bonding::Method method, lidar::bonding::TargetRule rule)
      : scheduler(links, method, rule) {}
  ~BondShared() { gst_object_unref(clock); }

  Time Now() const { return Time{Duration{static_cast<std::int64_t>(gst_clock_get_time(clock))}}; }

  std::mutex mutex;
  GstClock* clock = gst_system_clock_obtain();  // the links use the same one
  std::shared_ptr<SrtpLayer> srtp;              // set below READY
  Scheduler scheduler;
  std::unordered_map<std::uint64_t, Kept> kept;
  std::deque<std::pair<Time, std::uint64_t>> order;
  std::vector<Misdirected> misdirected;
};

class BondLink : public TxLink {
 public:
  BondLink(std::shared_ptr<BondShared> bond, std::size_t index)
      : bond_(std::move(bond)), index_(index) {}

  bool Wants(Time now, guint32 ssrc, guint16 seq) override {
    const std::lock_guard lock(bond_->mutex);
    return bond_->scheduler.Wants(now, index_, {ssrc, seq});
  }
  guint16 OnSent(Time now, guint32 ssrc, guint16 seq) override {
    const std::lock_guard lock(bond_->mutex);
    return bond_->scheduler.OnSent(now, index_, {ssrc, seq});
  }
  void OnDropped(Time now, guint32 ssrc, guint16 seq) override {
    const std::lock_guard lock(bond_->mutex);
    bond_->scheduler.OnDropped(now, index_, {ssrc, seq});
  }
  std::optional<lidar::scream::CongestionFeedback> OnFeedback(
      Time now, const lidar::scream::CongestionFeedback& report) override {
    const std::lock_guard lock(bond_->mutex);
    auto own = bond_->scheduler.OnFeedback(now, index_, report);
    if (own || bond_->misdirected.size() >= kMaxMisdirected) return own;
    // The other screamtx has a lock of its own, so the bond's thread takes the report there.
    if (const auto owner = bond_->scheduler.OwnerOf(report))
      bond_->misdirected.push_back({*owner, report});
    return own;
  }
  gsize trailer() const override { return bond_->srtp ? bond_->srtp->overhead() : 0; }
  void OnPath(const lidar::scream::Statistics& s) override {
    const std::lock_guard lock(bond_->mutex);
    const bool known = s.s_rtt > Duration{0};
    bond_->scheduler.OnPath(index_, {known ? s.ref_wnd / s.s_rtt : DataRate{}, s.s_rtt});
  }

 private:
  std::shared_ptr<BondShared> bond_;
  std::size_t index_;
};

struct BondState {
  std::shared_ptr<BondShared> shared;
  std::vector<GstLidarScreamTx*> links;
  std::vector<std::unique_ptr<BondStream>> streams;  // guarded by shared->mutex
  std::vector<std::unique_ptr<BondStream>> removed;  // kept, as a link's call may still use them
  guint next_pad = 0;
  std::function<void()> watch;
  std::condition_variable wake;
  bool stop = false;
  bool warned_of_swaps = false;
  GThread* thread = nullptr;
};

}  // namespace lidar::gst

using namespace lidar::gst;
using lidar::DataRate;
using lidar::DataSize;
using lidar::Duration;
using lidar::Time;

struct _GstLidarScreamBond {
  GstElement parent;
  lidar::gst::BondState* state;
};

G_DEFINE_TYPE(GstLidarScreamBond, gst_lidar_scream_bond, GST_TYPE_ELEMENT)

static GstStaticPadTemplate bond_sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink_%u", GST_PAD_SINK, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate bond_src_template = GST_STATIC_PAD_TEMPLATE(
    "src_%u_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));

static BondStream& StreamOf(GstPad* pad) {
  return *static_cast<BondStream*>(gst_pad_get_element_private(pad));
}

static BondState& BondOf(gpointer self) { return *GST_LIDAR_SCREAM_BOND(self)->state; }

/// Keeps a packet while it may be copied.
static void Keep(BondShared& shared, Time now, PacketId id, GstBuffer* buffer, BondStream* stream) {
  while (!shared.order.empty() && (now - shared.order.front().first > Scheduler::kMaxAge ||
                                   shared.order.size() >= Scheduler::kMaxPackets)) {
    shared.kept.erase(shared.order.front().second);
    shared.order.pop_front();
  }
  const bool fresh =
      shared.kept.insert_or_assign(id.key(), Kept{BufferPtr(gst_buffer_ref(buffer)), stream})
          .second;
  if (fresh) shared.order.emplace_back(now, id.key());
}

static lidar::bonding::LinkSet Schedule(BondShared& shared, GstBuffer* buffer, BondStream* stream) {
  const auto header = ReadRtpHeader(buffer);
  if (!header) return 1;  // another buffer counts as sent by the first link
  const Time now = shared.Now();
  const PacketId id{header->ssrc, header->seq};
  const auto size = static_cast<std::int64_t>(gst_buffer_get_size(buffer));
  const std::lock_guard lock(shared.mutex);
  Keep(shared, now, id, buffer, stream);
  const std::uint32_t slice = header->timestamp ^ header->ssrc;
  return shared.scheduler.OnPacket(now,
                                   {id, DataSize::Bytes(size) + kHeaders, slice, header->marker});
}

/// A failing link stops the stream only if no other link takes the packet.
static GstFlowReturn BondChain(GstPad* pad, GstObject* parent, GstBuffer* buffer) {
  BufferPtr packet(buffer);
  BondStream& stream = StreamOf(pad);
  BondShared& shared = *BondOf(parent).shared;
  if (shared.srtp) packet = shared.srtp->Protect(packet.release());
  if (!packet) return GST_FLOW_OK;
  const auto links = Schedule(shared, packet.get(), &stream);
  GstFlowReturn best = GST_FLOW_ERROR;
  for (std::size_t i = 0; i < stream.srcs.size(); ++i)
    if (links[i]) best = std::max(best, gst_pad_push(stream.srcs[i], gst_buffer_ref(packet.get())));
  return best;
}

/// Waits for packets that another link may still deliver: the first goodbye ends the receiver.
static void AwaitArrivals(BondState& state) {
  BondShared& shared = *state.shared;
  std::unique_lock lock(shared.mutex);
  while (!state.stop && shared.scheduler.AwaitsArrivals(shared.Now()))
    state.wake.wait_for(lock, Scheduler::kTick);
}

static gboolean BondSinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  const EventPtr owner(event);
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) AwaitArrivals(BondOf(parent));
  gboolean taken = FALSE;
  for (GstPad* src : StreamOf(pad).srcs)
    taken = gst_pad_push_event(src, gst_event_ref(event)) || taken;
  return taken;
}

/// Returns an event with the stream's combined target if the encoder does not have it yet. The
/// caller holds the lock.
static EventPtr DueTarget(BondShared& shared, BondStream& stream) {
  std::vector<DataRate> rates;
  for (const GstLidarTargetBitrate& t : stream.targets)
    rates.push_back(DataRate::BitsPerSecond(t.bitrate));
  const double bps = shared.scheduler.Target(shared.Now(), rates).bits_per_second();
  if (bps <= 0 ||
      std::abs(bps / std::max(1.0, static_cast<double>(stream.told)) - 1) < kWorthTelling)
    return nullptr;
  stream.told = static_cast<guint>(bps);
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < rates.size(); ++i)
    if (std::abs(rates[i].bits_per_second() - bps) <
        std::abs(rates[nearest].bits_per_second() - bps))
      nearest = i;
  GstLidarTargetBitrate target = stream.targets[nearest];
  target.bitrate = stream.told;
  target.reason = stream.reasons[nearest].c_str();
  return EventPtr(gst_lidar_event_new_target_bitrate(&target));
}

/// Returns true if another link has brought the same request for a key unit.
static bool IsRepeatedRequest(BondShared& shared, BondStream& stream, GstEvent* event) {
  if (!gst_video_event_is_force_key_unit(event)) return false;
  const Time now = shared.Now();
  const std::lock_guard lock(shared.mutex);
  if (stream.key_unit_at && now - *stream.key_unit_at < kKeyUnitInterval) return true;
  stream.key_unit_at = now;
  return false;
}

/// Combines targets, drops repeated requests, and passes other events on.
static gboolean BondSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  BondStream& stream = StreamOf(pad);
  if (IsRepeatedRequest(*BondOf(parent).shared, stream, event)) {
    gst_event_unref(event);
    return TRUE;
  }
  GstLidarTargetBitrate target{};
  if (!gst_lidar_event_parse_target_bitrate(event, &target))
    return gst_pad_push_event(stream.sink, event);
  const EventPtr owner(event);
  BondShared& shared = *BondOf(parent).shared;
  EventPtr due;
  {
    const std::lock_guard lock(shared.mutex);
    for (std::size_t i = 0; i < stream.srcs.size(); ++i) {
      if (stream.srcs[i] != pad) continue;
      stream.reasons[i] = target.reason != nullptr ? target.reason : "update";
      stream.targets[i] = target;
    }
    due = DueTarget(shared, stream);
  }
  return due ? gst_pad_push_event(stream.sink, due.release()) : TRUE;
}

static GstIterator* BondLinksOf(GstPad* pad, GstObject*) {
  BondStream& stream = StreamOf(pad);
  return LinkTo(pad == stream.sink ? stream.srcs.front() : stream.sink);
}

struct BondWork {
  std::vector<std::pair<PadPtr, BufferPtr>> copies;
  std::vector<std::pair<PadPtr, EventPtr>> targets;
  std::vector<Misdirected> reports;
};

/// The caller holds the lock.
static BondWork TakeWork(BondState& state) {
  BondShared& shared = *state.shared;
  BondWork work;
  work.reports.swap(shared.misdirected);
  for (const Scheduler::Copy& copy : shared.scheduler.TakeCopies(shared.Now())) {
    const auto kept = shared.kept.find(copy.id.key());
    if (kept == shared.kept.end()) continue;
    work.copies.emplace_back(PadPtr(GST_PAD(gst_object_ref(kept->second.stream->srcs[copy.link]))),
                             BufferPtr(gst_buffer_ref(kept->second.buffer.get())));
  }
  for (const auto& stream : state.streams)
    if (stream->told != 0)
      if (EventPtr due = DueTarget(shared, *stream))
        work.targets.emplace_back(PadPtr(GST_PAD(gst_object_ref(stream->sink))), std::move(due));
  return work;
}

static void TakeMisdirected(GstLidarScreamBond* self, const std::vector<Misdirected>& reports) {
  BondState& state = *self->state;
  for (const Misdirected& m : reports) TxTakeReport(state.links[m.owner], m.report);
  if (reports.empty() || std::exchange(state.warned_of_swaps, true)) return;
  GST_ELEMENT_WARNING(self, RESOURCE, READ,
                      ("Feedback of a link comes by another link; it is used for its own."),
                      ("Look for what swaps packets between the links: a relay, or translated "
                       "addresses. This is said once; feedback-ignored in links counts it."));
}

static gpointer BondRun(gpointer data) {
  auto* self = static_cast<GstLidarScreamBond*>(data);
  BondState& state = *self->state;
  std::unique_lock lock(state.shared->mutex);
  Time watch_at{};
  while (!state.stop) {
    BondWork work = TakeWork(state);
    lock.unlock();
    if (const Time now = state.shared->Now(); state.watch && now >= watch_at) {
      watch_at = now + kWatchEvery;
      state.watch();
    }
    TakeMisdirected(self, work.reports);
    for (auto& [pad, buffer] : work.copies) gst_pad_push(pad.get(), buffer.release());
    for (auto& [pad, event] : work.targets) gst_pad_push_event(pad.get(), event.release());
    work = {};
    lock.lock();
    state.wake.wait_for(lock, Scheduler::kTick, [&] { return state.stop; });
  }
  return nullptr;
}

static bool StartThread(GstLidarScreamBond* self) {
  BondState& state = *self->state;
  state.stop = false;
  state.warned_of_swaps = false;
  GError* error = nullptr;
  state.thread = g_thread_try_new("screambond", BondRun, self, &error);
  const ErrorPtr owner(error);
  if (state.thread != nullptr) return true;
  GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("No thread can be made: %s", error->message),
                    ("screamsink needs one to send copies over another link"));
  return false;
}

static void StopThread(BondState& state) {
  if (state.thread == nullptr) return;
  {
    const std::lock_guard lock(state.shared->mutex);
    state.stop = true;
    state.wake.notify_one();
  }
  g_thread_join(state.thread);
  state.thread = nullptr;
  const std::lock_guard lock(state.shared->mutex);
  state.shared->kept.clear();
  state.shared->misdirected.clear();
  state.shared->order.clear();
}

static GstStateChangeReturn BondChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_BOND(element);
  if (change == GST_STATE_CHANGE_READY_TO_PAUSED && !StartThread(self))
    return GST_STATE_CHANGE_FAILURE;
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_bond_parent_class)->change_state(element, change);
  if (change == GST_STATE_CHANGE_PAUSED_TO_READY) StopThread(*self->state);
  return result;
}

static void gst_lidar_scream_bond_init(GstLidarScreamBond* self) { self->state = new BondState; }

static void BondFinalize(GObject* object) {
  delete GST_LIDAR_SCREAM_BOND(object)->state;
  G_OBJECT_CLASS(gst_lidar_scream_bond_parent_class)->finalize(object);
}

static void gst_lidar_scream_bond_class_init(GstLidarScreamBondClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = BondFinalize;
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = BondChangeState;
  gst_element_class_add_static_pad_template(element, &bond_sink_template);
  gst_element_class_add_static_pad_template(element, &bond_src_template);
  gst_element_class_set_static_metadata(element, "SCReAM bond", "Filter/Network/RTP",
                                        "Sends a stream over several links", "gst-lidar");
}

namespace lidar::gst {

GstLidarScreamBond* NewBond(const std::vector<GstLidarScreamTx*>& links, bonding::Method method,
                            bonding::TargetRule rule) {
  auto* bond = GST_LIDAR_SCREAM_BOND(
      g_object_new(GST_TYPE_LIDAR_SCREAM_BOND, "name", "screambond", nullptr));
  BondState& state = *bond->state;
  state.shared = std::make_shared<BondShared>(links.size(), method, rule);
  state.links = links;
  for (std::size_t i = 0; i < links.size(); ++i)
    TxSetLink(links[i], std::make_shared<BondLink>(state.shared, i));
  return bond;
}

void BondProtect(GstLidarScreamBond* bond, std::shared_ptr<SrtpLayer> layer) {
  bond->state->shared->srtp = std::move(layer);
}

void BondRelease(GstLidarScreamBond* bond) {
  for (GstLidarScreamTx* tx : bond->state->links) TxSetLink(tx, nullptr);
  bond->state->links.clear();
  bond->state->shared->srtp.reset();
  bond->state->watch = nullptr;
}

GstPad* BondAddStream(GstLidarScreamBond* bond, const std::vector<GstPad*>& tx_pads) {
  BondState& state = *bond->state;
  auto stream = std::make_unique<BondStream>();
  const std::string number = std::to_string(state.next_pad++);
  const auto add = [&](GstStaticPadTemplate* pad_template, const std::string& name) {
    GstPad* pad = gst_pad_new_from_static_template(pad_template, name.c_str());
    gst_pad_set_element_private(pad, stream.get());
    gst_pad_set_iterate_internal_links_function(pad, BondLinksOf);
    return pad;
  };
  stream->sink = add(&bond_sink_template, "sink_" + number);
  GST_PAD_SET_PROXY_CAPS(stream->sink);
  gst_pad_set_chain_function(stream->sink, BondChain);
  gst_pad_set_event_function(stream->sink, BondSinkEvent);
  for (std::size_t i = 0; i < tx_pads.size(); ++i) {
    GstPad* src = add(&bond_src_template, "src_" + number + "_" + std::to_string(i));
    gst_pad_set_event_function(src, BondSrcEvent);
    stream->srcs.push_back(src);
  }
  stream->targets.resize(tx_pads.size());
  stream->reasons.resize(tx_pads.size());
  BondStream* made = stream.get();
  {
    const std::lock_guard lock(state.shared->mutex);
    state.streams.push_back(std::move(stream));
  }
  const bool active = GST_STATE(bond) > GST_STATE_READY;
  for (std::size_t i = 0; i < tx_pads.size(); ++i) {
    if (active) gst_pad_set_active(made->srcs[i], TRUE);
    gst_element_add_pad(GST_ELEMENT(bond), made->srcs[i]);
    gst_pad_link(made->srcs[i], tx_pads[i]);
  }
  if (active) gst_pad_set_active(made->sink, TRUE);
  gst_element_add_pad(GST_ELEMENT(bond), made->sink);
  return made->sink;
}

void BondRemoveStream(GstLidarScreamBond* bond, GstPad* sink) {
  BondState& state = *bond->state;
  BondStream* stream = &StreamOf(sink);
  gst_pad_set_active(sink, FALSE);
  std::unique_ptr<BondStream> gone;
  {
    const std::lock_guard lock(state.shared->mutex);
    for (auto it = state.shared->kept.begin(); it != state.shared->kept.end();)
      it = it->second.stream == stream ? state.shared->kept.erase(it) : std::next(it);
    for (auto& s : state.streams)
      if (s.get() == stream) gone = std::move(s);
    state.streams.erase(std::remove(state.streams.begin(), state.streams.end(), nullptr),
                        state.streams.end());
  }
  for (GstPad* src : stream->srcs) {
    gst_pad_set_active(src, FALSE);
    if (const PadPtr peer{gst_pad_get_peer(src)}) gst_pad_unlink(src, peer.get());
    gst_element_remove_pad(GST_ELEMENT(bond), src);
  }
  gst_element_remove_pad(GST_ELEMENT(bond), sink);
  state.removed.push_back(std::move(gone));
}

std::vector<PadPtr> BondedPads(GstPad* sink) {
  std::vector<PadPtr> pads;
  for (GstPad* src : StreamOf(sink).srcs) pads.emplace_back(gst_pad_get_peer(src));
  return pads;
}

void BondSetUsable(GstLidarScreamBond* bond, std::size_t link, bool usable) {
  BondShared& shared = *bond->state->shared;
  const std::lock_guard lock(shared.mutex);
  shared.scheduler.SetUsable(shared.Now(), link, usable);
}

void BondSetWatch(GstLidarScreamBond* bond, std::function<void()> watch) {
  bond->state->watch = std::move(watch);
}

BondLinkStats BondStats(GstLidarScreamBond* bond, std::size_t link) {
  BondShared& shared = *bond->state->shared;
  const std::lock_guard lock(shared.mutex);
  const Scheduler& scheduler = shared.scheduler;
  return {"",
          scheduler.counters(link),
          scheduler.usable(link),
          scheduler.InGap(shared.Now(), link),
          scheduler.has_reported(link),
          static_cast<guint>(scheduler.Bottleneck(link))};
}

}  // namespace lidar::gst

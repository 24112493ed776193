// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/bond.h"

#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

#include "gst/common/sink_pads.h"
#include "gst/scream/bond/bond_shared.h"
#include "gst/scream/tx/feedback.h"

namespace lidar::gst {

using bonding::Scheduler;

constexpr Duration kWatchEvery = std::chrono::milliseconds(100);

struct BondState {
  std::shared_ptr<BondShared> shared;
  std::vector<GstLidarScreamTx*> links;
  std::vector<std::unique_ptr<BondStream>> streams;  // guarded by shared->mutex
  std::vector<std::unique_ptr<BondStream>> removed;  // not freed: a link's call may still use them
  guint next_pad = 0;
  std::function<void()> watch;
  std::condition_variable wake;
  bool stop = false;
  bool warned_of_swaps = false;
  GThread* thread = nullptr;
};

}  // namespace lidar::gst

using namespace lidar::gst;
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

/// Pushes a packet to the links that the scheduler chooses. Returns an error only if all these
/// links fail.
static GstFlowReturn BondChain(GstPad* pad, GstObject* parent, GstBuffer* buffer) {
  BufferPtr packet(buffer);
  BondStream& stream = StreamOf(pad);
  BondShared& shared = *BondOf(parent).shared;
  if (shared.srtp) packet = shared.srtp->Protect(packet.release());
  if (!packet) return GST_FLOW_OK;
  const auto links = shared.Schedule(packet.get(), &stream);
  GstFlowReturn best = GST_FLOW_ERROR;
  for (std::size_t i = 0; i < stream.srcs.size(); ++i)
    if (links[i]) best = std::max(best, gst_pad_push(stream.srcs[i], gst_buffer_ref(packet.get())));
  return best;
}

/// Waits while a link may still deliver packets. Without this wait, the BYE of the fastest link
/// would end the receiver's streams before the packets of the other links arrive.
static void AwaitArrivals(BondState& state) {
  BondShared& shared = *state.shared;
  std::unique_lock lock(shared.mutex);
  while (!state.stop && shared.scheduler.AwaitsArrivals(shared.Now()))
    state.wake.wait_for(lock, Scheduler::kTick);
}

static gboolean BondSinkEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  const EventPtr owner(event);
  if (GST_EVENT_TYPE(event) == GST_EVENT_EOS) AwaitArrivals(BondOf(parent));
  if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP) {
    BondShared& shared = *BondOf(parent).shared;
    const std::lock_guard lock(shared.mutex);
    shared.ForgetPacketsLocked(&StreamOf(pad));
  }
  gboolean taken = FALSE;
  for (GstPad* src : StreamOf(pad).srcs)
    taken = gst_pad_push_event(src, gst_event_ref(event)) || taken;
  return taken;
}

/// Combines the targets of the links, drops repeated requests for key units, and passes other
/// events on.
static gboolean BondSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  BondStream& stream = StreamOf(pad);
  BondShared& shared = *BondOf(parent).shared;
  if (shared.IsRepeatedRequest(stream, event)) {
    gst_event_unref(event);
    return TRUE;
  }
  GstLidarTargetBitrate target{};
  if (!gst_lidar_event_parse_target_bitrate(event, &target))
    return gst_pad_push_event(stream.sink.get(), event);
  const EventPtr owner(event);
  EventPtr due = shared.Combine(stream, pad, target);
  return due ? gst_pad_push_event(stream.sink.get(), due.release()) : TRUE;
}

static GstIterator* BondLinksOf(GstPad* pad, GstObject*) {
  BondStream& stream = StreamOf(pad);
  return LinkTo(pad == stream.sink.get() ? stream.srcs.front() : stream.sink.get());
}

static void TakeMisdirected(GstLidarScreamBond* self, const std::vector<Misdirected>& reports) {
  BondState& state = *self->state;
  for (const Misdirected& m : reports) TxTakeReport(state.links[m.owner], m.report);
  if (reports.empty() || std::exchange(state.warned_of_swaps, true)) return;
  GST_ELEMENT_WARNING(
      self, RESOURCE, READ,
      ("Feedback about one link arrives on another link; it is used for the link that it is "
       "about."),
      ("Check whether a relay or address translation swaps packets between the links. This warning "
       "comes once; feedback-ignored in links counts such feedback."));
}

static gpointer BondRun(gpointer data) {
  auto* self = static_cast<GstLidarScreamBond*>(data);
  BondState& state = *self->state;
  std::unique_lock lock(state.shared->mutex);
  Time watch_at{};
  while (!state.stop) {
    BondWork work = state.shared->TakeWorkLocked(state.streams);
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
  GST_ELEMENT_ERROR(self, RESOURCE, FAILED, ("Cannot start a thread: %s.", error->message),
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
  state.shared->Clear(state.streams);
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
  for (std::size_t i = 0; i < links.size(); ++i) TxSetLink(links[i], NewBondLink(state.shared, i));
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
  GstPad* sink = add(&bond_sink_template, "sink_" + number);
  stream->sink.reset(GST_PAD(gst_object_ref_sink(sink)));
  GST_PAD_SET_PROXY_CAPS(sink);
  gst_pad_set_chain_function(sink, BondChain);
  gst_pad_set_event_function(sink, BondSinkEvent);
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
  if (active) gst_pad_set_active(sink, TRUE);
  gst_element_add_pad(GST_ELEMENT(bond), sink);
  return sink;
}

void BondRemoveStream(GstLidarScreamBond* bond, GstPad* sink) {
  BondState& state = *bond->state;
  BondStream* stream = &StreamOf(sink);
  gst_pad_set_active(sink, FALSE);
  std::unique_ptr<BondStream> gone;
  {
    const std::lock_guard lock(state.shared->mutex);
    state.shared->ForgetPacketsLocked(stream);
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

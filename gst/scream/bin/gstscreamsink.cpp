// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamsink
 *
 * screamtx and UDP with ECN in one bin; the receiver's feedback comes back on the same socket.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! lidarenc ! rtplidarpay ! screamsink \
 *   host=127.0.0.1 port=5004
 * ]|
 */
#include <gst/gst.h>

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "gst/common/element_class.h"
#include "gst/common/packet_probe.h"
#include "gst/common/refs.h"
#include "gst/common/sink_pads.h"
#include "gst/scream/bin/common.h"
#include "gst/scream/bond/sink_links.h"
#include "gst/scream/rtp_packet.h"
#include "gst/scream/tx/settings.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_scream_sink_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_sink_debug

using namespace lidar::gst;

namespace {

struct SinkSettings {
  UdpTarget target;
  bool strict_feedback = true;
  SrtpSettings srtp;
  BondSettings bond;
};

struct State : BinState {
  SinkSettings settings;
  SharedSocketAddress peer;
  std::shared_ptr<SinkLinks> links;  // null for a single link
  std::atomic<guint64> foreign{0};
};

}  // namespace

/// A ghost pad whose target is a sink pad of screamtx or, if there are several links, a sink pad of
/// the bond. It has the properties of the first link's pad. The pads of the other links have the
/// same values.
G_DECLARE_FINAL_TYPE(GstLidarScreamSinkPad, gst_lidar_scream_sink_pad, GST, LIDAR_SCREAM_SINK_PAD,
                     GstGhostPad)
struct _GstLidarScreamSinkPad {
  GstGhostPad parent;
};

G_DEFINE_TYPE(GstLidarScreamSinkPad, gst_lidar_scream_sink_pad, GST_TYPE_GHOST_PAD)

static void gst_lidar_scream_sink_pad_init(GstLidarScreamSinkPad*) {}

static PadPtr TxPadOf(GObject* ghost) {
  PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(ghost)));
  if (target && GST_IS_LIDAR_SCREAM_BOND(GST_OBJECT_PARENT(target.get())))
    return std::move(BondedPads(target.get()).front());
  return target;
}

static void gst_lidar_scream_sink_pad_class_init(GstLidarScreamSinkPadClass* klass) {
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = [](GObject* o, guint, const GValue* v, GParamSpec* spec) {
    if (const PadPtr pad = TxPadOf(o)) g_object_set_property(G_OBJECT(pad.get()), spec->name, v);
  };
  object->get_property = [](GObject* o, guint, GValue* v, GParamSpec* spec) {
    if (const PadPtr pad = TxPadOf(o)) g_object_get_property(G_OBJECT(pad.get()), spec->name, v);
  };
  InstallProperties(object, TxPadPropertyTable());
}

G_DECLARE_FINAL_TYPE(GstLidarScreamSink, gst_lidar_scream_sink, GST, LIDAR_SCREAM_SINK, GstBin)
struct _GstLidarScreamSink {
  GstBin parent;
  GstElement* tx;
  GstElement* sink;
  GstElement* src;
  State* state;
};

static void ChildProxyInit(gpointer iface, gpointer);

G_DEFINE_TYPE_WITH_CODE(GstLidarScreamSink, gst_lidar_scream_sink, GST_TYPE_BIN,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_CHILD_PROXY, ChildProxyInit))
GST_ELEMENT_REGISTER_DEFINE(screamsink, "screamsink", GST_RANK_NONE,
                            gst_lidar_scream_sink_get_type())

static StructurePtr Stats(GObject* object) {
  auto* self = GST_LIDAR_SCREAM_SINK(object);
  StructurePtr stats = StatsOf(self->tx);
  if (!stats) return stats;
  gst_structure_set(stats.get(), "feedback-foreign-address", G_TYPE_UINT64,
                    self->state->foreign.load(), nullptr);
  CopyStat(self->sink, "send-errors", stats.get());
  std::unique_lock lock(self->state->mutex);
  AddSrtpStats(self->state->srtp.get(), stats.get());
  const std::shared_ptr<SinkLinks> links = self->state->links;
  lock.unlock();
  if (links) links->AddStats(stats.get());
  return stats;
}

static guint Estimate(GObject* object) {
  guint bps = 0;
  if (GstElement* tx = GST_LIDAR_SCREAM_SINK(object)->tx)
    g_object_get(tx, "estimated-bitrate", &bps, nullptr);
  return bps;
}

/// Returns the defaults of the screamtx in a screamsink, which sends a BYE at the end, and a report
/// every second.
static const TxSettings& TxDefaults() {
  static const TxSettings defaults = [] {
    TxSettings s;
    s.send_bye = true;
    s.report_interval = std::chrono::seconds(1);
    return s;
  }();
  return defaults;
}

static Property<SinkSettings> OfTx(const char* name) {
  return Proxy<SinkSettings>(TxPropertyTable(), name,
                             ChildOf<GstLidarScreamSink, &GstLidarScreamSink::tx>, &TxDefaults());
}

static const std::array<Property<SinkSettings>, 27> kProperties = {{
    Within<&SinkSettings::target>(UdpTargetRows(), "host"),
    Within<&SinkSettings::target>(UdpTargetRows(), "port"),
    Within<&SinkSettings::target>(UdpTargetRows(), "bind-address"),
    Within<&SinkSettings::target>(UdpTargetRows(), "bind-port"),
    {"strict-feedback",
     "Accept feedback only from the host and port that media goes to; false: from any port of the "
     "host",
     &SinkSettings::strict_feedback},
    Proxy<SinkSettings>(UdpOptionRows(), "qos-dscp",
                        ChildOf<GstLidarScreamSink, &GstLidarScreamSink::sink>),
    OfTx("min-bitrate"),
    OfTx("start-bitrate"),
    OfTx("max-bitrate"),
    OfTx("max-total-bitrate"),
    OfTx("ecn-mode"),
    OfTx("max-queue-delay"),
    OfTx("stats-interval"),
    OfTx("send-bye"),
    OfTx("sender-report-interval"),
    OfTx("key-unit-on-loss"),
    OfTx("tuning"),
    {"estimated-bitrate", "Target of all streams together, IP included; notifies [bit/s]",
     Estimate},
    {"stats",
     "Statistics; bitrates in bit/s, times in ns; `links` has those of each link; links with the "
     "same `bottleneck` share one",
     Stats},
    Within<&SinkSettings::bond>(BondRows(), "bonding-addresses"),
    Within<&SinkSettings::bond>(BondRows(), "bonding-method"),
    Within<&SinkSettings::bond>(BondRows(), "bonding-target"),
    Within<&SinkSettings::srtp>(SrtpRows(), "srtp-key"),
    Within<&SinkSettings::srtp>(SrtpRows(), "srtp-cipher"),
    Within<&SinkSettings::srtp>(SrtpRows(), "srtp-auth"),
    Within<&SinkSettings::srtp>(SrtpRows(), "dtls-certificate"),
    Within<&SinkSettings::srtp>(SrtpRows(), "dtls-peer-certificate"),
}};

/// The rule by which feedback is accepted: it must come from the address `peer` or, if not
/// `strict`, from the host of `peer`.
struct FeedbackRule {
  SharedSocketAddress peer;
  bool strict;
};

static FeedbackRule FeedbackRuleOf(State& state) {
  const std::lock_guard lock(state.mutex);
  return {state.peer, state.settings.strict_feedback};
}

/// Returns true if `buffer` comes from the receiver at `peer`. Otherwise counts it as foreign. If
/// `peer` is a multicast group, all addresses are accepted, because the group may have many
/// receivers.
static bool IsFeedback(State& state, GstBuffer* buffer, GSocketAddress* peer, bool strict) {
  GSocketAddress* from = SourceOf(buffer);
  const auto is_group = [peer] {
    return g_inet_address_get_is_multicast(
               g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(peer))) != FALSE;
  };
  const bool known = from != nullptr && peer != nullptr &&
                     (is_group() || (strict ? SameAddress(from, peer) : SameHost(from, peer)));
  if (!known) ++state.foreign;
  return known;
}

static GstPadProbeReturn FilterFeedback(GstPad*, GstPadProbeInfo* info, gpointer data) {
  State& state = *GST_LIDAR_SCREAM_SINK(data)->state;
  const FeedbackRule rule = FeedbackRuleOf(state);
  return MapPackets(info, [&](BufferPtr packet) {
    return IsFeedback(state, packet.get(), rule.peer.get(), rule.strict) ? std::move(packet)
                                                                         : nullptr;
  });
}

static std::vector<PadPtr> SinkPadsOf(GstLidarScreamSink* self) {
  std::vector<PadPtr> pads;
  GST_OBJECT_LOCK(self);
  for (GList* p = GST_ELEMENT(self)->sinkpads; p != nullptr; p = p->next)
    pads.emplace_back(GST_PAD(gst_object_ref(p->data)));
  GST_OBJECT_UNLOCK(self);
  return pads;
}

/// Replaces the target of each ghost pad with the result of `retarget`.
static void ForEachGhost(GstLidarScreamSink* self, const std::function<PadPtr(GstPad*)>& retarget) {
  for (const PadPtr& pad : SinkPadsOf(self)) {
    const PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(pad.get())));
    if (!target) continue;
    gst_ghost_pad_set_target(GST_GHOST_PAD(pad.get()), nullptr);
    const PadPtr next = retarget(target.get());
    gst_ghost_pad_set_target(GST_GHOST_PAD(pad.get()), next.get());
  }
}

/// Inserts a bond between the ghost pads and the screamtx of each link.
static void Bond(GstLidarScreamSink* self, const std::vector<OpenLink>& open,
                 const BondSettings& settings) {
  const auto takes = [self](GstBuffer* buffer, GSocketAddress* peer) {
    return IsFeedback(*self->state, buffer, peer, FeedbackRuleOf(*self->state).strict);
  };
  auto links = std::make_shared<SinkLinks>(
      GST_ELEMENT(self), SinkLinks::Chain{self->tx, self->sink, self->src}, open, settings, takes);
  ForEachGhost(self,
               [&](GstPad* tx_pad) { return PadPtr(GST_PAD(gst_object_ref(links->Add(tx_pad)))); });
  const std::lock_guard lock(self->state->mutex);
  self->state->links = std::move(links);
}

static void Unbond(GstLidarScreamSink* self) {
  std::unique_lock lock(self->state->mutex);
  const std::shared_ptr<SinkLinks> links = std::move(self->state->links);
  lock.unlock();
  if (links) ForEachGhost(self, [&](GstPad* sink) { return links->Remove(sink); });
}

/// Opens the only link, or opens all links and stores them in `links`. Returns the first link. On
/// failure, posts an error message and returns a link without a socket.
static OpenLink OpenFirst(GstLidarScreamSink* self, const SinkSettings& s,
                          std::vector<OpenLink>* links) {
  OpenLink first;
  if (s.bond.addresses.empty()) {
    first.address.target = s.target;
    first.peer = ResolveTarget(GST_ELEMENT(self), s.target);
    if (first.peer)
      first.socket =
          OpenSending(GST_ELEMENT(self), s.target, g_socket_address_get_family(first.peer.get()));
    return first;
  }
  *links = OpenLinks(GST_ELEMENT(self), s.bond.addresses);
  return links->empty() ? first : links->front();
}

static std::shared_ptr<SinkLinks> LinksOf(GstLidarScreamSink* self) {
  const std::lock_guard lock(self->state->mutex);
  return self->state->links;
}

/// Returns the pads between which SRTP is inserted. `open` has all links.
static SrtpPlaces SrtpPlacesOf(GstLidarScreamSink* self, const std::vector<OpenLink>& open) {
  std::vector<SrtpPlace> places;
  const std::shared_ptr<SinkLinks> links = LinksOf(self);
  const auto add = [&](const SinkLinks::Chain& c) {
    places.push_back({c.tx, "src", "rtcp_sink", c.src});
  };
  if (!links) add({self->tx, self->sink, self->src});
  for (std::size_t i = 0; links && i < links->chains().size(); ++i) add(links->chains()[i]);
  const auto send_dtls = [open](GstBuffer* datagram, const DtlsKeys::Addresses&) {
    for (const OpenLink& link : open)
      SendDatagram(link.socket.get(), link.peer.get(), link.address.interface, datagram);
  };
  return {GST_ELEMENT(self), true, std::move(places), send_dtls};
}

/// Holds back the packets of `pad` until there is a key. Otherwise the SRTP layer would drop the
/// packets after screamtx has sent them, and screamtx would count them as lost.
static void AwaitKey(GstLidarScreamSink* self, GstPad* pad) {
  std::unique_lock lock(self->state->mutex);
  const std::shared_ptr<SrtpLayer> srtp = self->state->srtp;
  lock.unlock();
  if (srtp) KeyGate::Guard(srtp->gate(), pad);
}

/// Opens the socket, which is used in both directions, and gives it to the children.
static bool Open(GstLidarScreamSink* self) {
  State& state = *self->state;
  const SinkSettings s = Snapshot(state);
  if (!HasChildren(GST_ELEMENT(self),
                   {{self->tx, "screamtx"}, {self->sink, "ecnudpsink"}, {self->src, "ecnudpsrc"}}))
    return false;
  std::vector<OpenLink> links;
  const OpenLink first = OpenFirst(self, s, &links);
  SharedSocketAddress peer = first.peer;
  SharedSocket socket = first.socket;
  if (!socket) return false;
  // The sink gets the resolved address, because a name may have several addresses.
  g_object_set(self->sink, "host", HostOf(peer.get()).c_str(), "port", first.address.target.port,
               "interface", first.address.interface.c_str(), nullptr);
  GiveSocket(self->sink, socket.get());
  GiveSocket(self->src, socket.get());
  if (links.size() > 1) Bond(self, links, s.bond);
  std::shared_ptr<SrtpLayer> srtp;
  const std::vector<OpenLink> all = links.empty() ? std::vector<OpenLink>{first} : links;
  if (!StartSrtp(s.srtp, SrtpPlacesOf(self, all), &srtp)) return false;
  // A bond protects packets before they reach screamtx, so screamtx already counts the SRTP tags in
  // their size.
  const bool adds = srtp && links.size() < 2;
  const guint overhead = OverheadOf(peer.get()) + (adds ? srtp->overhead() : 0);
  g_object_set(self->tx, "packet-overhead", overhead, nullptr);
  if (srtp && !adds) LinksOf(self)->Protect(srtp);
  std::unique_lock lock(state.mutex);
  state.srtp = std::move(srtp);
  state.srtp_key = s.srtp.key;
  state.used = {std::move(socket), false};
  state.peer = std::move(peer);
  state.foreign = 0;
  lock.unlock();
  for (const PadPtr& pad : SinkPadsOf(self)) AwaitKey(self, pad.get());
  return true;
}

static void Close(GstLidarScreamSink* self) {
  EndSrtp(*self->state);
  Unbond(self);
  CloseBin(*self->state, {self->sink, self->src}, false);
  const std::lock_guard lock(self->state->mutex);
  self->state->peer.reset();
}

static void HandleMessage(GstBin* bin, GstMessage* message) {
  auto* self = GST_LIDAR_SCREAM_SINK(bin);
  const std::shared_ptr<SinkLinks> links =
      GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING ? LinksOf(self) : nullptr;
  if (links && links->IsNoNews(GST_MESSAGE_SRC(message))) return gst_message_unref(message);
  GST_BIN_CLASS(gst_lidar_scream_sink_parent_class)->handle_message(bin, message);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_SINK(element);
  if (change == GST_STATE_CHANGE_NULL_TO_READY && !Open(self)) {
    Close(self);
    return GST_STATE_CHANGE_FAILURE;
  }
  GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_sink_parent_class)->change_state(element, change);
  // NO_PREROLL comes from the source of the feedback. The bin does not return it, because the bin
  // is a sink of media.
  if (result == GST_STATE_CHANGE_NO_PREROLL) result = GST_STATE_CHANGE_SUCCESS;
  if (change == GST_STATE_CHANGE_READY_TO_NULL)
    Close(self);
  else if (result != GST_STATE_CHANGE_FAILURE)
    PlaySrtp(*self->state, change);
  return result;
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* templ, const gchar* name,
                          const GstCaps* caps) {
  auto* self = GST_LIDAR_SCREAM_SINK(element);
  if (self->tx == nullptr) return nullptr;
  GstPadTemplate* inner =
      gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(self->tx), "sink_%u");
  const PadPtr target(gst_element_request_pad(self->tx, inner, name, caps));
  if (!target) return nullptr;
  const StringPtr pad_name(gst_pad_get_name(target.get()));
  const std::shared_ptr<SinkLinks> links = LinksOf(self);
  GstPad* ghost = AddGhostSink(element, gst_lidar_scream_sink_pad_get_type(), templ, pad_name.get(),
                               links ? links->Add(target.get()) : target.get());
  AwaitKey(self, ghost);
  return ghost;
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  auto* self = GST_LIDAR_SCREAM_SINK(element);
  gst_pad_set_active(pad, FALSE);  // wakes a source that waits for the key
  PadPtr target(gst_ghost_pad_get_target(GST_GHOST_PAD(pad)));
  gst_ghost_pad_set_target(GST_GHOST_PAD(pad), nullptr);
  const std::shared_ptr<SinkLinks> links = LinksOf(self);
  if (links && target) target = links->Remove(target.get());
  if (target) gst_element_release_request_pad(self->tx, target.get());
  const StringPtr name(gst_pad_get_name(pad));
  gst_child_proxy_child_removed(GST_CHILD_PROXY(element), G_OBJECT(pad), name.get());
  gst_element_remove_pad(element, pad);
}

/// Returns GstBin's implementation, which lists the elements of the bin. The child proxy of
/// screamsink lists its pads after these elements, so that sink_0::priority can be set.
static GstChildProxyInterface* BinChildProxy() {
  return static_cast<GstChildProxyInterface*>(
      g_type_interface_peek(gst_lidar_scream_sink_parent_class, GST_TYPE_CHILD_PROXY));
}

static void ChildProxyInit(gpointer iface, gpointer) {
  auto* proxy = static_cast<GstChildProxyInterface*>(iface);
  proxy->get_children_count = [](GstChildProxy* p) -> guint {
    return BinChildProxy()->get_children_count(p) + SinkPadCount(p);
  };
  proxy->get_child_by_index = [](GstChildProxy* p, guint index) -> GObject* {
    const guint elements = BinChildProxy()->get_children_count(p);
    return index < elements ? BinChildProxy()->get_child_by_index(p, index)
                            : SinkPadAt(p, index - elements);
  };
  // GstBin's own function finds elements only.
  proxy->get_child_by_name = [](GstChildProxy* p, const gchar* name) -> GObject* {
    if (GstPad* pad = gst_element_get_static_pad(GST_ELEMENT(p), name)) return G_OBJECT(pad);
    return BinChildProxy()->get_child_by_name(p, name);
  };
}

static void gst_lidar_scream_sink_init(GstLidarScreamSink* self) {
  auto* element = GST_ELEMENT(self);
  self->state = new State;
  gst_bin_set_suppressed_flags(GST_BIN(self), GST_ELEMENT_FLAG_SOURCE);
  self->tx = AddChild(element, "screamtx");
  self->sink = AddChild(element, "ecnudpsink");
  self->src = AddChild(element, "ecnudpsrc");
  if (self->tx == nullptr || self->sink == nullptr || self->src == nullptr) return;
  const TxSettings& usual = TxDefaults();
  g_object_set(self->tx, "send-bye", static_cast<gboolean>(usual.send_bye),
               "sender-report-interval", static_cast<guint64>(usual.report_interval.count()),
               nullptr);
  g_object_set(self->sink, "sync", FALSE, "async", FALSE, nullptr);
  gst_element_link_pads(self->tx, "src", self->sink, "sink");
  gst_element_link_pads(self->src, "src", self->tx, "rtcp_sink");
  const PadPtr feedback(gst_element_get_static_pad(self->src, "src"));
  gst_pad_add_probe(feedback.get(), kPacketProbe, FilterFeedback, self, nullptr);
  g_signal_connect_swapped(
      self->tx, "notify::estimated-bitrate",
      G_CALLBACK(+[](GObject* bin) { g_object_notify(bin, "estimated-bitrate"); }), self);
}

static void gst_lidar_scream_sink_class_init(GstLidarScreamSinkClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scream_sink_debug, "screamsink", 0, "SCReAM sink bin");
  ServeState<GstLidarScreamSink, gst_lidar_scream_sink_parent_class, kProperties,
             ChangeSrtpKey<GstLidarScreamSink>>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->request_new_pad = RequestPad;
  element->release_pad = ReleasePad;
  GST_BIN_CLASS(klass)->handle_message = HandleMessage;
  Describe(klass,
           {"SCReAM network sink", "Sink/Network/RTP",
            "Sends RTP over UDP with SCReAM v2 congestion control and L4S"},
           {{"sink_%u", GST_PAD_SINK, "application/x-rtp", GST_PAD_REQUEST,
             gst_lidar_scream_sink_pad_get_type()}});
  gst_type_mark_as_plugin_api(gst_lidar_scream_sink_pad_get_type(),
                              static_cast<GstPluginAPIFlags>(0));
}

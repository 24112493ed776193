// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/sink_links.h"

#include <algorithm>

#include "gst/common/enum_type.h"
#include "gst/common/packet_probe.h"
#include "gst/scream/bin/common.h"
#include "gst/scream/tx/gstscreamtxpad.h"

namespace lidar::gst {
namespace {

using bonding::Method;
using bonding::TargetRule;

GType BondMethodType() {
  static const GEnumValue values[] = {
      {Int(Method::kAdaptive), "Copies of what waits, and of all after a gap", "adaptive"},
      {Int(Method::kBroadcast), "Every packet on every link", "broadcast"},
      {Int(Method::kBackup), "Copies of what waits only", "backup"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarScreamBondMethod", values);
  return type;
}

GType BondTargetType() {
  static const GEnumValue values[] = {
      {Int(TargetRule::kBetter), "What the better link carries", "better"},
      {Int(TargetRule::kSum), "What all links carry together", "sum"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarScreamBondTarget", values);
  return type;
}

// A link that failed to send packets is tried again after this time.
constexpr gint64 kRetryUs = 1 * G_USEC_PER_SEC;

/// Opens the link's socket. If the host is not found or the socket cannot be opened, returns a link
/// without a socket and sets `why` to the reason.
OpenLink Open(const BondAddress& address, std::string* why) {
  OpenLink link{address, nullptr, nullptr, true};
  GError* error = nullptr;
  link.peer.reset(ResolveUdpAddress(address.target.host, address.target.port, &error),
                  GObjectUnref{});
  if (link.peer) {
    const GSocketFamily family = g_socket_address_get_family(link.peer.get());
    link.socket.reset(OpenUdpSocket({address.target.bind_address, 0, family, false}, &error),
                      GObjectUnref{});
  }
  const ErrorPtr owner(error);
  if (error != nullptr) *why = error->message;
  return link;
}

GSocketFamily FamilyOf(const OpenLink& link) {
  return g_socket_address_get_family(link.peer.get());
}

/// The data of FilterLink(), which filters the feedback of a link.
struct FeedbackOfLink {
  SinkLinks::Takes takes;
  SharedSocketAddress peer;
};

GstPadProbeReturn FilterLink(GstPad*, GstPadProbeInfo* info, gpointer data) {
  const auto& link = *static_cast<const FeedbackOfLink*>(data);
  return MapPackets(info, [&link](BufferPtr packet) {
    return link.takes(packet.get(), link.peer.get()) ? std::move(packet) : nullptr;
  });
}

/// Binds the properties of `to`, except the property `own`, to those of `from`, which has the same
/// class.
void BindProperties(GObject* from, GObject* to, std::string_view own) {
  guint n = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(from), &n);
  for (guint i = 0; i < n; ++i) {
    if (specs[i]->owner_type == G_OBJECT_TYPE(from) && specs[i]->name != own &&
        (specs[i]->flags & G_PARAM_READWRITE) == G_PARAM_READWRITE)
      g_object_bind_property(from, specs[i]->name, to, specs[i]->name, G_BINDING_SYNC_CREATE);
  }
  g_free(specs);
}

GstElement* NewChild(GstElement* bin, const char* factory, std::size_t index) {
  GstElement* child = gst_element_factory_make(factory, (factory + std::to_string(index)).c_str());
  gst_bin_add(GST_BIN(bin), child);
  return child;
}

void RemoveChild(GstElement* bin, GstElement* child) {
  gst_element_set_state(child, GST_STATE_NULL);
  gst_bin_remove(GST_BIN(bin), child);
}

}  // namespace

const std::array<Property<BondSettings>, 3>& BondRows() {
  using S = BondSettings;
  static const std::array<Property<BondSettings>, 3> rows = {{
      {"bonding-addresses",
       "Links to send over, HOST:PORT@INTERFACE or HOST:PORT@LOCAL-ADDRESS, comma-separated, "
       "instead of host, port and bind-address; empty: one link",
       &S::addresses},
      {"bonding-method", "Packets that go over several links at once",
       EnumField<S>{&S::method, BondMethodType}},
      {"bonding-target", "Rate to request from encoders", EnumField<S>{&S::target, BondTargetType}},
  }};
  return rows;
}

std::vector<OpenLink> OpenLinks(GstElement* bin, const std::string& addresses) {
  std::string why;
  const auto parsed = ParseBondAddresses(addresses, &why);
  if (!parsed) {
    GST_ELEMENT_ERROR(bin, RESOURCE, SETTINGS, ("bonding-addresses: %s.", why.c_str()), (nullptr));
    return {};
  }
  const Interfaces now = Interfaces::Now();
  std::vector<OpenLink> links;
  bool any_usable = false;
  for (const BondAddress& address : *parsed) {
    OpenLink link = Open(address, &why);
    if (link.socket) why = now.Lacks(address, FamilyOf(link));
    link.usable = link.socket && why.empty();
    any_usable = any_usable || link.usable;
    if (!link.usable)
      GST_ELEMENT_WARNING(bin, RESOURCE, OPEN_WRITE,
                          ("The link %s cannot be used: %s.", address.text.c_str(), why.c_str()),
                          (link.socket ? "screamsink uses it as soon as it works"
                                       : "screamsink leaves it out until the next start"));
    if (link.socket) links.push_back(std::move(link));
  }
  if (any_usable) return links;
  GST_ELEMENT_ERROR(bin, RESOURCE, OPEN_WRITE, ("No link can be used: %s.", why.c_str()),
                    ("bonding-addresses are %s", addresses.c_str()));
  return {};
}

SinkLinks::SinkLinks(GstElement* bin, const Chain& first, const std::vector<OpenLink>& links,
                     const BondSettings& settings, Takes takes)
    : bin_(bin), takes_(std::move(takes)), chains_{first}, links_(links), health_(links.size()) {
  for (std::size_t i = 1; i < links.size(); ++i) AddLink(links[i]);
  std::vector<GstLidarScreamTx*> senders;
  for (const Chain& chain : chains_) senders.push_back(GST_LIDAR_SCREAM_TX(chain.tx));
  bond_ = NewBond(senders, static_cast<Method>(settings.method),
                  static_cast<TargetRule>(settings.target));
  for (std::size_t i = 0; i < links.size(); ++i) BondSetUsable(bond_, i, links[i].usable);
  BondSetWatch(bond_, [this] { Watch(); });
  gst_bin_add(GST_BIN(bin), GST_ELEMENT(bond_));
}

void SinkLinks::Watch() {
  const Interfaces now = Interfaces::Now();
  for (std::size_t i = 0; i < links_.size(); ++i) {
    std::string trouble = now.Lacks(links_[i].address, FamilyOf(links_[i]));
    if (Fails(i) && trouble.empty()) trouble = "its packets cannot be sent";
    if (links_[i].usable != trouble.empty()) Change(i, trouble);
  }
}

bool SinkLinks::Fails(std::size_t link) {
  Health& health = health_[link];
  const Health before = health;
  const StructurePtr stats = StatsOf(chains_[link].sink);
  gst_structure_get(stats.get(), "packets-sent", G_TYPE_UINT64, &health.sent, "send-errors",
                    G_TYPE_UINT64, &health.errors, nullptr);
  const gint64 now = g_get_monotonic_time();
  if (health.errors > before.errors && health.sent == before.sent) health.failed_us = now;
  return health.failed_us != 0 && now - health.failed_us < kRetryUs;
}

void SinkLinks::Change(std::size_t link, const std::string& trouble) {
  const bool usable = trouble.empty();
  links_[link].usable = usable;
  BondSetUsable(bond_, link, usable);
  gst_element_post_message(
      bin_, gst_message_new_element(
                GST_OBJECT(bin_),
                gst_structure_new("scream-link-changed", "link", G_TYPE_STRING,
                                  links_[link].address.text.c_str(), "usable", G_TYPE_BOOLEAN,
                                  static_cast<gboolean>(usable), "reason", G_TYPE_STRING,
                                  usable ? "it can be used again" : trouble.c_str(), nullptr)));
}

void SinkLinks::AddLink(const OpenLink& link) {
  const std::size_t index = chains_.size();
  const Chain chain{NewChild(bin_, "screamtx", index), NewChild(bin_, "ecnudpsink", index),
                    NewChild(bin_, "ecnudpsrc", index)};
  BindProperties(G_OBJECT(chains_[0].tx), G_OBJECT(chain.tx), "packet-overhead");
  g_object_set(chain.tx, "packet-overhead", OverheadOf(link.peer.get()), nullptr);
  g_object_bind_property(chains_[0].sink, "qos-dscp", chain.sink, "qos-dscp",
                         G_BINDING_SYNC_CREATE);
  g_object_set(chain.sink, "sync", FALSE, "async", FALSE, "host", HostOf(link.peer.get()).c_str(),
               "port", link.address.target.port, "interface", link.address.interface.c_str(),
               nullptr);
  GiveSocket(chain.sink, link.socket.get());
  GiveSocket(chain.src, link.socket.get());
  gst_element_link_pads(chain.tx, "src", chain.sink, "sink");
  gst_element_link_pads(chain.src, "src", chain.tx, "rtcp_sink");
  const PadPtr feedback(gst_element_get_static_pad(chain.src, "src"));
  gst_pad_add_probe(feedback.get(), kPacketProbe, FilterLink, new FeedbackOfLink{takes_, link.peer},
                    [](gpointer data) { delete static_cast<FeedbackOfLink*>(data); });
  chains_.push_back(chain);
}

SinkLinks::~SinkLinks() {
  BondRelease(bond_);
  RemoveChild(bin_, GST_ELEMENT(bond_));
  for (std::size_t i = 1; i < chains_.size(); ++i)
    for (GstElement* child : {chains_[i].tx, chains_[i].sink, chains_[i].src})
      RemoveChild(bin_, child);
  for (std::size_t i = 1; i < links_.size(); ++i) g_socket_close(links_[i].socket.get(), nullptr);
}

bool SinkLinks::IsNoNews(GstObject* warns) const {
  bool is_tx = false, other_was_heard = false;
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    if (GST_OBJECT(chains_[i].sink) == warns) return true;
    const bool its = GST_OBJECT(chains_[i].tx) == warns;
    is_tx = is_tx || its;
    other_was_heard = other_was_heard || (!its && BondStats(bond_, i).has_reported);
  }
  return is_tx && other_was_heard;
}

GstPad* SinkLinks::Add(GstPad* tx_pad) {
  std::vector<GstPad*> pads{tx_pad};
  const StringPtr name(gst_pad_get_name(tx_pad));
  for (std::size_t i = 1; i < chains_.size(); ++i) {
    GstPad* pad = gst_element_request_pad_simple(chains_[i].tx, name.get());
    BindProperties(G_OBJECT(tx_pad), G_OBJECT(pad), "");
    pads.push_back(pad);
  }
  GstPad* sink = BondAddStream(bond_, pads);
  for (std::size_t i = 1; i < pads.size(); ++i) gst_object_unref(pads[i]);
  return sink;
}

PadPtr SinkLinks::Remove(GstPad* sink) {
  std::vector<PadPtr> pads = BondedPads(sink);
  BondRemoveStream(bond_, sink);
  for (std::size_t i = 1; i < pads.size(); ++i)
    gst_element_release_request_pad(chains_[i].tx, pads[i].get());
  return std::move(pads.front());
}

void SinkLinks::AddStats(GstStructure* stats) const {
  GValue array = G_VALUE_INIT;
  gst_value_array_init(&array, 0);
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    StructurePtr link = StatsOf(chains_[i].tx);
    BondLinkStats bond = BondStats(bond_, i);
    bond.link = links_[i].address.text;
    AddLinkStats(bond, link.get());
    CopyStat(chains_[i].sink, "send-errors", link.get());
    GValue value = G_VALUE_INIT;
    g_value_init(&value, GST_TYPE_STRUCTURE);
    g_value_take_boxed(&value, link.release());
    gst_value_array_append_and_take_value(&array, &value);
  }
  gst_structure_take_value(stats, "links", &array);
}

}  // namespace lidar::gst

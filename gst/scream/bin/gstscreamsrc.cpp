// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamsrc
 *
 * UDP with ECN and screamrx in one bin; feedback goes back on the same socket to the address that
 * the media came from.
 *
 * |[
 * gst-launch-1.0 screamsrc port=5004 ! rtplidardepay ! lidardec ! fakesink
 * ]|
 */
#include <gst/gst.h>

#include "gst/common/element_class.h"
#include "gst/common/refs.h"
#include "gst/scream/bin/common.h"
#include "gst/scream/rx/private.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_scream_src_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_src_debug

using namespace lidar::gst;

namespace {

struct SrcSettings {
  UdpListen listen;
  GivenSocket given;
  SrtpSettings srtp;
};

struct State : BinState {
  SrcSettings settings;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarScreamSrc, gst_lidar_scream_src, GST, LIDAR_SCREAM_SRC, GstBin)
struct _GstLidarScreamSrc {
  GstBin parent;
  GstElement* src;
  GstElement* rx;
  GstElement* sink;
  State* state;
};

G_DEFINE_TYPE(GstLidarScreamSrc, gst_lidar_scream_src, GST_TYPE_BIN)
GST_ELEMENT_REGISTER_DEFINE(screamsrc, "screamsrc", GST_RANK_NONE, gst_lidar_scream_src_get_type())

static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate stream_template = GST_STATIC_PAD_TEMPLATE(
    "src_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));

static StructurePtr Stats(GObject* object) {
  auto* self = GST_LIDAR_SCREAM_SRC(object);
  StructurePtr stats = StatsOf(self->rx);
  if (!stats) return stats;
  CopyStat(self->src, "dropped-by-kernel", stats.get());
  const std::lock_guard lock(self->state->mutex);
  AddSrtpStats(self->state->srtp.get(), stats.get());
  return stats;
}

static Property<SrcSettings> OfSrc(const char* name) {
  return Proxy<SrcSettings>(UdpOptionRows(), name,
                            ChildOf<GstLidarScreamSrc, &GstLidarScreamSrc::src>);
}
static Property<SrcSettings> OfRx(const char* name) {
  return Proxy<SrcSettings>(RxPropertyTable(), name,
                            ChildOf<GstLidarScreamSrc, &GstLidarScreamSrc::rx>);
}

static const std::array<Property<SrcSettings>, 22> kProperties = {{
    Within<&SrcSettings::listen>(UdpListenRows(), "address"),
    Within<&SrcSettings::listen>(UdpListenRows(), "port"),
    Within<&SrcSettings::listen>(UdpListenRows(), "multicast-group"),
    Within<&SrcSettings::listen>(UdpListenRows(), "multicast-iface"),
    OfSrc("buffer-size"),
    OfSrc("timeout"),
    OfSrc("caps"),
    OfRx("feedback-interval"),
    OfRx("packets-per-feedback"),
    OfRx("num-reports"),
    OfRx("eos-on-bye"),
    OfRx("max-age"),
    OfRx("pt-map"),
    {"socket", "Socket to use for both ways; NULL opens one",
     At<&SrcSettings::given, &GivenSocket::socket>},
    {"close-socket", "Close the socket of the property socket when the element stops",
     At<&SrcSettings::given, &GivenSocket::close>},
    {"used-socket", "Socket in use; NULL when stopped", UsedSocket<GstLidarScreamSrc>},
    {"stats", "Counters of packets, bytes and reports", Stats},
    Within<&SrcSettings::srtp>(SrtpRows(), "srtp-key"),
    Within<&SrcSettings::srtp>(SrtpRows(), "srtp-cipher"),
    Within<&SrcSettings::srtp>(SrtpRows(), "srtp-auth"),
    Within<&SrcSettings::srtp>(SrtpRows(), "dtls-certificate"),
    Within<&SrcSettings::srtp>(SrtpRows(), "dtls-peer-certificate"),
}};

/// Opens the socket, which is used in both directions, and gives it to the children.
static bool Open(GstLidarScreamSrc* self) {
  State& state = *self->state;
  const SrcSettings s = Snapshot(state);
  if (!HasChildren(GST_ELEMENT(self),
                   {{self->src, "ecnudpsrc"}, {self->rx, "screamrx"}, {self->sink, "ecnudpsink"}}))
    return false;
  SocketInUse used =
      TakeSocket(s.given, [&] { return OpenListening(GST_ELEMENT(self), s.listen); });
  if (!used.socket) return false;
  GiveSocket(self->src, used.socket.get());
  GiveSocket(self->sink, used.socket.get());
  std::shared_ptr<SrtpLayer> srtp;
  SrtpPlaces places{GST_ELEMENT(self), false, {{self->rx, "rtcp_src", "sink", self->src}}, nullptr};
  places.send_dtls = [socket = used.socket](GstBuffer* datagram, const DtlsKeys::Addresses& to) {
    for (const SocketAddressPtr& address : to)
      SendDatagram(socket.get(), address.get(), "", datagram);
  };
  if (!StartSrtp(s.srtp, places, &srtp)) return false;
  const std::lock_guard lock(state.mutex);
  state.srtp = std::move(srtp);
  state.srtp_key = s.srtp.key;
  state.used = std::move(used);
  return true;
}

static void Close(GstLidarScreamSrc* self) {
  State& state = *self->state;
  std::unique_lock lock(state.mutex);
  const bool close_given = state.settings.given.close;
  lock.unlock();
  CloseBin(state, {self->sink, self->src}, close_given);
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_SRC(element);
  if (change == GST_STATE_CHANGE_NULL_TO_READY && !Open(self)) {
    Close(self);
    return GST_STATE_CHANGE_FAILURE;
  }
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_src_parent_class)->change_state(element, change);
  if (change == GST_STATE_CHANGE_READY_TO_NULL)
    Close(self);
  else if (result != GST_STATE_CHANGE_FAILURE)
    PlaySrtp(*self->state, change);
  return result;
}

/// Returns true if `error` was posted because a pad is not linked.
static bool SaysNotLinked(GstMessage* error) {
  const GstStructure* details = nullptr;
  gst_message_parse_error_details(error, &details);
  gint flow = GST_FLOW_OK;
  return details != nullptr && gst_structure_get_int(details, "flow-return", &flow) &&
         flow == GST_FLOW_NOT_LINKED;
}

/// Replaces the source's error about its unlinked pad by an error that says what to link.
static void HandleMessage(GstBin* bin, GstMessage* message) {
  auto* self = GST_LIDAR_SCREAM_SRC(bin);
  const PadPtr src(gst_element_get_static_pad(GST_ELEMENT(bin), "src"));
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR &&
      GST_MESSAGE_SRC(message) == GST_OBJECT(self->src) && SaysNotLinked(message) &&
      !gst_pad_is_linked(src.get())) {
    gst_message_unref(message);
    GST_ELEMENT_ERROR(bin, CORE, PAD,
                      ("The src pad is not linked; its stream is application/x-rtp."),
                      ("link a depayloader, such as rtplidardepay"));
    return;
  }
  GST_BIN_CLASS(gst_lidar_scream_src_parent_class)->handle_message(bin, message);
}

static void OnPadAdded(GstElement*, GstPad* pad, GstElement* bin) {
  const StringPtr name(gst_pad_get_name(pad));
  if (!g_str_has_prefix(name.get(), "src_")) return;
  GstPadTemplate* templ = gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(bin), "src_%u");
  GstPad* ghost = gst_ghost_pad_new_from_template(name.get(), pad, templ);
  gst_pad_set_active(ghost, TRUE);
  // The ghost pad gets its sticky events before it is added to the bin, because gst-launch links a
  // new pad by its caps.
  gst_pad_sticky_events_foreach(
      pad,
      [](GstPad*, GstEvent** event, gpointer to) -> gboolean {
        gst_pad_store_sticky_event(GST_PAD(to), *event);
        return TRUE;
      },
      ghost);
  gst_element_add_pad(bin, ghost);
}

static void OnPadRemoved(GstElement*, GstPad* pad, GstElement* bin) {
  const StringPtr name(gst_pad_get_name(pad));
  if (!g_str_has_prefix(name.get(), "src_")) return;
  const PadPtr ghost(gst_element_get_static_pad(bin, name.get()));
  if (!ghost) return;
  gst_pad_set_active(ghost.get(), FALSE);
  gst_element_remove_pad(bin, ghost.get());
}

static void gst_lidar_scream_src_init(GstLidarScreamSrc* self) {
  auto* element = GST_ELEMENT(self);
  self->state = new State;
  gst_bin_set_suppressed_flags(GST_BIN(self), GST_ELEMENT_FLAG_SINK);
  self->src = AddChild(element, "ecnudpsrc");
  self->rx = AddChild(element, "screamrx");
  self->sink = AddChild(element, "ecnudpsink");
  GstPad* ghost = nullptr;
  GstPadTemplate* templ = gst_static_pad_template_get(&src_template);
  if (self->src == nullptr || self->rx == nullptr || self->sink == nullptr) {
    ghost = gst_ghost_pad_new_no_target_from_template("src", templ);
  } else {
    g_object_set(self->sink, "sync", FALSE, "async", FALSE, "reply", TRUE, nullptr);
    gst_element_link_pads(self->src, "src", self->rx, "sink");
    gst_element_link_pads(self->rx, "rtcp_src", self->sink, "sink");
    const PadPtr target(gst_element_get_static_pad(self->rx, "src"));
    ghost = gst_ghost_pad_new_from_template("src", target.get(), templ);
    g_signal_connect(self->rx, "pad-added", G_CALLBACK(OnPadAdded), self);
    g_signal_connect(self->rx, "pad-removed", G_CALLBACK(OnPadRemoved), self);
  }
  gst_object_unref(templ);
  gst_element_add_pad(element, ghost);
}

static void gst_lidar_scream_src_class_init(GstLidarScreamSrcClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scream_src_debug, "screamsrc", 0, "SCReAM source bin");
  ServeState<GstLidarScreamSrc, gst_lidar_scream_src_parent_class, kProperties,
             ChangeSrtpKey<GstLidarScreamSrc>>(klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  GST_BIN_CLASS(klass)->handle_message = HandleMessage;
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_add_static_pad_template(element, &stream_template);
  Describe(klass, {"SCReAM network source", "Source/Network/RTP",
                   "Receives RTP over UDP and gives SCReAM v2 feedback with ECN"});
}

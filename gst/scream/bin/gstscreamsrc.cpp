// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamsrc
 *
 * UDP with ECN and screamrx in one bin; feedback goes back on the same socket to the address that
 * the media came from.
 *
 * |[
 * gst-launch-1.0 screamsrc port=5004 ! rtplidardepay ! dracodec ! fakesink
 * ]|
 */
#include "gst/scream/bin/gstscreamsrc.h"

#include <mutex>

#include "gst/common/refs.h"
#include "gst/scream/bin/common.h"
#include "gst/scream/rx/private.h"
#include "gst/scream/srtp/layer.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_scream_src_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_src_debug

using namespace lidar::gst;

namespace {

/// Those that the children have too are theirs: forwarded when set.
struct Settings {
  std::string address;
  guint port = 5004;
  std::string multicast_group;
  std::string multicast_iface;
  guint buffer_size = 0;
  guint64 timeout = 0;
  guint64 feedback_interval = RxSettings{}.feedback_interval;
  guint packets_per_feedback = RxSettings{}.packets_per_feedback;
  gint num_reports = RxSettings{}.num_reports;
  bool eos_on_bye = RxSettings{}.eos_on_bye;
  SrtpSettings srtp;
};

constexpr gint kLive = GST_PARAM_MUTABLE_PLAYING;
const std::array<Property<Settings>, 10> kProperties = {{
    {"address", "Local address to receive on; empty for any, IPv6 and IPv4", &Settings::address},
    {"port", "UDP port to receive on; 0 for any free one", &Settings::port, 0, 65535},
    {"multicast-group", "Multicast group to join; empty for none", &Settings::multicast_group},
    {"multicast-iface", "Network interface for multicast; empty for the kernel's choice",
     &Settings::multicast_iface},
    {"buffer-size",
     "Kernel receive buffer [bytes]; 0 asks for 2 MiB and takes what the kernel grants",
     &Settings::buffer_size, 0, G_MAXINT},
    {"timeout", "Silence after which a message GstEcnUdpSrcTimeout is posted [ns]; 0 for never",
     &Settings::timeout, 0, static_cast<gdouble>(G_MAXINT64)},
    {"feedback-interval", "Longest wait of a packet for its report; less at high rate [ns]",
     &Settings::feedback_interval, 1e6, 10e9, kLive},
    {"packets-per-feedback", "A report is sent after this many packets",
     &Settings::packets_per_feedback, 1, 1000, kLive},
    {"num-reports", "Meaning of num_reports in the reports",
     EnumField<Settings>{&Settings::num_reports, NumReportsType}, 0, 0, kLive},
    {"eos-on-bye", "End the stream once every SSRC has said BYE", &Settings::eos_on_bye, 0, 0,
     kLive},
}};
enum : guint {
  kPropCaps = kProperties.size() + 1,
  kPropPtMap,
  kPropUsedSocket,
  kPropStats,
  kPropSrtp,
};

struct State {
  std::mutex mutex;  // guards all
  Settings settings;
  SocketPtr socket;
  std::shared_ptr<SrtpLayer> srtp;
  CapsPtr caps;  // as the user set them
};

}  // namespace

struct _GstLidarScreamSrc {
  GstBin parent;
  GstElement* src;
  GstElement* rx;
  GstElement* sink;
  State* state;
};

G_DEFINE_TYPE(GstLidarScreamSrc, gst_lidar_scream_src, GST_TYPE_BIN)
GST_ELEMENT_REGISTER_DEFINE(screamsrc, "screamsrc", GST_RANK_NONE, GST_TYPE_LIDAR_SCREAM_SRC)

static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate stream_template = GST_STATIC_PAD_TEMPLATE(
    "src_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));

static GSocket* OpenSocket(const Settings& s, GError** error) {
  const bool multicast = !s.multicast_group.empty();
  UdpBind bind{s.address, s.port, G_SOCKET_FAMILY_INVALID, multicast};
  if (multicast)
    bind.family = s.multicast_group.find(':') != std::string::npos ? G_SOCKET_FAMILY_IPV6
                                                                   : G_SOCKET_FAMILY_IPV4;
  SocketPtr socket(OpenUdpSocket(bind, error));
  if (socket && multicast &&
      !JoinMulticast(socket.get(), s.multicast_group, s.multicast_iface, error))
    return nullptr;
  return socket.release();
}

/// Opens the socket for both ways and hands it to the children.
static bool Open(GstLidarScreamSrc* self) {
  State& state = *self->state;
  std::unique_lock lock(state.mutex);
  const Settings s = state.settings;
  lock.unlock();
  for (const auto& [child, name] :
       {std::pair{self->src, "ecnudpsrc"}, {self->rx, "screamrx"}, {self->sink, "ecnudpsink"}}) {
    if (child != nullptr) continue;
    ReportMissing(GST_ELEMENT(self), name);
    return false;
  }
  GError* error = nullptr;
  SocketPtr socket(OpenSocket(s, &error));
  if (!socket) {
    GST_ELEMENT_ERROR(self, RESOURCE, OPEN_READ,
                      ("Cannot receive on UDP port %u: %s", s.port, error->message),
                      ("address '%s', multicast-group '%s'; is another program using the port?",
                       s.address.c_str(), s.multicast_group.c_str()));
    g_error_free(error);
    return false;
  }
  GiveSocket(self->src, socket.get());
  GiveSocket(self->sink, socket.get());
  std::shared_ptr<SrtpLayer> srtp;
  if (!StartSrtp(s.srtp,
                 {GST_ELEMENT(self), self->rx, "rtcp_src", "sink", self->sink, self->src, false},
                 &srtp))
    return false;
  lock.lock();
  state.srtp = std::move(srtp);
  state.socket = std::move(socket);
  return true;
}

static void Close(GstLidarScreamSrc* self) {
  State& state = *self->state;
  std::unique_lock srtp_lock(state.mutex);
  const std::shared_ptr<SrtpLayer> srtp = std::move(state.srtp);
  srtp_lock.unlock();
  for (GstElement* child : {self->sink, self->src})
    if (child != nullptr) GiveSocket(child, nullptr);
  std::lock_guard lock(state.mutex);
  if (state.socket) g_socket_close(state.socket.get(), nullptr);
  state.socket.reset();
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_SRC(element);
  if (change == GST_STATE_CHANGE_NULL_TO_READY && !Open(self)) return GST_STATE_CHANGE_FAILURE;
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_src_parent_class)->change_state(element, change);
  if (change == GST_STATE_CHANGE_READY_TO_NULL) Close(self);
  return result;
}

static void OnPadAdded(GstElement*, GstPad* pad, GstElement* bin) {
  const StringPtr name(gst_pad_get_name(pad));
  if (!g_str_has_prefix(name.get(), "src_")) return;
  GstPadTemplate* templ = gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(bin), "src_%u");
  GstPad* ghost = gst_ghost_pad_new_from_template(name.get(), pad, templ);
  gst_pad_set_active(ghost, TRUE);
  // With its events before anybody sees the pad: gst-launch links by caps.
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

static void SetPropertyVfunc(GObject* o, guint id, const GValue* v, GParamSpec* spec) {
  auto* self = GST_LIDAR_SCREAM_SRC(o);
  if (id >= kPropSrtp) {
    SetSrtpProperty(GST_ELEMENT(self), *self->state, id - kPropSrtp, v);
    return;
  }
  if (id == kPropCaps) {
    std::lock_guard lock(self->state->mutex);
    self->state->caps.reset(static_cast<GstCaps*>(g_value_dup_boxed(v)));
  }
  if (id <= kProperties.size()) {
    std::lock_guard lock(self->state->mutex);
    SetProperty(self->state->settings, kProperties[id - 1], v);
  }
  Forward(self->src, spec, v);
  Forward(self->rx, spec, v);
}

static void AddUdpStats(GstLidarScreamSrc* self, GstStructure* stats) {
  {
    std::lock_guard lock(self->state->mutex);
    AddSrtpStats(self->state->srtp.get(), stats);
  }
  GstStructure* udp = nullptr;
  if (self->src != nullptr) g_object_get(self->src, "stats", &udp, nullptr);
  if (udp == nullptr) return;
  guint drops = 0;
  gst_structure_get_uint(udp, "dropped-by-kernel", &drops);
  gst_structure_set(stats, "dropped-by-kernel", G_TYPE_UINT, drops, nullptr);
  gst_structure_free(udp);
}

static void GetPropertyVfunc(GObject* o, guint id, GValue* v, GParamSpec* spec) {
  auto* self = GST_LIDAR_SCREAM_SRC(o);
  if (id == kPropUsedSocket) {
    std::lock_guard lock(self->state->mutex);
    g_value_set_object(v, self->state->socket.get());
  } else if (id >= kPropSrtp) {
    std::lock_guard lock(self->state->mutex);
    GetSrtpProperty(self->state->settings.srtp, id - kPropSrtp, v);
  } else if (id == kPropCaps) {
    std::lock_guard lock(self->state->mutex);
    gst_value_set_caps(v, self->state->caps.get());
  } else if (id > kProperties.size() && self->rx != nullptr) {
    g_object_get_property(G_OBJECT(self->rx), spec->name, v);
    if (id == kPropStats) AddUdpStats(self, static_cast<GstStructure*>(g_value_get_boxed(v)));
  } else if (id <= kProperties.size()) {
    std::lock_guard lock(self->state->mutex);
    GetProperty(self->state->settings, kProperties[id - 1], v);
  }
}

static void InstallOwnProperties(GObjectClass* object) {
  constexpr auto kRead = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS);
  constexpr auto kReadWrite = static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                       GST_PARAM_MUTABLE_READY);
  g_object_class_install_property(
      object, kPropCaps,
      g_param_spec_boxed("caps", "caps", "Caps of the stream; NULL takes what downstream wants",
                         GST_TYPE_CAPS, kReadWrite));
  g_object_class_install_property(
      object, kPropPtMap,
      g_param_spec_boxed("pt-map", "pt-map",
                         "Caps of each payload type (application/x-rtp-pt-map,96=(string)\"...\"); "
                         "with it every SSRC leaves by a pad of its own",
                         GST_TYPE_STRUCTURE, kReadWrite));
  g_object_class_install_property(
      object, kPropUsedSocket,
      g_param_spec_object("used-socket", "used-socket", "Socket in use; NULL when stopped",
                          G_TYPE_SOCKET, kRead));
  g_object_class_install_property(
      object, kPropStats,
      g_param_spec_boxed("stats", "stats", "Counters of packets, bytes and reports",
                         GST_TYPE_STRUCTURE, kRead));
  InstallSrtpProperties(object, kPropSrtp);
}

static void gst_lidar_scream_src_init(GstLidarScreamSrc* self) {
  auto* element = GST_ELEMENT(self);
  self->state = new State;
  gst_bin_set_suppressed_flags(GST_BIN(self), GST_ELEMENT_FLAG_SINK);
  self->src = AddChild(element, "ecnudpsrc", "ecnudpsrc");
  self->rx = AddChild(element, "screamrx", "screamrx");
  self->sink = AddChild(element, "ecnudpsink", "ecnudpsink");
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
  auto* object = G_OBJECT_CLASS(klass);
  object->set_property = SetPropertyVfunc;
  object->get_property = GetPropertyVfunc;
  object->finalize = [](GObject* o) {
    delete GST_LIDAR_SCREAM_SRC(o)->state;
    G_OBJECT_CLASS(gst_lidar_scream_src_parent_class)->finalize(o);
  };
  InstallProperties(object, kProperties);
  InstallOwnProperties(object);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_add_static_pad_template(element, &stream_template);
  gst_element_class_set_static_metadata(
      element, "SCReAM network source", "Source/Network/RTP",
      "Receives RTP over UDP and gives SCReAM v2 feedback with ECN", "gst-lidar");
}

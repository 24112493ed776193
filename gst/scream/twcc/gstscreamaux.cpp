// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamaux
 *
 * SCReAM v2 for receivers that report with transport-wide feedback (TWCC) in place of RFC 8888. It
 * stands right before an rtpsession; request-aux-sender of webrtcbin puts it there.
 *
 * |[
 * gst-launch-1.0 lidartestsrc is-live=true ! lidarenc ! rtplidarpay ! screamaux \
 *   ! bin.send_rtp_sink_0 rtpbin name=bin rtp-profile=avpf \
 *   bin.send_rtp_src_0 ! udpsink host=127.0.0.1 port=5004 sync=false async=false
 * ]|
 */
#include <gst/gst.h>

#include <mutex>

#include "gst/common/element_class.h"
#include "gst/common/properties.h"
#include "gst/common/refs.h"
#include "gst/scream/bin/common.h"
#include "gst/scream/twcc/session_numbers.h"
#include "gst/scream/tx/feedback.h"
#include "gst/scream/tx/settings.h"

GST_DEBUG_CATEGORY_STATIC(gst_lidar_scream_aux_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_aux_debug

using namespace lidar;
using namespace lidar::gst;

namespace {

constexpr guint kIpUdpAndSrtpTag = 38;  // bytes
/// The interval at which the rtpsession of a stock receiver sends reports at low rates.
constexpr guint64 kFeedbackInterval = 500 * GST_MSECOND;

struct AuxSettings {
  gint session = -1;
};

struct State {
  std::mutex mutex;
  AuxSettings settings;
  SessionNumbers numbers;
  bool warned = false;
};

}  // namespace

G_DECLARE_FINAL_TYPE(GstLidarScreamAux, gst_lidar_scream_aux, GST, LIDAR_SCREAM_AUX, GstBin)
struct _GstLidarScreamAux {
  GstBin parent;
  GstElement* tx;
  GstPad* sink;
  GstPad* src;
  State* state;
};

G_DEFINE_TYPE(GstLidarScreamAux, gst_lidar_scream_aux, GST_TYPE_BIN)
GST_ELEMENT_REGISTER_DEFINE(screamaux, "screamaux", GST_RANK_NONE, gst_lidar_scream_aux_get_type())

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("application/x-rtp"));
// These pads replace the pads sink and src if the property session is set.
static GstStaticPadTemplate session_sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink_%u", GST_PAD_SINK, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));
static GstStaticPadTemplate session_src_template = GST_STATIC_PAD_TEMPLATE(
    "src_%u", GST_PAD_SRC, GST_PAD_SOMETIMES, GST_STATIC_CAPS("application/x-rtp"));

static StructurePtr Stats(GObject* object) {
  auto* self = GST_LIDAR_SCREAM_AUX(object);
  StructurePtr stats = StatsOf(self->tx);
  if (!stats) return stats;
  const std::lock_guard lock(self->state->mutex);
  const SessionNumbers::Stats& s = self->state->numbers.stats();
  gst_structure_set(stats.get(), "twcc-reports", G_TYPE_UINT64, s.reports, "twcc-packets",
                    G_TYPE_UINT64, s.packets, "twcc-mismatched", G_TYPE_UINT64, s.mismatched,
                    nullptr);
  return stats;
}

static guint Estimate(GObject* object) {
  guint bps = 0;
  if (GstElement* tx = GST_LIDAR_SCREAM_AUX(object)->tx)
    g_object_get(tx, "estimated-bitrate", &bps, nullptr);
  return bps;
}

static Property<AuxSettings> OfTx(const char* name) {
  return Proxy<AuxSettings>(TxPropertyTable(), name,
                            ChildOf<GstLidarScreamAux, &GstLidarScreamAux::tx>);
}

static const std::array<Property<AuxSettings>, 9> kProperties = {{
    {"session",
     "Session of rtpbin: the pads are named sink_N and src_N, as its request-aux-sender needs "
     "them; -1: sink and src. Set it before the pads are linked",
     &AuxSettings::session, -1, G_MAXINT},
    OfTx("min-bitrate"),
    OfTx("start-bitrate"),
    OfTx("max-bitrate"),
    OfTx("max-queue-delay"),
    OfTx("stats-interval"),
    OfTx("key-unit-on-loss"),
    {"estimated-bitrate", "Target of all streams together, IP included; notifies [bit/s]",
     Estimate},
    {"stats", "Statistics; bitrates in bit/s, times in ns", Stats},
}};

static void OnReport(GstLidarScreamAux* self, GstEvent* event) {
  State& state = *self->state;
  std::unique_lock lock(state.mutex);
  const auto report = state.numbers.OnEvent(event);
  const bool warn =
      state.numbers.stats().mismatched > 0 &&
      !std::exchange(state.warned, state.warned || state.numbers.stats().mismatched > 0);
  lock.unlock();
  if (warn)
    GST_ELEMENT_WARNING(
        self, STREAM, FAILED, ("The session reports packets that did not pass screamaux."),
        ("put screamaux directly before rtpsession, so that all streams of the session pass it"));
  if (report) TxTakeReport(GST_LIDAR_SCREAM_TX(self->tx), *report);
}

/// Returns false if the next pad refuses packets. The session then gives them no number.
static bool NextPadTakes(GstPad* src) {
  const PadPtr next(gst_pad_get_peer(src));
  return next && !GST_PAD_IS_FLUSHING(next.get()) && !GST_PAD_IS_EOS(next.get());
}

static GstPadProbeReturn WatchSource(GstPad*, GstPadProbeInfo* info, gpointer data) {
  auto* self = GST_LIDAR_SCREAM_AUX(data);
  State& state = *self->state;
  if ((info->type & GST_PAD_PROBE_TYPE_EVENT_UPSTREAM) != 0) {
    OnReport(self, GST_PAD_PROBE_INFO_EVENT(info));
    return GST_PAD_PROBE_OK;
  }
  const std::lock_guard lock(state.mutex);
  if ((info->type & GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM) != 0) {
    GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
    GstCaps* caps = nullptr;
    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) gst_event_parse_caps(event, &caps);
    if (caps != nullptr) state.numbers.OnCaps(caps);
  } else if (!NextPadTakes(self->src)) {
    return GST_PAD_PROBE_OK;
  } else if ((info->type & GST_PAD_PROBE_TYPE_BUFFER_LIST) != 0) {
    GstBufferList* list = GST_PAD_PROBE_INFO_BUFFER_LIST(info);
    for (guint i = 0; i < gst_buffer_list_length(list); ++i)
      state.numbers.OnPacket(gst_buffer_list_get(list, i));
  } else {
    state.numbers.OnPacket(GST_PAD_PROBE_INFO_BUFFER(info));
  }
  return GST_PAD_PROBE_OK;
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  auto* self = GST_LIDAR_SCREAM_AUX(element);
  if (change == GST_STATE_CHANGE_NULL_TO_READY && !HasChildren(element, {{self->tx, "screamtx"}}))
    return GST_STATE_CHANGE_FAILURE;
  if (change == GST_STATE_CHANGE_READY_TO_PAUSED) {
    const std::lock_guard lock(self->state->mutex);
    self->state->numbers.ResetStats();
    self->state->warned = false;
  }
  return GST_ELEMENT_CLASS(gst_lidar_scream_aux_parent_class)->change_state(element, change);
}

/// Adds a ghost pad in place of `old`, which may be NULL.
static GstPad* ReplaceGhost(GstLidarScreamAux* self, GstPad* old, const PadPtr& target,
                            GstStaticPadTemplate* templ, gint session) {
  if (old != nullptr) gst_element_remove_pad(GST_ELEMENT(self), old);
  StringPtr name(g_strdup(templ->name_template));
  if (session >= 0) name.reset(g_strdup_printf(templ->name_template, static_cast<guint>(session)));
  GstPadTemplate* pad_template = gst_static_pad_template_get(templ);
  GstPad* pad = gst_ghost_pad_new_from_template(name.get(), target.get(), pad_template);
  gst_object_unref(pad_template);
  gst_element_add_pad(GST_ELEMENT(self), pad);
  return pad;
}

/// Creates the pads anew, with names that follow from the property session.
static void NamePads(GstLidarScreamAux* self) {
  if (self->tx == nullptr) return;
  const gint session = Snapshot(*self->state).session;
  const bool named = session >= 0;
  const PadPtr sink(gst_element_get_static_pad(self->tx, "sink_0"));
  const PadPtr src(gst_element_get_static_pad(self->tx, "src"));
  self->sink = ReplaceGhost(self, self->sink, sink, named ? &session_sink_template : &sink_template,
                            session);
  self->src =
      ReplaceGhost(self, self->src, src, named ? &session_src_template : &src_template, session);
}

static void OnPropertySet(GObject* object, GParamSpec* spec) {
  if (g_strcmp0(spec->name, "session") == 0) NamePads(GST_LIDAR_SCREAM_AUX(object));
}

static void gst_lidar_scream_aux_init(GstLidarScreamAux* self) {
  self->state = new State;
  self->tx = AddChild(GST_ELEMENT(self), "screamtx");
  if (self->tx == nullptr) return;
  gst_util_set_object_arg(G_OBJECT(self->tx), "ecn-mode", "off");
  g_object_set(self->tx, "packet-overhead", kIpUdpAndSrtpTag, "feedback-interval",
               kFeedbackInterval, nullptr);
  const PadPtr sink(gst_element_request_pad_simple(self->tx, "sink_0"));
  NamePads(self);
  const PadPtr src(gst_element_get_static_pad(self->tx, "src"));
  gst_pad_add_probe(src.get(),
                    static_cast<GstPadProbeType>(
                        GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_BUFFER_LIST |
                        GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM | GST_PAD_PROBE_TYPE_EVENT_UPSTREAM),
                    WatchSource, self, nullptr);
  g_signal_connect_swapped(
      self->tx, "notify::estimated-bitrate",
      G_CALLBACK(+[](GObject* bin) { g_object_notify(bin, "estimated-bitrate"); }), self);
}

static void gst_lidar_scream_aux_class_init(GstLidarScreamAuxClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scream_aux_debug, "screamaux", 0, "SCReAM with TWCC");
  ServeState<GstLidarScreamAux, gst_lidar_scream_aux_parent_class, kProperties, OnPropertySet>(
      klass);
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  gst_element_class_add_static_pad_template(element, &sink_template);
  gst_element_class_add_static_pad_template(element, &src_template);
  gst_element_class_add_static_pad_template(element, &session_sink_template);
  gst_element_class_add_static_pad_template(element, &session_src_template);
  Describe(klass,
           {"SCReAM for TWCC sessions", "Filter/Network/RTP",
            "SCReAM v2 congestion control before an rtpsession, with transport-wide feedback"});
}

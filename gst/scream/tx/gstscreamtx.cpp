// SPDX-License-Identifier: LGPL-2.1-or-later
/**
 * SECTION:element-screamtx
 *
 * Sends RTP no faster than the network carries it (SCReAM v2) and sends the encoders upstream their
 * target bitrates. RFC 8888 feedback goes to rtcp_sink.
 *
 * |[
 * gst-launch-1.0 videotestsrc is-live=true ! openh264enc ! rtph264pay ! screamsink \
 *   host=127.0.0.1 port=5004
 * ]|
 */
#include "gst/scream/tx/gstscreamtx.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "gst/common/element_class.h"
#include "gst/scream/tx/private.h"

GST_DEBUG_CATEGORY(gst_lidar_scream_tx_debug);
#define GST_CAT_DEFAULT gst_lidar_scream_tx_debug

using namespace lidar::gst;

static void ChildProxyInit(gpointer iface, gpointer);

G_DEFINE_TYPE_WITH_CODE(GstLidarScreamTx, gst_lidar_scream_tx, GST_TYPE_ELEMENT,
                        G_IMPLEMENT_INTERFACE(GST_TYPE_CHILD_PROXY, ChildProxyInit))
GST_ELEMENT_REGISTER_DEFINE(screamtx, "screamtx", GST_RANK_NONE, GST_TYPE_LIDAR_SCREAM_TX)

enum : guint { kSignalRouteChanged, kSignals };
static guint signals[kSignals];

namespace lidar::gst {

Time TxNow(const TxState& state) { return TimeOf(state.clock); }

void SettingsChanged(GstLidarScreamTx* self) {
  const TxLock lock(self->state->mutex);
  self->state->pacing.OnSettings();
}

void TxSetLink(GstLidarScreamTx* tx, std::shared_ptr<TxLink> link) {
  const TxLock lock(tx->state->mutex);
  tx->state->link = std::move(link);
}

TxStream* FindStream(TxState& state, scream::StreamId id) {
  for (auto& stream : state.streams)
    if (stream->id == id) return stream.get();
  return nullptr;
}

void Configure(TxState& state, TxStream& stream) {
  stream.config = MakeConfig(stream, PadSettings(stream.pad), state.settings);
  stream.configured_share = stream.overhead.payload_share();
  state.controller->ConfigureStream(stream.id, stream.config);
}

void ClearQueue(TxState& state, TxStream& stream, Time now) {
  const auto packets = static_cast<std::size_t>(
      std::count_if(stream.queue.begin(), stream.queue.end(),
                    [](const TxItem& item) { return item.buffer != nullptr; }));
  if (packets > 0) state.controller->OnDropped(now, stream.id, packets);
  stream.queue.clear();
}

void FlushQueue(TxState& state, TxStream& stream, Time now) {
  std::deque<TxItem> kept;
  for (TxItem& item : stream.queue) {
    const GstEvent* event = item.event.get();
    if (event != nullptr && GST_EVENT_IS_STICKY(event) &&
        GST_EVENT_TYPE(event) != GST_EVENT_SEGMENT && GST_EVENT_TYPE(event) != GST_EVENT_EOS)
      kept.push_back(std::move(item));
  }
  ClearQueue(state, stream, now);
  stream.queue = std::move(kept);
}

}  // namespace lidar::gst

static TxState& StateOf(gpointer self) { return *GST_LIDAR_SCREAM_TX(self)->state; }

static void AddStream(TxState& state, GstPad* pad) {
  auto stream = std::make_unique<TxStream>();
  stream->pad = pad;
  gst_segment_init(&stream->segment, GST_FORMAT_UNDEFINED);
  SetPadStream(pad, stream.get());
  if (state.controller) {
    stream->config = MakeConfig(*stream, PadSettings(pad), state.settings);
    stream->id = state.controller->AddStream(stream->config);
  }
  state.streams.push_back(std::move(stream));
}

static bool HasPad(const TxState& state, const std::string& name) {
  return std::any_of(state.streams.begin(), state.streams.end(),
                     [&](const auto& s) { return name == GST_PAD_NAME(s->pad); });
}

/// Returns the name for a pad that was requested as `wanted`, or an empty text if another pad
/// already has this name.
static std::string NewPadName(TxState& state, const gchar* wanted) {
  guint index = 0;
  if (wanted == nullptr || sscanf(wanted, "sink_%u", &index) != 1) index = state.next_pad;
  const std::string name = "sink_" + std::to_string(index);
  if (HasPad(state, name)) return "";
  state.next_pad = std::max(state.next_pad, index + 1);
  return name;
}

static void RemoveStream(TxState& state, GstPad* pad) {
  TxStream* stream = PadStream(pad);
  if (state.controller) {
    ClearQueue(state, *stream, TxNow(state));
    state.controller->RemoveStream(stream->id);
  }
  state.streams.erase(std::find_if(state.streams.begin(), state.streams.end(),
                                   [&](const auto& s) { return s.get() == stream; }));
  SetPadStream(pad, nullptr);
  state.pacing.Wake();
}

static GstPad* NewPad(GstPadTemplate* templ, const std::string& name) {
  auto* pad = GST_PAD(g_object_new(GST_TYPE_LIDAR_SCREAM_TX_PAD, "name", name.c_str(), "direction",
                                   GST_PAD_SINK, "template", templ, nullptr));
  gst_pad_set_chain_function(pad, TxChain);
  gst_pad_set_chain_list_function(pad, TxChainList);
  gst_pad_set_event_function(pad, TxSinkEvent);
  gst_pad_set_query_function(pad, TxSinkQuery);
  gst_pad_set_iterate_internal_links_function(pad, TxLinksOf);
  GST_PAD_SET_PROXY_CAPS(pad);
  return pad;
}

static GstPad* RequestPad(GstElement* element, GstPadTemplate* templ, const gchar* wanted,
                          const GstCaps*) {
  TxState& state = StateOf(element);
  TxLock lock(state.mutex);
  const std::string name = NewPadName(state, wanted);
  if (name.empty()) {
    GST_WARNING_OBJECT(element, "there is a pad %s already", wanted);
    return nullptr;
  }
  GstPad* pad = NewPad(templ, name);
  AddStream(state, pad);
  lock.unlock();
  gst_element_add_pad(element, pad);
  gst_child_proxy_child_added(GST_CHILD_PROXY(element), G_OBJECT(pad), name.c_str());
  return pad;
}

static void ReleasePad(GstElement* element, GstPad* pad) {
  TxState& state = StateOf(element);
  const PadPtr keep(GST_PAD(gst_object_ref(pad)));
  const StringPtr name(gst_pad_get_name(pad));
  TxStream* stream = PadStream(pad);
  bool flushes_src = false;
  {
    TxLock lock(state.mutex);
    flushes_src = stream->flushes_src && state.gate.open();
    stream->flushing = true;
    state.gate.Release(*stream);
  }
  gst_pad_set_active(pad, FALSE);  // waits until the pad's thread has left its functions
  if (flushes_src) TxFlush(GST_LIDAR_SCREAM_TX(element), *stream, gst_event_new_flush_stop(TRUE));
  gst_element_remove_pad(element, pad);
  {
    TxLock lock(state.mutex);
    RemoveStream(state, pad);
  }
  gst_child_proxy_child_removed(GST_CHILD_PROXY(element), G_OBJECT(pad), name.get());
}

/// Checks the property tuning. If it is wrong, posts an error message and returns false.
static bool TakesTuning(GstElement* element) {
  lidar::scream::Parameters parameters;
  const TxSettings settings = Snapshot(StateOf(element));
  const std::string wrong = ReadTuning(settings.tuning.get(), &parameters);
  if (wrong.empty()) return true;
  GST_ELEMENT_ERROR(element, RESOURCE, SETTINGS, ("tuning: %s.", wrong.c_str()), (nullptr));
  return false;
}

/// Creates a new controller, and resets the streams.
static void Prepare(TxState& state) {
  TxLock lock(state.mutex);
  state.controller.emplace(ToParameters(state.settings));
  state.max_queue_delay = state.settings.max_queue_delay;
  state.parser = {};
  state.feedback_peer = {};
  for (auto& stream : state.streams) {
    auto fresh = TxStream{};
    fresh.pad = stream->pad;
    *stream = std::move(fresh);
    gst_segment_init(&stream->segment, GST_FORMAT_UNDEFINED);
    stream->config = MakeConfig(*stream, PadSettings(stream->pad), state.settings);
    stream->id = state.controller->AddStream(stream->config);
  }
  state.merger = {};
  state.reports = {};
  state.pacing.ForgetEnd();
  state.reporter.notices().Reset(*state.controller, TxNow(state));
  state.malformed_rtcp = state.reports_of_others = state.frames_dropped = 0;
}

static void BeforeChange(TxState& state, GstStateChange change) {
  const TxLock lock(state.mutex);
  if (change == GST_STATE_CHANGE_PAUSED_TO_READY) {
    state.gate.Close(state.streams);
    state.pacing.Wake();
  } else if (change == GST_STATE_CHANGE_PAUSED_TO_PLAYING) {
    state.gate.set_playing(state.streams, true);
  } else if (change == GST_STATE_CHANGE_PLAYING_TO_PAUSED) {
    state.gate.set_playing(state.streams, false);
  }
}

static GstStateChangeReturn ChangeState(GstElement* element, GstStateChange change) {
  TxState& state = StateOf(element);
  const bool up = change == GST_STATE_CHANGE_READY_TO_PAUSED;
  if (up) {
    if (!TakesTuning(element)) return GST_STATE_CHANGE_FAILURE;
    Prepare(state);
    if (!state.reporter.Start()) return GST_STATE_CHANGE_FAILURE;
  }
  BeforeChange(state, change);
  const GstStateChangeReturn result =
      GST_ELEMENT_CLASS(gst_lidar_scream_tx_parent_class)->change_state(element, change);
  const bool failed_up = up && result == GST_STATE_CHANGE_FAILURE;
  if (change == GST_STATE_CHANGE_PAUSED_TO_READY || failed_up) state.reporter.Stop();
  return result;
}

static gboolean ActivateSrc(GstPad*, GstObject* parent, GstPadMode mode, gboolean active) {
  TxState& state = StateOf(parent);
  if (mode != GST_PAD_MODE_PUSH) return FALSE;
  {
    const TxLock lock(state.mutex);
    active ? state.gate.Open() : state.gate.Close(state.streams);
    state.pacing.Wake();
  }
  return active ? state.pacing.Start() : state.pacing.Stop();
}

static StructurePtr Stats(GObject* tx) {
  TxState& state = StateOf(tx);
  const TxLock lock(state.mutex);
  return StatsOf(state);
}

static guint Estimate(GObject* tx) {
  TxState& state = StateOf(tx);
  const TxLock lock(state.mutex);
  return state.reporter.notices().estimated_bps();
}

static const auto& Rows() {
  static const auto rows =
      Join(TxPropertyTable(),
           std::array<Property<TxSettings>, 2>{
               {{"estimated-bitrate",
                 "Target of all streams together, IP included; notifies [bit/s]", Estimate},
                {"stats", "Statistics; bitrates in bit/s, times in ns", Stats}}});
  return rows;
}

static void OnPropertySet(GObject* object, GParamSpec*) {
  SettingsChanged(GST_LIDAR_SCREAM_TX(object));
}

static void RouteChanged(GstLidarScreamTx* self) {
  TxState& state = *self->state;
  TxLock lock(state.mutex);
  if (state.controller) state.controller->OnRouteChange(TxNow(state));
  state.pacing.Wake();
}

static void ChildProxyInit(gpointer iface, gpointer) {
  auto* proxy = static_cast<GstChildProxyInterface*>(iface);
  proxy->get_children_count = [](GstChildProxy* p) -> guint {
    TxState& state = StateOf(p);
    TxLock lock(state.mutex);
    return static_cast<guint>(state.streams.size());
  };
  proxy->get_child_by_index = [](GstChildProxy* p, guint index) -> GObject* {
    TxState& state = StateOf(p);
    TxLock lock(state.mutex);
    if (index >= state.streams.size()) return nullptr;
    return G_OBJECT(g_object_ref(state.streams[index]->pad));
  };
}

static void InstallSignals() {
  signals[kSignalRouteChanged] = g_signal_new_class_handler(
      "route-changed", GST_TYPE_LIDAR_SCREAM_TX,
      static_cast<GSignalFlags>(G_SIGNAL_RUN_LAST | G_SIGNAL_ACTION), G_CALLBACK(RouteChanged),
      nullptr, nullptr, nullptr, G_TYPE_NONE, 0);
}

static GstPad* AddLinkedPad(GstLidarScreamTx* self, const char* name) {
  GstPad* pad = AddPad(self, name);
  gst_pad_set_iterate_internal_links_function(pad, TxLinksOf);
  return pad;
}

static void gst_lidar_scream_tx_init(GstLidarScreamTx* self) {
  self->state = new TxState(self);
  self->src = AddLinkedPad(self, "src");
  gst_pad_set_event_function(self->src, TxSrcEvent);
  gst_pad_set_query_function(self->src, TxSrcQuery);
  gst_pad_set_activatemode_function(self->src, ActivateSrc);
  self->rtcp_sink = AddLinkedPad(self, "rtcp_sink");
  gst_pad_set_chain_function(self->rtcp_sink, TxRtcpChain);
  self->rtcp_src = AddLinkedPad(self, "rtcp_src");
}

static void gst_lidar_scream_tx_class_init(GstLidarScreamTxClass* klass) {
  GST_DEBUG_CATEGORY_INIT(gst_lidar_scream_tx_debug, "screamtx", 0, "SCReAM v2 sender");
  ServeState<GstLidarScreamTx, gst_lidar_scream_tx_parent_class, Rows, OnPropertySet>(klass);
  InstallSignals();
  auto* element = GST_ELEMENT_CLASS(klass);
  element->change_state = ChangeState;
  element->request_new_pad = RequestPad;
  element->release_pad = ReleasePad;
  Describe(
      klass,
      {"SCReAM sender", "Filter/Network/RTP", "Congestion control for RTP with SCReAM v2 and L4S"},
      {{"sink_%u", GST_PAD_SINK, "application/x-rtp", GST_PAD_REQUEST,
        GST_TYPE_LIDAR_SCREAM_TX_PAD},
       {"src", GST_PAD_SRC, "application/x-rtp"},
       {"rtcp_sink", GST_PAD_SINK, "application/x-rtcp"},
       {"rtcp_src", GST_PAD_SRC, "application/x-rtcp"}});
  gst_type_mark_as_plugin_api(GST_TYPE_LIDAR_SCREAM_TX_PAD, static_cast<GstPluginAPIFlags>(0));
}

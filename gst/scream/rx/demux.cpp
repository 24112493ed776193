// SPDX-License-Identifier: LGPL-2.1-or-later
// Splits the streams that screamrx receives: each SSRC has a pad, whose caps come from pt-map.
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "gst/scream/rx/private.h"

#define GST_CAT_DEFAULT gst_lidar_scream_rx_debug

namespace lidar::gst {
namespace {

// The greatest number of pads. A limit is needed because each new SSRC creates a pad, even if the
// SSRC is forged.
constexpr std::size_t kMaxRoutes = 1'024;

bool IsLidar(const GstCaps* caps) {
  if (gst_caps_get_size(caps) == 0) return false;
  const gchar* name = gst_structure_get_string(gst_caps_get_structure(caps, 0), "encoding-name");
  return name != nullptr && g_str_has_prefix(name, "X-LIDAR");
}

CapsPtr CapsOfValue(const GValue* value) {
  if (value != nullptr && GST_VALUE_HOLDS_CAPS(value))
    return CapsPtr(gst_caps_copy(gst_value_get_caps(value)));
  if (value != nullptr && G_VALUE_HOLDS_STRING(value))
    return CapsPtr(gst_caps_from_string(g_value_get_string(value)));
  return nullptr;
}

/// Returns true for payload types that look like RTCP if the marker bit is set (RFC 5761, section
/// 4).
constexpr bool CollidesWithRtcp(unsigned type) { return type >= 64 && type <= 95; }

/// Returns what is wrong with a field of pt-map, or NULL.
const char* FaultOf(std::string_view name, const GValue* value) {
  unsigned type = 0;
  const auto end = std::from_chars(name.data(), name.data() + name.size(), type).ptr;
  if (end != name.data() + name.size() || type > 127) return "is not a payload type (0 to 127)";
  if (CollidesWithRtcp(type))
    return "looks like RTCP on a port that carries both (64 to 95, RFC 5761)";
  const CapsPtr caps = CapsOfValue(value);
  if (!caps || !gst_caps_is_fixed(caps.get())) return "must have fixed caps";
  return nullptr;
}

/// Returns the caps in pt-map for the packet's payload type, with the packet's SSRC added. Returns
/// NULL if pt-map has no valid caps for it. The caller owns the caps.
GstCaps* CapsOf(GstLidarScreamRx* self, const RtpHeader& header) {
  RxState& state = *self->state;
  if (CollidesWithRtcp(header.payload_type)) return nullptr;
  const StringPtr field(g_strdup_printf("%u", header.payload_type));
  CapsPtr caps;
  {
    RxLock lock(state.mutex);
    if (state.settings.pt_map)
      caps = CapsOfValue(gst_structure_get_value(state.settings.pt_map.get(), field.get()));
  }
  if (!caps || !gst_caps_is_fixed(caps.get())) return nullptr;
  gst_caps_set_simple(caps.get(), "payload", G_TYPE_INT, static_cast<gint>(header.payload_type),
                      "ssrc", G_TYPE_UINT, header.ssrc, nullptr);
  return caps.release();
}

gboolean CopyExceptCaps(GstPad*, GstEvent** event, gpointer to) {
  const GstEventType type = GST_EVENT_TYPE(*event);
  if (type != GST_EVENT_CAPS && type != GST_EVENT_STREAM_START && type != GST_EVENT_EOS)
    gst_pad_push_event(GST_PAD(to), gst_event_ref(*event));
  return TRUE;
}

/// Returns the number in the name of a new pad: `ssrc`, or the next higher number that is not in
/// the name of another pad.
guint32 FreePadNumber(GstLidarScreamRx* self, guint32 ssrc) {
  for (guint32 number = ssrc;; ++number) {
    const StringPtr name(g_strdup_printf("src_%u", number));
    if (!PadPtr(gst_element_get_static_pad(GST_ELEMENT(self), name.get()))) return number;
  }
}

GstPad* NewPad(GstLidarScreamRx* self, guint32 ssrc, GstCaps* caps) {
  GstPadTemplate* templ = gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(self), "src_%u");
  const StringPtr name(g_strdup_printf("src_%u", FreePadNumber(self, ssrc)));
  GstPad* pad = gst_pad_new_from_template(templ, name.get());
  gst_pad_use_fixed_caps(pad);
  gst_pad_set_event_function(pad, RxSrcEvent);
  gst_pad_set_active(pad, TRUE);
  gchar* id = gst_pad_create_stream_id(pad, GST_ELEMENT(self), name.get());
  gst_pad_push_event(pad, gst_event_new_stream_start(id));
  g_free(id);
  gst_pad_push_event(pad, gst_event_new_caps(caps));
  gst_pad_sticky_events_foreach(self->sink, CopyExceptCaps, pad);
  gst_flow_combiner_add_pad(self->state->combiner, pad);
  gst_element_add_pad(GST_ELEMENT(self), pad);
  return pad;
}

/// Pushes the caps on `src`. The first time, also pushes the sticky events that must follow the
/// caps.
void StartSrc(GstLidarScreamRx* self, const CapsPtr& caps) {
  gst_pad_push_event(self->src, gst_event_new_caps(caps.get()));
  if (!self->state->src_started)
    gst_pad_sticky_events_foreach(self->sink, CopyExceptCaps, self->src);
  self->state->src_started = true;
}

/// Returns true if `pad` is linked to an element, directly or through ghost pads.
bool LeadsToSomebody(GstPad* pad) {
  const PadPtr peer(gst_pad_get_peer(pad));
  if (!peer || !GST_IS_PROXY_PAD(peer.get())) return peer != nullptr;
  GstProxyPad* ghost = gst_proxy_pad_get_internal(GST_PROXY_PAD(peer.get()));
  const PadPtr owner(GST_PAD(ghost));
  return ghost != nullptr && LeadsToSomebody(GST_PAD(ghost));
}

/// Returns the pad for a new stream. `src` gets the first stream whose caps its peer accepts, and
/// each other stream gets a new pad. Streams whose payload type is not in pt-map (retransmission,
/// FEC) go to `src`, too.
GstPad* Route(GstLidarScreamRx* self, const RtpHeader& header, const CapsPtr& caps) {
  RxState& state = *self->state;
  if (!caps) {
    if (!state.src_started) StartSrc(self, CapsPtr(gst_caps_new_empty_simple("application/x-rtp")));
    return self->src;
  }
  const bool fits =
      LeadsToSomebody(self->src) && gst_pad_peer_query_accept_caps(self->src, caps.get()) != FALSE;
  if (state.src_taken || !fits) return NewPad(self, header.ssrc, caps.get());
  state.src_taken = true;
  StartSrc(self, caps);
  return self->src;
}

}  // namespace

void NoteLidarTypes(RxState& state) {
  state.lidar_types.reset();
  if (!state.settings.pt_map) return;
  const auto note = [](GQuark name, const GValue* value, gpointer data) -> gboolean {
    const CapsPtr caps = CapsOfValue(value);
    const auto type = g_ascii_strtoull(g_quark_to_string(name), nullptr, 10);
    if (caps && IsLidar(caps.get()) && type < 128)
      static_cast<RxState*>(data)->lidar_types.set(static_cast<std::size_t>(type));
    return TRUE;
  };
  gst_structure_foreach(state.settings.pt_map.get(), note, &state);
}

void CheckPtMap(GstLidarScreamRx* self) {
  SharedStructure map;
  {
    const RxLock lock(self->state->mutex);
    map = self->state->settings.pt_map;
  }
  if (!map) return;
  const auto check = [](GQuark field, const GValue* value, gpointer data) -> gboolean {
    const gchar* name = g_quark_to_string(field);
    if (const char* fault = FaultOf(name, value))
      GST_ELEMENT_WARNING(data, RESOURCE, SETTINGS,
                          ("pt-map: the entry %s %s; it is ignored.", name, fault), (nullptr));
    return TRUE;
  };
  gst_structure_foreach(map.get(), check, self);
}

void NoteCaps(RxState& state, const GstCaps* caps) {
  gint type = 0;
  const RxLock lock(state.mutex);
  state.lidar_types.reset();
  if (IsLidar(caps) && gst_structure_get_int(gst_caps_get_structure(caps, 0), "payload", &type))
    state.lidar_types.set(static_cast<std::size_t>(type & 127));
}

bool HasPtMap(GstLidarScreamRx* self) {
  RxLock lock(self->state->mutex);
  return self->state->settings.pt_map != nullptr;
}

/// Drops a packet of a new SSRC that gets no pad, because there are already kMaxRoutes pads.
static GstFlowReturn Refuse(GstLidarScreamRx* self, GstBuffer* buffer) {
  RxState& state = *self->state;
  gst_buffer_unref(buffer);
  if (!std::exchange(state.routes_full, true)) {
    GST_ELEMENT_WARNING(self, STREAM, DEMUX, ("More than %zu streams arrive.", kMaxRoutes),
                        ("Further SSRCs are dropped until the element is restarted."));
  }
  RxLock lock(state.mutex);
  ++state.counters.foreign;
  return GST_FLOW_OK;
}

/// Warns, once, that the packets of a stream are dropped because its pad is not linked.
static void WarnOfUntaken(GstLidarScreamRx* self, const RtpHeader& header, GstPad* pad) {
  if (std::exchange(self->state->warned_of_untaken, true)) return;
  GST_ELEMENT_WARNING(self, STREAM, DEMUX,
                      ("A stream with payload type %u (SSRC %u) is dropped: its pad is not linked.",
                       header.payload_type, header.ssrc),
                      ("link the pad %s, or a second branch from this element: each SSRC leaves by "
                       "a pad of its own",
                       GST_PAD_NAME(pad)));
}

/// Returns the route of an ended stream that has `payload_type` and whose pad accepts `caps`, or
/// the end of the routes. If there are several, returns the oldest, because a restarted sender
/// begins its streams in the same order as before.
static auto FindEnded(RxState& state, guint payload_type, GstCaps* caps) {
  auto first = state.routes.end();
  for (auto at = state.routes.begin(); at != state.routes.end(); ++at) {
    const RxRoute& route = at->second;
    if (!route.ended || route.payload_type != payload_type || !LeadsToSomebody(route.pad) ||
        gst_pad_peer_query_accept_caps(route.pad, caps) == FALSE)
      continue;
    if (first == state.routes.end() || route.number < first->second.number) first = at;
  }
  return first;
}

/// Returns the pad for a new SSRC. If the sender has restarted, the new SSRC gets the pad of an
/// ended stream, because an application links each pad only once. Such a pad gets no second
/// STREAM_START: a sink would then wait until every other pad has sent a STREAM_START, too. If the
/// sink pad is flushing, the returned pad begins a flush, too.
static GstPad* AddRoute(GstLidarScreamRx* self, const RtpHeader& header, GstBuffer** buffer) {
  RxState& state = *self->state;
  const CapsPtr caps(CapsOf(self, header));
  const auto ended = caps ? FindEnded(state, header.payload_type, caps.get()) : state.routes.end();
  GstPad* pad = nullptr;
  if (ended != state.routes.end()) {
    pad = ended->second.pad;
    gst_pad_push_event(pad, gst_event_new_caps(caps.get()));
    *buffer = gst_buffer_make_writable(*buffer);
    GST_BUFFER_FLAG_SET(*buffer, GST_BUFFER_FLAG_DISCONT);
  } else {
    pad = Route(self, header, caps);
  }
  {
    const RxLock lock(state.mutex);
    if (ended != state.routes.end()) state.routes.erase(ended);
    state.routes.emplace(header.ssrc, RxRoute{pad, header.payload_type, ++state.routes_begun});
  }
  if (GST_PAD_IS_FLUSHING(self->sink)) gst_pad_push_event(pad, gst_event_new_flush_start());
  return pad;
}

GstFlowReturn Demux(GstLidarScreamRx* self, const RtpHeader& header, GstBuffer* buffer) {
  RxState& state = *self->state;
  const auto found = state.routes.find(header.ssrc);
  if (found == state.routes.end() && state.routes.size() >= kMaxRoutes) {
    return Refuse(self, buffer);
  }
  if (found != state.routes.end()) found->second.ended = false;
  GstPad* pad = found == state.routes.end() ? AddRoute(self, header, &buffer) : found->second.pad;
  const GstFlowReturn flow = gst_pad_push(pad, buffer);
  if (flow == GST_FLOW_NOT_LINKED) WarnOfUntaken(self, header, pad);
  return gst_flow_combiner_update_pad_flow(state.combiner, pad, flow);
}

gboolean ForwardToAll(GstLidarScreamRx* self, GstEvent* event) {
  std::vector<PadPtr> pads;
  {
    const RxLock lock(self->state->mutex);
    for (const auto& [ssrc, route] : self->state->routes)
      if (route.pad != self->src) pads.emplace_back(GST_PAD(gst_object_ref(route.pad)));
  }
  for (const PadPtr& pad : pads) gst_pad_push_event(pad.get(), gst_event_ref(event));
  if (HasPtMap(self) && GST_EVENT_IS_STICKY(event) && GST_EVENT_TYPE(event) != GST_EVENT_EOS &&
      !self->state->src_started) {
    gst_event_unref(event);  // src gets its caps with the first packet, and then the sticky events
    return TRUE;
  }
  return gst_pad_push_event(self->src, event);
}

void RemoveRoutes(GstLidarScreamRx* self) {
  RxState& state = *self->state;
  std::map<guint32, RxRoute> routes;
  {
    const RxLock lock(state.mutex);
    routes.swap(state.routes);
  }
  for (const auto& [ssrc, route] : routes) {
    if (route.pad == self->src) continue;
    gst_flow_combiner_remove_pad(state.combiner, route.pad);
    gst_pad_set_active(route.pad, FALSE);
    gst_element_remove_pad(GST_ELEMENT(self), route.pad);
  }
  state.src_taken = state.src_started = state.routes_full = state.warned_of_untaken = false;
}

}  // namespace lidar::gst

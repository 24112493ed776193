// SPDX-License-Identifier: LGPL-2.1-or-later
// Queries, links and upstream events of screamtx's pads.
#include "gst/common/latency.h"
#include "gst/common/sink_pads.h"
#include "gst/scream/tx/private.h"

namespace lidar::gst {
namespace {

TxState& StateOf(gpointer self) { return *GST_LIDAR_SCREAM_TX(self)->state; }

gint IsNot(gconstpointer item, gconstpointer excluded) {
  const bool same = g_value_get_object(static_cast<const GValue*>(item)) ==
                    g_value_get_object(static_cast<const GValue*>(excluded));
  return same ? 1 : 0;
}

/// Returns a new reference to the pad of the stream whose SSRC the event names, or NULL.
GstPad* PadOfSsrc(TxState& state, GstEvent* event) {
  guint ssrc = 0;
  const GstStructure* s = gst_event_get_structure(event);
  if (s == nullptr || !gst_structure_get_uint(s, "ssrc", &ssrc)) return nullptr;
  TxLock lock(state.mutex);
  if (!state.controller) return nullptr;
  const auto id = state.controller->FindStream(ssrc);
  const TxStream* stream = id ? FindStream(state, *id) : nullptr;
  return stream == nullptr ? nullptr : GST_PAD(gst_object_ref(stream->pad));
}

/// Adds max_queue_delay, the longest time that a packet waits in the queue, to upstream's latency.
gboolean AnswerLatency(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (!gst_pad_query_default(pad, parent, query)) return FALSE;
  if (!ReadLatency(query).live) return TRUE;
  TxState& state = StateOf(parent);
  TxLock lock(state.mutex);
  AddLatency(query, static_cast<GstClockTime>(state.max_queue_delay.count()));
  return TRUE;
}

}  // namespace

/// RTP and RTCP are separate: the sink pads are linked to src, and rtcp_sink to rtcp_src.
GstIterator* TxLinksOf(GstPad* pad, GstObject* parent) {
  auto* self = GST_LIDAR_SCREAM_TX(parent);
  if (pad != self->src)
    return LinkTo(pad == self->rtcp_sink  ? self->rtcp_src
                  : pad == self->rtcp_src ? self->rtcp_sink
                                          : self->src);
  GValue value = G_VALUE_INIT;
  g_value_init(&value, GST_TYPE_PAD);
  g_value_set_object(&value, self->rtcp_sink);
  GstIterator* links =
      gst_iterator_filter(gst_element_iterate_sink_pads(GST_ELEMENT(self)), IsNot, &value);
  g_value_unset(&value);
  return links;
}

gboolean TxSrcEvent(GstPad* pad, GstObject* parent, GstEvent* event) {
  if (GST_EVENT_TYPE(event) == GST_EVENT_CUSTOM_UPSTREAM) {
    const PadPtr target(PadOfSsrc(StateOf(parent), event));
    if (target) return gst_pad_push_event(target.get(), event);
  }
  return gst_pad_event_default(pad, parent, event);
}

gboolean TxSrcQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  if (GST_QUERY_TYPE(query) == GST_QUERY_LATENCY) return AnswerLatency(pad, parent, query);
  return gst_pad_query_default(pad, parent, query);
}

gboolean TxSinkQuery(GstPad* pad, GstObject* parent, GstQuery* query) {
  // A serialized query is refused, because it would overtake queued packets.
  if (GST_QUERY_IS_SERIALIZED(query)) return FALSE;
  return gst_pad_query_default(pad, parent, query);
}

}  // namespace lidar::gst

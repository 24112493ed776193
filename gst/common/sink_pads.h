// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions for links between the pads of an element, and for sink pads as children with
// properties.
#pragma once
#include "gst/common/refs.h"

namespace lidar::gst {

/// Returns an iterator over the single pad `pad`, for a pad whose queries and events are forwarded
/// only to `pad`. The caller owns the iterator.
inline GstIterator* LinkTo(GstPad* pad) {
  GValue value = G_VALUE_INIT;
  g_value_init(&value, GST_TYPE_PAD);
  g_value_set_object(&value, pad);
  GstIterator* iterator = gst_iterator_new_single(GST_TYPE_PAD, &value);
  g_value_unset(&value);
  return iterator;
}

inline guint SinkPadCount(gpointer element) {
  GST_OBJECT_LOCK(element);
  const guint pads = GST_ELEMENT(element)->numsinkpads;
  GST_OBJECT_UNLOCK(element);
  return pads;
}

/// Returns a new reference to the sink pad with this index, or null if there is none.
inline GObject* SinkPadAt(gpointer element, guint index) {
  GST_OBJECT_LOCK(element);
  gpointer pad = g_list_nth_data(GST_ELEMENT(element)->sinkpads, index);
  if (pad != nullptr) gst_object_ref(pad);
  GST_OBJECT_UNLOCK(element);
  return static_cast<GObject*>(pad);
}

/// Implements GstChildProxy for an element whose children are its sink pads, so that for example
/// sink_0::topic can be set.
inline void ServeSinkPads(gpointer iface, gpointer) {
  auto* proxy = static_cast<GstChildProxyInterface*>(iface);
  proxy->get_children_count = [](GstChildProxy* p) { return SinkPadCount(p); };
  proxy->get_child_by_index = [](GstChildProxy* p, guint index) { return SinkPadAt(p, index); };
  proxy->get_child_by_name = [](GstChildProxy* p, const gchar* name) {
    PadPtr pad(gst_element_get_static_pad(GST_ELEMENT(p), name));
    if (pad && !GST_PAD_IS_SINK(pad.get())) pad.reset();
    return reinterpret_cast<GObject*>(pad.release());
  };
}

/// Adds a ghost pad of `type` with the target `target`, and emits "child-added".
inline GstPad* AddGhostSink(GstElement* element, GType type, GstPadTemplate* pad_template,
                            const gchar* name, GstPad* target) {
  auto* ghost = GST_PAD(g_object_new(type, "name", name, "direction", GST_PAD_SINK, "template",
                                     pad_template, nullptr));
  gst_ghost_pad_set_target(GST_GHOST_PAD(ghost), target);
  if (GST_STATE(element) > GST_STATE_READY || GST_STATE_NEXT(element) > GST_STATE_READY)
    gst_pad_set_active(ghost, TRUE);
  gst_element_add_pad(element, ghost);
  gst_child_proxy_child_added(GST_CHILD_PROXY(element), G_OBJECT(ghost), name);
  return ghost;
}

}  // namespace lidar::gst

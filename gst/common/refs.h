// SPDX-License-Identifier: LGPL-2.1-or-later
// Owning pointers for the reference-counted and boxed types of GStreamer.
#pragma once
#include <gst/gst.h>

#include <memory>

namespace lidar::gst {

struct Unref {
  void operator()(GstBuffer* p) const { gst_buffer_unref(p); }
  void operator()(GstBufferList* p) const { gst_buffer_list_unref(p); }
  void operator()(GstCaps* p) const { gst_caps_unref(p); }
  void operator()(GstEvent* p) const { gst_event_unref(p); }
  void operator()(GstQuery* p) const { gst_query_unref(p); }
  void operator()(GstMessage* p) const { gst_message_unref(p); }
  void operator()(GstStructure* p) const { gst_structure_free(p); }
  void operator()(GError* p) const { g_error_free(p); }
  void operator()(gchar* p) const { g_free(p); }
  void operator()(gpointer p) const { gst_object_unref(p); }
};

using BufferPtr = std::unique_ptr<GstBuffer, Unref>;
using BufferListPtr = std::unique_ptr<GstBufferList, Unref>;
using CapsPtr = std::unique_ptr<GstCaps, Unref>;
using EventPtr = std::unique_ptr<GstEvent, Unref>;
using QueryPtr = std::unique_ptr<GstQuery, Unref>;
using MessagePtr = std::unique_ptr<GstMessage, Unref>;
using StructurePtr = std::unique_ptr<GstStructure, Unref>;
using ErrorPtr = std::unique_ptr<GError, Unref>;
using StringPtr = std::unique_ptr<gchar, Unref>;
using PadPtr = std::unique_ptr<GstPad, Unref>;
using ElementPtr = std::unique_ptr<GstElement, Unref>;

}  // namespace lidar::gst

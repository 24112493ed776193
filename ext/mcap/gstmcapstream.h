// SPDX-License-Identifier: LGPL-2.1-or-later
// A stream that is recorded: an element inside of mcapsink.
#pragma once
#include <gst/base/gstbasesink.h>

#include "ext/mcap/gstmcapsink.h"

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_MCAP_STREAM (gst_lidar_mcap_stream_get_type())
G_DECLARE_FINAL_TYPE(GstLidarMcapStream, gst_lidar_mcap_stream, GST, LIDAR_MCAP_STREAM, GstBaseSink)

/** Returns a new stream as a floating reference. @sink must outlive the stream. */
GstElement* gst_lidar_mcap_stream_new(GstLidarMcapSink* sink, const gchar* name);
/** Returns TRUE if the stream has received EOS, and no flush after it. */
gboolean gst_lidar_mcap_stream_ended(GstLidarMcapStream* stream);
G_END_DECLS

// SPDX-License-Identifier: LGPL-2.1-or-later
// Latency queries, read and answered.
#pragma once
#include <gst/gst.h>

namespace lidar::gst {

struct Latency {
  bool live = false;
  GstClockTime min = 0;
  GstClockTime max = 0;  // NONE: no limit
};

inline Latency ReadLatency(GstQuery* query) {
  gboolean live = FALSE;
  Latency latency;
  gst_query_parse_latency(query, &live, &latency.min, &latency.max);
  latency.live = live != FALSE;
  return latency;
}

/// Adds the element's own latency [ns] to upstream's answer.
inline void AddLatency(GstQuery* query, GstClockTime own) {
  const Latency upstream = ReadLatency(query);
  gst_query_set_latency(
      query, upstream.live, upstream.min + own,
      GST_CLOCK_TIME_IS_VALID(upstream.max) ? upstream.max + own : GST_CLOCK_TIME_NONE);
}

/// Has the pipeline ask for the latency anew.
inline void PostNewLatency(gpointer element) {
  gst_element_post_message(GST_ELEMENT(element), gst_message_new_latency(GST_OBJECT(element)));
}

}  // namespace lidar::gst

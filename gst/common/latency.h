// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads latency queries and answers them.
#pragma once
#include <gst/gst.h>

namespace lidar::gst {

struct Latency {
  bool live = false;
  GstClockTime min = 0;
  GstClockTime max = 0;  // NONE for no limit
};

inline Latency ReadLatency(GstQuery* query) {
  gboolean live = FALSE;
  Latency latency;
  gst_query_parse_latency(query, &live, &latency.min, &latency.max);
  latency.live = live != FALSE;
  return latency;
}

/// Adds the element's own latency [ns] to the answer of upstream.
inline void AddLatency(GstQuery* query, GstClockTime own) {
  const Latency upstream = ReadLatency(query);
  gst_query_set_latency(
      query, upstream.live, upstream.min + own,
      GST_CLOCK_TIME_IS_VALID(upstream.max) ? upstream.max + own : GST_CLOCK_TIME_NONE);
}

/// Posts a message that makes the pipeline query the latency again.
inline void PostNewLatency(gpointer element) {
  gst_element_post_message(GST_ELEMENT(element), gst_message_new_latency(GST_OBJECT(element)));
}

}  // namespace lidar::gst

// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/gstlidar.h"

#include "gst/common/pose_covariance.h"

namespace {

// Registers the name unless it is registered already, because a process can register a name only
// once.
void RegisterMeta(const char* name) {
  static const gchar* no_tags[] = {nullptr};
  if (gst_meta_get_info(name) == nullptr)
    gst_meta_register_custom(name, no_tags, nullptr, nullptr, nullptr);
}

/// Returns the structure of the meta `name` of `buffer`. Adds the meta if it is missing.
GstStructure* WritableMeta(GstBuffer* buffer, const char* name) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, name);
  if (meta == nullptr) meta = gst_buffer_add_custom_meta(buffer, name);
  return gst_custom_meta_get_structure(meta);
}

GstStructure* ReadMeta(GstBuffer* buffer, const char* name) {
  GstCustomMeta* meta = gst_buffer_get_custom_meta(buffer, name);
  return meta == nullptr ? nullptr : gst_custom_meta_get_structure(meta);
}

GstCaps* UnixTimeReference() {
  static GstStaticCaps caps = GST_STATIC_CAPS("timestamp/x-unix");
  return gst_static_caps_get(&caps);
}

}  // namespace

void gst_lidar_init(void) {
  static gsize done = 0;
  if (g_once_init_enter(&done)) {
    RegisterMeta(GST_LIDAR_SLICE_META_NAME);
    RegisterMeta(GST_LIDAR_ECN_META_NAME);
    RegisterMeta(GST_LIDAR_POSE_META_NAME);
    g_once_init_leave(&done, 1);
  }
}

void gst_lidar_buffer_set_slice(GstBuffer* buffer, const GstLidarSlice* slice) {
  gst_structure_set(WritableMeta(buffer, GST_LIDAR_SLICE_META_NAME), "scan-id", G_TYPE_UINT,
                    slice->scan_id, "slice-index", G_TYPE_UINT, slice->slice_index, "slice-count",
                    G_TYPE_UINT, slice->slice_count, "first-column", G_TYPE_UINT,
                    slice->first_column, nullptr);
}

gboolean gst_lidar_buffer_get_slice(GstBuffer* buffer, GstLidarSlice* slice) {
  *slice = {0, 0, 1, 0};
  GstStructure* s = ReadMeta(buffer, GST_LIDAR_SLICE_META_NAME);
  GstLidarSlice read{};
  if (s == nullptr ||
      !gst_structure_get(s, "scan-id", G_TYPE_UINT, &read.scan_id, "slice-index", G_TYPE_UINT,
                         &read.slice_index, "slice-count", G_TYPE_UINT, &read.slice_count,
                         "first-column", G_TYPE_UINT, &read.first_column, nullptr)) {
    return FALSE;
  }
  *slice = read;
  return TRUE;
}

void gst_lidar_buffer_set_ecn(GstBuffer* buffer, GstLidarEcn ecn, GstClockTime arrival) {
  gst_structure_set(WritableMeta(buffer, GST_LIDAR_ECN_META_NAME), "ecn", G_TYPE_UINT,
                    static_cast<guint>(ecn), "arrival", G_TYPE_UINT64, arrival, nullptr);
}

gboolean gst_lidar_buffer_get_ecn(GstBuffer* buffer, GstLidarEcn* ecn, GstClockTime* arrival) {
  GstStructure* s = ReadMeta(buffer, GST_LIDAR_ECN_META_NAME);
  guint bits = 0;
  if (s == nullptr || !gst_structure_get_uint(s, "ecn", &bits)) return FALSE;
  if (ecn != nullptr) *ecn = static_cast<GstLidarEcn>(bits & 3);
  if (arrival != nullptr && !gst_structure_get_uint64(s, "arrival", arrival))
    *arrival = GST_CLOCK_TIME_NONE;
  return TRUE;
}

void gst_lidar_buffer_set_capture_time(GstBuffer* buffer, GstClockTime unix_time) {
  GstCaps* reference = UnixTimeReference();
  if (auto* meta = gst_buffer_get_reference_timestamp_meta(buffer, reference)) {
    meta->timestamp = unix_time;
  } else {
    gst_buffer_add_reference_timestamp_meta(buffer, reference, unix_time, GST_CLOCK_TIME_NONE);
  }
  gst_caps_unref(reference);
}

GstClockTime gst_lidar_buffer_get_capture_time(GstBuffer* buffer) {
  GstCaps* reference = UnixTimeReference();
  auto* meta = gst_buffer_get_reference_timestamp_meta(buffer, reference);
  gst_caps_unref(reference);
  return meta == nullptr ? GST_CLOCK_TIME_NONE : meta->timestamp;
}

void gst_lidar_buffer_set_pose(GstBuffer* buffer, const GstLidarPose* pose) {
  const gdouble* p = pose->position;
  const gdouble* q = pose->orientation;
  GstStructure* s = WritableMeta(buffer, GST_LIDAR_POSE_META_NAME);
  gst_structure_set(s, "x", G_TYPE_DOUBLE, p[0], "y", G_TYPE_DOUBLE, p[1], "z", G_TYPE_DOUBLE, p[2],
                    "qx", G_TYPE_DOUBLE, q[0], "qy", G_TYPE_DOUBLE, q[1], "qz", G_TYPE_DOUBLE, q[2],
                    "qw", G_TYPE_DOUBLE, q[3], "tracking", G_TYPE_UINT,
                    static_cast<guint>(pose->tracking), nullptr);
  lidar::gst::SetCovariance(pose->covariance, s);
}

gboolean gst_lidar_buffer_get_pose(GstBuffer* buffer, GstLidarPose* pose) {
  GstStructure* s = ReadMeta(buffer, GST_LIDAR_POSE_META_NAME);
  gdouble* p = pose->position;
  gdouble* q = pose->orientation;
  guint tracking = 0;
  if (s == nullptr ||
      !gst_structure_get(s, "x", G_TYPE_DOUBLE, &p[0], "y", G_TYPE_DOUBLE, &p[1], "z",
                         G_TYPE_DOUBLE, &p[2], "qx", G_TYPE_DOUBLE, &q[0], "qy", G_TYPE_DOUBLE,
                         &q[1], "qz", G_TYPE_DOUBLE, &q[2], "qw", G_TYPE_DOUBLE, &q[3], "tracking",
                         G_TYPE_UINT, &tracking, nullptr) ||
      !lidar::gst::GetCovariance(s, pose->covariance)) {
    return FALSE;
  }
  pose->tracking = static_cast<GstLidarTracking>(MIN(tracking, GST_LIDAR_TRACKING_LOST));
  return TRUE;
}

GstEvent* gst_lidar_event_new_target_bitrate(const GstLidarTargetBitrate* target) {
  return gst_event_new_custom(
      GST_EVENT_CUSTOM_UPSTREAM,
      gst_structure_new(GST_LIDAR_TARGET_BITRATE_EVENT, "bitrate", G_TYPE_UINT, target->bitrate,
                        "ssrc", G_TYPE_UINT, target->ssrc, "min-bitrate", G_TYPE_UINT,
                        target->min_bitrate, "max-bitrate", G_TYPE_UINT, target->max_bitrate, "rtt",
                        G_TYPE_UINT64, target->rtt, "queue-delay", G_TYPE_UINT64,
                        target->queue_delay, "reason", G_TYPE_STRING,
                        target->reason != nullptr ? target->reason : "update", nullptr));
}

gboolean gst_lidar_event_parse_target_bitrate(GstEvent* event, GstLidarTargetBitrate* target) {
  *target = {};
  const GstStructure* s = gst_event_get_structure(event);
  if (GST_EVENT_TYPE(event) != GST_EVENT_CUSTOM_UPSTREAM || s == nullptr ||
      !gst_structure_has_name(s, GST_LIDAR_TARGET_BITRATE_EVENT) ||
      !gst_structure_get_uint(s, "bitrate", &target->bitrate)) {
    return FALSE;
  }
  // Senders of others may set only the bitrate.
  gst_structure_get_uint(s, "ssrc", &target->ssrc);
  gst_structure_get_uint(s, "min-bitrate", &target->min_bitrate);
  gst_structure_get_uint(s, "max-bitrate", &target->max_bitrate);
  gst_structure_get_uint64(s, "rtt", &target->rtt);
  gst_structure_get_uint64(s, "queue-delay", &target->queue_delay);
  target->reason = gst_structure_get_string(s, "reason");
  return TRUE;
}

namespace {

/// Sets the field `name` to a list of numbers. Each pair is two consecutive numbers in the list.
void SetPairs(GstStructure* s, const char* name, guint count, guint (*number)(gconstpointer, guint),
              gconstpointer data) {
  GValue list = G_VALUE_INIT;
  GValue value = G_VALUE_INIT;
  gst_value_array_init(&list, 2 * count);
  g_value_init(&value, G_TYPE_UINT);
  for (guint i = 0; i < 2 * count; ++i) {
    g_value_set_uint(&value, number(data, i));
    gst_value_array_append_value(&list, &value);
  }
  gst_structure_take_value(s, name, &list);
}

/// Reads a list of numbers that contains pairs. Reads at most GST_LIDAR_MAX_RECEIVED pairs. Returns
/// FALSE if the list is malformed.
gboolean GetPairs(const GstStructure* s, const char* name, guint* count,
                  void (*take)(gpointer, guint, guint, guint), gpointer data) {
  const GValue* list = gst_structure_get_value(s, name);
  if (list == nullptr || !GST_VALUE_HOLDS_ARRAY(list)) return FALSE;
  const guint pairs = gst_value_array_get_size(list) / 2;
  *count = MIN(pairs, guint{GST_LIDAR_MAX_RECEIVED});
  for (guint i = 0; i < *count; ++i) {
    const GValue* first = gst_value_array_get_value(list, 2 * i);
    const GValue* second = gst_value_array_get_value(list, 2 * i + 1);
    if (!G_VALUE_HOLDS_UINT(first) || !G_VALUE_HOLDS_UINT(second)) return FALSE;
    take(data, i, g_value_get_uint(first), g_value_get_uint(second));
  }
  return TRUE;
}

const GstStructure* UpstreamNamed(GstEvent* event, const char* name) {
  const GstStructure* s = gst_event_get_structure(event);
  const bool is_it = GST_EVENT_TYPE(event) == GST_EVENT_CUSTOM_UPSTREAM && s != nullptr &&
                     gst_structure_has_name(s, name);
  return is_it ? s : nullptr;
}

}  // namespace

GstEvent* gst_lidar_event_new_packets_received(const GstLidarPacketsReceived* received) {
  GstStructure* s =
      gst_structure_new(GST_LIDAR_PACKETS_RECEIVED_EVENT, "ssrc", G_TYPE_UINT, received->ssrc,
                        "receiver", G_TYPE_UINT, received->receiver, nullptr);
  SetPairs(
      s, "ranges", received->count,
      [](gconstpointer data, guint i) -> guint {
        const GstLidarSequenceRange& range =
            static_cast<const GstLidarPacketsReceived*>(data)->ranges[i / 2];
        return i % 2 == 0 ? range.first : range.last;
      },
      received);
  return gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s);
}

gboolean gst_lidar_event_parse_packets_received(GstEvent* event,
                                                GstLidarPacketsReceived* received) {
  *received = {};
  const GstStructure* s = UpstreamNamed(event, GST_LIDAR_PACKETS_RECEIVED_EVENT);
  return s != nullptr && gst_structure_get_uint(s, "ssrc", &received->ssrc) &&
         gst_structure_get_uint(s, "receiver", &received->receiver) &&
         GetPairs(
             s, "ranges", &received->count,
             [](gpointer data, guint i, guint first, guint last) {
               static_cast<GstLidarPacketsReceived*>(data)->ranges[i] = {
                   static_cast<guint16>(first), static_cast<guint16>(last)};
             },
             received);
}

GstEvent* gst_lidar_event_new_slices_received(const GstLidarSlicesReceived* received) {
  GstStructure* s = gst_structure_new(GST_LIDAR_SLICES_RECEIVED_EVENT, "receiver", G_TYPE_UINT,
                                      received->receiver, nullptr);
  SetPairs(
      s, "slices", received->count,
      [](gconstpointer data, guint i) -> guint {
        const GstLidarReceivedSlice& slice =
            static_cast<const GstLidarSlicesReceived*>(data)->slices[i / 2];
        return i % 2 == 0 ? slice.scan_id : slice.slice_index;
      },
      received);
  return gst_event_new_custom(GST_EVENT_CUSTOM_UPSTREAM, s);
}

gboolean gst_lidar_event_parse_slices_received(GstEvent* event, GstLidarSlicesReceived* received) {
  *received = {};
  const GstStructure* s = UpstreamNamed(event, GST_LIDAR_SLICES_RECEIVED_EVENT);
  return s != nullptr && gst_structure_get_uint(s, "receiver", &received->receiver) &&
         GetPairs(
             s, "slices", &received->count,
             [](gpointer data, guint i, guint scan_id, guint slice_index) {
               static_cast<GstLidarSlicesReceived*>(data)->slices[i] = {scan_id, slice_index};
             },
             received);
}

GstEvent* gst_lidar_event_new_bitrate_bounds(const GstLidarBitrateBounds* bounds) {
  return gst_event_new_custom(
      GST_EVENT_CUSTOM_DOWNSTREAM_STICKY,
      gst_structure_new(GST_LIDAR_BITRATE_BOUNDS_EVENT, "min-bitrate", G_TYPE_UINT,
                        bounds->min_bitrate, "max-bitrate", G_TYPE_UINT, bounds->max_bitrate,
                        "nominal-bitrate", G_TYPE_UINT, bounds->nominal_bitrate, nullptr));
}

gboolean gst_lidar_event_parse_bitrate_bounds(GstEvent* event, GstLidarBitrateBounds* bounds) {
  *bounds = {};
  const GstStructure* s = gst_event_get_structure(event);
  return GST_EVENT_TYPE(event) == GST_EVENT_CUSTOM_DOWNSTREAM_STICKY && s != nullptr &&
         gst_structure_has_name(s, GST_LIDAR_BITRATE_BOUNDS_EVENT) &&
         gst_structure_get(s, "min-bitrate", G_TYPE_UINT, &bounds->min_bitrate, "max-bitrate",
                           G_TYPE_UINT, &bounds->max_bitrate, "nominal-bitrate", G_TYPE_UINT,
                           &bounds->nominal_bitrate, nullptr);
}

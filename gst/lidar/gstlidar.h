/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What all gst-lidar plugins share: metas on buffers, and events between elements. */
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS

#ifdef GST_LIDAR_BUILD
#define GST_LIDAR_API __attribute__((visibility("default")))
#else
#define GST_LIDAR_API
#endif

#define GST_LIDAR_CLOUD_MEDIA_TYPE "application/x-pointcloud2"
#define GST_LIDAR_DRACO_MEDIA_TYPE "application/x-draco"
#define GST_LIDAR_IMU_MEDIA_TYPE "application/x-imu"
#define GST_LIDAR_ODOMETRY_MEDIA_TYPE "application/x-odometry"
#define GST_LIDAR_SLICE_MEDIA_TYPE "application/x-lidar-slice"
#define GST_LIDAR_SLICE_META_NAME "LidarSliceMeta"
#define GST_LIDAR_ECN_META_NAME "LidarEcnMeta"
#define GST_LIDAR_POSE_META_NAME "LidarPoseMeta"
#define GST_LIDAR_TARGET_BITRATE_EVENT "target-bitrate"
#define GST_LIDAR_BITRATE_BOUNDS_EVENT "bitrate-bounds"
#define GST_LIDAR_PACKETS_RECEIVED_EVENT "packets-received"
#define GST_LIDAR_SLICES_RECEIVED_EVENT "slices-received"

/** Registers the metas. Idempotent and thread-safe; every plugin of the set calls it. */
GST_LIDAR_API void gst_lidar_init(void);

/** A slice: one azimuth sector of a scan. A buffer without this meta is a scan with one slice. */
typedef struct {
  guint scan_id;     /* counts scans, wraps at 2^32 */
  guint slice_index; /* 0 .. slice_count - 1 */
  guint slice_count;
  guint first_column; /* measurement id of the buffer's first column */
} GstLidarSlice;

GST_LIDAR_API void gst_lidar_buffer_set_slice(GstBuffer* buffer, const GstLidarSlice* slice);
/** Returns FALSE and sets @slice to {0, 0, 1, 0} if the buffer has no meta. */
GST_LIDAR_API gboolean gst_lidar_buffer_get_slice(GstBuffer* buffer, GstLidarSlice* slice);

/** The two ECN bits of the IP header (RFC 3168). */
typedef enum {
  GST_LIDAR_ECN_NOT_ECT = 0,
  GST_LIDAR_ECN_ECT1 = 1,
  GST_LIDAR_ECN_ECT0 = 2,
  GST_LIDAR_ECN_CE = 3
} GstLidarEcn;

/** @arrival is the kernel's time of reception [ns since the Unix epoch], or GST_CLOCK_TIME_NONE. */
GST_LIDAR_API void gst_lidar_buffer_set_ecn(GstBuffer* buffer, GstLidarEcn ecn,
                                            GstClockTime arrival);
/** Returns FALSE if the buffer has no meta. Both out pointers may be NULL. */
GST_LIDAR_API gboolean gst_lidar_buffer_get_ecn(GstBuffer* buffer, GstLidarEcn* ecn,
                                                GstClockTime* arrival);

/** Sets the time at which the buffer's first column was sampled [ns since the Unix epoch, UTC]. */
GST_LIDAR_API void gst_lidar_buffer_set_capture_time(GstBuffer* buffer, GstClockTime unix_time);
/** Returns GST_CLOCK_TIME_NONE if the capture time is unknown. */
GST_LIDAR_API GstClockTime gst_lidar_buffer_get_capture_time(GstBuffer* buffer);

/** The reliability of a pose. */
typedef enum {
  GST_LIDAR_TRACKING_STARTED = 0,    /* the first scan, with which the map begins */
  GST_LIDAR_TRACKING_OK = 1,         /* the scan fits the map */
  GST_LIDAR_TRACKING_DEGENERATE = 2, /* the scene does not show the motion along one direction */
  GST_LIDAR_TRACKING_LOST = 3        /* the scan does not fit the map; the pose is a prediction */
} GstLidarTracking;

/**
 * The pose of the sensor, relative to its start, at the time when the buffer's first column was
 * sampled.
 */
typedef struct {
  gdouble position[3];    /* x, y, z [m] */
  gdouble orientation[4]; /* unit quaternion x, y, z, w: sensor to start */
  GstLidarTracking tracking;
  /* Of the pose's error since the start, after the last whole scan: x, y, z [m], and turns about
   * these axes [rad]. Symmetric, row by row, as in nav_msgs/Odometry. */
  gdouble covariance[36];
} GstLidarPose;

GST_LIDAR_API void gst_lidar_buffer_set_pose(GstBuffer* buffer, const GstLidarPose* pose);
/** Returns FALSE if the buffer has no meta. */
GST_LIDAR_API gboolean gst_lidar_buffer_get_pose(GstBuffer* buffer, GstLidarPose* pose);

/**
 * Upstream event: the target bitrate, and the limits of the bitrate, for the output of the element
 * that receives the event [bit/s].
 */
typedef struct {
  guint bitrate;
  guint ssrc;
  guint min_bitrate;
  guint max_bitrate;
  guint64 rtt;         /* ns */
  guint64 queue_delay; /* ns */
  const gchar* reason; /* "start", "update", ...; owned by the event once parsed */
} GstLidarTargetBitrate;

GST_LIDAR_API GstEvent* gst_lidar_event_new_target_bitrate(const GstLidarTargetBitrate* target);
GST_LIDAR_API gboolean gst_lidar_event_parse_target_bitrate(GstEvent* event,
                                                            GstLidarTargetBitrate* target);

/** A range of RTP sequence numbers that includes @first and @last. The numbers may wrap. */
typedef struct {
  guint16 first;
  guint16 last;
} GstLidarSequenceRange;

#define GST_LIDAR_MAX_RECEIVED 256

/**
 * Upstream event from a sender to the payloader: the packets that a receiver has received. More
 * packets may still arrive.
 */
typedef struct {
  guint ssrc;
  guint receiver; /* a number that identifies the receiver */
  guint count;
  GstLidarSequenceRange ranges[GST_LIDAR_MAX_RECEIVED];
} GstLidarPacketsReceived;

GST_LIDAR_API GstEvent* gst_lidar_event_new_packets_received(
    const GstLidarPacketsReceived* received);
GST_LIDAR_API gboolean gst_lidar_event_parse_packets_received(GstEvent* event,
                                                              GstLidarPacketsReceived* received);

/** Identifies a slice by the numbers in its GstLidarSlice. */
typedef struct {
  guint scan_id;
  guint slice_index;
} GstLidarReceivedSlice;

/**
 * Upstream event from a payloader to the encoder: the slices that a receiver has received
 * completely.
 */
typedef struct {
  guint receiver;
  guint count;
  GstLidarReceivedSlice slices[GST_LIDAR_MAX_RECEIVED];
} GstLidarSlicesReceived;

GST_LIDAR_API GstEvent* gst_lidar_event_new_slices_received(const GstLidarSlicesReceived* received);
GST_LIDAR_API gboolean gst_lidar_event_parse_slices_received(GstEvent* event,
                                                             GstLidarSlicesReceived* received);

/**
 * Sticky downstream event: the bitrate that the encoder needs to keep its error bound, the bitrate
 * that it can use at most, and its nominal bitrate [bit/s].
 */
typedef struct {
  guint min_bitrate;
  guint max_bitrate;
  guint nominal_bitrate;
} GstLidarBitrateBounds;

GST_LIDAR_API GstEvent* gst_lidar_event_new_bitrate_bounds(const GstLidarBitrateBounds* bounds);
GST_LIDAR_API gboolean gst_lidar_event_parse_bitrate_bounds(GstEvent* event,
                                                            GstLidarBitrateBounds* bounds);

G_END_DECLS

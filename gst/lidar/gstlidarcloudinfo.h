/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Raw clouds for applications, as GstVideoInfo and GstVideoFrame are for video: the caps, parsed
 * once, and the points of a buffer by the names of their fields.
 */
#pragma once
#include <gst/lidar/gstlidar.h>

G_BEGIN_DECLS

typedef enum {
  GST_LIDAR_FIELD_I8,
  GST_LIDAR_FIELD_U8,
  GST_LIDAR_FIELD_I16,
  GST_LIDAR_FIELD_U16,
  GST_LIDAR_FIELD_I32,
  GST_LIDAR_FIELD_U32,
  GST_LIDAR_FIELD_F32,
  GST_LIDAR_FIELD_F64
} GstLidarFieldType;

#define GST_LIDAR_MAX_FIELDS 32

/** A field of a point. Its numbers are little-endian. */
typedef struct {
  gchar name[64]; /* a longer name is cut off */
  GstLidarFieldType type;
  guint offset; /* bytes from the start of the point */
} GstLidarField;

/** The contents of a cloud's caps. A cloud is stored point by point, row after row. */
typedef struct {
  guint width;       /* columns, or points */
  guint height;      /* beams; 1: the cloud has no rows */
  guint point_step;  /* bytes per point, including gaps between its fields */
  gboolean is_dense; /* every point is a return */
  gint framerate_n;  /* scans/s; 0/1: not known */
  gint framerate_d;
  guint n_fields;
  GstLidarField fields[GST_LIDAR_MAX_FIELDS];
  /*< private >*/
  gpointer padding[GST_PADDING];
} GstLidarCloudInfo;

/**
 * Parses @caps. Returns FALSE if they are not the caps of a little-endian raw cloud with a fixed
 * size.
 */
GST_LIDAR_API gboolean gst_lidar_cloud_info_from_caps(GstLidarCloudInfo* info, const GstCaps* caps);
/** Returns the field @name, or NULL if there is no such field. */
GST_LIDAR_API const GstLidarField* gst_lidar_cloud_info_find(const GstLidarCloudInfo* info,
                                                             const gchar* name);

/** The points of a mapped buffer. */
typedef struct {
  GstLidarCloudInfo info;
  guint8* data;
  gsize n_points; /* width * height */
  /*< private >*/
  GstBuffer* buffer;
  GstMapInfo map;
  gpointer padding[GST_PADDING];
} GstLidarCloud;

/** Maps @buffer. Returns FALSE if @buffer cannot be mapped, or if its size does not match @info. */
GST_LIDAR_API gboolean gst_lidar_cloud_map(GstLidarCloud* cloud, const GstLidarCloudInfo* info,
                                           GstBuffer* buffer, GstMapFlags flags);
GST_LIDAR_API void gst_lidar_cloud_unmap(GstLidarCloud* cloud);

/**
 * Returns the value of @field for the point @index. @field must belong to the cloud. Points are
 * counted row by row.
 */
GST_LIDAR_API gdouble gst_lidar_cloud_get(const GstLidarCloud* cloud, const GstLidarField* field,
                                          gsize index);
/**
 * Sets the value of @field for the point @index, in a cloud that is mapped for writing. Integers
 * are rounded and limited to their range.
 */
GST_LIDAR_API void gst_lidar_cloud_set(GstLidarCloud* cloud, const GstLidarField* field,
                                       gsize index, gdouble value);

G_END_DECLS

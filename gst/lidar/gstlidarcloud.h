/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Raw clouds for coders. They are the input of GstLidarEncoder and the output of GstLidarDecoder.
 */
#pragma once
#include <gst/lidar/gstlidar.h>

G_BEGIN_DECLS

/** The caps of a raw cloud. The caller owns all pointers. They are valid until the call returns. */
typedef struct {
  guint width;         /* columns; 0: unknown */
  guint height;        /* beams; 1: the cloud has no rows */
  guint point_step;    /* bytes per point, including gaps between its fields */
  const gchar* fields; /* names, types and offsets: "x:F32:0,y:F32:4,z:F32:8" */
  gint framerate_n;    /* scans/s; 0/1: not known */
  gint framerate_d;
  GstBuffer* sensor_model; /* as in the caps (docs/wire-format.md); NULL: none */
} GstLidarCloudFormat;

/**
 * Returns the offset of a field in a point [bytes], or -1 if no field has the name @name and the
 * type @type. Types are I8, U8, I16, U16, I32, U32, F32 and F64. Integers and floats are
 * little-endian.
 */
GST_LIDAR_API gint gst_lidar_cloud_format_get_offset(const GstLidarCloudFormat* cloud,
                                                     const gchar* name, const gchar* type);

/**
 * Returns caps of @media_type for slices that are encoded from @cloud: alignment=slice, framerate,
 * the sensor model if there is one, and @fields. @fields are the fields of the decoded cloud,
 * without gaps, and include x, y and z as F32. Transfer full.
 */
GST_LIDAR_API GstCaps* gst_lidar_coded_caps_new(const gchar* media_type, const gchar* fields,
                                                const GstLidarCloudFormat* cloud);

/** A decoded point. A pixel without a return is all zero. */
typedef struct {
  gfloat x; /* m */
  gfloat y;
  gfloat z;
  guint32 range; /* mm; 0 if the coder does not encode ranges */
} GstLidarPoint;

G_END_DECLS

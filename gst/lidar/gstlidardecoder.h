/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Base class of decoders of point clouds: coded slices in, slices of a raw cloud out.
 *
 * The base class has the pads `sink` and `src`, the caps, the properties max-points, stats and
 * stats-interval, holds sticky events back until the first slice tells the size of the cloud, drops
 * and counts damaged slices, and sends gaps. A subclass brings two pad templates and decodes one
 * slice; any bytes may come.
 *
 * All virtual methods but reset() run in the streaming thread, one at a time. None is called while
 * a lock is held.
 */
#pragma once
#include <gst/lidar/gstlidarcloud.h>

G_BEGIN_DECLS

#define GST_TYPE_LIDAR_DECODER (gst_lidar_decoder_get_type())
#define GST_LIDAR_DECODER(object) \
  (G_TYPE_CHECK_INSTANCE_CAST((object), GST_TYPE_LIDAR_DECODER, GstLidarDecoder))
#define GST_LIDAR_DECODER_CLASS(klass) \
  (G_TYPE_CHECK_CLASS_CAST((klass), GST_TYPE_LIDAR_DECODER, GstLidarDecoderClass))
#define GST_LIDAR_DECODER_GET_CLASS(object) \
  (G_TYPE_INSTANCE_GET_CLASS((object), GST_TYPE_LIDAR_DECODER, GstLidarDecoderClass))
#define GST_IS_LIDAR_DECODER(object) (G_TYPE_CHECK_INSTANCE_TYPE((object), GST_TYPE_LIDAR_DECODER))

typedef struct _GstLidarDecoder GstLidarDecoder;
typedef struct _GstLidarDecoderClass GstLidarDecoderClass;
typedef struct _GstLidarDecoderState GstLidarDecoderState;

GST_LIDAR_API GType gst_lidar_decoder_get_type(void);

/** What set_format() answers. */
typedef struct {
  gboolean is_organised; /* a slice is rows of pixels, of which some may be missing: the caps keep
                            the sensor model. Else points without order, and none is missing */
  const gchar* refusal;  /* static; where FALSE is returned, what the caps lack */
} GstLidarDecodedFormat;

/** What a coded slice holds. Where it does not say how it was coded, the rest stays as it is. */
typedef struct {
  guint width;  /* columns, or points */
  guint height; /* beams, or 1 */
  gdouble step; /* of the grid [m]; 0: not known */
  gdouble error_bound;
  guint intensity_bits;
  gdouble keep_fraction;    /* rows that the encoder kept; the others it left out to save bits */
  gboolean lacks_reference; /* where FALSE is returned: only because it was coded by another slice
                               that never came. The base class asks for one that stands alone */
} GstLidarDecodedSlice;

struct _GstLidarDecoder {
  GstElement parent;
  /*< private >*/
  GstLidarDecoderState* state;
  gpointer padding[GST_PADDING];
};

struct _GstLidarDecoderClass {
  GstElementClass parent_class;

  /**
   * Before the first slice and at each change of @caps. @cloud is what write() is to give: packed
   * fields, x, y and z as F32 among them. FALSE where the caps cannot be decoded; the base class
   * posts the error.
   */
  gboolean (*set_format)(GstLidarDecoder* decoder, GstCaps* caps, const GstLidarCloudFormat* cloud,
                         GstLidarDecodedFormat* decoded);
  /**
   * Decodes a slice for write(), until whose return @data stays. FALSE for what is damaged,
   * hostile, or of more than @max_points, for which nothing may be allocated.
   */
  gboolean (*decode)(GstLidarDecoder* decoder, const guint8* data, gsize size, guint max_points,
                     GstLidarDecodedSlice* slice);
  /** Writes all of the slice decoded last: width * height points. What it does not know is 0. */
  void (*write)(GstLidarDecoder* decoder, guint8* points);
  /** The element went to READY: free what belongs to the stream. Optional. */
  void (*reset)(GstLidarDecoder* decoder);

  /*< private >*/
  gpointer padding[GST_PADDING_LARGE];
};

G_DEFINE_AUTOPTR_CLEANUP_FUNC(GstLidarDecoder, gst_object_unref)

G_END_DECLS

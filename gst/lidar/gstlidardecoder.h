/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Base class of decoders of point clouds: coded slices in, slices of a raw cloud out.
 *
 * The base class has the pads `sink` and `src`, the caps, the properties max-points, stats and
 * stats-interval, holds sticky events back until the first slice gives the size of the cloud, drops
 * and counts damaged slices, and sends gaps. A subclass brings two pad templates and decodes one
 * slice from unchecked bytes.
 *
 * All virtual methods but reset() run in the streaming thread, one at a time. The base class holds
 * no lock during a call.
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

/** The answer of set_format(). */
typedef struct {
  gboolean is_organised; /* TRUE: a slice has rows of pixels, and some pixels may be missing. The
                            caps keep the sensor model. FALSE: points in no order, none missing */
  const gchar* refusal;  /* says what the caps lack, if set_format() returns FALSE; static */
} GstLidarDecodedFormat;

/**
 * The properties of a decoded slice. decode() does not change a member about the coding if the
 * slice does not contain its value.
 */
typedef struct {
  guint width;  /* columns, or points */
  guint height; /* beams, or 1 */
  gdouble step; /* step of the grid [m]; 0: unknown */
  gdouble error_bound;
  guint intensity_bits;
  gdouble keep_fraction; /* share of the rows that were kept; the rest was removed to save bits */
  gboolean lacks_reference; /* TRUE if decode() returns FALSE only because the slice refers to a
                               slice that never arrived. The base class then requests a slice
                               without references */
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
   * Called before the first slice and at each change of @caps. @cloud is the cloud that write()
   * must give: packed fields, x, y and z as F32 among them. Returns FALSE if slices of the caps
   * cannot be decoded; the base class posts the error.
   */
  gboolean (*set_format)(GstLidarDecoder* decoder, GstCaps* caps, const GstLidarCloudFormat* cloud,
                         GstLidarDecodedFormat* decoded);
  /**
   * Decodes a slice for write(); @data is valid until write() returns. Returns FALSE if the slice
   * is damaged, hostile, or of more than @max_points, for which it must allocate nothing.
   */
  gboolean (*decode)(GstLidarDecoder* decoder, const guint8* data, gsize size, guint max_points,
                     GstLidarDecodedSlice* slice);
  /** Writes all width * height points of the last decoded slice. Unknown values are 0. */
  void (*write)(GstLidarDecoder* decoder, guint8* points);
  /** Frees what belongs to the stream, because the element has changed to READY. Optional. */
  void (*reset)(GstLidarDecoder* decoder);

  /*< private >*/
  gpointer padding[GST_PADDING_LARGE];
};

G_DEFINE_AUTOPTR_CLEANUP_FUNC(GstLidarDecoder, gst_object_unref)

G_END_DECLS

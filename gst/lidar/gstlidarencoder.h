/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Base class of encoders of point clouds: slices in, slices out (docs/writing-an-encoder.md).
 *
 * The base class has the pads `sink` and `src`, the caps, the rate loop, the events target-bitrate,
 * bitrate-bounds and slices-received, the properties bitrate, max-error, min-bitrate,
 * quantization-step, intensity-bits, rate-model, model-location, degradation-preference, threads,
 * error-check, stats and stats-interval, gaps, DISCONT, flushes and state changes. A subclass
 * brings two pad templates and codes one slice at one step.
 *
 * All virtual methods but reset() run in the streaming thread, one at a time. The base class holds
 * no lock during a call.
 */
#pragma once
#include <gst/lidar/gstlidarcloud.h>

G_BEGIN_DECLS

#define GST_TYPE_LIDAR_ENCODER (gst_lidar_encoder_get_type())
#define GST_LIDAR_ENCODER(object) \
  (G_TYPE_CHECK_INSTANCE_CAST((object), GST_TYPE_LIDAR_ENCODER, GstLidarEncoder))
#define GST_LIDAR_ENCODER_CLASS(klass) \
  (G_TYPE_CHECK_CLASS_CAST((klass), GST_TYPE_LIDAR_ENCODER, GstLidarEncoderClass))
#define GST_LIDAR_ENCODER_GET_CLASS(object) \
  (G_TYPE_INSTANCE_GET_CLASS((object), GST_TYPE_LIDAR_ENCODER, GstLidarEncoderClass))
#define GST_IS_LIDAR_ENCODER(object) (G_TYPE_CHECK_INSTANCE_TYPE((object), GST_TYPE_LIDAR_ENCODER))

typedef struct _GstLidarEncoder GstLidarEncoder;
typedef struct _GstLidarEncoderClass GstLidarEncoderClass;
typedef struct _GstLidarEncoderState GstLidarEncoderState;

GST_LIDAR_API GType gst_lidar_encoder_get_type(void);

/** The answer of set_format(). */
typedef struct {
  GstCaps* caps;         /* caps of the coded slices: gst_lidar_coded_caps_new(); transfer full */
  gboolean codes_ranges; /* TRUE: receivers compute points from the ranges and the sensor model.
                            The base class then warns if positions contradict the ranges */
  const gchar* refusal;  /* says what the cloud lacks, if set_format() returns FALSE; static */
} GstLidarCodedFormat;

/** A slice of a raw cloud. It is valid until the next call of load(). */
typedef struct {
  const guint8* data;
  gsize size;         /* bytes; of whole points, and of whole beams if height is above 1 */
  guint width;        /* columns; computed from the size of the buffer if the caps lack it */
  guint height;       /* beams */
  guint first_column; /* measurement id of the first column */
  guint scan_id;      /* scan_id to slice_count: as in GstLidarSlice */
  guint slice_index;
  guint slice_count;
} GstLidarRawSlice;

/** The result of load(). */
typedef struct {
  guint returns;          /* number of points that encode() will encode */
  gdouble extent;         /* longest side of the points' box, or the longest range [m] */
  guint rows;             /* number of beams or points from which thin() chooses; 0: no thinning */
  gboolean has_intensity; /* the slice has intensities to encode */
  guint level;            /* highest compression level, which rate models may lower; or 0 */
  const gchar* mode;      /* "xyz-" or "range-" and a name of the coder's choice, valid until the
                             next load(). Sizes are learnt for each mode separately. NULL means
                             "xyz-other" */
} GstLidarLoadedSlice;

/** The grid steps of a coder that keep the error within a limit [m]. */
typedef struct {
  gdouble finest;   /* finer steps would only encode meaningless digits */
  gdouble coarsest; /* the largest step that keeps the error; may be smaller than finest */
  gdouble unit;     /* all steps are finest plus a multiple of unit; 0: any step */
} GstLidarStepRange;

/** The settings for encode(). */
typedef struct {
  gdouble max_error;    /* largest allowed distance between a point and its decoded point [m] */
  gdouble step;         /* wanted step of the grid [m], if max_error allows it */
  guint intensity_bits; /* 0: geometry only */
  guint level;          /* compression level, at most `level` of GstLidarLoadedSlice */
  guint threads;        /* most threads for this slice; 1: only the calling thread */
} GstLidarEncodeSettings;

/** The result of encode(). */
typedef struct {
  guint returns;       /* number of encoded points */
  gdouble step;        /* step of the grid that was used [m] */
  gdouble error_bound; /* largest possible distance with this step [m] */
} GstLidarCodedSlice;

typedef enum {
  GST_LIDAR_ENCODE_OK = 0,
  GST_LIDAR_ENCODE_EMPTY = 1,       /* this coder can encode nothing of it: the slice is a gap */
  GST_LIDAR_ENCODE_OUT_OF_REACH = 2 /* no step of this coder keeps max_error: a gap and a warning */
} GstLidarEncodeResult;

/** The rule that assigns each decoded point to a point of the raw slice. */
typedef enum {
  GST_LIDAR_ORDER_PIXELS = 0, /* one point for each point of the raw slice, in its order */
  GST_LIDAR_ORDER_KEPT = 1,   /* the raw points that are finite and not all zero, in their order */
  GST_LIDAR_ORDER_ANY = 2 /* as KEPT, but in any order, and a point may stand for several points.
                             Errors are distances to the nearest point */
} GstLidarPointOrder;

struct _GstLidarEncoder {
  GstElement parent;
  /*< private >*/
  GstLidarEncoderState* state;
  gpointer padding[GST_PADDING];
};

struct _GstLidarEncoderClass {
  GstElementClass parent_class;

  /**
   * Called before the first slice and at each change of caps. @with_intensity is TRUE if
   * intensity-bits is above 0. Returns FALSE if this coder cannot encode such clouds. The base
   * class then posts the error.
   */
  gboolean (*set_format)(GstLidarEncoder* encoder, const GstLidarCloudFormat* cloud,
                         gboolean with_intensity, GstLidarCodedFormat* coded);
  /** Loads a slice. The next four methods use this slice. */
  void (*load)(GstLidarEncoder* encoder, const GstLidarRawSlice* raw, GstLidarLoadedSlice* loaded);
  /**
   * Sets @steps to the steps that keep the error within @max_error. Optional. The default is the
   * steps of a cubic grid of coordinates.
   */
  void (*get_steps)(GstLidarEncoder* encoder, gdouble max_error, GstLidarStepRange* steps);
  /** Removes the rows whose element of @kept is 0. Optional if the loaded slice has no rows. */
  void (*thin)(GstLidarEncoder* encoder, const guint8* kept, guint rows);
  /** Appends the coded slice to @bytes, which is empty. May be called several times for a slice. */
  GstLidarEncodeResult (*encode)(GstLidarEncoder* encoder, const GstLidarEncodeSettings* settings,
                                 GByteArray* bytes, GstLidarCodedSlice* coded);
  /**
   * Decodes a coded slice as a receiver would, for error-check. Appends a GstLidarPoint for each
   * point to @points. Returns FALSE if the slice cannot be decoded. Optional. If it is missing,
   * error-check does nothing.
   */
  gboolean (*decode)(GstLidarEncoder* encoder, const guint8* data, gsize size, GArray* points,
                     GstLidarPointOrder* order);
  /** Frees what belongs to the stream, because the element has changed to READY. Optional. */
  void (*reset)(GstLidarEncoder* encoder);
  /**
   * Notes that a receiver has received a whole slice, or that it has received none yet
   * (@slice_index is G_MAXUINT). Called only while slices go to a single destination. @receiver is
   * a number that identifies the receiver. Optional.
   */
  void (*acknowledge)(GstLidarEncoder* encoder, guint receiver, guint scan_id, guint slice_index);
  /**
   * Makes encode() encode the next slices without references, because a receiver cannot decode its
   * slices. Optional.
   */
  void (*request_key)(GstLidarEncoder* encoder);

  /*< private >*/
  gpointer padding[GST_PADDING_LARGE];
};

G_DEFINE_AUTOPTR_CLEANUP_FUNC(GstLidarEncoder, gst_object_unref)

G_END_DECLS

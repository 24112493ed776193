// SPDX-License-Identifier: LGPL-2.1-or-later
// An encoder and a decoder in one file, which use only the public API. The encoder maps each point
// to a cell of a uniform grid. It writes the difference to the cell of the previous point in as few
// bytes as the difference needs. docs/writing-an-encoder.md explains the code.
#include <gst/lidar/gstlidardecoder.h>
#include <gst/lidar/gstlidarencoder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#define EXAMPLE_MEDIA_TYPE "application/x-lidar-example"

// A coded slice consists of this header and of three differences for each point. All numbers are
// little-endian.
struct Header {
  guint32 points;
  gfloat step;  // m
};
constexpr double kMaxCell = 1 << 28;
constexpr double kFinestStep = 0.001;  // m
// The largest distance between a point and the middle of its cell, for a step of 1. It is half the
// diagonal of a cube.
constexpr double kErrorPerStep = 0.8660254;

// Appends a difference in groups of seven bits, the lowest bits first. The highest bit of a byte is
// set if another byte follows. The lowest bit of the whole number is the sign.
static void put_difference(GByteArray* bytes, gint64 difference) {
  guint64 rest = static_cast<guint64>(difference < 0 ? -difference * 2 - 1 : difference * 2);
  do {
    const guint8 byte = static_cast<guint8>((rest & 127) | (rest > 127 ? 128 : 0));
    g_byte_array_append(bytes, &byte, 1);
    rest >>= 7;
  } while (rest > 0);
}

static gboolean get_difference(const guint8** at, const guint8* end, gint64* difference) {
  guint64 value = 0;
  for (unsigned shift = 0; *at < end && shift < 35; shift += 7) {
    const guint8 byte = *(*at)++;
    value |= static_cast<guint64>(byte & 127) << shift;
    if (byte > 127) continue;
    *difference = value & 1 ? -static_cast<gint64>(value / 2) - 1 : static_cast<gint64>(value / 2);
    return TRUE;
  }
  return FALSE;
}

static gfloat middle_of(gint64 cell, gfloat step) {
  return (static_cast<gfloat>(cell) + 0.5F) * step;
}

// Decodes a slice. exampledec calls this to get its output, and exampleenc to measure the errors of
// its slices. `data` may contain any bytes.
static gboolean decode_slice(const guint8* data, gsize size, guint max_points,
                             std::vector<GstLidarPoint>* points) {
  Header header;
  if (size < sizeof header) return FALSE;
  std::memcpy(&header, data, sizeof header);
  const guint8* at = data + sizeof header;
  const guint8* end = data + size;
  points->clear();
  // Each point has at least three bytes. This check refuses a header whose number of points is too
  // large for the bytes that were sent.
  if (header.points > max_points || header.points > size / 3 || !std::isfinite(header.step))
    return FALSE;
  std::array<gint64, 3> cell = {0, 0, 0};
  for (guint i = 0; i < header.points; ++i) {
    for (gint64& c : cell) {
      gint64 difference = 0;
      if (!get_difference(&at, end, &difference)) return FALSE;
      c += difference;
    }
    const GstLidarPoint point = {middle_of(cell[0], header.step), middle_of(cell[1], header.step),
                                 middle_of(cell[2], header.step), 0};
    points->push_back(point);
  }
  return header.points > 0 && at == end;
}

struct ExampleEnc {
  GstLidarEncoder parent;
  gint x_offset;                               // bytes
  guint point_step;                            // bytes
  std::vector<std::array<gfloat, 3>>* points;  // the points of the loaded slice
};
using ExampleEncClass = GstLidarEncoderClass;
GType example_enc_get_type();
G_DEFINE_TYPE(ExampleEnc, example_enc, GST_TYPE_LIDAR_ENCODER)

static ExampleEnc* EXAMPLE_ENC(gpointer base) { return static_cast<ExampleEnc*>(base); }

static gboolean example_enc_set_format(GstLidarEncoder* base, const GstLidarCloudFormat* cloud,
                                       gboolean, GstLidarCodedFormat* coded) {
  ExampleEnc* self = EXAMPLE_ENC(base);
  self->x_offset = gst_lidar_cloud_format_get_offset(cloud, "x", "F32");
  self->point_step = cloud->point_step;
  if (self->x_offset < 0 ||
      gst_lidar_cloud_format_get_offset(cloud, "y", "F32") != self->x_offset + 4 ||
      gst_lidar_cloud_format_get_offset(cloud, "z", "F32") != self->x_offset + 8) {
    coded->refusal = "it lacks x, y and z as F32 side by side";
    return FALSE;
  }
  coded->caps = gst_lidar_coded_caps_new(EXAMPLE_MEDIA_TYPE, "x:F32:0,y:F32:4,z:F32:8", cloud);
  return TRUE;
}

static void example_enc_load(GstLidarEncoder* base, const GstLidarRawSlice* raw,
                             GstLidarLoadedSlice* loaded) {
  ExampleEnc* self = EXAMPLE_ENC(base);
  gfloat nearest = INFINITY;
  gfloat farthest = -INFINITY;
  self->points->clear();
  for (gsize at = 0; at < raw->size; at += self->point_step) {
    std::array<gfloat, 3> p;
    std::memcpy(p.data(), raw->data + at + self->x_offset, sizeof p);
    if (!std::isfinite(p[0] + p[1] + p[2]) || (p[0] == 0 && p[1] == 0 && p[2] == 0)) continue;
    self->points->push_back(p);
    nearest = std::min(nearest, p[0]);
    farthest = std::max(farthest, p[0]);
  }
  loaded->returns = static_cast<guint>(self->points->size());
  loaded->extent = loaded->returns > 0 ? static_cast<double>(farthest - nearest) : 0;
  loaded->rows = loaded->returns;
  loaded->mode = "xyz-example";
}

static void example_enc_get_steps(GstLidarEncoder*, gdouble max_error, GstLidarStepRange* steps) {
  steps->finest = kFinestStep;
  steps->coarsest = max_error / kErrorPerStep;
  steps->unit = 0;
}

static void example_enc_thin(GstLidarEncoder* base, const guint8* kept, guint) {
  auto& points = *EXAMPLE_ENC(base)->points;
  std::size_t left = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i] != 0) points[left++] = points[i];
  points.resize(left);
}

static GstLidarEncodeResult example_enc_encode(GstLidarEncoder* base,
                                               const GstLidarEncodeSettings* settings,
                                               GByteArray* bytes, GstLidarCodedSlice* coded) {
  ExampleEnc* self = EXAMPLE_ENC(base);
  if (self->points->empty()) return GST_LIDAR_ENCODE_EMPTY;
  // The step is slightly smaller than the error allows, because floats are rounded.
  const double bound = 0.999 * settings->max_error / kErrorPerStep;
  const Header header = {
      static_cast<guint32>(self->points->size()),
      static_cast<gfloat>(std::min(std::max(settings->step, kFinestStep), bound))};
  g_byte_array_append(bytes, reinterpret_cast<const guint8*>(&header), sizeof header);
  std::array<gint64, 3> last = {0, 0, 0};
  for (const auto& p : *self->points) {
    for (unsigned k = 0; k < 3; ++k) {
      const double cell = std::floor(static_cast<double>(p[k]) / static_cast<double>(header.step));
      if (std::abs(cell) > kMaxCell) return GST_LIDAR_ENCODE_OUT_OF_REACH;
      put_difference(bytes, static_cast<gint64>(cell) - last[k]);
      last[k] = static_cast<gint64>(cell);
    }
  }
  coded->returns = header.points;
  coded->step = static_cast<double>(header.step);
  coded->error_bound = coded->step * kErrorPerStep;
  return GST_LIDAR_ENCODE_OK;
}

static gboolean example_enc_decode(GstLidarEncoder*, const guint8* data, gsize size, GArray* points,
                                   GstLidarPointOrder* order) {
  std::vector<GstLidarPoint> decoded;
  if (!decode_slice(data, size, G_MAXUINT, &decoded)) return FALSE;
  g_array_append_vals(points, decoded.data(), static_cast<guint>(decoded.size()));
  *order = GST_LIDAR_ORDER_KEPT;
  return TRUE;
}

static GstStaticPadTemplate raw_sink = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));
static GstStaticPadTemplate coded_src = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(EXAMPLE_MEDIA_TYPE));

static void example_enc_init(ExampleEnc* self) {
  self->points = new std::vector<std::array<gfloat, 3>>;
}

static void example_enc_finalize(GObject* object) {
  delete EXAMPLE_ENC(object)->points;
  G_OBJECT_CLASS(example_enc_parent_class)->finalize(object);
}

static void example_enc_class_init(ExampleEncClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = example_enc_finalize;
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &raw_sink);
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &coded_src);
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "Example encoder",
                                        "Codec/Encoder/PointCloud", "Cells of a uniform grid",
                                        "you");
  klass->set_format = example_enc_set_format;
  klass->load = example_enc_load;
  klass->get_steps = example_enc_get_steps;
  klass->thin = example_enc_thin;
  klass->encode = example_enc_encode;
  klass->decode = example_enc_decode;
}

struct ExampleDec {
  GstLidarDecoder parent;
  std::vector<GstLidarPoint>* points;  // the points of the last decoded slice
};
using ExampleDecClass = GstLidarDecoderClass;
GType example_dec_get_type();
G_DEFINE_TYPE(ExampleDec, example_dec, GST_TYPE_LIDAR_DECODER)

static ExampleDec* EXAMPLE_DEC(gpointer base) { return static_cast<ExampleDec*>(base); }

static gboolean example_dec_set_format(GstLidarDecoder*, GstCaps*, const GstLidarCloudFormat* cloud,
                                       GstLidarDecodedFormat* decoded) {
  decoded->refusal = "their fields are more than x, y and z";
  return cloud->point_step == 12;
}

static gboolean example_dec_decode(GstLidarDecoder* base, const guint8* data, gsize size,
                                   guint max_points, GstLidarDecodedSlice* slice) {
  std::vector<GstLidarPoint>& points = *EXAMPLE_DEC(base)->points;
  if (!decode_slice(data, size, max_points, &points)) return FALSE;
  slice->width = static_cast<guint>(points.size());
  slice->height = 1;
  return TRUE;
}

static void example_dec_write(GstLidarDecoder* base, guint8* points) {
  for (const GstLidarPoint& p : *EXAMPLE_DEC(base)->points) {
    std::memcpy(points, &p, 12);
    points += 12;
  }
}

static GstStaticPadTemplate coded_sink = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(EXAMPLE_MEDIA_TYPE));
static GstStaticPadTemplate raw_src = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_LIDAR_CLOUD_MEDIA_TYPE));

static void example_dec_init(ExampleDec* self) { self->points = new std::vector<GstLidarPoint>; }

static void example_dec_finalize(GObject* object) {
  delete EXAMPLE_DEC(object)->points;
  G_OBJECT_CLASS(example_dec_parent_class)->finalize(object);
}

static void example_dec_class_init(ExampleDecClass* klass) {
  G_OBJECT_CLASS(klass)->finalize = example_dec_finalize;
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &coded_sink);
  gst_element_class_add_static_pad_template(GST_ELEMENT_CLASS(klass), &raw_src);
  gst_element_class_set_static_metadata(GST_ELEMENT_CLASS(klass), "Example decoder",
                                        "Codec/Decoder/PointCloud", "Cells of a uniform grid",
                                        "you");
  klass->set_format = example_dec_set_format;
  klass->decode = example_dec_decode;
  klass->write = example_dec_write;
}

// This function is not static, because tests of this project call it, too.
gboolean example_coder_register(GstPlugin* plugin);
gboolean example_coder_register(GstPlugin* plugin) {
  return gst_element_register(plugin, "exampleenc", GST_RANK_NONE, example_enc_get_type()) &&
         gst_element_register(plugin, "exampledec", GST_RANK_NONE, example_dec_get_type());
}

// The name of a plugin must match the file name of its library, which is libgstlidarexample.so.
#define PACKAGE "lidarexample"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, lidarexample, "A coder of clouds",
                  example_coder_register, "1.0", "LGPL", "lidarexample", "https://example.org")
